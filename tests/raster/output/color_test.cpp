// Colour output: the fast functions against the general one bit by bit, and the general one against known values.
#include "raster/output/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "raster/output/blend.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kSide = 16;

/// A small target with its memory.
struct Target {
  texel::ImageLayout layout;
  std::vector<std::byte> memory;
  texel::ImageView view;

  explicit Target(VkFormat format) {
    texel::ImageDesc desc;
    desc.format = format;
    desc.extent = {kSide, kSide, 1};
    EXPECT_TRUE(texel::make_image_layout(desc, layout));
    memory.resize(layout.size + 64);
    texel::ImageViewDesc view_desc;
    view_desc.format = format;
    view = texel::make_image_view(layout, memory.data(), view_desc);
  }
};

struct Inputs {
  QuadPositions quads;
  base::LaneMask mask;
  base::WaveRegister color[4], second[4];
};

float random_value(std::mt19937& random) {
  switch (random() % 8) {
    case 0:
      return base::float_of(static_cast<std::uint32_t>(random()));
    case 1:
      return static_cast<float>(random() % 256) / 255.0f;
    case 2:
      return 0.0f;
    case 3:
      return 1.0f;
    default:
      return static_cast<float>(random() % 10000) / 8000.0f - 0.1f;
  }
}

Inputs random_inputs(std::mt19937& random) {
  Inputs in;
  for (std::size_t q = 0; q < base::kQuadsPerWave; ++q) {
    in.quads.x[q] = static_cast<std::uint16_t>(random() % (kSide / 2) * 2);
    in.quads.y[q] = static_cast<std::uint16_t>(random() % (kSide / 4) * 2);  // crowded: pixels repeat in a wave
  }
  in.mask = (std::uint64_t{random()} << 32 | random()) | (random() % 2 ? base::kAllLanes : 0);
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < base::kWaveWidth; ++i) {
      in.color[c].lane[i] = base::bits_of(random_value(random));
      in.second[c].lane[i] = base::bits_of(random_value(random));
    }
  }
  return in;
}

BlendAttachment random_blend(std::mt19937& random) {
  BlendAttachment blend;
  const unsigned factors = random() % 4 ? 15 : 19;  // the last four are dual-source ones
  blend.enable = random() % 4 != 0;
  blend.src_color = static_cast<VkBlendFactor>(random() % factors);
  blend.dst_color = static_cast<VkBlendFactor>(random() % factors);
  blend.src_alpha = static_cast<VkBlendFactor>(random() % factors);
  blend.dst_alpha = static_cast<VkBlendFactor>(random() % factors);
  blend.color_op = kBlendOps[random() % kBlendOps.size()];
  blend.alpha_op = kBlendOps[random() % kBlendOps.size()];
  blend.write_mask = random() % 3 ? 0xf : random() % 16;
  return blend;
}

std::uint32_t word_at(const std::vector<std::byte>& memory, std::ptrdiff_t index) {
  std::uint32_t word;
  std::memcpy(&word, memory.data() + 4 * index, sizeof(word));
  return word;
}

/// Replaces every NaN by one: which of two different ones a sum keeps is the compiler's choice.
void unify_nan(base::WaveRegister registers[4], float nan) {
  for (std::size_t c = 0; c < 4; ++c)
    for (std::uint32_t& bits : registers[c].lane)
      if (std::isnan(base::float_of(bits))) bits = base::bits_of(nan);
}

/// Random texels of floats of 16 or 32 bits, their NaN unified.
void randomize_floats(std::mt19937& random, std::size_t bits, std::uint16_t nan, std::vector<std::byte>& memory) {
  for (std::size_t i = 0; i + bits / 8 <= memory.size(); i += bits / 8) {
    float value = random_value(random);
    if (std::isnan(value)) value = base::half_to_float(nan);
    const std::uint16_t half =
        random() % 8 ? base::float_to_half_truncate(value) : static_cast<std::uint16_t>(random());
    const std::uint16_t stored = (half & 0x7fff) > 0x7c00 ? nan : half;
    if (bits == 16)
      std::memcpy(memory.data() + i, &stored, sizeof(stored));
    else
      std::memcpy(memory.data() + i, &value, sizeof(value));
  }
}

TEST(Color, FastFunctionsEqualTheGeneralOne) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  std::mt19937 random(7);
  std::size_t changed = 0;
  for (const VkFormat format :
       {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_A8B8G8R8_UNORM_PACK32, VK_FORMAT_B8G8R8A8_SRGB,
        VK_FORMAT_A8B8G8R8_SRGB_PACK32, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
        VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32_UINT,
        VK_FORMAT_R32G32B32A32_SINT}) {
    const texel::Channel& channel = texel::format_desc(format).channel[0];
    const bool is_float = channel.numeric == texel::Numeric::kSfloat;
    for (int n = 0; n < 400; ++n) {
      State state;
      const auto nan_half = static_cast<std::uint16_t>((random() & 0x8000) | 0x7c01 | random() % 0x400);
      const float nan = base::half_to_float(nan_half);
      for (float& constant : state.blend_constants) {
        constant = random_value(random);
        if (std::isnan(constant)) constant = nan;
      }
      const BlendAttachment blend = random_blend(random);
      const ColorWriter fast = make_color_writer(format, blend, state);
      const ColorWriter general = make_general_color_writer(format, blend, state);
      Inputs in = random_inputs(random);
      Target a(format), b(format);
      for (std::byte& byte : a.memory) byte = static_cast<std::byte>(random());
      if (is_float) {
        randomize_floats(random, channel.bits, nan_half, a.memory);
        unify_nan(in.color, nan);
        unify_nan(in.second, nan);
      }
      std::memcpy(b.memory.data(), a.memory.data(), a.memory.size());
      const std::vector<std::byte> before = a.memory;
      write_color(fast, {&a.view, 0, 0, &in.quads, in.mask, in.color, in.second});
      write_color(general, {&b.view, 0, 0, &in.quads, in.mask, in.color, in.second});
      const auto at = std::mismatch(a.memory.begin(), a.memory.end(), b.memory.begin()).first - a.memory.begin();
      ASSERT_TRUE(a.memory == b.memory) << "format " << format << " case " << n << " word " << at / 4 << ": "
                                        << std::hex << word_at(a.memory, at / 4) << " and " << word_at(b.memory, at / 4)
                                        << ", before " << word_at(before, at / 4);
      changed += a.memory != before;
    }
  }
  EXPECT_GT(changed, 3000u);
}

