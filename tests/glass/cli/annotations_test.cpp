// Findings for the runners of a code host.
#include "glass/cli/annotations.h"

#include <gtest/gtest.h>

#include "tests/glass/report/findings.h"

namespace vitrine::glass::cli {
namespace {

TEST(Annotations, HavePlaceRuleAndMessage) {
  EXPECT_EQ(
      annotations({whole_finding()}),
      "::error file=shaders/blur.comp,line=12,col=3,title=vitrine/out-of-bounds-store::store of 4 bytes at offset 4096 "
      "of storage buffer 'particles' (4096 bytes)%0Aat submission 1, command 3 (vkCmdDispatch) in 'frame' > 'blur', "
      "pipeline 'gauss', compute shader main, invocation (5, 0, 0); 128 times\n");
  EXPECT_EQ(annotations({bare_finding(), note_finding()}),
            "::error title=vitrine/endless-shader::more than 1000 instructions\n"
            "::notice file=a.comp,line=7,title=vitrine/printf::x = 3\n");
}

TEST(Annotations, RacesNameTheOtherAccessAndTheBarrier) {
  EXPECT_EQ(annotations({race_finding()}),
            "::error file=a.comp,line=9,title=vitrine/race-shared::load of 4 bytes races%0Aat invocation (2, 0, "
            "0)%0Astore of 4 bytes at a.comp:8%0Amissing: barrier(); between them\n");
}

TEST(Annotations, NobodyElsesCommandGetsIn) {
  Finding finding = note_finding();
  finding.address.frames[0].file = "a:b,c\n::error::d.comp";
  finding.message = "100%\r\n::error::no";
  EXPECT_EQ(annotations({finding}),
            "::notice file=a%3Ab%2Cc%0A%3A%3Aerror%3A%3Ad.comp,line=7,title=vitrine/printf::100%25%0D%0A::error::no\n");
}

}  // namespace
}  // namespace vitrine::glass::cli
