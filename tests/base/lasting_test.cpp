// Values that exit handlers may still use.
#include "base/lasting.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <vector>

#include "base/workers.h"

namespace vitrine::base {
namespace {

std::vector<int>& numbers() {
  static std::vector<int>& values = lasting([] { return std::vector<int>{1, 2, 3}; });
  return values;
}

struct Kept {
  std::vector<int> list = {4, 5};
};

TEST(LastingDeathTest, ServesExitHandlers) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int kAllThere = 7;
  const auto leave = [] {
    // Registered before the first use of everything, so that it runs after the destructors of static locals.
    std::atexit([] {
      std::atomic<std::size_t> done = 0;
      parallel_for(64, [&](std::size_t, std::size_t) { ++done; });
      const bool whole = done == 64 && numbers().size() == 3 && per_thread<Kept>().list.size() == 2;
      _exit(whole ? kAllThere : 1);
    });
    std::atomic<std::size_t> done = 0;
    parallel_for(64, [&](std::size_t, std::size_t) { ++done; });
    numbers().at(2) = per_thread<Kept>().list.at(1);
    std::exit(0);
  };
  EXPECT_EXIT(leave(), ::testing::ExitedWithCode(kAllThere), "");
}

}  // namespace
}  // namespace vitrine::base
