// Random triangles, lines and points with random state: culling, depth, stencil, blending, viewports, scissors,
// formats.
#include <cmath>
#include "harness/case.h"

#include "harness/graphics.h"
#include "harness/random_clear.h"

namespace vitrine::cts {
namespace {

enum class Shape { kTriangles, kLines, kPoints, kPolygonMode };

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec4 extra;
layout(location = 0) out vec4 smooth_color;
layout(location = 1) noperspective out vec4 linear_color;
layout(location = 2) flat out vec4 flat_color;
void main() {
  smooth_color = color;
  linear_color = extra;
  flat_color = color.zwxy;
  gl_Position = position;
  gl_PointSize = extra.x * 9.0;
})";

std::string fragment_text(Random& random, const TargetSpec& target) {
  std::string text =
      "layout(location = 0) in vec4 smooth_color;\n"
      "layout(location = 1) noperspective in vec4 linear_color;\n"
      "layout(location = 2) flat in vec4 flat_color;\n";
  std::string writes;
  for (size_t i = 0; i < target.colors.size(); ++i) {
    const FormatInfo& info = format_info(target.colors[i]);
    const std::string prefix = info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
    const std::string n = std::to_string(i);
    text += "layout(location = " + n + ") out " + prefix + "vec4 result" + n + ";\n";
    const std::string value =
        random.pick<const char*>({"smooth_color", "linear_color", "flat_color", "smooth_color + linear_color",
                                  "gl_FragCoord * vec4(0.015, 0.015, 1.0, 1.0)", "smooth_color * flat_color",
                                  "(gl_FrontFacing ? smooth_color : linear_color)", "smooth_color * 2.0 - 0.5"});
    writes += "  result" + n + " = " + prefix + "vec4(" + (prefix.empty() ? value : "(" + value + ") * 100.0") + ");\n";
  }
  if (random.chance(0.15f)) writes += "  if (smooth_color.x > 0.7) discard;\n";
  if (target.depth && aspects_of(target.depth) & VK_IMAGE_ASPECT_DEPTH_BIT && random.chance(0.15f))
    writes += "  gl_FragDepth = linear_color.y;\n";
  return text + "void main() {\n" + writes + "}\n";
}

/// Clip coordinates: mostly in view, often across the planes, sometimes with w < 0; some shared and degenerate.
std::vector<float> random_vertices(Random& random, uint32_t count, bool clipped, bool inside_xy) {
  std::vector<float> values;
  const float size = random.pick({0.05f, 0.3f, 1.0f, 1.0f});
  float cx = 0, cy = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (i % 3 == 0) {
      cx = random.real(-1.0f, 1.0f);
      cy = random.real(-1.0f, 1.0f);
    }
    const float w = clipped && random.chance(0.1f) ? random.real(-1.0f, 0.5f)
                    : random.chance(0.5f)          ? 1.0f
                                                   : random.real(0.2f, 4.0f);
    const float reach = clipped ? random.pick({1.0f, 2.0f, 20.0f}) : 1.0f;
    float x = clipped ? cx + random.real(-1, 1) * size * reach
                      : std::min(std::max(cx + random.real(-1, 1) * size, -1.0f), 1.0f);
    float y = clipped ? cy + random.real(-1, 1) * size * reach
                      : std::min(std::max(cy + random.real(-1, 1) * size, -1.0f), 1.0f);
    // The reference draws points whose centre lies outside the volume (deviations.md, point-clipping).
    if (inside_xy) {
      x = std::min(std::max(x, -1.0f), 1.0f);
      y = std::min(std::max(y, -1.0f), 1.0f);
    }
    const float z = clipped ? random.real(-0.5f, 1.5f) : random.unit();
    for (const float v : {x * w, y * w, z * w, w}) values.push_back(v);
    for (int c = 0; c < 8; ++c) values.push_back(random.unit());
  }
  return values;
}

VkStencilOpState random_stencil(Random& random) {
  const auto op = [&] { return static_cast<VkStencilOp>(random.below(8)); };
  return {op(),
          op(),
          op(),
          static_cast<VkCompareOp>(random.below(8)),
          random.pick({0xffu, 0x0fu, 0xa5u}),
          random.pick({0xffu, 0x3cu}),
          random.below(256)};
}

