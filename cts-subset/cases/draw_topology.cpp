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

const bool kRegistered = [] {
  for (const Topology& topology : kTopologies)
    for (const bool indexed : {false, true})
      AddCase("draw", std::string(topology.name) + (indexed ? ".indexed" : ".direct"),
              [=](Run& run) { draw_topology(run, topology.value, indexed); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
