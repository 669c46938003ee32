// AmberScript: what it says of a dispatch, and what it has no words for.
#include "glass/bug/amber.h"

#include <gtest/gtest.h>

#include "tests/glass/bug/bugs.h"

namespace vitrine::glass::bug {
namespace {

TEST(Amber, SaysADispatchWithItsData) {
  const base::Result<std::string> script = to_amber(small_bug());
  ASSERT_TRUE(script.ok()) << script.message();
  EXPECT_TRUE(script.value().starts_with("#!amber\n"));
  for (const char* const part :
       {"SHADER compute shader0 SPIRV-HEX\n03 02 23 07 00 03 01 00 00 00 00 00 01 00 00 00 00 00 00 00END\n",
        "# particles\nBUFFER buffer0 DATA_TYPE uint32 STD430 DATA\n"
        "0x00000000 0x00000000 0x00000000 0x00000000 0x00000001 0x00000002 0x00000003 0x00000004\n",
        "ATTACH shader0 TYPE compute ENTRY_POINT main SPECIALIZE 3 AS uint32 5\n",
        "BIND BUFFER buffer0 AS storage DESCRIPTOR_SET 0 BINDING 0 DESCRIPTOR_OFFSET 0 DESCRIPTOR_RANGE 64\n",
        "BIND BUFFER pushed AS push_constant\n", "RUN pipeline 4 2 1\n", "EXPECT buffer0 EQ_BUFFER expected0\n"})
    EXPECT_NE(script.value().find(part), std::string::npos) << part << script.value();
}

TEST(Amber, HasNoWordsForDraws) {
  Bug bug = small_bug();
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  EXPECT_EQ(to_amber(bug).message(), "AmberScript is not written for draws");
}

TEST(Amber, ContentsAreThoseOfTheBuffer) {
  const Bug bug = small_bug();
  const Bytes before = contents_of(bug, bug.buffers[0], false), after = contents_of(bug, bug.buffers[0], true);
  ASSERT_EQ(before.size(), 64u);
  EXPECT_EQ(before[16], std::byte{1});
  EXPECT_EQ(before[28], std::byte{4});
  EXPECT_EQ(after[28], std::byte{5});
  EXPECT_EQ(after[63], std::byte{0});
}

}  // namespace
}  // namespace vitrine::glass::bug
