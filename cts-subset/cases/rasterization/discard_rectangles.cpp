// Discard rectangles, inclusive and exclusive, static and dynamic, under every topology, depth and stencil tests and
// samples. The reference does not have them: there the fragment shader discards by gl_FragCoord.
#include <algorithm>
#include <sstream>

#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

bool has_rectangles(Run& run) { return run.gpu.has("VK_EXT_discard_rectangles"); }

/// Some of them empty, outside, or over each other.
std::vector<VkRect2D> random_rectangles(Random& random, uint32_t width, uint32_t height) {
  std::vector<VkRect2D> rectangles(1 + random.below(8));
  for (VkRect2D& rectangle : rectangles)
    rectangle = {{static_cast<int32_t>(random.below(width)), static_cast<int32_t>(random.below(height))},
                 {random.chance(0.1f) ? 0 : random.below(width), random.below(height)}};
  return rectangles;
}

/// A fragment shader that does what the rectangles do.
std::string discarding_shader(const std::vector<VkRect2D>& rectangles, bool inclusive) {
  std::ostringstream code;
  code << "layout(location = 0) in vec4 color;\nlayout(location = 0) out vec4 result;\nvoid main() {\n"
          "  ivec2 at = ivec2(gl_FragCoord.xy);\n  bool inside = false;\n";
  for (const VkRect2D& r : rectangles)
    code << "  inside = inside || (at.x >= " << r.offset.x << " && at.y >= " << r.offset.y << " && at.x < "
         << static_cast<uint32_t>(r.offset.x) + r.extent.width << " && at.y < "
         << static_cast<uint32_t>(r.offset.y) + r.extent.height << ");\n";
  code << "  if (inside != " << (inclusive ? "true" : "false") << ") discard;\n  result = color;\n}\n";
  return code.str();
}

void set_tests(Random& random, GraphicsSpec& spec, const TargetSpec& target) {
  if (target.depth == VK_FORMAT_UNDEFINED) return;
  spec.depth.depthTestEnable = random.chance(0.7f);
  spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = random.pick({VK_COMPARE_OP_LESS, VK_COMPARE_OP_GREATER, VK_COMPARE_OP_ALWAYS});
  spec.depth.stencilTestEnable = target.depth == VK_FORMAT_D32_SFLOAT_S8_UINT;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_ZERO, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_INVERT, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
}

/// The reference draws points whose vertex lies outside of the volume (deviations.md, point-clipping).
void keep_inside(std::vector<float>& vertices) {
  for (size_t i = 0; i < vertices.size(); i += 8)
    for (size_t axis = 0; axis < 2; ++axis) vertices[i + axis] = std::clamp(vertices[i + axis], -1.0f, 1.0f);
}

CTS_RANDOM("rasterization", "random_discard_rectangles", 60) {
  run.require(gpus().device.has("VK_EXT_discard_rectangles"), "VK_EXT_discard_rectangles");
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.width = 20 + random.below(150);
  target_spec.height = 20 + random.below(150);
  target_spec.colors = {
      random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})};
  target_spec.depth =
      random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT_S8_UINT});
  if (random.chance(0.3f)) target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Target target = make_target(run, target_spec);
  const std::vector<VkRect2D> rectangles = random_rectangles(random, target_spec.width, target_spec.height);
  const bool inclusive = random.chance(0.5f), dynamic = random.chance(0.5f), large = random.chance(0.3f);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                                        VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, VK_PRIMITIVE_TOPOLOGY_LINE_LIST,
                                        VK_PRIMITIVE_TOPOLOGY_POINT_LIST});
  set_tests(random, spec, target_spec);
  VkPipelineDiscardRectangleStateCreateInfoEXT state{
      VK_STRUCTURE_TYPE_PIPELINE_DISCARD_RECTANGLE_STATE_CREATE_INFO_EXT};
  state.discardRectangleMode =
      inclusive ? VK_DISCARD_RECTANGLE_MODE_INCLUSIVE_EXT : VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT;
  state.discardRectangleCount = static_cast<uint32_t>(rectangles.size());
  if (has_rectangles(run)) {
    if (!dynamic) state.pDiscardRectangles = rectangles.data();
    if (dynamic) spec.dynamic.push_back(VK_DYNAMIC_STATE_DISCARD_RECTANGLE_EXT);
    spec.next = &state;
  } else {
    spec.fragment = discarding_shader(rectangles, inclusive);
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const uint32_t count = large ? 6 : 60;
  std::vector<float> values = random_colored_vertices(random, count);
  if (spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST) keep_inside(values);
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (has_rectangles(run) && dynamic)
      CTS_COMMAND(run.gpu, CmdSetDiscardRectangleEXT)(cmd, 0, state.discardRectangleCount, rectangles.data());
    vkCmdDraw(cmd, count, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
