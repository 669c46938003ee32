// Draw commands: indexed with every index type and offset, restart, instances, indirect, first and base vertex.
#include "cases/draw/instanced_scene.h"

namespace vitrine::cts {
namespace {

/// Triangles of a random strip; the instance moves and tints them; the vertex index is visible in the colour.
const char kVertex[] = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 instance;
layout(location = 0) out vec4 passed;
void main() {
  gl_Position = vec4(position * 0.3 + instance.xy, 0.5, 1.0);
  passed = vec4(float(gl_VertexIndex) / 32.0, float(gl_InstanceIndex) / 8.0, instance.z, 1.0);
})";

struct Scene : InstancedScene {
  explicit Scene(Run& run, VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, bool restart = false)
      : InstancedScene(run, kVertex, kColorFragment, topology, 64) {
    spec.assembly.primitiveRestartEnable = restart;
  }
};

CTS_CASE("draw", "first_vertex") {
  Scene scene(run);
  scene.record(run, [](VkCommandBuffer cmd) { vkCmdDraw(cmd, 12, 1, 5, 0); });
}

CTS_CASE("draw", "instances") {
  Scene scene(run);
  scene.record(run, [](VkCommandBuffer cmd) { vkCmdDraw(cmd, 6, 5, 0, 0); });
}

CTS_CASE("draw", "first_instance") {
  Scene scene(run);
  scene.record(run, [](VkCommandBuffer cmd) { vkCmdDraw(cmd, 6, 3, 3, 4); });
}

CTS_CASE("draw", "indexed.uint16_first_index_base_vertex") {
  Scene scene(run);
  const Buffer indices = random_indices<uint16_t>(run, 64, 32);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 4, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(cmd, 18, 2, 3, 7, 1);
  });
}

CTS_CASE("draw", "indexed.uint32_negative_base_vertex") {
  Scene scene(run);
  std::vector<uint32_t> values;
  for (int i = 0; i < 30; ++i) values.push_back(20 + run.random.below(40));
  const Buffer indices = run.buffer_of(values);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(cmd, 30, 1, 0, -17, 0);
  });
}

void restart(Run& run, VkPrimitiveTopology topology, bool wide) {
  Scene scene(run, topology, true);
  const Buffer indices =
      wide ? random_indices<uint32_t>(run, 60, 40, 0.15f) : random_indices<uint16_t>(run, 60, 40, 0.15f);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, wide ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(cmd, 60, 2, 0, 0, 0);
  });
}

CTS_CASE("draw", "restart.triangle_strip_uint16") { restart(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, false); }
CTS_CASE("draw", "restart.triangle_strip_uint32") { restart(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true); }
CTS_CASE("draw", "restart.triangle_fan") { restart(run, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, false); }
CTS_CASE("draw", "restart.line_strip") { restart(run, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, false); }

CTS_CASE("draw", "indirect") {
  Scene scene(run);
  run.require(run.gpu.features.drawIndirectFirstInstance, "drawIndirectFirstInstance");
  const Buffer commands = run.buffer_of<uint32_t>({0, 9, 2, 3, 1, /* second */ 6, 1, 20, 0, 0});
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdDrawIndirect(cmd, commands.handle, 4, 1, 0);
    vkCmdDrawIndirect(cmd, commands.handle, 20, 1, 0);
  });
}

CTS_CASE("draw", "indirect.multi") {
  Scene scene(run);
  run.require(run.gpu.features.multiDrawIndirect, "multiDrawIndirect");
  const Buffer commands = run.buffer_of<uint32_t>({6, 1, 0, 0, 99, 6, 2, 10, 0, 99, 3, 1, 30, 0, 99});
  scene.record(run, [&](VkCommandBuffer cmd) { vkCmdDrawIndirect(cmd, commands.handle, 0, 3, 20); });
}

CTS_CASE("draw", "indirect.indexed") {
  Scene scene(run);
  const Buffer indices = random_indices<uint16_t>(run, 64, 32);
  const Buffer commands = run.buffer_of<uint32_t>({21, 3, 2, 5, 0});
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexedIndirect(cmd, commands.handle, 0, 1, 0);
  });
}

