// Fixed-function state of extensions: provoking vertex, depth clipping, line rasterization, instance divisors, restart
// of lists, stencil export, coverage after the depth test, viewport and layer from the vertex shader.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 smooth_color;
layout(location = 1) noperspective out vec4 linear_color;
layout(location = 2) flat out vec4 flat_color;
void main() {
  smooth_color = color;
  linear_color = color.wzyx;
  flat_color = color.zwxy;
  gl_Position = position;
  gl_PointSize = 1.0 + color.x * 6.0;
})";

const char kFragment[] = R"(
layout(location = 0) in vec4 smooth_color;
layout(location = 1) noperspective in vec4 linear_color;
layout(location = 2) flat in vec4 flat_color;
layout(location = 0) out vec4 result0;
layout(location = 1) out vec4 result1;
void main() {
  result0 = smooth_color + 2.0 * linear_color;
  result1 = flat_color + vec4(0.0, 0.0, gl_FragCoord.zw);
})";

/// position and colour; `reach` > 1: beyond the view volume.
std::vector<float> random_vertices(Random& random, uint32_t count, float reach, float low_z, float high_z) {
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = random.chance(0.3f) ? 1.0f : random.real(0.3f, 3.0f);
    for (const float v :
         {random.real(-reach, reach) * w, random.real(-reach, reach) * w, random.real(low_z, high_z) * w, w})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

struct Scene {
  TargetSpec target;
  GraphicsSpec spec;
  std::vector<float> vertices;
  uint32_t count = 0;

  explicit Scene(Random& random, VkFormat depth = VK_FORMAT_UNDEFINED) {
    target.width = 30 + random.below(70);
    target.height = 30 + random.below(70);
    target.colors = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
    target.depth = depth;
    spec.vertex = kVertex;
    spec.fragment = kFragment;
    spec.floats({4, 4});
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = depth != VK_FORMAT_UNDEFINED;
  }
};

void draw(Run& run, const Scene& scene, const std::function<void(VkCommandBuffer)>& set_state = {}) {
  const Target target = make_target(run, scene.target);
  const VkPipeline pipeline = make_pipeline(run, scene.spec, target);
  const Buffer vertices = run.buffer_of(scene.vertices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (set_state) set_state(cmd);
    vkCmdDraw(cmd, scene.count, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

VkPrimitiveTopology any_topology(Random& random) {
  return static_cast<VkPrimitiveTopology>(random.below(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN + 1));
}

CTS_RANDOM("rasterization", "random_provoking_vertex", 30) {
  Random& random = run.random;
  run.require(run.gpu.extension_features.provokingVertexLast, "provokingVertexLast");
  Scene scene(random, random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D16_UNORM}));
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT mode{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  mode.provokingVertexMode =
      random.chance(0.8f) ? VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT;
  scene.spec.raster.pNext = &mode;
  scene.spec.assembly.topology = any_topology(random);
  scene.spec.raster.cullMode = random.chance(0.3f) ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  const bool points = scene.spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const bool lines = scene.spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST ||
                     scene.spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
  if (!points && !lines && random.chance(0.2f)) scene.spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
  scene.count = 3 + random.below(60);
  scene.vertices = random_vertices(random, scene.count, points || random.chance(0.5f) ? 0.9f : 1.5f, 0, 1);
  draw(run, scene);
}

CTS_RANDOM("clipping", "random_depth_clip", 50) {
  Random& random = run.random;
  const bool has_clip = run.gpu.extension_features.depthClipEnable;
  const bool has_control = run.gpu.extension_features.depthClipControl;
  run.require(has_clip && has_control, "depthClipEnable, depthClipControl");
  Scene scene(random, random.pick({VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32}));
  VkPipelineRasterizationDepthClipStateCreateInfoEXT clip{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT};
  clip.depthClipEnable = random.chance(0.5f);
  if (random.chance(0.7f)) scene.spec.raster.pNext = &clip;
  scene.spec.raster.depthClampEnable = random.chance(0.5f);
  VkPipelineViewportDepthClipControlCreateInfoEXT control{
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT};
  control.negativeOneToOne = random.chance(0.7f);
  if (random.chance(0.7f)) scene.spec.viewport_next = &control;
  VkViewport viewport{0, 0, static_cast<float>(scene.target.width), static_cast<float>(scene.target.height), 0, 1};
  if (random.chance(0.4f)) viewport.minDepth = random.unit();
  if (random.chance(0.4f)) viewport.maxDepth = random.unit();
  scene.spec.viewports = {viewport};
  scene.spec.assembly.topology = any_topology(random);
  const bool points = scene.spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  scene.spec.depth.depthCompareOp = random.pick({VK_COMPARE_OP_LESS, VK_COMPARE_OP_ALWAYS, VK_COMPARE_OP_GREATER});
  scene.count = 3 + random.below(60);
  scene.vertices = random_vertices(random, scene.count, points ? 0.9f : 1.5f, -1.5f, 1.5f);
  draw(run, scene);
}

/// `by_command`: mode and stipple are set by commands, and are others in the pipeline.
void random_lines(Run& run, VkSampleCountFlagBits samples, bool stippled, bool smooth, bool by_command = false) {
  Random& random = run.random;
  const auto& features = run.gpu.extension_features;
  run.require(features.bresenhamLines && features.rectangularLines, "bresenhamLines, rectangularLines");
  Scene scene(random, random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT}));
  scene.target.samples = samples;
  if (samples != VK_SAMPLE_COUNT_1_BIT) {  // deviations.md, multisample-line-tiles
    scene.target.width = std::min(scene.target.width, 64u);
    scene.target.height = std::min(scene.target.height, 64u);
  }
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  line.lineRasterizationMode =
      random.pick({VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT,
                   VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT});
  if (smooth) line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
  // deviations.md, line-depth-first-sample
  if (samples != VK_SAMPLE_COUNT_1_BIT &&
      (smooth || line.lineRasterizationMode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT)) {
    scene.target.depth = VK_FORMAT_UNDEFINED;
    scene.spec.depth.depthTestEnable = scene.spec.depth.depthWriteEnable = VK_FALSE;
  }
  line.lineStippleFactor = 1 + random.below(4);
  line.lineStipplePattern = static_cast<uint16_t>(random.below(65536));
  line.stippledLineEnable = stippled;
  if (stippled) {
    run.require(features.stippledBresenhamLines && features.stippledRectangularLines, "stippled lines");
    if (line.lineRasterizationMode == VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT)
      line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  }
  if (smooth) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = random.chance(0.7f);
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorWriteMask = 0xf;
    scene.spec.blends = {blend, blend};
  }
  scene.spec.raster.pNext = &line;
  scene.spec.raster.lineWidth = random.chance(0.5f) ? 1.0f : random.real(1.0f, 7.0f);
  if (random.chance(0.2f)) {
    scene.spec.raster.polygonMode = VK_POLYGON_MODE_LINE;
    scene.spec.assembly.topology =
        random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP});
  } else {
    scene.spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP});
  }
  scene.count = 2 + random.below(30);
  // deviations.md, multisample-short-lines: dashes end with pieces shorter than a pixel. Outlines are multisampled.
  if (samples != VK_SAMPLE_COUNT_1_BIT && scene.spec.raster.polygonMode == VK_POLYGON_MODE_LINE)
    line.stippledLineEnable = stippled = false;
  // deviations.md, stipple-counter and multisample-short-lines: whole lines, none clipped away or cut short.
  const bool whole = samples != VK_SAMPLE_COUNT_1_BIT ||
                     (stippled && scene.spec.assembly.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
  const bool inside = random.chance(0.6f) || whole;
  scene.vertices = random_vertices(random, scene.count, inside ? 0.85f : 1.3f, 0, 1);
  // Ends on the centres and edges of pixels decide the diamond rule.
  if (random.chance(0.4f))
    for (uint32_t i = 0; i < scene.count; ++i) {
      float* v = &scene.vertices[i * 8];
      v[0] = static_cast<float>(random.between(0, static_cast<int32_t>(2 * scene.target.width))) /
                 static_cast<float>(scene.target.width) -
             1.0f;
      v[1] = static_cast<float>(random.between(0, static_cast<int32_t>(2 * scene.target.height))) /
                 static_cast<float>(scene.target.height) -
             1.0f;
      if (whole)
        for (const int c : {0, 1}) v[c] = std::min(std::max(v[c], -0.85f), 0.85f);
      if (whole) v[2] /= v[3];
      v[3] = 1.0f;
    }
  // deviations.md, multisample-short-lines: no line is shorter than a pixel.
  if (samples != VK_SAMPLE_COUNT_1_BIT)
    for (uint32_t i = 1; i < scene.count; ++i)
      for (uint32_t j = i < 2 ? 0 : i - 2; j < i; ++j) {
        float* v = &scene.vertices[i * 8];
        const float* u = &scene.vertices[j * 8];
        const float dx = (v[0] / v[3] - u[0] / u[3]) * 0.5f * static_cast<float>(scene.target.width);
        const float dy = (v[1] / v[3] - u[1] / u[3]) * 0.5f * static_cast<float>(scene.target.height);
        if (std::fabs(dx) < 1.5f && std::fabs(dy) < 1.5f) v[0] += (v[0] > 0 ? -0.25f : 0.25f) * v[3];
      }
  run.note("state", "mode " + std::to_string(line.lineRasterizationMode) + ", topology " +
                        std::to_string(scene.spec.assembly.topology) + ", polygon mode " +
                        std::to_string(scene.spec.raster.polygonMode) + ", width " +
                        std::to_string(scene.spec.raster.lineWidth) + ", factor " +
                        std::to_string(line.lineStippleFactor) + ", pattern " +
                        std::to_string(line.lineStipplePattern) + ", vertices " + std::to_string(scene.count) + "\n");
  if (!by_command) return draw(run, scene);
  const auto& dynamic = run.gpu.extension_features;
  run.require(dynamic.extendedDynamicState3LineRasterizationMode && dynamic.extendedDynamicState3LineStippleEnable,
              "dynamic line state");
  const VkLineRasterizationModeEXT mode = line.lineRasterizationMode;
  line.lineRasterizationMode =
      random.pick({VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT,
                   VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT});
  line.stippledLineEnable = !stippled;
  scene.spec.dynamic = {VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT, VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT};
  draw(run, scene, [&](VkCommandBuffer cmd) {
    CTS_COMMAND(run.gpu, CmdSetLineRasterizationModeEXT)(cmd, mode);
    CTS_COMMAND(run.gpu, CmdSetLineStippleEnableEXT)(cmd, stippled);
  });
}

