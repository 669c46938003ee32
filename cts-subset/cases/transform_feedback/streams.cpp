// Transform feedback beyond what the reference has: a vertex stream other than the first is rasterized; vertices lie
// farther apart. There the geometry shader emits that stream alone; the vertices are moved together.
#include "harness/case.h"
#include "harness/graphics.h"
#include "harness/shader.h"

namespace vitrine::cts {
namespace {

/// Points in two streams; `#` stands for the number of the second.
std::string geometry_of(const std::string& second, bool both) {
  const std::string stream = "stream = " + second;
  return std::string(
             "layout(points) in;\nlayout(points, max_vertices = 8) out;\nlayout(location = 0) in vec4 passed[];\n") +
         (both ? "layout(location = 0, stream = 0) out vec4 zero;\n" : "") + "layout(location = 1, " + stream +
         ") out vec4 one;\nlayout(" + stream +
         ") out gl_PerVertex { vec4 gl_Position; float gl_PointSize; };\nvoid main() {\n"
         "  for (int i = 0; i < 3; ++i) {\n" +
         (both ? "    zero = passed[0];\n    EmitStreamVertex(0);\n    EndStreamPrimitive(0);\n" : "") +
         "    one = passed[0].wzyx * (1.0 - 0.2 * float(i));\n"
         "    gl_Position = gl_in[0].gl_Position * vec4(1.0 - 0.3 * float(i), 1.0, 1.0, 1.0);\n"
         "    gl_PointSize = 1.0 + 3.0 * float(i);\n    EmitStreamVertex(" +
         second + ");\n    EndStreamPrimitive(" + second + ");\n  }\n}\n";
}

std::vector<float> random_points(Random& random, uint32_t count) {
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    for (const float v : {random.real(-0.9f, 0.9f), random.real(-0.9f, 0.9f), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

void rasterize_stream(Run& run, bool dynamic) {
  run.require(gpus().device.extension_features.extendedDynamicState3RasterizationStream, "choice of the stream");
  run.require(run.gpu.extension_features.geometryStreams, "geometryStreams");
  const bool chooses = run.gpu.extension_features.extendedDynamicState3RasterizationStream;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  VkPipelineRasterizationStateStreamCreateInfoEXT state{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_STREAM_CREATE_INFO_EXT};
  state.rasterizationStream = dynamic ? 0 : 2;
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.geometry = geometry_of(chooses ? "2" : "0", chooses);
  spec.fragment =
      "layout(location = 1) in vec4 one;\nlayout(location = 0) out vec4 result;\nvoid main() { result = one; }\n";
  spec.floats({4, 4});
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  if (chooses) spec.raster.pNext = &state;
  if (chooses && dynamic) spec.dynamic.push_back(VK_DYNAMIC_STATE_RASTERIZATION_STREAM_EXT);
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_points(run.random, 50));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (chooses && dynamic) CTS_COMMAND(run.gpu, CmdSetRasterizationStreamEXT)(cmd, 2);
    vkCmdDraw(cmd, 50, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("transform_feedback", "rasterized_stream") { rasterize_stream(run, false); }
CTS_CASE("transform_feedback", "rasterized_dynamic_stream") { rasterize_stream(run, true); }

constexpr char kStridden[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0, xfb_buffer = 0, xfb_offset = 224, xfb_stride = 240) out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
})";

/// The shader above with another stride: glslang refuses what is beyond a limit of its own.
std::vector<uint32_t> with_stride(uint32_t stride) {
  std::vector<uint32_t> words = compile_glsl(VK_SHADER_STAGE_VERTEX_BIT, kStridden);
  constexpr uint32_t kHeader = 5, kDecorate = 4u << 16 | 71, kXfbStride = 37;
  for (size_t at = kHeader; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
    if (words[at] == kDecorate && words[at + 2] == kXfbStride) words[at + 3] = stride;
  return words;
}

uint32_t largest_stride(Run& run) {
  if (&run.gpu != &gpus().device) return 512;
  VkPhysicalDeviceTransformFeedbackPropertiesEXT feedback{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_PROPERTIES_EXT};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &feedback};
  vkGetPhysicalDeviceProperties2(run.gpu.physical, &all);
  return feedback.maxTransformFeedbackBufferDataStride;
}

CTS_CASE("transform_feedback", "largest_stride") {
  run.require(run.gpu.has("VK_EXT_transform_feedback"), "transform feedback");
  const uint32_t stride = largest_stride(run), count = 30;
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex_module = run.module(with_stride(stride));
  spec.floats({4, 4});
  spec.raster.rasterizerDiscardEnable = VK_TRUE;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer_of(random_points(run.random, count));
  const Buffer captured = run.buffer(VkDeviceSize{stride} * count, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
  std::memset(captured.data, 0xee, captured.size);
  run.once([&](VkCommandBuffer cmd) {
    const VkDeviceSize offset = 0;
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    CTS_COMMAND(run.gpu, CmdBindTransformFeedbackBuffersEXT)(cmd, 0, 1, &captured.handle, &offset, nullptr);
    CTS_COMMAND(run.gpu, CmdBeginTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdDraw(cmd, count, 1, 0, 0);
    CTS_COMMAND(run.gpu, CmdEndTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
    vkCmdEndRenderPass(cmd);
  });
  const Buffer moved = run.buffer(512 * count);
  for (uint32_t i = 0; i < count; ++i) std::memcpy(moved.data + i * 512, captured.data + i * stride, 512);
  run.out("vertices", moved);
}

}  // namespace
}  // namespace vitrine::cts
