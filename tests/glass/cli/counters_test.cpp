// Files of counters: sums and differences.
#include "glass/cli/counters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vitrine::glass::cli {
namespace {

TEST(CliCounters, AddUpByName) {
  const auto sum = sum_of_counters(R"({"version": 1, "tool": "count", "total": {"adds": 3, "loads": 1}})",
                                   R"({"version": 1, "total": {"adds": 9007199254740993, "stores": 2}})");
  ASSERT_TRUE(sum);
  EXPECT_NE(sum->find("\"adds\": 9007199254740996"), std::string::npos) << *sum;
  const Counters expected = {{"total/adds", 9007199254740996.0}, {"total/loads", 1}, {"total/stores", 2}};
  EXPECT_EQ(read_counters(*sum), expected);
  EXPECT_NE(sum->find("\"version\": 1"), std::string::npos);
}

TEST(CliCounters, SumsThatDoNotFitAreRounded) {
  const auto sum = sum_of_counters(R"({"adds": 9223372036854775807})", R"({"adds": 9223372036854775807})");
  ASSERT_TRUE(sum);
  EXPECT_EQ(read_counters(*sum), (Counters{{"adds", 18446744073709551614.0}}));
}

TEST(CliCounters, OfTheMostTheLargerCounts) {
  const auto sum = sum_of_counters(R"({"total": {"mostOverdraw": 3}})", R"({"total": {"mostOverdraw": 2}})");
  ASSERT_TRUE(sum);
  EXPECT_EQ(read_counters(*sum), (Counters{{"total/mostOverdraw", 3}}));
}

TEST(CliCounters, GroupsHaveNames) {
  const Counters counters = {
      {"pipelines/a/vertices", 1}, {"pipelines/a/x/y", 2}, {"pipelines/b/x/y", 2}, {"total/c", 1}};
  EXPECT_EQ(names_in_group(counters, "pipelines"), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(names_in_group(counters, "draws").empty());
}

TEST(CliCounters, RefuseWhatIsNoObject) {
  for (const char* const text : {"", "3", "[1]", "{\"a\":"}) {
    EXPECT_FALSE(sum_of_counters("{}", text)) << text;
    EXPECT_FALSE(read_counters(text)) << text;
  }
}

TEST(CliCounters, SurviveGroupsThatAreNumbersElsewhere) {
  EXPECT_TRUE(sum_of_counters(R"({"a": 1, "b": {"c": 1}})", R"({"a": {"c": 1}, "b": 2})"));
}

TEST(CliCounters, ChangesAreOfWhatWas) {
  const auto list =
      changes({{"a", 100}, {"b/x", 4}, {"c", 1}, {"gone", 5}}, {{"a", 106}, {"b/x", 3}, {"c", 1}, {"new", 2}}, "*");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].name, "a");
  EXPECT_DOUBLE_EQ(list[0].growth(), 6);
  EXPECT_DOUBLE_EQ(list[1].growth(), -25);
  EXPECT_DOUBLE_EQ(list[2].growth(), -100);
  EXPECT_TRUE(std::isinf(list[3].growth()));
}

TEST(CliCounters, PatternsChoose) {
  const auto list = changes({}, {{"total/adds", 1}, {"pipelines/a/adds", 1}, {"total/loads", 1}}, "total/*");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].name, "total/adds");
}

}  // namespace
}  // namespace vitrine::glass::cli
