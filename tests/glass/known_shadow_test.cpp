// What is known of whole ranges and images, and when it is asked again.
#include "glass/known_shadow.h"

#include <gtest/gtest.h>

#include <array>

namespace vitrine::glass {
namespace {

class KnownShadow : public ::testing::Test {
 protected:
  void SetUp() override {
    add_shadow(memory_.data(), memory_.size());
    region_ = find_shadow(memory_.data());
    ASSERT_NE(region_, nullptr);
  }
  void TearDown() override { remove_shadow(memory_.data()); }

  std::uintptr_t at(std::size_t byte) const { return reinterpret_cast<std::uintptr_t>(memory_.data()) + byte; }
  bool knows(std::size_t first, std::size_t bytes, const void* command = nullptr) const {
    return is_all_written(*region_, memory_.data() + first, bytes, command);
  }
  /// 8 x 4 texels of four bytes; rows are 64 bytes apart.
  texel::ImageView view(std::uint32_t layers = 1) {
    texel::ImageView view;
    view.base = memory_.data();
    view.format = &texel::format_desc(VK_FORMAT_R8G8B8A8_UNORM);
    view.layer_count = layers;
    view.layer_stride = 512;
    view.level[0].extent = {8, 4, 1};
    view.level[0].row_pitch = 64;
    return view;
  }

  alignas(64) std::array<std::byte, 4096> memory_{};
  ShadowRegion* region_ = nullptr;
};

TEST_F(KnownShadow, RangesAreKnownUntilSomethingIsGivenUp) {
  EXPECT_FALSE(knows(0, 256));
  region_->fill(at(0), 256, ByteState::kWritten);
  EXPECT_TRUE(knows(0, 256));
  EXPECT_FALSE(knows(0, 257)) << "one more";
  region_->fill(at(100), 1, ByteState::kDiscarded);
  EXPECT_FALSE(knows(0, 256));
  region_->mark(at(100), 1);
  EXPECT_TRUE(knows(0, 256));
  region_->states(at(0))[255] = static_cast<std::byte>(ByteState::kFresh);
  EXPECT_FALSE(knows(0, 256)) << "whoever copies states may have given something up";
}

TEST_F(KnownShadow, OneCommandAsksOnce) {
  const int command = 0, other = 0, third = 0;
  EXPECT_FALSE(knows(0, 64, &command));
  region_->fill(at(0), 64, ByteState::kWritten);
  EXPECT_FALSE(knows(0, 64, &command)) << "perhaps not";
  EXPECT_FALSE(knows(0, 64, &other)) << "not every command looks again";
  EXPECT_TRUE(knows(0, 64, &third));
  EXPECT_TRUE(knows(0, 64, &command));
}

TEST_F(KnownShadow, PaddingOfRowsIsNoTexel) {
  for (std::size_t row = 0; row < 4; ++row) region_->fill(at(64 * row), 32, ByteState::kWritten);
  EXPECT_TRUE(is_all_written(*region_, view(), nullptr));
  EXPECT_FALSE(is_all_written(*region_, view(2), nullptr));
  region_->fill(at(128), 4, ByteState::kDiscarded);
  EXPECT_FALSE(is_all_written(*region_, view(), nullptr));
}

TEST_F(KnownShadow, NothingIsKnownOfNewMemory) {
  region_->fill(at(0), 256, ByteState::kWritten);
  EXPECT_TRUE(knows(0, 256));
  remove_shadow(memory_.data());
  add_shadow(memory_.data(), memory_.size());
  region_ = find_shadow(memory_.data());
  EXPECT_FALSE(knows(0, 256)) << "at the same address";
}

}  // namespace
}  // namespace vitrine::glass
