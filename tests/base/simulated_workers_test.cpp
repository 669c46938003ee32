// Simulated threads: every item runs once, on the worker that would be free first.
#include "base/simulated_workers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <vector>

#include "base/workers.h"

namespace vitrine::base {
namespace {

/// In a process of its own, since the number is read once. What it tells at its end is on stderr.
void run_simulated() {
  setenv("VITRINE_SIMULATED_THREADS", "8", 1);
  setenv("VITRINE_LOG", "threads", 1);
  if (worker_count() != 8) _exit(1);
  std::vector<int> runs(100);
  std::set<std::size_t> workers;
  {
    const SimulatedWork work;
    parallel_for(runs.size(), [&](std::size_t index, std::size_t worker) {
      ++runs[index];
      workers.insert(worker);
      volatile double sum = 0;
      for (int i = 0; i < 200000; ++i) sum = sum + 1;
      // A loop in an item is none of its own, and has the worker of the item.
      parallel_for(4, [&](std::size_t, std::size_t inner) {
        if (inner != worker) _exit(3);
      });
    });
  }
  for (const int times : runs)
    if (times != 1) _exit(2);
  std::exit(workers.size() == 8 ? 0 : 4);
}

TEST(SimulatedWorkersDeathTest, ShareTheItemsOfALoop) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(run_simulated(), testing::ExitedWithCode(0),
              "threads: 8: [0-9.]+ s by one, [0-9.]+ s by all: [0-9.]+ s outside of loops, [0-9.]+ s in 1 loops");
}

}  // namespace
}  // namespace vitrine::base
