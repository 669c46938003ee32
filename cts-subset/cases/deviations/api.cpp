// Listed deviations of transfers.
#include "cases/deviations/deviation.h"

namespace vitrine::cts {
namespace {

const AddCase kBlitAspect("api", "deviation.blit_other_aspect", "blit-other-aspect", case_against_control,
                          [](Run& run) {
                            ImageSpec spec;
                            spec.format = VK_FORMAT_D32_SFLOAT_S8_UINT;
                            spec.extent = {24, 24, 1};
                            const Image from = run.image(spec), to = run.image(spec);
                            run.fill_random(from);
                            run.fill_random(to);
                            const auto put_depth_out = [&](const char* name) {
                              const FormatInfo& depth = format_info(VK_FORMAT_D32_SFLOAT);
                              run.out(Output{name, depth, 24, 24, 1, run.download(to, 0, VK_IMAGE_ASPECT_DEPTH_BIT)});
                            };
                            put_depth_out("before");
                            VkImageBlit blit{{VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0, 1},
                                             {{0, 0, 0}, {24, 24, 1}},
                                             {VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0, 1},
                                             {{3, 2, 0}, {17, 21, 1}}};
                            run.once([&](VkCommandBuffer cmd) {
                              vkCmdBlitImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle,
                                             VK_IMAGE_LAYOUT_GENERAL, 1, &blit, VK_FILTER_NEAREST);
                            });
                            put_depth_out("after");
                            std::swap(run.outputs[0], run.outputs[1]);
                          });

}  // namespace
}  // namespace vitrine::cts
