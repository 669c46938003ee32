// Timing and set-up shared by the workloads.
#include "bench.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace vitrine::bench {

std::vector<Workload> workloads() {
  std::vector<Workload> transfers = transfer_workloads(), fills = fill_workloads(), triangles = triangle_workloads();
  for (Workload& transfer : transfers) transfer.runs_shaders = false;
  for (Workload& fill : fills) fill.fixed_function = true;
  for (Workload& triangle : triangles) triangle.fixed_function = true;
  std::vector<Workload> all;
  for (auto& group : {fills, triangles, scene_workloads(), shader_workloads(), texture_workloads(), lookup_workloads(),
                      compute_workloads(), transfers, overhead_workloads()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

double now() {
  static const bool cpu_time = std::getenv("VITRINE_BENCH_CPU") != nullptr;
  timespec time{};
  clock_gettime(cpu_time ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

double time_calls(const std::function<void()>& work, double seconds) {
  work();
  work();
  std::vector<double> times;
  const double end = now() + seconds;
  while (times.size() < 5 || now() < end) {
    const double start = now();
    work();
    times.push_back(now() - start);
    if (times.size() >= 3 && times[0] > 3 * seconds) break;  // very slow: three are enough
  }
  std::sort(times.begin(), times.end());
  const std::size_t half = (times.size() + 1) / 2;
  double sum = 0;
  for (std::size_t i = 0; i < half; ++i) sum += times[i];
  return sum / static_cast<double>(half);
}

double time_submissions(Run& run, VkCommandBuffer cmd, double seconds) {
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &cmd;
  const VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence;
  CTS_VK(vkCreateFence(run.device, &fence_info, nullptr, &fence));
  const double result = time_calls(
      [&] {
        CTS_VK(vkQueueSubmit(run.gpu.queue, 1, &info, fence));
        CTS_VK(vkWaitForFences(run.device, 1, &fence, VK_TRUE, UINT64_MAX));
        CTS_VK(vkResetFences(run.device, 1, &fence));
      },
      seconds);
  vkDestroyFence(run.device, fence, nullptr);
  return result;
}

cts::Target make_screen(Run& run, std::uint32_t width, std::uint32_t height, bool depth,
                        VkSampleCountFlagBits samples) {
  cts::TargetSpec spec;
  spec.width = width;
  spec.height = height;
  spec.samples = samples;
  if (depth) spec.depth = VK_FORMAT_D32_SFLOAT;
  return cts::make_target(run, spec);
}

VkCommandBuffer begin_repeatable(Run& run) {
  // Run::begin() records the first transitions of new images: those must happen once, in a submission of their own.
  run.once([](VkCommandBuffer) {});
  return run.begin();
}

VkCommandBuffer finish(VkCommandBuffer cmd) {
  CTS_VK(vkEndCommandBuffer(cmd));
  return cmd;
}

double measure_fragments(Run& run, const std::string& fragment, const cts::Resources* resources) {
  constexpr std::uint32_t kWidth = 1280, kHeight = 720;
  const cts::Target target = make_screen(run, kWidth, kHeight);
  cts::GraphicsSpec spec;
  spec.vertex = cts::kFullScreenVertex;
  spec.fragment = fragment;
  if (resources) spec.layout = resources->layout;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  if (resources) resources->bind(cmd);
  vkCmdDraw(cmd, 3, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return kWidth * kHeight / time_submissions(run, finish(cmd)) / 1e6;
}

double resident_megabytes() {
  long pages = 0, resident = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace vitrine::bench