/// The reference's formula: within one of the rounded product, exact for 0 and 255.
TEST(Color, ByteProductsAreNearlyRounded) {
  for (std::uint32_t a = 0; a < 256; ++a) {
    for (std::uint32_t b = 0; b < 256; ++b) {
      EXPECT_NEAR(NormalizedBlend<8>::mul(a, b), (a * b * 2 + 255) / 510, 1) << a << " " << b;
    }
    EXPECT_EQ(NormalizedBlend<8>::mul(a, 255), a);
    EXPECT_EQ(NormalizedBlend<8>::mul(a, 0), 0u);
  }
  EXPECT_EQ(NormalizedBlend<8>::mul(253, 191), 189u);  // 189.5 is rounded down
}

TEST(Color, ComplementaryFactorsAreRecognisedBothWays) {
  using Lerp = BlendShape::Lerp;
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA), Lerp::kSource);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR, VK_BLEND_FACTOR_DST_COLOR), Lerp::kDestination);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO), Lerp::kSource);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE), Lerp::kDestination);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_SRC1_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA), Lerp::kSource);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA), Lerp::kNone);
  EXPECT_EQ(complementary(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE), Lerp::kNone);
}

/// Writes one colour to pixel (0, 0) and returns the stored word.
std::uint32_t store_one(VkFormat format, std::array<float, 4> color) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  Target target(format);
  Inputs in{};
  for (std::size_t c = 0; c < 4; ++c) in.color[c].lane[0] = base::bits_of(color[c]);
  write_color(make_color_writer(format, {}, {}), {&target.view, 0, 0, &in.quads, 1, in.color, nullptr});
  std::uint32_t word;
  std::memcpy(&word, target.view.block(0, 0, 0, 0, 0, 0), 4);
  return word;
}

TEST(Color, StoresRoundAsTheTablesSay) {
  EXPECT_EQ(store_one(VK_FORMAT_R8G8B8A8_UNORM, {0.1f, 0.3f, 0.5f, 0.7f}), 0xb2804c1au);
  EXPECT_EQ(store_one(VK_FORMAT_B8G8R8A8_UNORM, {0.1f, 0.3f, 0.5f, 0.7f}), 0xb21a4c80u);
  EXPECT_EQ(store_one(VK_FORMAT_R8G8B8A8_UNORM, {NAN, -1.0f, 2.0f, INFINITY}), 0xffff0000u);
  // A shader's 5 and 6 bits truncate the byte: 0.5 -> 0x80 -> 16, 32.
  EXPECT_EQ(store_one(VK_FORMAT_R5G6B5_UNORM_PACK16, {0.5f, 0.5f, 0.5f, 1.0f}) & 0xffff, 16u << 11 | 32u << 5 | 16u);
  EXPECT_EQ(store_one(VK_FORMAT_R16_SFLOAT, {0.7f, 0, 0, 0}) & 0xffff, 0x3999u);
}

TEST(Color, SignedNormalizedTargetsBlend) {
  Target target(VK_FORMAT_R8G8B8A8_SNORM);
  std::byte* pixel = target.view.block(0, 0, 0, 0, 0, 0);
  const std::int8_t before[4] = {127, -127, 64, 0};
  std::memcpy(pixel, before, 4);
  Inputs in{};
  const float color[4] = {-1.0f, 0.5f, 0.0f, 0.5f};
  for (std::size_t c = 0; c < 4; ++c) in.color[c].lane[0] = base::bits_of(color[c]);
  BlendAttachment blend;
  blend.enable = true;
  blend.src_color = blend.src_alpha = VK_BLEND_FACTOR_SRC_ALPHA;
  blend.dst_color = blend.dst_alpha = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  write_color(make_color_writer(VK_FORMAT_R8G8B8A8_SNORM, blend, {}),
              {&target.view, 0, 0, &in.quads, 1, in.color, nullptr});
  std::int8_t after[4];
  std::memcpy(after, pixel, 4);
  EXPECT_NEAR(after[0], 0, 1);
  EXPECT_NEAR(after[1], -32, 1);
  EXPECT_NEAR(after[2], 32, 1);
  EXPECT_NEAR(after[3], 32, 1);
}

}  // namespace
}  // namespace vitrine::raster
