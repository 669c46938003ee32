// Choices by a seed: what a list asks for, numbers in another order.
#include "base/shake.h"

#include <gtest/gtest.h>

#include <set>

namespace vitrine::base {
namespace {

TEST(Shake, ListsAreASeedAndKinds) {
  EXPECT_EQ(parse_shake("").kinds, 0u);
  const ShakeSettings usual = parse_shake("7");
  EXPECT_EQ(usual.seed, 7u);
  EXPECT_TRUE(usual.has(ShakeKind::kOrder) && usual.has(ShakeKind::kDelays) && usual.has(ShakeKind::kPoison));
  EXPECT_FALSE(usual.has(ShakeKind::kErrors));
  const ShakeSettings some = parse_shake("12,order,errors");
  EXPECT_EQ(some.seed, 12u);
  EXPECT_TRUE(some.has(ShakeKind::kOrder) && some.has(ShakeKind::kErrors));
  EXPECT_FALSE(some.has(ShakeKind::kPoison));
}

TEST(Shake, WordsThatMeanNothingAreTold) {
  EXPECT_EQ(parse_shake("order").unknown, std::vector<std::string>{"order"});
  EXPECT_EQ(parse_shake("3x").unknown, std::vector<std::string>{"3x"});
  const ShakeSettings settings = parse_shake("3,waves,order");
  EXPECT_EQ(settings.unknown, std::vector<std::string>{"waves"});
  EXPECT_TRUE(settings.has(ShakeKind::kOrder));
}

TEST(Shuffle, HasEveryNumberOnce) {
  for (const std::uint64_t count : {1u, 2u, 3u, 4u, 5u, 17u, 64u, 1000u, 4097u})
    for (const std::uint64_t key : {0u, 1u, 77u}) {
      const Shuffle shuffle(count, key);
      std::set<std::uint64_t> seen;
      for (std::uint64_t i = 0; i < count; ++i) {
        EXPECT_LT(shuffle(i), count);
        seen.insert(shuffle(i));
      }
      EXPECT_EQ(seen.size(), count);
    }
}

TEST(Shuffle, KeysGiveOtherOrders) {
  for (const std::uint64_t count : {2u, 3u, 16u}) {
    std::set<std::vector<std::uint64_t>> orders;
    for (std::uint64_t key = 0; key < 20; ++key) {
      const Shuffle shuffle(count, mix(key, 0));
      std::vector<std::uint64_t> order;
      for (std::uint64_t i = 0; i < count; ++i) order.push_back(shuffle(i));
      orders.insert(order);
    }
    EXPECT_GE(orders.size(), std::min<std::uint64_t>(count, 5)) << count;
  }
}

TEST(Shake, ChoicesFollowFromTheirNumber) {
  restart_choices(5);
  const std::uint64_t first = next_choice(), second = next_choice();
  EXPECT_NE(first, second);
  restart_choices(6);
  EXPECT_NE(next_choice(), first);
  restart_choices(5);
  EXPECT_EQ(next_choice(), first);
  EXPECT_EQ(next_choice(), second);
}

}  // namespace
}  // namespace vitrine::base
