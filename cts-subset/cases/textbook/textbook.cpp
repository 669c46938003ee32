// The scenes of ./run demo, compared with the reference.
#include <algorithm>

#include "harness/case.h"
#include "harness/graphics.h"
#include "tests/demo/textbook_frag.h"
#include "tests/demo/textbook_scenes.h"
#include "tests/demo/textbook_vert.h"

namespace vitrine::cts {
namespace {

template <size_t N>
std::vector<uint32_t> words(const uint32_t (&array)[N]) {
  return std::vector<uint32_t>(array, array + N);
}

void draw_scene(Run& run, const demo::TextbookScene& scene) {
  run.require(run.gpu.extension_features.bresenhamLines, "bresenhamLines");
  TargetSpec target_spec;
  target_spec.width = demo::kTextbookWidth;
  target_spec.height = demo::kTextbookHeight;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  ImageSpec image_spec;
  image_spec.extent = {demo::kTextureSize, demo::kTextureSize, 1};
  image_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(image_spec);
  run.upload(image, 0, demo::textbook_texels());
  const Resources resources = run.resources({sampled(0, image, run.sampler(VK_FILTER_LINEAR))});
  struct Recorded {
    VkPipeline pipeline;
    Buffer vertices;
    uint32_t count;
  };
  std::vector<Recorded> recorded;
  for (const demo::TextbookDraw& draw : scene.draws) {
    const demo::TextbookState state(draw);
    GraphicsSpec spec;
    spec.vertex_module = run.module(words(textbook_vert));
    spec.fragment_module = run.module(words(textbook_frag));
    spec.fragment_special = &state.special;
    spec.layout = resources.layout;
    spec.floats({4, 4, 2});
    spec.assembly = state.assembly;
    spec.raster = state.raster;
    spec.depth = state.depth;
    spec.blends = {state.blend};
    spec.viewports = {draw.viewport};
    recorded.push_back(
        {make_pipeline(run, spec, target), run.buffer_of(draw.vertices), static_cast<uint32_t>(draw.vertices.size())});
  }
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    resources.bind(cmd);
    for (const Recorded& r : recorded) {
      bind_pipeline(cmd, r.pipeline);
      bind_vertices(cmd, r.vertices);
      vkCmdDraw(cmd, r.count, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

const bool kRegistered = [] {
  for (const demo::TextbookScene& scene : demo::textbook_scenes()) {
    std::string name = scene.name;
    std::replace(name.begin(), name.end(), '-', '_');
    AddCase("textbook", name, [=](Run& run) { draw_scene(run, scene); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
