// The file of a report: whole after every append, grows, and says once why it cannot be written.
#include "glass/report/report_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/glass/report/findings.h"

namespace vitrine::glass {
namespace {

class ReportFileTest : public testing::Test {
 protected:
  ReportFileTest() {
    char name[] = "/tmp/vitrine-report-XXXXXX";
    folder_ = ::mkdtemp(name);
  }
  ~ReportFileTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) const { return folder_ + "/" + name; }
  static std::string content(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::size_t findings_in(const std::string& path) {
    return nlohmann::json::parse(content(path)).at("findings").size();
  }
  static void replace(const std::string& path, std::string_view text) { std::ofstream(path) << text; }

  std::string folder_;
};

TEST_F(ReportFileTest, IsWholeAfterEveryAppend) {
  const Finding findings[] = {whole_finding(), bare_finding(), note_finding()};
  for (const char* name : {"a.txt", "a.json", "a.sarif"}) {
    ReportFile report(path(name));
    for (std::size_t i = 0; i <= std::size(findings); ++i) {
      EXPECT_EQ(content(path(name)), to_report(format_of(name), std::span(findings).first(i))) << name << ' ' << i;
      if (i < std::size(findings)) report.append({&findings[i], 1});
    }
    EXPECT_TRUE(report.good());
  }
}

TEST_F(ReportFileTest, GrowsWhereAnotherProcessHasWritten) {
  const Finding finding = bare_finding();
  ReportFile(path("a.json")).append({&finding, 1});
  ReportFile(path("a.json")).append({&finding, 1});
  EXPECT_EQ(findings_in(path("a.json")), 2u);
}

TEST_F(ReportFileTest, ReplacesWhatIsNoReportOfThisVersion) {
  replace(path("a.json"), "{\"findings\": \"" + std::string(10000, 'x') + "\"}");
  const ReportFile report(path("a.json"));
  EXPECT_TRUE(report.good());
  EXPECT_EQ(content(path("a.json")), to_report(ReportFormat::kJson, {}));
}

TEST_F(ReportFileTest, ProcessesMayShareIt) {
  constexpr int kProcesses = 4, kAppends = 50;
  for (int i = 0; i < kProcesses; ++i) {
    if (::fork() == 0) {
      const Finding finding = whole_finding();
      ReportFile report(path("a.json"));
      for (int j = 0; j < kAppends; ++j) report.append({&finding, 1});
      ::_exit(0);
    }
  }
  for (int i = 0; i < kProcesses; ++i) ::wait(nullptr);
  EXPECT_EQ(findings_in(path("a.json")), std::size_t{kProcesses} * kAppends);
}

TEST_F(ReportFileTest, NameMayHoldTheProcess) {
  EXPECT_EQ(report_path("/a/%p%%%x%"), "/a/" + std::to_string(::getpid()) + "%%x%");
  EXPECT_EQ(report_path("a"), std::filesystem::current_path().string() + "/a");
}

TEST_F(ReportFileTest, SaysWhyItCannotBeWritten) {
  const Finding finding = bare_finding();
  ReportFile missing(path("no/such/folder.sarif")), folder(folder_);
  EXPECT_EQ(missing.error(),
            "the report " + path("no/such/folder.sarif") + " cannot be written: No such file or directory");
  EXPECT_EQ(folder.error(), "the report " + folder_ + " cannot be written: Is a directory");
  missing.append({&finding, 1});
  EXPECT_FALSE(std::filesystem::exists(path("no")));
}

/// In a child, whose files may not grow: what fits no more leaves the report as it was.
TEST_F(ReportFileTest, StaysWholeWhenTheDiskIsFull) {
  const Finding finding = whole_finding();
  ReportFile report(path("a.json"));
  report.append({&finding, 1});
  const std::string before = content(path("a.json"));
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{before.size() + 20, before.size() + 20};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    report.append({&finding, 1});
    ::_exit(report.good() ? 1 : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(content(path("a.json")), before);
}

}  // namespace
}  // namespace vitrine::glass
