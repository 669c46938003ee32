// Advanced blend operations against values worked out by hand, and the way of a colour through a writer.
#include "raster/output/advanced_blend.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/numeric.h"
#include "raster/output/color.h"

namespace vitrine::raster {
namespace {

using Rgba = std::array<float, 4>;

BlendAttachment with(VkBlendOp op, VkBlendOverlapEXT overlap = VK_BLEND_OVERLAP_UNCORRELATED_EXT) {
  BlendAttachment state;
  state.enable = true;
  state.color_op = state.alpha_op = op;
  state.overlap = overlap;
  return state;
}

TEST(AdvancedBlend, OverlapsWeighWhatIsCovered) {
  const Rgba src{0.25f, 0, 0, 0.5f}, dst{0, 0.75f, 0, 0.75f};
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_SRC_OVER_EXT), src, dst), (Rgba{0.25f, 0.375f, 0, 0.875f}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_SRC_OVER_EXT, VK_BLEND_OVERLAP_CONJOINT_EXT), src, dst),
            (Rgba{0.25f, 0.25f, 0, 0.75f}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_SRC_OVER_EXT, VK_BLEND_OVERLAP_DISJOINT_EXT), src, dst),
            (Rgba{0.25f, 0.5f, 0, 1}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_DST_OUT_EXT), src, dst), (Rgba{0, 0.375f, 0, 0.375f}));
}

TEST(AdvancedBlend, ColoursAreDividedByTheirAlpha) {
  BlendAttachment state = with(VK_BLEND_OP_MULTIPLY_EXT);
  const Rgba src{0.25f, 0.5f, 0, 0.5f}, dst{0.5f, 0.25f, 1, 1};
  EXPECT_EQ(blend_advanced(state, src, dst), (Rgba{0.375f, 0.25f, 0.5f, 1}));
  state.src_premultiplied = false;
  EXPECT_EQ(blend_advanced(state, src, dst), (Rgba{0.3125f, 0.1875f, 0.5f, 1}));
  state.src_premultiplied = true;
  state.dst_premultiplied = false;
  EXPECT_EQ(blend_advanced(state, src, {0.5f, 0.5f, 0.5f, 0}), (Rgba{0.5f, 1, 0, 0.5f})) << "given back as divided";
  EXPECT_EQ(blend_advanced(state, {}, {0.5f, 0.5f, 0.5f, 0}), Rgba{}) << "0 is not divided by";
}

TEST(AdvancedBlend, HueSaturationAndLuminosity) {
  const Rgba grey{0.5f, 0.5f, 0.5f, 1}, red{1, 0, 0, 1};
  const Rgba dark = blend_advanced(with(VK_BLEND_OP_HSL_LUMINOSITY_EXT), grey, red);
  EXPECT_NEAR(0.30f * dark[0] + 0.59f * dark[1] + 0.11f * dark[2], 0.5f, 1e-6f);
  EXPECT_NEAR(dark[0], 1.0f, 1e-6f) << "clipped";
  const Rgba still_grey = blend_advanced(with(VK_BLEND_OP_HSL_SATURATION_EXT), grey, red);
  EXPECT_NEAR(still_grey[0], 0.30f, 1e-6f);
  EXPECT_EQ(still_grey[0], still_grey[1]);
}

TEST(AdvancedBlend, AdditionalOperations) {
  const Rgba src{0.5f, 0.25f, 1, 0.75f}, dst{0.25f, 0.5f, 0.5f, 0.5f};
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_PLUS_EXT), src, dst), (Rgba{0.75f, 0.75f, 1.5f, 1.25f}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_PLUS_CLAMPED_EXT), src, dst), (Rgba{0.75f, 0.75f, 1, 1}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_MINUS_CLAMPED_EXT), src, dst), (Rgba{0, 0.25f, 0, 0}));
  EXPECT_EQ(blend_advanced(with(VK_BLEND_OP_GREEN_EXT), src, dst), (Rgba{0.25f, 0.25f, 0.5f, 0.5f}));
  BlendAttachment clamped = with(VK_BLEND_OP_PLUS_EXT);
  clamped.clamped = true;
  EXPECT_EQ(blend_advanced(clamped, src, dst), (Rgba{0.75f, 0.75f, 1, 1}));
}

/// One pixel of four bytes.
TEST(AdvancedBlend, FixedPointClampsBeforeItBlends) {
  texel::ImageDesc desc;
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.extent = {2, 2, 1};
  texel::ImageLayout layout;
  ASSERT_TRUE(texel::make_image_layout(desc, layout));
  std::vector<std::byte> memory(layout.size + 64, std::byte{128});
  memory[3] = std::byte{255};
  texel::ImageViewDesc view_desc;
  view_desc.format = desc.format;
  const texel::ImageView view = texel::make_image_view(layout, memory.data(), view_desc);
  State state;
  const ColorWriter writer = make_color_writer(desc.format, with(VK_BLEND_OP_MULTIPLY_EXT), state);
  base::WaveRegister color[4] = {};
  for (std::size_t c = 0; c < 4; ++c) color[c].lane[0] = base::bits_of(c == 1 ? 0.5f : 3.0f);
  QuadPositions quads{};
  write_color(writer, {&view, 0, 0, &quads, 1, color, nullptr});
  EXPECT_EQ(memory[0], std::byte{128});
  EXPECT_EQ(memory[1], std::byte{64});
  EXPECT_EQ(memory[3], std::byte{255});
}

}  // namespace
}  // namespace vitrine::raster