/// A strip of more lines than a worker takes at a time: the pattern runs on. All but the last lines lie in a corner.
CTS_CASE("rasterization", "long_stippled_strip") {
  run.require(run.gpu.extension_features.stippledRectangularLines, "stippledRectangularLines");
  Random& random = run.random;
  Scene scene(random);
  scene.target.width = scene.target.height = 64;
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  line.stippledLineEnable = VK_TRUE;
  line.lineStippleFactor = 2;
  line.lineStipplePattern = 0x17a3;
  scene.spec.raster.pNext = &line;
  scene.spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
  constexpr uint32_t kCorner = 70000;
  scene.count = kCorner + 40;
  scene.vertices = random_vertices(random, scene.count, 0.9f, 0, 1);
  for (uint32_t i = 0; i < kCorner; ++i) {
    const float v[4] = {-0.9f + static_cast<float>(i % 7) * 0.01f, -0.9f + static_cast<float>(i % 2) * 0.09f, 0.5f, 1};
    std::copy_n(v, 4, &scene.vertices[i * 8]);
  }
  draw(run, scene);
}

/// Multisampled dashes. They are wide and run at 30 to 60 degrees, so that the last piece of a line is never shorter
/// than a pixel in both directions (deviations.md, multisample-short-lines).
CTS_RANDOM("rasterization", "random_line_stipple.samples_4", 15) {
  Random& random = run.random;
  run.require(run.gpu.extension_features.stippledRectangularLines, "stippledRectangularLines");
  Scene scene(random);
  scene.target.samples = VK_SAMPLE_COUNT_4_BIT;
  scene.target.width = scene.target.height = 64;  // deviations.md, multisample-line-tiles
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
  line.stippledLineEnable = VK_TRUE;
  line.lineStippleFactor = 1 + random.below(4);
  line.lineStipplePattern = static_cast<uint16_t>(1 + random.below(65535));
  scene.spec.raster.pNext = &line;
  scene.spec.raster.lineWidth = random.real(3.0f, 7.0f);
  scene.spec.assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP});
  scene.count = 6 + random.below(10);
  scene.vertices = random_vertices(random, scene.count, 0.85f, 0, 1);
  float x = 0, y = 0;
  for (uint32_t i = 0; i < scene.count; ++i) {
    const float dx = random.real(0.2f, 0.6f), dy = dx * random.real(0.6f, 1.6f);
    x += x > 0 ? -dx : dx;
    y += y > 0 ? -dy : dy;
    float* v = &scene.vertices[i * 8];
    v[0] = x * v[3];
    v[1] = y * v[3];
  }
  draw(run, scene);
}

