// The table of rules: ids that reports can be made of, texts that say something, rules of Vulkan that exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "glass/finding.h"

namespace vitrine::glass {
namespace {

TEST(Rules, IdsAreWordsWithHyphensAndDiffer) {
  std::set<std::string> ids;
  for (const Rule& row : rules()) {
    EXPECT_TRUE(std::regex_match(row.id, std::regex("[a-z]+(-[a-z]+)*"))) << row.id;
    EXPECT_TRUE(ids.insert(row.id).second) << row.id << " is there twice";
    EXPECT_EQ(&rule(row.id), &row);
  }
}

TEST(Rules, TextsSaySomething) {
  for (const Rule& row : rules()) {
    const std::string title = row.title, help = row.help;
    EXPECT_TRUE(std::isupper(title.front()) && title.size() < 60 && title.back() != '.') << row.id;
    EXPECT_TRUE(std::isupper(help.front()) && help.back() == '.') << row.id;
    EXPECT_EQ(help.find("  "), std::string::npos) << row.id;
  }
}

/// Ids that help texts quote and that Vulkan 1.3.239 has, but not 1.4.309: it has the same rules under other ids, or
/// has made them part of others.
const std::set<std::string> kOlder = {
    "VUID-RuntimeSpirv-NonUniform-06274", "VUID-vkCmdDispatch-None-02697", "VUID-vkCmdDispatch-None-02698",
    "VUID-vkCmdDrawIndexed-robustBufferAccess2-07825", "VUID-vkCmdDrawIndirectCount-countBuffer-03122"};

/// Valid-usage ids that help texts quote exist in each list that the headers came with, installed or unpacked
/// (VITRINE_TEST_VALID_USAGE), but for those that a later one dropped.
TEST(Rules, QuoteValidUsageThatExists) {
  const std::regex pattern("VUID-[\\w-]+"), api("\"api version\": \"([\\d.]+)\"");
  bool any = false;
  for (const char* path : {"/usr/share/vulkan/registry/validusage.json", VITRINE_TEST_VALID_USAGE}) {
    std::ifstream file(path);
    if (!file) continue;
    any = true;
    const std::string known{std::istreambuf_iterator<char>(file), {}};
    std::smatch version;
    const auto head = known.begin() + std::min<std::ptrdiff_t>(known.size(), 400);
    ASSERT_TRUE(std::regex_search(known.begin(), head, version, api)) << path;
    const bool is_older = version[1] == "1.3.239";
    for (const Rule& row : rules()) {
      const std::string help = row.help;
      for (std::sregex_iterator id(help.begin(), help.end(), pattern), end; id != end; ++id) {
        const bool is_there = known.find('"' + id->str() + '"') != std::string::npos;
        EXPECT_TRUE(is_there || (!is_older && kOlder.count(id->str())))
            << row.id << " quotes " << id->str() << ": " << path;
      }
    }
  }
  if (!any) GTEST_SKIP() << "the Vulkan headers came without validusage.json";
}

}  // namespace
}  // namespace vitrine::glass