VkPipelineColorBlendAttachmentState random_blend(Random& random) {
  VkPipelineColorBlendAttachmentState blend{};
  const auto factor = [&] { return static_cast<VkBlendFactor>(random.below(15)); };
  blend.blendEnable = random.chance(0.5f);
  blend.srcColorBlendFactor = factor();
  blend.dstColorBlendFactor = factor();
  blend.colorBlendOp = static_cast<VkBlendOp>(random.below(5));
  blend.srcAlphaBlendFactor = factor();
  blend.dstAlphaBlendFactor = factor();
  blend.alphaBlendOp = static_cast<VkBlendOp>(random.below(5));
  blend.colorWriteMask = random.chance(0.7f) ? 0xf : random.below(16);
  return blend;
}

TargetSpec random_target(Run& run, bool multisample) {
  Random& random = run.random;
  TargetSpec spec;
  spec.width = 16 + random.below(120);
  spec.height = 16 + random.below(120);
  spec.colors.clear();
  const uint32_t count = random.chance(0.75f) ? 1 : 2 + random.below(2);
  for (uint32_t i = 0; i < count; ++i) {
    const VkFormat plain =
        random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT});
    VkFormat format = random.chance(0.5f)
                          ? plain
                          : color_formats()[random.below(static_cast<uint32_t>(color_formats().size()))].format;
    // Both devices must choose the same format, so only formats that Vulkan demands as attachments are drawn blindly.
    if (!(gpus().reference.features_of(format) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) format = plain;
    if (multisample) format = plain;
    spec.colors.push_back(format);
  }
  if (random.chance(0.6f))
    spec.depth = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32,
                              VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  if (multisample) {
    spec.samples = VK_SAMPLE_COUNT_4_BIT;
    spec.resolve = random.chance(0.5f);
  }
  return spec;
}

void random_state(Run& run, GraphicsSpec& spec, const TargetSpec& target, Shape shape) {
  Random& random = run.random;
  spec.raster.cullMode =
      random.chance(0.5f) ? 0 : random.pick<VkCullModeFlags>({VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_FRONT_BIT});
  spec.raster.frontFace = static_cast<VkFrontFace>(random.below(2));
  if (shape == Shape::kPolygonMode)
    spec.raster.polygonMode = random.pick({VK_POLYGON_MODE_LINE, VK_POLYGON_MODE_POINT});
  if (random.chance(0.3f)) {
    spec.raster.depthBiasEnable = VK_TRUE;
    spec.raster.depthBiasConstantFactor = random.real(-200.0f, 200.0f);
    spec.raster.depthBiasSlopeFactor = random.real(-3.0f, 3.0f);
    if (random.chance(0.5f) && run.gpu.features.depthBiasClamp) spec.raster.depthBiasClamp = random.real(-0.1f, 0.1f);
  }
  if (run.gpu.features.depthClamp) spec.raster.depthClampEnable = random.chance(0.2f);
  if (shape == Shape::kLines && run.gpu.features.wideLines && random.chance(0.5f))
    spec.raster.lineWidth = random.real(1.0f, 6.0f);
  if (target.depth) {
    spec.depth.depthTestEnable = random.chance(0.8f);
    spec.depth.depthWriteEnable = random.chance(0.8f);
    spec.depth.depthCompareOp = random.chance(0.5f) ? VK_COMPARE_OP_LESS : static_cast<VkCompareOp>(random.below(8));
    spec.depth.stencilTestEnable = random.chance(0.4f);
    spec.depth.front = random_stencil(random);
    spec.depth.back = random_stencil(random);
    // deviations.md, polygon-mode-facing
    if (shape == Shape::kPolygonMode) spec.depth.back = spec.depth.front;
  }
  for (const VkFormat format : target.colors) {
    VkPipelineColorBlendAttachmentState blend = random_blend(random);
    if (!(gpus().reference.features_of(format) & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT))
      blend.blendEnable = VK_FALSE;
    spec.blends.push_back(blend);
  }
  for (float& constant : spec.blend.blendConstants) constant = random.unit();
  // The reference cuts samples at the viewport's and scissor's pixels (deviations.md, viewport-scissor and
  // multisample-scissor).
  const bool multisample = target.samples != VK_SAMPLE_COUNT_1_BIT;
  if (shape != Shape::kTriangles && multisample) return;
  const auto width = static_cast<float>(target.width), height = static_cast<float>(target.height);
  if (random.chance(0.4f)) {
    const float step = multisample ? 1.0f : 0.125f;
    const auto length = [&](float limit) { return std::floor(random.unit() * limit / step) * step; };
    const float x = length(width * 0.4f), y = length(height * 0.4f);
    const float w = width - x - length(width * 0.3f), h = height - y - length(height * 0.3f);
    VkViewport viewport{x, y, w, h, 0.0f, 1.0f};
    if (random.chance(0.3f)) viewport = {x, y + h, w, -h, 0.0f, 1.0f};
    if (random.chance(0.4f)) viewport.minDepth = random.unit();
    if (random.chance(0.4f)) viewport.maxDepth = random.unit();
    spec.viewports = {viewport};
  }
  if (random.chance(0.3f) && !multisample) {
    const auto x = static_cast<int32_t>(random.below(target.width / 2)),
               y = static_cast<int32_t>(random.below(target.height / 2));
    spec.scissors = {{{x, y}, {random.below(target.width), random.below(target.height)}}};
  }
}

