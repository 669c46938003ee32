// Simulated threads: each workload once for each number of threads, in a process of its own.
#include "threads.h"

#include <unistd.h>

#include <cstdio>
#include <sstream>
#include <vector>

#include "bench.h"

namespace vitrine::bench {
namespace {

/// What the driver tells of a process, in seconds.
struct Simulated {
  double by_one = 0, by_all = 0, outside = 0, in_loops = 0, longest = 0;
};

std::string own_path() {
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

Simulated simulate(const std::string& manifest, const char* workload, unsigned threads) {
  std::string command = "VK_DRIVER_FILES='";
  command += manifest + "' VK_ICD_FILENAMES='" + manifest + "' VK_LOADER_LAYERS_DISABLE='~all~' VITRINE_LOG=threads ";
  command += "VITRINE_SIMULATED_THREADS=" + std::to_string(threads) + " '" + own_path() + "' --child=" + workload;
  Simulated found;
  FILE* output = popen((command + " 2>&1 >/dev/null").c_str(), "r");
  if (!output) return found;
  char line[512];
  while (std::fgets(line, sizeof line, output)) {
    Simulated s;
    if (std::sscanf(
            line,
            "vitrine: threads: %*u: %lf s by one, %lf s by all: %lf s outside of loops, %lf s in %*u loops, %lf s "
            "of longest items",
            &s.by_one, &s.by_all, &s.outside, &s.in_loops, &s.longest) == 5)
      found = s;
  }
  pclose(output);
  return found;
}

/// What keeps the largest number of threads from being that many times as fast as one.
const char* limit_of(const Simulated& s) {
  if (s.outside > s.in_loops) return "work outside of loops";
  return s.longest > s.in_loops / 2 ? "longest items" : "-";
}

}  // namespace

int run_threads(const std::string& manifest, const std::string& list, const std::string& filter) {
  std::vector<unsigned> counts;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    if (const int count = std::atoi(word.c_str()); count > 0) counts.push_back(static_cast<unsigned>(count));
  std::printf("| %-16s |", "workload");
  for (const unsigned count : counts) std::printf(" %7u |", count);
  std::printf(" limit with %u\n|---|", counts.empty() ? 0 : counts.back());
  for (std::size_t i = 0; i < counts.size(); ++i) std::printf("---:|");
  std::printf("---|\n");
  for (const Workload& workload : workloads()) {
    if (std::string(workload.name).find(filter) == std::string::npos) continue;
    std::printf("| %-16s |", workload.name);
    Simulated last;
    for (const unsigned count : counts) {
      last = simulate(manifest, workload.name, count);
      std::printf(" %6.2fx |", last.by_all > 0 ? last.by_one / last.by_all : 0.0);
      std::fflush(stdout);
    }
    std::printf(" %s |\n", limit_of(last));
  }
  return 0;
}

}  // namespace vitrine::bench
