// Every list, strip and fan topology, direct and indexed.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Topology {
  const char* name;
  VkPrimitiveTopology value;
};
constexpr Topology kTopologies[] = {
    {"point_list", VK_PRIMITIVE_TOPOLOGY_POINT_LIST},         {"line_list", VK_PRIMITIVE_TOPOLOGY_LINE_LIST},
    {"line_strip", VK_PRIMITIVE_TOPOLOGY_LINE_STRIP},         {"triangle_list", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST},
    {"triangle_strip", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP}, {"triangle_fan", VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN},
};

/// vec4 position and vec4 colour of random vertices inside the view volume.
std::vector<float> random_vertices(Random& random, uint32_t count) {
  std::vector<float> values;
  for (uint32_t i = 0; i < count; ++i) {
    for (const float v : {random.real(-1, 1), random.real(-1, 1), random.unit(), 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(random.unit());
  }
  return values;
}

void draw_topology(Run& run, VkPrimitiveTopology topology, bool indexed) {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.assembly.topology = topology;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  constexpr uint32_t kVertices = 23;
  const Buffer vertices = run.buffer_of(random_vertices(run.random, kVertices));
  std::vector<uint16_t> order;
  for (uint32_t i = 0; i < 31; ++i) order.push_back(static_cast<uint16_t>(run.random.below(kVertices)));
  const Buffer indices = run.buffer_of(order);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    if (indexed) {
      vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
      vkCmdDrawIndexed(cmd, static_cast<uint32_t>(order.size()), 1, 0, 0, 0);
    } else {
      vkCmdDraw(cmd, kVertices, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Fans of few triangles, whose order of corners tells in the last bits of what they interpolate.
CTS_RANDOM("draw", "random_short_fans", 16) {
  Random& random = run.random;
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  const bool flat = random.chance(0.2f);
  const std::string second = flat ? "flat" : "noperspective";
  spec.vertex =
      "layout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 color;\n"
      "layout(location = 0) out vec4 smooth_color;\nlayout(location = 1) " +
      second +
      " out vec4 other;\n"
      "void main() {\n  smooth_color = color;\n  other = color.wzyx;\n  gl_Position = position;\n"
      "  gl_Position.x += float(gl_InstanceIndex) * 0.125 * gl_Position.w;\n}\n";
  spec.fragment = "layout(location = 0) in vec4 smooth_color;\nlayout(location = 1) " + second +
                  " in vec4 other;\nlayout(location = 0) out vec4 result;\n"
                  "void main() { result = smooth_color + 3.0 * other; }\n";
  spec.floats({4, 4});
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
  spec.raster.cullMode = random.chance(0.1f) ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT mode{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  mode.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
  if (run.gpu.extension_features.provokingVertexLast && random.chance(0.25f)) spec.raster.pNext = &mode;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const uint32_t count = random.pick({3u, 4u, 4u, 4u, 5u}), instances = 1 + random.below(3);
  const bool indexed = random.chance(0.2f);
  std::vector<float> values = random_vertices(random, count);
  for (uint32_t i = 0; i < count; ++i) {
    const float w = random.real(0.5f, 2.0f), reach = random.chance(0.05f) ? 1.5f : 0.7f;
    for (uint32_t c = 0; c < 3; ++c) values[i * 8 + c] *= c < 2 ? reach * w : w;
    values[i * 8 + 3] = w;
  }
  const Buffer vertices = run.buffer_of(values), indices = run.buffer_of(std::vector<uint16_t>{0, 1, 2, 3, 4});
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    if (indexed)
      vkCmdDrawIndexed(cmd, count, instances, 0, 0, 0);
    else
      vkCmdDraw(cmd, count, instances, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

const bool kRegistered = [] {
  for (const Topology& topology : kTopologies)
    for (const bool indexed : {false, true})
      AddCase("draw", std::string(topology.name) + (indexed ? ".indexed" : ".direct"),
              [=](Run& run) { draw_topology(run, topology.value, indexed); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
