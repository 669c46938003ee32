// Reports for people.
#include <gtest/gtest.h>

#include "glass/report/report.h"
#include "tests/glass/report/findings.h"

namespace vitrine::glass {
namespace {

std::string text_of(const Finding& finding) { return to_report(ReportFormat::kText, {&finding, 1}); }

TEST(ReportText, ParagraphSaysWhatAndWhere) {
  EXPECT_EQ(text_of(whole_finding()),
            "shaders/blur.comp:12:3: error: store of 4 bytes at offset 4096 of storage buffer 'particles' (4096 bytes) "
            "[vitrine/out-of-bounds-store]\n"
            "   12 | \t\xc3\xa4[i] = x;\n"
            "      | \t ^\n"
            "  in function put\n"
            "  called from function main at shaders/blur.comp:30:5\n"
            "  at submission 1, command 3 (vkCmdDispatch) in 'frame' > 'blur', pipeline 'gauss', compute shader main, "
            "invocation (5, 0, 0); 128 times\n\n");
}

TEST(ReportText, RacesHaveBothAccesses) {
  EXPECT_EQ(text_of(race_finding()),
            "a.comp:9: error: load of 4 bytes races [vitrine/race-shared]\n"
            "    9 | x = s[i ^ 1];\n"
            "  in function main\n"
            "  at invocation (2, 0, 0)\n"
            "a.comp:8: note: store of 4 bytes by invocation (3, 0, 0)\n"
            "    8 | s[i] = i;\n"
            "  in function main\n"
            "  missing: barrier(); between them\n\n");
}

TEST(ReportText, LeavesOutWhatIsUnknown) {
  EXPECT_EQ(text_of(bare_finding()), "vitrine: error: more than 1000 instructions [vitrine/endless-shader]\n\n");
}

TEST(ReportText, WhatShadersSayIsALine) {
  EXPECT_EQ(text_of(note_finding()), "a.comp:7: note: x = 3 [vitrine/printf]\n");
}

TEST(ReportText, TakesNoOrdersForTerminals) {
  Finding finding = note_finding();
  finding.message = "a\x1b[2Jb\nc";
  EXPECT_EQ(text_of(finding), "a.comp:7: note: a?[2Jb\n    c [vitrine/printf]\n");
}

TEST(ReportText, CutsLinesWithoutEnd) {
  Finding finding = bare_finding();
  finding.address.frames = {{"", "min.hlsl", 1, 900, std::string(150, 'a') + ' ' + std::string(5000, 'b')}};
  EXPECT_EQ(text_of(finding), "min.hlsl:1:900: error: more than 1000 instructions [vitrine/endless-shader]\n    1 | " +
                                  std::string(150, 'a') + " ...\n\n");
}

TEST(ReportText, MarksNoColumnThatALineDoesNotHave) {
  Finding finding = bare_finding();
  finding.address.frames = {{"", "a.comp", 2, 4000000000u, "x"}};
  EXPECT_EQ(text_of(finding).find('^'), std::string::npos);
}

}  // namespace
}  // namespace vitrine::glass
