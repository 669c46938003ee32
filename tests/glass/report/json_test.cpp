// Reports for scripts.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "glass/report/report.h"
#include "tests/glass/report/findings.h"

namespace vitrine::glass {
namespace {

nlohmann::json report_of(std::span<const Finding> findings) {
  return nlohmann::json::parse(to_report(ReportFormat::kJson, findings));
}

TEST(ReportJson, HasEverythingThatIsKnown) {
  const Finding findings[] = {whole_finding(), bare_finding()};
  const nlohmann::json report = report_of(findings);
  EXPECT_EQ(report.at("format"), "vitrine-findings");
  ASSERT_EQ(report.at("findings").size(), 2u);
  const nlohmann::json& first = report["findings"][0];
  EXPECT_EQ(first.at("rule"), "out-of-bounds-store");
  EXPECT_EQ(first.at("severity"), "error");
  EXPECT_EQ(first.at("count"), 128);
  EXPECT_EQ(first.at("/address/labels/1"_json_pointer), "blur");
  EXPECT_EQ(first.at("/address/invocation"_json_pointer), R"({"kind": "compute", "id": [5, 0, 0]})"_json);
  EXPECT_EQ(
      first.at("/address/frames/1"_json_pointer),
      R"({"function": "main", "file": "shaders/blur.comp", "line": 30, "column": 5, "text": "    put(i);"})"_json);
}

TEST(ReportJson, RacesHaveBothAccesses) {
  const Finding finding = race_finding();
  const nlohmann::json first = report_of({&finding, 1}).at("findings").at(0);
  EXPECT_EQ(first.at("remedy"), "barrier(); between them");
  EXPECT_EQ(first.at("/related/0/message"_json_pointer), "store of 4 bytes");
  EXPECT_EQ(first.at("/related/0/address/frames/0/line"_json_pointer), 8);
  EXPECT_EQ(first.at("/related/0/address/invocation/id/0"_json_pointer), 3);
}

TEST(ReportJson, LeavesOutWhatIsUnknown) {
  const Finding finding = bare_finding();
  EXPECT_EQ(report_of({&finding, 1}).at("/findings/0/address"_json_pointer), nlohmann::json::object());
}

TEST(ReportJson, IsWholeWithoutFindings) { EXPECT_TRUE(report_of({}).at("findings").empty()); }

TEST(ReportJson, SurvivesNamesThatAreNoUtf8) {
  Finding finding = bare_finding();
  finding.address.pipeline = "a\xff\"\n";
  EXPECT_EQ(report_of({&finding, 1}).at("/findings/0/address/pipeline"_json_pointer), "a\xef\xbf\xbd\"\n");
}

}  // namespace
}  // namespace vitrine::glass