VkPrimitiveTopology random_topology(Random& random, Shape shape) {
  switch (shape) {
    case Shape::kPoints:
      return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    case Shape::kLines:
      return random.pick({VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP});
    default:
      return random.chance(0.7f)
                 ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
                 : random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN});
  }
}

void random_draws(Run& run, Shape shape, bool multisample, bool clipped) {
  Random& random = run.random;
  if (shape == Shape::kPolygonMode) run.require(run.gpu.features.fillModeNonSolid, "fillModeNonSolid");
  const TargetSpec target_spec = random_target(run, multisample);
  Target target = make_target(run, target_spec);
  for (size_t i = 0; i < target_spec.colors.size(); ++i) target.clears[i] = random_clear(random, target_spec.colors[i]);
  if (target.depth) {
    const float stencil = random.unit();
    target.clears.back() = clear_value(target_spec.depth, random.pick({1.0f, 0.5f, 0.7f}), stencil, 0, 0);
  }
  GraphicsSpec spec;
  spec.vertex = kVertex;
  spec.fragment = fragment_text(random, target_spec);
  spec.floats({4, 4, 4});
  spec.assembly.topology = random_topology(random, shape);
  random_state(run, spec, target_spec, shape);
  run.note("fragment", spec.fragment);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const uint32_t count = 3 * (1 + random.below(40)) + (random.chance(0.1f) ? 1 : 0);
  const Buffer vertices = run.buffer_of(random_vertices(random, count, clipped, shape == Shape::kPoints));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, count, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

void add(const char* group, const char* name, uint32_t count, Shape shape, bool multisample, bool clipped) {
  AddGenerator(group, name, count, [=](Run& run) { random_draws(run, shape, multisample, clipped); });
}

const bool kRegistered = [] {
  add("rasterization", "random_triangles", 300, Shape::kTriangles, false, false);
  add("rasterization", "random_triangles_multisample", 100, Shape::kTriangles, true, false);
  add("rasterization", "random_lines", 100, Shape::kLines, false, false);
  add("rasterization", "random_points", 60, Shape::kPoints, false, false);
  add("rasterization", "random_polygon_mode", 60, Shape::kPolygonMode, false, false);
  add("clipping", "random_triangles", 200, Shape::kTriangles, false, true);
  add("clipping", "random_triangles_multisample", 60, Shape::kTriangles, true, true);
  add("clipping", "random_lines", 60, Shape::kLines, false, true);
  add("clipping", "random_points", 40, Shape::kPoints, false, true);
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
