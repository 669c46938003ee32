// Findings read back from reports, and those of several processes made one.
#include "glass/cli/findings.h"

#include <gtest/gtest.h>

#include <fstream>

#include "glass/cli/files.h"
#include "glass/report/report.h"
#include "tests/glass/report/findings.h"

namespace vitrine::glass::cli {
namespace {

TEST(CliFindings, ReadWhatReportsSay) {
  const Finding written[] = {whole_finding(), bare_finding(), note_finding()};
  const std::string report = to_report(ReportFormat::kJson, written);
  std::vector<Finding> read;
  std::string error;
  ASSERT_TRUE(read_findings(report, read, error)) << error;
  EXPECT_EQ(to_report(ReportFormat::kJson, read), report);
}

TEST(CliFindings, RefuseWhatIsNoReport) {
  for (
      const char* const text :
      {"", "[]", "{}", "{\"format\":3}", R"({"format":"vitrine-findings","version":2,"findings":[]})",
       R"({"format":"vitrine-findings","version":1})", R"({"format":"vitrine-findings","version":1,"findings":[3]})",
       R"({"format":"vitrine-findings","version":1,"findings":[{"rule":"no-such-rule","message":"","address":{}}]})",
       R"({"format":"vitrine-findings","version":1,"findings":[{"rule":"printf","message":1,"address":{}}]})",
       R"({"format":"vitrine-findings","version":1,"findings":[{"rule":"printf","message":"","address":{"frames":3}}]})"}) {
    std::vector<Finding> read;
    std::string error;
    EXPECT_FALSE(read_findings(text, read, error)) << text;
    EXPECT_FALSE(error.empty()) << text;
  }
}

TEST(CliFindings, RacesKeepBothAccesses) {
  const Finding race = race_finding();
  std::vector<Finding> findings;
  std::string error;
  ASSERT_TRUE(read_findings(to_report(ReportFormat::kJson, {&race, 1}), findings, error)) << error;
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(to_report(ReportFormat::kText, findings), to_report(ReportFormat::kText, {&race, 1}));
}

TEST(CliFindings, SamePlacesAreOneFinding) {
  Finding again = whole_finding(), elsewhere = whole_finding();
  again.address.submission = 7;
  again.address.invocation.id[0] = 9;
  again.count = 2;
  elsewhere.address.frames[0].line = 13;
  const std::vector<Finding> result = folded({whole_finding(), note_finding(), again, elsewhere, note_finding()});
  ASSERT_EQ(result.size(), 4u);
  EXPECT_EQ(result[0].count, 130u);
  EXPECT_EQ(result[0].address.submission, 1u);
  EXPECT_EQ(result[1].message, "x = 3");
  EXPECT_EQ(result[2].count, 128u);
}

TEST(CliFindings, QuoteFilesThatAreThere) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.comp") << "first\r\nsecond\nthird";
  std::vector<Finding> findings = {whole_finding()};
  const std::string file = folder.path() / "a.comp", missing = folder.path() / "b.comp";
  findings[0].address.frames = {{"", file, 2, 0, ""},      {"", file, 1, 0, ""},    {"", file, 4, 0, ""},
                                {"", file, 3, 0, "known"}, {"", missing, 1, 0, ""}, {"", folder.path(), 1, 0, ""}};
  quote_files(findings);
  std::string texts;
  for (const Frame& frame : findings[0].address.frames) texts += frame.text + "|";
  EXPECT_EQ(texts, "second|first||known|||");
}

}  // namespace
}  // namespace vitrine::glass::cli
