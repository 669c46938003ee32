// Fixed costs: draws, render passes, dispatches, submissions, new pipelines with their first draw.
#include <algorithm>
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

double many_draws(Run& run) {
  const cts::Target target = make_screen(run, 256, 256);
  const cts::Resources resources = run.resources({}, 16);
  cts::GraphicsSpec spec;
  spec.vertex =
      "layout(push_constant) uniform P { vec4 o; } p; layout(location=0) out vec4 c; void main() { c = p.o;"
      "gl_Position = vec4(p.o.xy + vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1)) * 0.02, 0.5, 1.0); }";
  spec.fragment = cts::kColorFragment;
  spec.layout = resources.layout;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  constexpr std::uint32_t kDraws = 10000;
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const float offset[4] = {static_cast<float>(i % 100) * 0.0198f - 1, static_cast<float>(i / 100) * 0.0198f - 1, 0.5f,
                             1};
    vkCmdPushConstants(cmd, resources.layout, VK_SHADER_STAGE_ALL, 0, 16, offset);
    vkCmdDraw(cmd, 3, 1, 0, 0);
  }
  vkCmdEndRenderPass(cmd);
  return kDraws / time_submissions(run, finish(cmd)) / 1e3;
}

double render_passes(Run& run) {
  const cts::Target target = make_screen(run, 64, 64);
  constexpr std::uint32_t kPasses = 200;
  VkCommandBuffer cmd = begin_repeatable(run);
  for (std::uint32_t i = 0; i < kPasses; ++i) {
    target.begin(cmd);
    vkCmdEndRenderPass(cmd);
  }
  return kPasses / time_submissions(run, finish(cmd)) / 1e3;
}

double dispatches(Run& run) {
  const cts::Buffer buffer = run.buffer(1024);
  const cts::Resources resources = run.resources({cts::storage_buffer(0, buffer)});
  const VkPipeline pipeline =
      run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                               "layout(local_size_x=64) in; layout(binding=0) buffer B { uint b[]; };"
                                               "void main() { b[gl_LocalInvocationIndex] += 1u; }"));
  constexpr std::uint32_t kDispatches = 500;
  VkCommandBuffer cmd = begin_repeatable(run);
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
  for (std::uint32_t i = 0; i < kDispatches; ++i) {
    vkCmdDispatch(cmd, 1, 1, 1);
    run.barrier(cmd);
  }
  return kDispatches / time_submissions(run, finish(cmd)) / 1e3;
}

double empty_submits(Run& run) { return 1 / time_submissions(run, finish(begin_repeatable(run))) / 1e3; }

double clears(Run& run) {
  const cts::Target target = make_screen(run, 2048, 2048);
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  vkCmdEndRenderPass(cmd);
  return 2048.0 * 2048 * 8 / time_submissions(run, finish(cmd)) / 1e9;
}

/// A fragment shader of this many statements, different from every other.
std::string distinct_shader(std::uint32_t number, std::uint32_t statements) {
  std::string text =
      "layout(location=0) in vec2 uv; layout(location=0) out vec4 o; void main() { vec4 a = vec4(uv, uv);\n";
  for (std::uint32_t i = 0; i < statements; ++i) {
    text += "a = a.yzwx * " + std::to_string(1.0 + 0.001 * i) + " + vec4(sin(a.x), max(a.y, " +
            std::to_string(0.1 * number) + "), a.z * a.w, normalize(a.xyz).y);\n";
  }
  return text + "o = a; }";
}

/// Milliseconds for vkCreateGraphicsPipelines and the first draw with it, median of several.
double new_pipeline(Run& run, std::uint32_t statements) {
  const cts::Target target = make_screen(run, 64, 64);
  std::vector<double> times;
  for (std::uint32_t i = 0; i < 9; ++i) {
    cts::GraphicsSpec spec;
    spec.vertex_module = run.shader(VK_SHADER_STAGE_VERTEX_BIT, cts::kFullScreenVertex);
    spec.fragment_module = run.shader(VK_SHADER_STAGE_FRAGMENT_BIT, distinct_shader(i, statements));
    const double start = now();
    const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      cts::bind_pipeline(cmd, pipeline);
      vkCmdDraw(cmd, 3, 1, 0, 0);
      vkCmdEndRenderPass(cmd);
    });
    times.push_back(now() - start);
  }
  std::nth_element(times.begin(), times.begin() + 4, times.end());
  return times[4] * 1e3;
}

}  // namespace

std::vector<Workload> overhead_workloads() {
  return {{"draws_push", "kdraw/s", false, many_draws, true, true},
          {"renderpasses", "kpass/s", false, render_passes, false},
          {"c_dispatches", "kdisp/s", false, dispatches, true, true},
          {"empty_submit", "ksubmit/s", false, empty_submits, false},
          {"clears", "GB/s", false, clears, false},
          {"pipeline_tiny", "ms", true, [](Run& run) { return new_pipeline(run, 1); }, false},
          {"pipeline_medium", "ms", true, [](Run& run) { return new_pipeline(run, 20); }, false},
          {"pipeline_large", "ms", true, [](Run& run) { return new_pipeline(run, 100); }, false}};
}

}  // namespace vitrine::bench
