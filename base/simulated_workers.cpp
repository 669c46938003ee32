// Simulated threads: sums over all loops of a process.
#include "base/simulated_workers.h"

#include <ctime>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <vector>

#include "base/lasting.h"
#include "base/log.h"

namespace vitrine::base {
namespace {

/// Seconds of the processor that this thread has had: what else the machine does is not counted.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// Seconds of a process, which the end of it tells.
struct Sums {
  Sums() = default;
  Sums(const Sums&) = delete;
  Sums& operator=(const Sums&) = delete;
  ~Sums() {
    const double alone = work - looped;
    char line[200];
    std::snprintf(
        line, sizeof line,
        "%zu: %.6f s by one, %.6f s by all: %.6f s outside of loops, %.6f s in %llu loops, %.6f s of longest items",
        simulated_workers(), alone + items, alone + spread, alone, spread, static_cast<unsigned long long>(loops),
        longest);
    log("threads", line);
  }

  std::mutex mutex;
  double work = 0;     ///< SimulatedWork
  double looped = 0;   ///< of it, in loops, with what it takes to time each item
  double items = 0;    ///< in items
  double spread = 0;   ///< the same, by all threads
  double longest = 0;  ///< the longest item of each loop
  std::uint64_t loops = 0;
};

Sums& sums() {
  static Sums& instance = lasting([] { return Sums(); });
  return instance;
}

}  // namespace

std::size_t simulated_workers() {
  static const std::size_t count = [] {
    const char* value = std::getenv("VITRINE_SIMULATED_THREADS");
    return value ? static_cast<std::size_t>(std::clamp(std::strtol(value, nullptr, 10), 0L, 256L)) : std::size_t{0};
  }();
  return count;
}

void simulate_loop(std::size_t count, FunctionRef<void(std::size_t, std::size_t)> body) {
  std::vector<double> busy(simulated_workers());  // until when, by thread
  double items = 0, longest = 0;
  const double start = thread_seconds();
  for (std::size_t i = 0; i < count; ++i) {
    const auto next = std::min_element(busy.begin(), busy.end());
    const double begin = thread_seconds();
    body(i, static_cast<std::size_t>(next - busy.begin()));
    const double took = thread_seconds() - begin;
    *next += took;
    items += took;
    longest = std::max(longest, took);
  }
  Sums& s = sums();
  const std::lock_guard lock(s.mutex);
  s.looped += thread_seconds() - start;
  s.items += items;
  s.spread += *std::max_element(busy.begin(), busy.end());
  s.longest += longest;
  ++s.loops;
}

SimulatedWork::SimulatedWork() {
  if (simulated_workers() != 0) begin_ = thread_seconds();
}

SimulatedWork::~SimulatedWork() {
  if (simulated_workers() == 0) return;
  Sums& s = sums();
  const std::lock_guard lock(s.mutex);
  s.work += thread_seconds() - begin_;
}

}  // namespace vitrine::base
