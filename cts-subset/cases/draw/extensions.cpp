// Extensions of drawing: several draws in one command, 8-bit indices, conditional rendering, dynamic depth clipping.
#include "cases/draw/instanced_scene.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 instance;
layout(location = 0) flat out vec4 passed;
void main() {
  gl_Position = vec4(position * 0.3 + instance.xy, 0.5, 1.0);
  passed = vec4(float(gl_VertexIndex) / 64.0, float(gl_InstanceIndex) / 16.0, instance.z + 0.6, 1.0);
})";
const char kFragment[] = R"(
layout(location = 0) flat in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed; })";

/// Small triangles whose colour tells the vertex that provoked it and the instance.
struct Scene : InstancedScene {
  explicit Scene(Run& run, VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST)
      : InstancedScene(run, kVertex, kFragment, topology, 256) {}
};

/// Colours add up, so that the order does not show (deviations.md, multi-draw-order).
void add_colors(Scene& scene) {
  scene.spec.blends = {{VK_TRUE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, VK_BLEND_FACTOR_ONE,
                        VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, 0xf}};
}

CTS_CASE("draw", "multi_draw.plain") {
  run.require(run.gpu.extension_features.multiDraw, "multiDraw");
  Scene scene(run);
  add_colors(scene);
  const VkMultiDrawInfoEXT draws[4] = {{0, 6}, {30, 9}, {12, 0}, {60, 3}};
  scene.record(run, [&](VkCommandBuffer cmd) {
    CTS_COMMAND(run.gpu, CmdDrawMultiEXT)(cmd, 4, draws, 2, 1, sizeof draws[0]);
  });
}

void multi_draw_indexed(Run& run, bool one_offset) {
  run.require(run.gpu.extension_features.multiDraw, "multiDraw");
  Scene scene(run);
  add_colors(scene);
  const Buffer indices = random_indices<uint16_t>(run, 64, 50);
  const VkMultiDrawIndexedInfoEXT draws[3] = {{0, 12, 5}, {20, 9, 0}, {40, 6, 100}};
  const int32_t offset = 7;
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    CTS_COMMAND(run.gpu, CmdDrawMultiIndexedEXT)(cmd, 3, draws, 2, 0, sizeof draws[0], one_offset ? &offset : nullptr);
  });
}
CTS_CASE("draw", "multi_draw.indexed") { multi_draw_indexed(run, false); }
CTS_CASE("draw", "multi_draw.indexed_with_one_offset") { multi_draw_indexed(run, true); }

void index_uint8(Run& run, bool restart) {
  run.require(run.gpu.extension_features.indexTypeUint8, "indexTypeUint8");
  Scene scene(run, restart ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST);
  scene.spec.assembly.primitiveRestartEnable = restart;
  const Buffer indices = random_indices<uint8_t>(run, 128, 255, restart ? 0.15f : 0.0f);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 3, VK_INDEX_TYPE_UINT8_EXT);
    vkCmdDrawIndexed(cmd, 60, 2, 5, 0, 0);
  });
}
CTS_CASE("draw", "index_uint8.list") { index_uint8(run, false); }
CTS_CASE("draw", "index_uint8.strip_with_restart") { index_uint8(run, true); }

/// Draws, clears and dispatches under every predicate.
CTS_CASE("conditional_rendering", "draws_clears_and_dispatches") {
  run.require(run.gpu.extension_features.conditionalRendering, "conditionalRendering");
  Scene scene(run);
  const Buffer predicates = run.buffer(64, VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT);
  const uint32_t values[] = {0, 1, 0x80000000u};
  std::memcpy(predicates.data, values, sizeof values);
  const auto begin = CTS_COMMAND(run.gpu, CmdBeginConditionalRenderingEXT);
  const auto end = CTS_COMMAND(run.gpu, CmdEndConditionalRenderingEXT);
  const auto with = [&](VkCommandBuffer cmd, uint32_t word, bool inverted, const std::function<void()>& work) {
    VkConditionalRenderingBeginInfoEXT info{VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT};
    info.buffer = predicates.handle;
    info.offset = word * 4;
    info.flags = inverted ? VK_CONDITIONAL_RENDERING_INVERTED_BIT_EXT : 0;
    begin(cmd, &info);
    work();
    end(cmd);
  };
  scene.record(run, [&](VkCommandBuffer cmd) {
    for (uint32_t n = 0; n < 6; ++n)
      with(cmd, n / 2, n & 1, [&] {
        vkCmdDraw(cmd, 6, 1, n * 6, n);
        const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0,
                                      clear_value(scene.target.spec.colors[0], 1, 1, 0, 1)};
        const VkClearRect rect{{{static_cast<int32_t>(n * 10), 3}, {6, 6}}, 0, 1};
        vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
      });
    vkCmdDraw(cmd, 6, 1, 60, 7);
  });
  const Buffer counters = run.buffer(64);
  const Resources res = run.resources({storage_buffer(0, counters)}, 4);
  const VkPipeline pipeline = run.compute(
      res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                             "layout(local_size_x = 1) in;\nlayout(binding = 0) buffer C { uint c[]; };\n"
                             "layout(push_constant) uniform P { uint n; };\nvoid main() { c[n] += 1u; }\n"));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    for (uint32_t n = 0; n < 6; ++n)
      with(cmd, n / 2, n & 1, [&] {
        vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, 4, &n);
        vkCmdDispatch(cmd, 1, 1, 1);
      });
  });
  run.out("counters", counters);
}

/// Triangles through the near and far planes with depth clipping and clamping of every combination, static or dynamic,
/// in both conventions of the depth range.
CTS_RANDOM("clipping", "depth_clip.random", 40) {
  const ExtensionFeatures& claimed = run.gpu.extension_features;
  run.require(claimed.depthClipEnable && claimed.depthClipControl, "depthClipEnable and depthClipControl");
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  const VkBool32 clip = random.chance(0.5f), clamp = random.chance(0.5f), symmetric = random.chance(0.5f);
  VkPipelineRasterizationDepthClipStateCreateInfoEXT clip_info{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT};
  clip_info.depthClipEnable = clip;
  VkPipelineViewportDepthClipControlCreateInfoEXT control{
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT};
  control.negativeOneToOne = symmetric;
  spec.raster.depthClampEnable = clamp;
  spec.raster.pNext = &clip_info;
  spec.viewport_next = &control;
  spec.viewports = {{0, 0, 64, 64, random.pick({0.0f, 0.2f, 1.0f}), random.pick({1.0f, 0.7f, 0.0f})}};
  const bool dynamic = gpus().device.extension_features.extendedDynamicState3DepthClipEnable &&
                       gpus().reference.extension_features.extendedDynamicState3DepthClipEnable && random.chance(0.5f);
  if (dynamic) {
    clip_info.depthClipEnable = !clip;
    control.negativeOneToOne = !symmetric;
    spec.dynamic = {VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT, VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT};
  }
  run.note("state", "clip " + std::to_string(clip) + " clamp " + std::to_string(clamp) + " symmetric " +
                        std::to_string(symmetric) + " dynamic " + std::to_string(dynamic));
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (int i = 0; i < 36; ++i) {
    for (const float x : {random.real(-1.2f, 1.2f), random.real(-1.2f, 1.2f), random.real(-1.8f, 1.8f), 1.0f})
      values.push_back(x);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (dynamic) {
      CTS_COMMAND(run.gpu, CmdSetDepthClipEnableEXT)(cmd, clip);
      CTS_COMMAND(run.gpu, CmdSetDepthClipNegativeOneToOneEXT)(cmd, symmetric);
    }
    vkCmdDraw(cmd, 36, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
