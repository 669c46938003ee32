// Which topics VITRINE_LOG asks for.
#include "base/log.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace vitrine::base {
namespace {

const int log_is_set = setenv("VITRINE_LOG", "all", 1);

TEST(Log, AllLeavesOutWhatSlowsShadersDown) {
  static_cast<void>(log_is_set);
  EXPECT_TRUE(log_enabled("error"));
  EXPECT_TRUE(log_enabled("shader"));
  EXPECT_FALSE(log_enabled("shader-profile"));
}

}  // namespace
}  // namespace vitrine::base
