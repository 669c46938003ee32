// Parallel loops: every item once, workers not shared, nesting inline.
#include "base/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <thread>
#include <vector>

namespace vitrine::base {
namespace {

TEST(Workers, EveryItemRunsOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 1000u}) {
    std::vector<std::atomic<int>> runs(count);
    parallel_for(count, [&](std::size_t i, std::size_t) { ++runs[i]; });
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(runs[i], 1) << i << " of " << count;
  }
}

TEST(Workers, NoTwoConcurrentItemsShareAWorker) {
  std::vector<std::atomic<int>> busy(worker_count());
  std::atomic<int> clashes{0};
  parallel_for(500, [&](std::size_t, std::size_t worker) {
    ASSERT_LT(worker, busy.size());
    if (busy[worker]++ != 0) ++clashes;
    std::this_thread::yield();
    --busy[worker];
  });
  EXPECT_EQ(clashes, 0);
}

TEST(Workers, AnExceptionEndsTheLoopAndReachesTheCaller) {
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> running{0};
    EXPECT_THROW(parallel_for(100,
                              [&](std::size_t i, std::size_t) {
                                ++running;
                                std::this_thread::yield();
                                --running;
                                if (i == 7) throw std::bad_alloc();
                              }),
                 std::bad_alloc);
    EXPECT_EQ(running, 0) << "a thread is still in the loop";
    std::atomic<int> runs{0};
    parallel_for(10, [&](std::size_t, std::size_t) { ++runs; });
    EXPECT_EQ(runs, 10);
  }
}

TEST(Workers, NestedLoopsRunInline) {
  std::atomic<int> total{0};
  std::atomic<int> moved{0};
  parallel_for(20, [&](std::size_t, std::size_t outer) {
    const std::thread::id self = std::this_thread::get_id();
    parallel_for(10, [&](std::size_t, std::size_t inner) {
      ++total;
      if (inner != outer || std::this_thread::get_id() != self) ++moved;
    });
  });
  EXPECT_EQ(total, 200);
  EXPECT_EQ(moved, 0);
}

TEST(Workers, LoopsFromSeveralThreadsAllFinish) {
  std::atomic<int> total{0};
  std::vector<std::thread> callers;
  for (int t = 0; t < 4; ++t) {
    callers.emplace_back([&] {
      for (int n = 0; n < 50; ++n) parallel_for(8, [&](std::size_t, std::size_t) { ++total; });
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(total, 4 * 50 * 8);
}

}  // namespace
}  // namespace vitrine::base
