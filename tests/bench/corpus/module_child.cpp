// One module of a corpus in a process of its own: compared on both devices, then timed alternately.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>

#include "bench.h"
#include "cases/modules/run_module.h"
#include "corpus/corpus.h"
#include "harness/options.h"

namespace vitrine::bench {
namespace {

using cts::ModuleRun;

constexpr std::uint32_t kScale = 8;

/// Seconds of one device.
struct Times {
  double first = std::numeric_limits<double>::infinity();   ///< from the module to the end of the first submission
  double steady = std::numeric_limits<double>::infinity();  ///< of a dispatch or draw among many
  void keep_best(const Times& other) {
    first = std::min(first, other.first);
    steady = std::min(steady, other.steady);
  }
};

Times measure(cts::Gpu& gpu, const std::string& path) {
  Times times;
  ModuleRun how;
  how.scale = kScale;
  how.scaled_stages_only = true;
  const double start = now();
  how.submit = [&](Run& run, const ModuleRun::Record& record) {
    run.once(record);
    times.first = now() - start;
    const auto time_turns = [&](int turns, double seconds) {
      VkCommandBuffer cmd = run.begin();
      for (int i = 0; i < turns; ++i) {
        record(cmd);
        run.barrier(cmd);
      }
      return time_submissions(run, finish(cmd), seconds) / turns;
    };
    const double once = time_turns(1, 0.005);
    times.steady = time_turns(static_cast<int>(std::clamp(1e-3 / once, 1.0, 100.0)), 0.05);
    throw cts::Unsupported("timed");  // what it wrote by now depends on how often it ran
  };
  Run run(gpu, 1, 0);
  try {
    cts::run_module(run, path, how);
  } catch (const cts::Unsupported&) {
  }
  return times;
}

std::vector<cts::Output> outputs_of(cts::Gpu& gpu, const std::string& path) {
  ModuleRun how;
  how.scaled_stages_only = true;
  Run run(gpu, 1, 0);
  cts::run_module(run, path, how);
  return std::move(run.outputs);
}

bool equal(const std::vector<cts::Output>& a, const std::vector<cts::Output>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].bytes.size() != b[i].bytes.size() || cts::compare(a[i], b[i]).differing_texels != 0) return false;
  return true;
}

}  // namespace

int run_corpus_module(const std::string& path, const std::string& manifest, int rounds) {
  try {
    cts::Options options;
    options.icd = manifest;
    options.reference_icd = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
    options.reference_is_given = true;
    options.validation = false;
    cts::set_options(options);
    cts::prepare_environment(options);
    unsetenv("LP_NUM_THREADS");
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    cts::Gpus& both = cts::gpus();
    const bool same = equal(outputs_of(both.device, path), outputs_of(both.reference, path));
    Times device, reference;
    for (int round = 0; round < rounds; ++round) {
      device.keep_best(measure(both.device, path));
      reference.keep_best(measure(both.reference, path));
    }
    std::printf("times %.9g %.9g %.9g %.9g %d\n", device.steady, reference.steady, device.first - device.steady,
                reference.first - reference.steady, same ? 1 : 0);
    std::fflush(stdout);
    _Exit(0);
  } catch (const cts::Unsupported& missing) {
    std::printf("unsupported\n");
  } catch (const std::exception& error) {
    std::printf("failed\n");
    std::fprintf(stderr, "%s: %s\n", path.c_str(), error.what());
  }
  std::fflush(stdout);
  _Exit(0);  // drivers may not survive their end
}

}  // namespace vitrine::bench