const bool kLines = [] {
  AddGenerator("rasterization", "random_line_modes.samples_1", 50,
               [](Run& run) { random_lines(run, VK_SAMPLE_COUNT_1_BIT, false, false); });
  AddGenerator("rasterization", "random_dynamic_lines", 30, [](Run& run) {
    const bool stippled = run.random.chance(0.5f), smooth = run.random.chance(0.3f);
    random_lines(run, VK_SAMPLE_COUNT_1_BIT, stippled, smooth, true);
  });
  AddGenerator("rasterization", "random_line_modes.samples_4", 30,
               [](Run& run) { random_lines(run, VK_SAMPLE_COUNT_4_BIT, false, false); });
  AddGenerator("rasterization", "random_line_stipple", 40,
               [](Run& run) { random_lines(run, VK_SAMPLE_COUNT_1_BIT, true, false); });
  AddGenerator("rasterization", "random_smooth_lines", 30, [](Run& run) {
    run.require(run.gpu.extension_features.smoothLines, "smoothLines");
    const auto samples = run.random.pick({VK_SAMPLE_COUNT_1_BIT, VK_SAMPLE_COUNT_4_BIT});
    random_lines(run, samples, run.random.chance(0.3f), true);
  });
  return true;
}();

CTS_RANDOM("draw", "random_instance_divisor", 15) {
  Random& random = run.random;
  const auto& features = run.gpu.extension_features;
  run.require(features.vertexAttributeInstanceRateDivisor && features.vertexAttributeInstanceRateZeroDivisor,
              "vertexAttributeInstanceRateDivisor");
  Scene scene(random);
  scene.spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec4 moved;
layout(location = 0) out vec4 smooth_color;
layout(location = 1) noperspective out vec4 linear_color;
layout(location = 2) flat out vec4 flat_color;
void main() {
  smooth_color = color;
  linear_color = moved;
  flat_color = color + moved;
  gl_Position = position + vec4(moved.xy - 0.5, 0.0, 0.0);
})";
  scene.spec.floats({4}, VK_VERTEX_INPUT_RATE_INSTANCE);
  const VkVertexInputBindingDivisorDescriptionEXT divisor{1, random.pick({0u, 1u, 2u, 3u, 7u})};
  VkPipelineVertexInputDivisorStateCreateInfoEXT divisors{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT};
  divisors.vertexBindingDivisorCount = 1;
  divisors.pVertexBindingDivisors = &divisor;
  scene.spec.input_next = &divisors;
  const Target target = make_target(run, scene.target);
  const VkPipeline pipeline = make_pipeline(run, scene.spec, target);
  const Buffer vertices = run.buffer_of(random_vertices(random, 6, 0.3f, 0, 1));
  std::vector<float> instances;
  for (int i = 0; i < 4 * 12; ++i) instances.push_back(random.unit());
  const Buffer moves = run.buffer_of(instances);
  // The first instance must be 0 beside divisors other than 1 in Vulkan 1.3.
  const uint32_t first = divisor.divisor == 1 ? random.below(4) : 0;
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    bind_vertices(cmd, moves, 1);
    vkCmdDraw(cmd, 6, 8, 0, first);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_RANDOM("draw", "random_list_restart", 20) {
  Random& random = run.random;
  run.require(run.gpu.extension_features.primitiveTopologyListRestart, "primitiveTopologyListRestart");
  Scene scene(random);
  scene.spec.assembly.topology = any_topology(random);
  scene.spec.assembly.primitiveRestartEnable = VK_TRUE;
  const Target target = make_target(run, scene.target);
  const VkPipeline pipeline = make_pipeline(run, scene.spec, target);
  const Buffer vertices = run.buffer_of(random_vertices(random, 20, 0.9f, 0, 1));
  std::vector<uint16_t> order;
  for (uint32_t i = 0; i < 40; ++i)
    order.push_back(static_cast<uint16_t>(random.chance(0.15f) ? 0xffff : random.below(20)));
  const Buffer indices = run.buffer_of(order);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

const char kInputs[] = R"(
layout(location = 0) in vec4 smooth_color;
layout(location = 1) noperspective in vec4 linear_color;
layout(location = 2) flat in vec4 flat_color;
layout(location = 0) out vec4 result0;
layout(location = 1) out vec4 result1;
)";

