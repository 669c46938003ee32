// Applications of several threads. Worth most under TSan (preset tsan).
#include <mutex>
#include <thread>
#include <vector>

#include "tests/icd/small_program.h"

namespace vitrine::icd::test {
namespace {

constexpr int kThreads = 8, kRounds = 20;

template <class F>
void on_all_threads(F&& round) {
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < kRounds && !::testing::Test::HasFailure(); ++i) round();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(Threads, EachWithADeviceOfItsOwn) {
  on_all_threads([] {
    Program p;
    EXPECT_EQ(run(p), VK_SUCCESS);
    check_results(p);
    destroy(p);
  });
}

TEST(Threads, AllWithOneDevice) {
  Program shared;
  ASSERT_EQ(make_device(shared), VK_SUCCESS);
  std::mutex queue;
  on_all_threads([&] {
    Program p = shared;
    for (const auto step : {make_resources, make_descriptors, make_render_pass, make_pipelines, record}) {
      ASSERT_EQ(step(p), VK_SUCCESS);
    }
    {
      const std::lock_guard lock(queue);
      EXPECT_EQ(submit(p), VK_SUCCESS);
    }
    EXPECT_EQ(wait(p), VK_SUCCESS);
    check_results(p);
    destroy_objects(p);
  });
  destroy(shared);
}

TEST(Threads, AllWithTheLayoutsOfOne) {
  Program shared;
  for (const auto step : {make_device, make_resources, make_descriptors, make_render_pass, make_pipelines}) {
    ASSERT_EQ(step(shared), VK_SUCCESS);
  }
  // Pipelines and command buffers of all threads come of one layout, one render pass and, by content, the same modules.
  on_all_threads([&] {
    Program p = shared;
    ASSERT_EQ(make_pipelines(p), VK_SUCCESS);
    ASSERT_EQ(record(p), VK_SUCCESS);
    destroy_recorded(p);
  });
  for (const auto step : {record, submit, wait}) ASSERT_EQ(step(shared), VK_SUCCESS);
  check_results(shared);
  destroy(shared);
}

}  // namespace
}  // namespace vitrine::icd::test
