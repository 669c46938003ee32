// The scene of the draw command cases: random positions, and instances that move and tint them.
#pragma once

#include <functional>
#include <vector>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {

struct InstancedScene {
  Target target;
  GraphicsSpec spec;  ///< may be changed until record()
  Buffer vertices, instances;

  /// `vertex` reads a position at location 0 and an instance's move and tint at location 1. Makes `vertex_count`
  /// positions and 16 instances.
  InstancedScene(Run& run, const char* vertex, const char* fragment, VkPrimitiveTopology topology, int vertex_count)
      : target(make_target(run, {})) {
    spec.vertex = vertex;
    spec.fragment = fragment;
    spec.floats({2});
    spec.floats({4}, VK_VERTEX_INPUT_RATE_INSTANCE);
    spec.assembly.topology = topology;
    std::vector<float> positions, tints;
    for (int i = 0; i < vertex_count * 2; ++i) positions.push_back(run.random.real(-1, 1));
    for (int i = 0; i < 16 * 4; ++i) tints.push_back(run.random.real(-0.6f, 0.6f));
    vertices = run.buffer_of(positions);
    instances = run.buffer_of(tints);
  }

  void record(Run& run, const std::function<void(VkCommandBuffer)>& draws) {
    const VkPipeline pipeline = make_pipeline(run, spec, target);
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      bind_pipeline(cmd, pipeline);
      bind_vertices(cmd, vertices, 0);
      bind_vertices(cmd, instances, 1);
      draws(cmd);
      vkCmdEndRenderPass(cmd);
    });
    out_target(run, target);
  }
};

/// `count` indices below `limit`, or with probability `restart` the index that restarts a primitive.
template <typename T>
Buffer random_indices(Run& run, uint32_t count, uint32_t limit, float restart = 0.0f) {
  std::vector<T> values;
  for (uint32_t i = 0; i < count; ++i)
    values.push_back(run.random.chance(restart) ? static_cast<T>(~T{0}) : static_cast<T>(run.random.below(limit)));
  return run.buffer_of(values);
}

}  // namespace vitrine::cts