CTS_RANDOM("pipeline", "random_stencil_export", 20) {
  Random& random = run.random;
  run.require(run.gpu.has("VK_EXT_shader_stencil_export"), "VK_EXT_shader_stencil_export");
  Scene scene(random, random.pick({VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_S8_UINT}));
  if (scene.target.depth != VK_FORMAT_S8_UINT && random.chance(0.5f)) scene.target.samples = VK_SAMPLE_COUNT_4_BIT;
  const auto op = [&] {
    return random.chance(0.5f) ? VK_STENCIL_OP_REPLACE : static_cast<VkStencilOp>(random.below(8));
  };
  VkStencilOpState face{op(), op(), op(), static_cast<VkCompareOp>(random.below(8)), 0xff, 0xff, 3};
  scene.spec.depth.front = scene.spec.depth.back = face;
  scene.spec.depth.stencilTestEnable = VK_TRUE;
  if (scene.target.depth == VK_FORMAT_S8_UINT)
    scene.spec.depth.depthTestEnable = scene.spec.depth.depthWriteEnable = VK_FALSE;
  scene.spec.fragment = std::string("#extension GL_ARB_shader_stencil_export : require\n") + kInputs +
                        "void main() {\n  result0 = smooth_color;\n  result1 = linear_color;\n" +
                        (random.chance(0.3f) ? "  if (flat_color.x > 0.6) discard;\n" : "") +
                        "  gl_FragStencilRefARB = int(smooth_color.x * 300.0);\n}\n";
  scene.count = 24;
  scene.vertices = random_vertices(random, scene.count, 1, 0, 1);
  draw(run, scene);
}

