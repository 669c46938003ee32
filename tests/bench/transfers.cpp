// Copies, blits, clears.
#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kSide = 2048;

double per_second(Run& run, double work, const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBuffer cmd = begin_repeatable(run);
  record(cmd);
  return work / time_submissions(run, finish(cmd));
}

double copy_buffer(Run& run) {
  constexpr VkDeviceSize kBytes = 64 << 20;
  const cts::Buffer from = run.buffer(kBytes), to = run.buffer(kBytes);
  const VkBufferCopy copy{0, 0, kBytes};
  return per_second(run, kBytes / 1e9,
                    [&](VkCommandBuffer cmd) { vkCmdCopyBuffer(cmd, from.handle, to.handle, 1, &copy); });
}

double copy_image(Run& run, bool to_image) {
  const cts::Buffer buffer = run.buffer(VkDeviceSize{kSide} * kSide * 4);
  cts::ImageSpec spec;
  spec.extent = {kSide, kSide, 1};
  const cts::Image image = run.image(spec);
  VkBufferImageCopy copy{};
  copy.imageSubresource = image.layers();
  copy.imageExtent = spec.extent;
  return per_second(run, kSide * kSide * 4 / 1e9, [&](VkCommandBuffer cmd) {
    if (to_image) {
      vkCmdCopyBufferToImage(cmd, buffer.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    } else {
      vkCmdCopyImageToBuffer(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, buffer.handle, 1, &copy);
    }
  });
}

double blit(Run& run, VkFilter filter) {
  cts::ImageSpec spec;
  spec.extent = {1024, 1024, 1};
  const cts::Image from = run.image(spec);
  run.fill_random(from);
  spec.extent = {1400, 1400, 1};
  const cts::Image to = run.image(spec);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = from.layers();
  region.srcOffsets[1] = {1024, 1024, 1};
  region.dstOffsets[1] = {1400, 1400, 1};
  return per_second(run, 1400 * 1400 / 1e6, [&](VkCommandBuffer cmd) {
    vkCmdBlitImage(cmd, from.handle, VK_IMAGE_LAYOUT_GENERAL, to.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region, filter);
  });
}

double clear_image(Run& run) {
  cts::ImageSpec spec;
  spec.extent = {kSide, kSide, 1};
  const cts::Image image = run.image(spec);
  const VkClearColorValue color{{0.1f, 0.2f, 0.3f, 0.4f}};
  const VkImageSubresourceRange range = image.range();
  return per_second(run, kSide * kSide * 4 / 1e9, [&](VkCommandBuffer cmd) {
    vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
  });
}

}  // namespace

std::vector<Workload> transfer_workloads() {
  return {{"x_copy_buffer", "GB/s", false, copy_buffer},
          {"x_buf_to_img", "GB/s", false, [](Run& run) { return copy_image(run, true); }},
          {"x_img_to_buf", "GB/s", false, [](Run& run) { return copy_image(run, false); }},
          {"x_blit_linear", "Mpix/s", false, [](Run& run) { return blit(run, VK_FILTER_LINEAR); }},
          {"x_blit_nearest", "Mpix/s", false, [](Run& run) { return blit(run, VK_FILTER_NEAREST); }},
          {"x_clear_image", "GB/s", false, clear_image}};
}

}  // namespace vitrine::bench
