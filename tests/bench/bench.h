// The benchmark: workloads that a child process runs on one driver. A workload prepares its objects, then measures;
// what it returns is a rate (higher is better) or a time (lower is better), as its unit says.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/graphics.h"
#include "harness/run.h"

namespace vitrine::bench {

using cts::Run;

struct Workload {
  const char* name;
  const char* unit;
  bool lower_is_better = false;
  std::function<double(Run&)> measure;
  bool runs_shaders = true;  ///< draws and dispatches are most of it, so that tools that watch shaders cost something
  bool fixed_function = false;  ///< but most of those is not the shaders
};

/// Every workload, in the order of the table.
std::vector<Workload> workloads();

std::vector<Workload> fill_workloads();
std::vector<Workload> triangle_workloads();
std::vector<Workload> scene_workloads();
std::vector<Workload> shader_workloads();
std::vector<Workload> texture_workloads();
std::vector<Workload> lookup_workloads();
std::vector<Workload> compute_workloads();
std::vector<Workload> transfer_workloads();
std::vector<Workload> overhead_workloads();

/// Seconds since some fixed moment; of all threads of this process, if VITRINE_BENCH_CPU is set (busy machines).
double now();

/// Submits `cmd` again and again, waiting each time, for about `seconds` after two warm-up runs; seconds per
/// submission: the fastest half's mean, because neighbours of this machine only ever make things slower.
double time_submissions(Run& run, VkCommandBuffer cmd, double seconds = 0.4);
/// Calls `work` the same way.
double time_calls(const std::function<void()>& work, double seconds = 0.4);

/// An RGBA8 target of this size, with D32 depth unless told otherwise.
cts::Target make_screen(Run& run, std::uint32_t width, std::uint32_t height, bool depth = true,
                        VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT);
/// Megapixels per second of one full-screen draw of a fragment shader, with what it reads.
double measure_fragments(Run& run, const std::string& fragment, const cts::Resources* resources = nullptr);
/// Ends a command buffer and returns it.
VkCommandBuffer finish(VkCommandBuffer cmd);
/// A command buffer that may be submitted again and again.
VkCommandBuffer begin_repeatable(Run& run);

/// Resident set of this process in megabytes.
double resident_megabytes();

}  // namespace vitrine::bench