CTS_RANDOM("pipeline", "random_post_depth_coverage", 20) {
  Random& random = run.random;
  run.require(run.gpu.has("VK_EXT_post_depth_coverage"), "VK_EXT_post_depth_coverage");
  Scene scene(random, VK_FORMAT_D32_SFLOAT);
  scene.target.samples = random.pick({VK_SAMPLE_COUNT_1_BIT, VK_SAMPLE_COUNT_4_BIT, VK_SAMPLE_COUNT_4_BIT});
  scene.spec.fragment =
      std::string("#extension GL_ARB_post_depth_coverage : require\n") +
      (random.chance(0.7f) ? "layout(post_depth_coverage) in;\n" : "layout(early_fragment_tests) in;\n") + kInputs +
      "void main() {\n  result0 = vec4(float(gl_SampleMaskIn[0]), smooth_color.xyz);\n"
      "  result1 = linear_color;\n}\n";
  scene.count = 24;
  scene.vertices = random_vertices(random, scene.count, 1, 0, 1);
  draw(run, scene);
}

const char kSelectingVertex[] = R"(
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 smooth_color;
layout(location = 1) noperspective out vec4 linear_color;
layout(location = 2) flat out vec4 flat_color;
void main() {
  smooth_color = color;
  linear_color = color.wzyx;
  flat_color = color.zwxy;
  gl_Position = position;
  gl_PointSize = 4.0;
  SELECT
})";

