// Findings for GitLab's merge requests.
#include "glass/cli/code_quality.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/glass/report/findings.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::json;

TEST(CodeQuality, HasPlaceRuleAndMessage) {
  const Json list = Json::parse(code_quality({whole_finding(), note_finding()}));
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["description"],
            "store of 4 bytes at offset 4096 of storage buffer 'particles' (4096 bytes); at submission 1, command 3 "
            "(vkCmdDispatch) in 'frame' > 'blur', pipeline 'gauss', compute shader main, invocation (5, 0, 0); 128 "
            "times");
  EXPECT_EQ(list[0]["check_name"], "vitrine/out-of-bounds-store");
  EXPECT_EQ(list[0]["severity"], "critical");
  EXPECT_EQ(list[0]["location"], Json::parse(R"({"path": "shaders/blur.comp", "lines": {"begin": 12}})"));
  EXPECT_EQ(list[1]["severity"], "info");
  EXPECT_EQ(Json::parse(code_quality({race_finding()}))[0]["description"],
            "load of 4 bytes races; at invocation (2, 0, 0); missing: barrier(); between them");
}

TEST(CodeQuality, LeavesOutWhatHasNoFile) { EXPECT_EQ(code_quality({bare_finding()}), "[]\n"); }

TEST(CodeQuality, FingerprintsAreDifferentAndStay) {
  Finding other = whole_finding();
  other.message = "another store in the same line";
  const std::vector<Finding> findings = {whole_finding(), other, race_finding(), note_finding()};
  std::set<std::string> fingerprints;
  for (const Json& row : Json::parse(code_quality(findings))) fingerprints.insert(row["fingerprint"]);
  EXPECT_EQ(fingerprints.size(), findings.size());
  EXPECT_EQ(code_quality(findings), code_quality(findings));
}

}  // namespace
}  // namespace vitrine::glass::cli
