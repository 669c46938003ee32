// Reports for code hosts: what SARIF 2.1.0 demands and what hosts make use of.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "glass/report/report.h"
#include "glass/report/sarif_parts.h"
#include "tests/glass/report/findings.h"

namespace vitrine::glass {
namespace {

nlohmann::json run_of(std::span<const Finding> findings) {
  return nlohmann::json::parse(to_report(ReportFormat::kSarif, findings)).at("runs").at(0);
}
nlohmann::json result_of(const Finding& finding) { return run_of({&finding, 1}).at("results").at(0); }

TEST(Sarif, DescribesEveryRule) {
  const nlohmann::json run = run_of({});
  EXPECT_TRUE(run.at("results").empty());
  ASSERT_EQ(run.at("/tool/driver/rules"_json_pointer).size(), rules().size());
  const nlohmann::json rule = run.at("/tool/driver/rules/1"_json_pointer);
  EXPECT_EQ(rule.at("id"), "vitrine/out-of-bounds-store");
  EXPECT_EQ(rule.at("name"), "OutOfBoundsStore");
  EXPECT_EQ(rule.at("/defaultConfiguration/level"_json_pointer), "error");
}

TEST(Sarif, ResultNamesRulePlaceAndInvocation) {
  const nlohmann::json result = result_of(whole_finding());
  EXPECT_EQ(result.at("ruleId"), "vitrine/out-of-bounds-store");
  EXPECT_EQ(result.at("ruleIndex"), 1);
  EXPECT_EQ(result.at("level"), "error");
  EXPECT_EQ(result.at("occurrenceCount"), 128);
  const nlohmann::json place = result.at("/locations/0/physicalLocation"_json_pointer);
  EXPECT_EQ(place.at("/artifactLocation/uri"_json_pointer), "shaders/blur.comp");
  EXPECT_EQ(place.at("/region/startLine"_json_pointer), 12);
  const nlohmann::json logical = result.at("/locations/0/logicalLocations"_json_pointer);
  EXPECT_EQ(logical.at(0).at("name"), "put");
  EXPECT_EQ(logical.at(1).at("name"), "invocation (5, 0, 0)");
}

TEST(Sarif, CallsAreAStackAndAFlow) {
  const nlohmann::json result = result_of(whole_finding());
  const auto line = [&](const char* pointer) {
    return result.at(
        nlohmann::json::json_pointer(std::string(pointer) + "/location/physicalLocation/region/startLine"));
  };
  EXPECT_EQ(line("/stacks/0/frames/0"), 12);
  EXPECT_EQ(line("/stacks/0/frames/1"), 30);
  EXPECT_EQ(line("/codeFlows/0/threadFlows/0/locations/0"), 30);
  EXPECT_EQ(line("/codeFlows/0/threadFlows/0/locations/1"), 12);
}

TEST(Sarif, ClaimsNoPlaceThatIsUnknown) {
  EXPECT_FALSE(result_of(bare_finding()).contains("locations"));
  Finding finding = bare_finding();
  finding.address.frames = {{"main", "", 3, 0, ""}};
  EXPECT_FALSE(result_of(finding).at("locations").at(0).contains("physicalLocation"));
}

TEST(Sarif, RacesHaveBothAccesses) {
  const nlohmann::json result = nlohmann::json::parse(sarif_entry(race_finding()));
  const std::string line = "/physicalLocation/region/startLine";
  const auto at = [&](const std::string& pointer) { return result.at(nlohmann::json::json_pointer(pointer)); };
  EXPECT_EQ(at("/locations/0" + line), 9);
  EXPECT_EQ(at("/relatedLocations/0" + line), 8);
  EXPECT_EQ(at("/codeFlows/0/threadFlows/0/locations/0/location" + line), 8);
  EXPECT_EQ(at("/codeFlows/0/threadFlows/0/locations/1/location" + line), 9);
}

TEST(Sarif, FilesAreReferences) {
  EXPECT_EQ(sarif_uri("shaders/a b.comp"), "shaders/a%20b.comp");
  EXPECT_EQ(sarif_uri("/src/\xc3\xa4.comp"), "file:///src/%C3%A4.comp");
  EXPECT_EQ(sarif_uri("C:\\src\\a.hlsl"), "file:///C:/src/a.hlsl");
  EXPECT_EQ(sarif_uri("a:b<c>"), "a%3Ab%3Cc%3E");
}

TEST(Sarif, ColumnsAreCodePoints) {
  EXPECT_EQ(sarif_column({"", "", 1, 4, "\xc3\xa4\xc3\xb6x"}), 3u);
  EXPECT_EQ(sarif_column({"", "", 1, 4, ""}), 4u);
  EXPECT_EQ(sarif_column({"", "", 1, 0, "x"}), 0u);
}

TEST(Sarif, FingerprintsFollowTheTextOfTheLine) {
  const Finding finding = whole_finding();
  Finding moved = finding, changed = finding, elsewhere = finding;
  moved.address.frames[0].line += 10;
  moved.address.submission = 9;
  moved.address.frames[0].text = "  " + finding.address.frames[0].text;
  moved.address.frames[0].column += 2;
  changed.address.frames[0].text += "y";
  elsewhere.address.frames[0].file = "other.comp";
  EXPECT_EQ(sarif_fingerprint(moved), sarif_fingerprint(finding));
  EXPECT_NE(sarif_fingerprint(changed), sarif_fingerprint(finding));
  EXPECT_NE(sarif_fingerprint(elsewhere), sarif_fingerprint(finding));
}

}  // namespace
}  // namespace vitrine::glass
