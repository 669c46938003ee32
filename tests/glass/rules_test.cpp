// The table of rules: ids that reports can be made of, texts that say something, rules of Vulkan that exist.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

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

/// Valid-usage ids that help texts quote exist in the specification that is installed beside the headers.
TEST(Rules, QuoteValidUsageThatExists) {
  std::ifstream file("/usr/share/vulkan/registry/validusage.json");
  if (!file) GTEST_SKIP() << "the Vulkan headers came without validusage.json";
  const std::string known{std::istreambuf_iterator<char>(file), {}};
  const std::regex pattern("VUID-[\\w-]+");
  for (const Rule& row : rules()) {
    const std::string help = row.help;
    for (std::sregex_iterator id(help.begin(), help.end(), pattern), end; id != end; ++id) {
      EXPECT_NE(known.find('"' + id->str() + '"'), std::string::npos) << row.id << " quotes " << id->str();
    }
  }
}

}  // namespace
}  // namespace vitrine::glass
