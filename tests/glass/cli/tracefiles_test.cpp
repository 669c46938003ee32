// Tracefiles of several processes added up.
#include "glass/cli/tracefiles.h"

#include <gtest/gtest.h>

namespace vitrine::glass::cli {
namespace {

constexpr char kFirst[] =
    "TN:\nSF:a.comp\nFN:9,f(vf3;\nFN:1,main\nFNDA:0,f(vf3;\nFNDA:2,main\nFNF:2\nFNH:1\n"
    "BRDA:3,0,0,2\nBRDA:3,0,1,0\nBRDA:9,0,0,-\nBRDA:9,0,1,-\nBRF:4\nBRH:1\nDA:1,2\nDA:9,0\nLF:2\nLH:1\nend_of_record\n";
constexpr char kSecond[] =
    "TN:test\nSF:a.comp\nFN:9,f(vf3;\nFNDA:4,f(vf3;\nBRDA:9,0,0,4\nBRDA:9,0,1,0\nDA:9,4,checksum\nend_of_record\n"
    "SF:b,c.frag\nDA:5,1\nend_of_record\n";

Coverage read(std::initializer_list<const char*> texts) {
  Coverage coverage;
  std::string error;
  for (const char* const text : texts) EXPECT_TRUE(add_tracefile(text, coverage, error)) << error;
  return coverage;
}

TEST(CliTracefiles, ReadWhatIsWritten) { EXPECT_EQ(to_lcov(read({kFirst})), kFirst); }

TEST(CliTracefiles, AddUp) {
  EXPECT_EQ(to_lcov(read({kFirst, kSecond})),
            "TN:\nSF:a.comp\nFN:9,f(vf3;\nFN:1,main\nFNDA:4,f(vf3;\nFNDA:2,main\nFNF:2\nFNH:2\n"
            "BRDA:3,0,0,2\nBRDA:3,0,1,0\nBRDA:9,0,0,4\nBRDA:9,0,1,0\nBRF:4\nBRH:2\nDA:1,2\nDA:9,4\nLF:2\nLH:2\n"
            "end_of_record\nTN:\nSF:b,c.frag\nFNF:0\nFNH:0\nBRF:0\nBRH:0\nDA:5,1\nLF:1\nLH:1\nend_of_record\n");
}

TEST(CliTracefiles, FunctionsBeginWhereCodeIs) {
  EXPECT_EQ(to_lcov(read({"SF:a.comp\nFN:7,put\nFNDA:4,put\nDA:8,4\nend_of_record\n"})),
            "TN:\nSF:a.comp\nFN:8,put\nFNDA:4,put\nFNF:1\nFNH:1\nBRF:0\nBRH:0\nDA:8,4\nLF:1\nLH:1\nend_of_record\n");
}

TEST(CliTracefiles, SumsSayHowMuchRan) {
  const CoverageSummary summary = summary_of(read({kFirst}));
  EXPECT_EQ(summary.lines.hit, 1u);
  EXPECT_EQ(summary.branches.found, 4u);
  EXPECT_DOUBLE_EQ(summary.functions.percent(), 50);
  EXPECT_DOUBLE_EQ(summary_of({}).lines.percent(), 100);
}

TEST(CliTracefiles, NameTheLineThatIsNone) {
  for (const char* const text : {"SF:a\nnonsense\n", "SF:a\nDA:x,1\n", "TN:\nDA:1,1\n", "SF:a\nBRDA:1,0,4000000000,1\n",
                                 "SF:a\nDA:1\n", "SF:a\nXX:1\n"}) {
    Coverage coverage;
    std::string error;
    EXPECT_FALSE(add_tracefile(text, coverage, error)) << text;
    EXPECT_EQ(error, "line 2 is none of a tracefile");
  }
}

}  // namespace
}  // namespace vitrine::glass::cli
