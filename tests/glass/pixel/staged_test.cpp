// Bytes of buffers lead back to the texels that were copied there.
#include "glass/pixel/staged.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace vitrine::glass::pixel::test {
namespace {

class StagedTest : public testing::Test {
 protected:
  StagedTest() {
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7);
  }
  StagedTexel texel_at(std::uint32_t x, std::uint32_t y, std::uint32_t command) const {
    StagedTexel texel{{}, &format, 1, command, "vkCmdCopyImageToBuffer"};
    texel.texel.image = 3;
    texel.texel.x = x;
    texel.texel.y = y;
    return texel;
  }

  const texel::FormatDesc& format = texel::format_desc(VK_FORMAT_R8G8B8A8_UNORM);
  std::array<std::byte, 512> bytes{};
  Staged staged;
};

TEST_F(StagedTest, FindsTheTexelOfARow) {
  staged.add(bytes.data() + 16, 64, texel_at(8, 2, 5), 1);
  const auto found = staged.find(bytes.data() + 28, 4);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->texel.x, 11u);
  EXPECT_EQ(found->texel.y, 2u);
  EXPECT_EQ(found->command, 5u);
  for (const std::size_t outside : {12, 14, 80, 30}) EXPECT_FALSE(staged.find(bytes.data() + outside, 4)) << outside;
}

TEST_F(StagedTest, KnowsWhatIsStillThere) {
  staged.add(bytes.data(), 64, texel_at(0, 0, 5), 1);
  bytes[9] = std::byte{255};
  EXPECT_FALSE(staged.find(bytes.data() + 8, 4));
  EXPECT_TRUE(staged.find(bytes.data() + 12, 4));
  staged.add(bytes.data() + 8, 8, texel_at(40, 1, 6), 1);
  EXPECT_EQ(staged.find(bytes.data() + 12, 4)->texel.x, 41u);
}

TEST_F(StagedTest, FollowsCopiesOfWholeBlocks) {
  staged.add(bytes.data(), 64, texel_at(0, 0, 5), 1);
  std::memcpy(bytes.data() + 256, bytes.data() + 6, 40);
  staged.copied(bytes.data() + 6, bytes.data() + 256, 40);
  // Bytes 8 to 43 of the row lie at 258.
  EXPECT_EQ(staged.find(bytes.data() + 258, 4)->texel.x, 2u);
  EXPECT_EQ(staged.find(bytes.data() + 290, 4)->texel.x, 10u);
  EXPECT_FALSE(staged.find(bytes.data() + 254, 4));
  EXPECT_FALSE(staged.find(bytes.data() + 294, 4));
}

TEST_F(StagedTest, CountsTexelsOfBlocks) {
  const texel::FormatDesc& blocks = texel::format_desc(VK_FORMAT_BC1_RGBA_UNORM_BLOCK);
  StagedTexel first = texel_at(4, 8, 5);
  first.format = &blocks;
  staged.add(bytes.data(), 32, first, 4);
  EXPECT_EQ(staged.find(bytes.data() + 16, 8)->texel.x, 12u);
}

}  // namespace
}  // namespace vitrine::glass::pixel::test