/// The count comes from a buffer: below, at and above the limit of the command.
CTS_CASE("draw", "indirect_count.plain") {
  run.require(run.gpu.has("VK_KHR_draw_indirect_count"), "VK_KHR_draw_indirect_count");
  Scene scene(run);
  const Buffer commands = run.buffer_of<uint32_t>({6, 1, 0, 0, 99, 6, 2, 10, 0, 99, 3, 1, 30, 0, 99});
  const Buffer counts = run.buffer_of<uint32_t>({2, 0, 9});
  scene.record(run, [&](VkCommandBuffer cmd) {
    const auto draw = CTS_COMMAND(run.gpu, CmdDrawIndirectCountKHR);
    draw(cmd, commands.handle, 0, counts.handle, 0, 3, 20);
    draw(cmd, commands.handle, 20, counts.handle, 4, 2, 20);
    draw(cmd, commands.handle, 40, counts.handle, 8, 1, 20);
  });
}

CTS_CASE("draw", "indirect_count.indexed") {
  run.require(run.gpu.has("VK_KHR_draw_indirect_count"), "VK_KHR_draw_indirect_count");
  Scene scene(run);
  const Buffer indices = random_indices<uint16_t>(run, 64, 32);
  const Buffer commands = run.buffer_of<uint32_t>({21, 3, 2, 5, 0, 12, 1, 30, 9, 0});
  const Buffer counts = run.buffer_of<uint32_t>({77, 2});
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, VK_INDEX_TYPE_UINT16);
    CTS_COMMAND(run.gpu, CmdDrawIndexedIndirectCountKHR)(cmd, commands.handle, 0, counts.handle, 0, 2, 20);
  });
}

CTS_CASE("draw", "many_draws") {
  Scene scene(run);
  scene.record(run, [&](VkCommandBuffer cmd) {
    for (uint32_t i = 0; i < 300; ++i) vkCmdDraw(cmd, 3, 1, i % 60, i % 16);
  });
}

CTS_CASE("draw", "empty_draws") {
  Scene scene(run);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdDraw(cmd, 0, 1, 0, 0);
    vkCmdDraw(cmd, 3, 0, 0, 0);
    vkCmdDraw(cmd, 2, 1, 0, 0);
    vkCmdDraw(cmd, 5, 1, 0, 0);
  });
}

/// A mesh of tiny triangles: several chunks of vertices, thousands of primitives in few tiles.
CTS_CASE("draw", "dense_mesh") {
  TargetSpec target_spec;
  target_spec.width = target_spec.height = 200;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = VK_TRUE;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  constexpr uint32_t kSide = 120;
  std::vector<float> vertices;
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const float w = run.random.real(0.8f, 1.3f);
      for (const float v : {(static_cast<float>(x) / 60.0f - 1.0f) * w, (static_cast<float>(y) / 60.0f - 1.0f) * w,
                            run.random.unit() * w, w, run.random.unit(), run.random.unit(), run.random.unit(), 1.0f})
        vertices.push_back(v);
      if (x + 1 < kSide && y + 1 < kSide)
        for (const uint32_t i : {0u, 1u, kSide, 1u, kSide + 1, kSide}) indices.push_back(y * kSide + x + i);
    }
  const Buffer vertex_buffer = run.buffer_of(vertices), index_buffer = run.buffer_of(indices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertex_buffer);
    vkCmdBindIndexBuffer(cmd, index_buffer.handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(cmd, static_cast<uint32_t>(indices.size()), 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

/// Random draws: topology, index type, restart, counts, offsets.
CTS_RANDOM("draw", "random", 80) {
  Random& random = run.random;
  const auto topology = static_cast<VkPrimitiveTopology>(random.below(6));
  const bool strip = topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP || topology >= VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  const bool restarts = strip && random.chance(0.5f);
  // A point's size must be written, which these shaders do not.
  Scene scene(run, topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST ? VK_PRIMITIVE_TOPOLOGY_LINE_LIST : topology, restarts);
  const bool wide = random.chance(0.5f);
  const float rate = restarts ? 0.1f : 0.0f;
  const Buffer indices =
      wide ? random_indices<uint32_t>(run, 200, 40, rate) : random_indices<uint16_t>(run, 200, 40, rate);
  scene.record(run, [&](VkCommandBuffer cmd) {
    vkCmdBindIndexBuffer(cmd, indices.handle, 0, wide ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_UINT16);
    for (uint32_t n = 1 + random.below(4); n > 0; --n) {
      const uint32_t first_instance = random.below(8), instances = 1 + random.below(8);
      if (random.chance(0.5f)) {
        const uint32_t first = random.below(24);
        vkCmdDraw(cmd, random.below(40), instances, first, first_instance);
      } else {
        const int32_t vertex_offset = random.between(0, 20);
        const uint32_t first = random.below(80);
        vkCmdDrawIndexed(cmd, random.below(120), instances, first, vertex_offset, first_instance);
      }
    }
  });
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