/// One viewport (or layer) per instance.
void draw_selecting(Run& run, Scene& scene, const std::string& select, uint32_t instances) {
  run.require(run.gpu.has("VK_EXT_shader_viewport_index_layer"), "VK_EXT_shader_viewport_index_layer");
  scene.spec.vertex = kSelectingVertex;
  scene.spec.vertex.replace(scene.spec.vertex.find("SELECT"), 6, select);
  const Target target = make_target(run, scene.target);
  const VkPipeline pipeline = make_pipeline(run, scene.spec, target);
  const Buffer vertices = run.buffer_of(scene.vertices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, scene.count, instances, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

CTS_RANDOM("draw", "random_shader_viewport_index", 20) {
  Random& random = run.random;
  run.require(run.gpu.features.multiViewport, "multiViewport");
  Scene scene(random, random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM}));
  const uint32_t count = 1 + random.below(16);
  const auto size = [&](uint32_t limit) { return static_cast<float>(1 + random.below(limit)); };
  for (uint32_t i = 0; i < count; ++i) {
    const float width = size(scene.target.width), height = size(scene.target.height);
    const auto x = static_cast<float>(random.below(scene.target.width - static_cast<uint32_t>(width) + 1));
    const auto y = static_cast<float>(random.below(scene.target.height - static_cast<uint32_t>(height) + 1));
    scene.spec.viewports.push_back({x, y, width, height, random.unit() * 0.5f, 0.5f + random.unit() * 0.5f});
    scene.spec.scissors.push_back({{static_cast<int32_t>(random.below(10)), static_cast<int32_t>(random.below(10))},
                                   {10 + random.below(80), 10 + random.below(80)}});
  }
  scene.spec.raster.depthClampEnable = random.chance(0.3f);
  scene.count = 3 * (1 + random.below(6));
  scene.vertices = random_vertices(random, scene.count, random.chance(0.5f) ? 0.95f : 1.4f, 0, 1);
  const bool per_primitive = random.chance(0.4f);
  draw_selecting(run, scene,
                 per_primitive ? "gl_ViewportIndex = (gl_VertexIndex / 3) % " + std::to_string(count) + ";"
                               : "gl_ViewportIndex = gl_InstanceIndex;",
                 count);
}

CTS_RANDOM("draw", "random_shader_layer", 20) {
  Random& random = run.random;
  Scene scene(random, random.pick({VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT}));
  scene.target.layers = 2 + random.below(5);
  scene.spec.assembly.topology = any_topology(random);
  scene.count = 3 * (1 + random.below(6));
  scene.vertices = random_vertices(random, scene.count, 0.95f, 0, 1);
  draw_selecting(run, scene,
                 random.chance(0.5f) ? "gl_Layer = gl_InstanceIndex;" : "gl_Layer = (gl_VertexIndex / 3) & 1;",
                 scene.target.layers);
}

}  // namespace
}  // namespace vitrine::cts
