// Codecs: vectors of stored bits and values per format, the reference's clear table, and round trips.
#include "texel/codec.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "base/numeric.h"
#include "tests/simd_targets.h"
#include "texel/capabilities.h"
#include "texel/codec/srgb.h"

namespace vitrine::texel {
namespace {

using base::bits_of;

std::uint64_t encoded(VkFormat format, Encoding encoding, float r, float g, float b, float a) {
  std::uint64_t words[2] = {};
  encode_texel(format_desc(format), encoding, {bits_of(r), bits_of(g), bits_of(b), bits_of(a)},
               reinterpret_cast<std::byte*>(words));
  return words[0];
}

Texel decoded(VkFormat format, std::uint64_t low, std::uint64_t high = 0) {
  const std::uint64_t words[2] = {low, high};
  Texel out{};
  decode_row(format_desc(format), reinterpret_cast<const std::byte*>(words), 1, &out);
  return out;
}

void expect_floats(VkFormat format, std::uint64_t stored, float r, float g, float b, float a) {
  EXPECT_EQ(decoded(format, stored), (Texel{bits_of(r), bits_of(g), bits_of(b), bits_of(a)}))
      << format_desc(format).name;
}

TEST(Decode, Vectors) {
  expect_floats(VK_FORMAT_R8_UNORM, 0xFF, 1, 0, 0, 1);
  expect_floats(VK_FORMAT_B8G8R8A8_UNORM, 0x00FF0000, 1, 0, 0, 0);
  expect_floats(VK_FORMAT_R8G8B8A8_SNORM, 0x7F80817F, 1, -1, -1, 1);
  expect_floats(VK_FORMAT_R5G6B5_UNORM_PACK16, 0xF800, 1, 0, 0, 1);
  expect_floats(VK_FORMAT_B4G4R4A4_UNORM_PACK16, 0xF00F, 0, 0, 1, 1);
  expect_floats(VK_FORMAT_A1R5G5B5_UNORM_PACK16, 0x801F, 0, 0, 1, 1);
  expect_floats(VK_FORMAT_A2B10G10R10_UNORM_PACK32, 0xC00003FF, 1, 0, 0, 1);
  expect_floats(VK_FORMAT_R16G16B16A16_SFLOAT, 0x3C00'7BFF'0001'C000, -2, 0x1p-24f, 65504, 1);
  expect_floats(VK_FORMAT_B10G11R11_UFLOAT_PACK32, 0x3C0 | 1u << 11 | 0x3DFu << 22, 1, 0x1p-20f, 64512, 1);
  expect_floats(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, 16u << 27 | 256 | 511u << 18, 1, 0, 511 / 256.0f, 1);
  expect_floats(VK_FORMAT_X8_D24_UNORM_PACK32, 0xABFFFFFF, 1, 0, 0, 1);
  expect_floats(VK_FORMAT_R8G8B8A8_SRGB, 0xFF0000FF, kSrgbToLinear[255], 0, 0, 1);
  expect_floats(VK_FORMAT_R8G8_USCALED, 0xFF07, 7, 255, 0, 1);
  expect_floats(VK_FORMAT_R8G8_SSCALED, 0xFF07, 7, -1, 0, 1);
  EXPECT_EQ(decoded(VK_FORMAT_R8_SINT, 0x80), (Texel{0xFFFFFF80u, 0, 0, 1}));
  EXPECT_EQ(decoded(VK_FORMAT_A2B10G10R10_UINT_PACK32, 0xBFF003FF), (Texel{1023, 0, 1023, 2}));
  EXPECT_EQ(decoded(VK_FORMAT_R32G32B32A32_UINT, 0x2'00000001, 0x4'00000003), (Texel{1, 2, 3, 4}));
}

// lavapipe-rasterization.md 11.5.
TEST(Encode, ClearTable) {
  const float values[9] = {0.1f, 0.3f, 0.5f, 0.7f, -0.3f, 1.5f, 0.00196f, 0.501961f, 0.998047f};
  const struct {
    VkFormat format;
    std::uint64_t expected[9];
  } rows[] = {
      {VK_FORMAT_R8_UNORM, {0x1a, 0x4c, 0x80, 0xb2, 0, 0xff, 0, 0x80, 0xff}},
      {VK_FORMAT_R8_SNORM, {0x0d, 0x26, 0x40, 0x59, 0xda, 0x7f, 0, 0x40, 0x7f}},
      {VK_FORMAT_R8_SRGB, {0x59, 0x95, 0xbc, 0xda, 0, 0xff, 0x06, 0xbc, 0xff}},
      {VK_FORMAT_R5G6B5_UNORM_PACK16, {0x18c3, 0x4a69, 0x8410, 0xb596, 0, 0xffff, 0, 0x8410, 0xffff}},
      {VK_FORMAT_A2B10G10R10_UNORM_PACK32,
       {0x06619866, 0x5334cd33, 0xa0080200, 0xaccb32cc, 0, 0xffffffff, 0x00200802, 0xa0280a02, 0xffdff7fd}},
      {VK_FORMAT_B10G11R11_UFLOAT_PACK32,
       {0x5cd732e6, 0x699a634c, 0x701c0380, 0x731ccb99, 0, 0x7c1f03e0, 0x300c0180, 0x701c0380, 0x77ddfbbf}},
      {VK_FORMAT_R16_SFLOAT, {0x2e66, 0x34cc, 0x3800, 0x3999, 0xb4cc, 0x3e00, 0x1803, 0x3804, 0x3bfc}},
      {VK_FORMAT_R16_UNORM, {0x199a, 0x4ccd, 0x8000, 0xb333, 0, 0xffff, 0x0080, 0x8080, 0xff7f}},
  };
  for (const auto& row : rows) {
    for (int i = 0; i < 9; ++i) {
      const float c = values[i];
      EXPECT_EQ(encoded(row.format, Encoding::kClear, c, c, c, c), row.expected[i])
          << format_desc(row.format).name << " " << c;
    }
  }
}

TEST(Decode, FormatsThatTheReferenceLacks) {
  expect_floats(VK_FORMAT_R8_SRGB, 0x80, kSrgbToLinear[128], 0, 0, 1);
  expect_floats(VK_FORMAT_R8G8_SRGB, 0xFF01, kSrgbToLinear[1], kSrgbToLinear[255], 0, 1);
  expect_floats(VK_FORMAT_R4G4B4A4_UNORM_PACK16, 0xF00F, 1, 0, 0, 1);
#ifdef VK_VERSION_1_4
  expect_floats(VK_FORMAT_A8_UNORM, 0xFF, 0, 0, 0, 1);
  EXPECT_EQ(decoded(VK_FORMAT_A8_UNORM, 0x33), (Texel{0, 0, 0, decoded(VK_FORMAT_R8_UNORM, 0x33)[0]}));
  expect_floats(VK_FORMAT_A1B5G5R5_UNORM_PACK16, 0x801F, 1, 0, 0, 1);
  expect_floats(VK_FORMAT_A1B5G5R5_UNORM_PACK16, 0x7C00, 0, 0, 1, 0);
#endif
  EXPECT_EQ(decoded(VK_FORMAT_A2R10G10B10_SINT_PACK32, 0x9FF80201),
            (Texel{0x1FF, static_cast<std::uint32_t>(-512), static_cast<std::uint32_t>(-511),
                   static_cast<std::uint32_t>(-2)}));
  EXPECT_EQ(decoded(VK_FORMAT_A2B10G10R10_SINT_PACK32, 0x9FF80201),
            (Texel{static_cast<std::uint32_t>(-511), static_cast<std::uint32_t>(-512), 0x1FF,
                   static_cast<std::uint32_t>(-2)}));
}

/// A component of an sRGB storage image is encoded as one of an attachment is.
TEST(Encode, StoredSrgbIsWhatAttachmentsGet) {
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_A8B8G8R8_SRGB_PACK32}) {
    for (int i = -40; i < 1100; ++i) {
      const float x = static_cast<float>(i) * 0.001f;
      EXPECT_EQ(encoded(format, Encoding::kStore, x, 1 - x, x * x, x),
                encoded(format, Encoding::kAttachment, x, 1 - x, x * x, x));
    }
  }
}

TEST(Encode, NanAndLimitsByWriter) {
  const float nan = base::float_of(0x7fc00000u);
  EXPECT_EQ(encoded(VK_FORMAT_R8_UNORM, Encoding::kStore, nan, 0, 0, 0), 0xFFu);
  EXPECT_EQ(encoded(VK_FORMAT_R8_UNORM, Encoding::kAttachment, nan, 0, 0, 0), 0u);
  EXPECT_EQ(encoded(VK_FORMAT_R8_UNORM, Encoding::kClear, nan, 0, 0, 0), 0u);
  EXPECT_EQ(encoded(VK_FORMAT_R8_SNORM, Encoding::kAttachment, -2, 0, 0, 0), 0x80u);
  EXPECT_EQ(encoded(VK_FORMAT_R8_SNORM, Encoding::kStore, -2, 0, 0, 0), 0x81u);
  EXPECT_EQ(encoded(VK_FORMAT_R5G6B5_UNORM_PACK16, Encoding::kAttachment, 0.5f, 0.5f, 0.5f, 0), 0x8410u);
  EXPECT_EQ(encoded(VK_FORMAT_R16_SFLOAT, Encoding::kAttachment, 1e9f, 0, 0, 0), 0x7BFFu);
  EXPECT_EQ(encoded(VK_FORMAT_D16_UNORM, Encoding::kClear, 0.5f, 0, 0, 0), 0x8000u);
  EXPECT_EQ(encoded(VK_FORMAT_X8_D24_UNORM_PACK32, Encoding::kAttachment, 1, 0, 0, 0), 0xFFFFFFu);
}

/// Every stored value of every small format: encode(decode(v)) == v, for all writers that round to nearest.
TEST(Codec, RoundTripsOfUpTo16Bits) {
  for (int value = 1; value < 184; ++value) {
    const FormatDesc& format = format_desc(static_cast<VkFormat>(value));
    if (!can_encode(format) || format.block_bytes > 2) continue;
    const std::uint32_t count = 1u << (8 * format.block_bytes);
    std::uint32_t wrong = 0;
    for (std::uint32_t stored = 0; stored < count; ++stored) {
      Texel texel{};
      decode_row(format, reinterpret_cast<const std::byte*>(&stored), 1, &texel);
      for (const auto encoding : {Encoding::kClear, Encoding::kStore}) {
        if (encoding == Encoding::kStore && !can_store(format)) continue;
        std::uint32_t again = 0;
        encode_texel(format, encoding, texel, reinterpret_cast<std::byte*>(&again));
        Texel second{};
        decode_row(format, reinterpret_cast<const std::byte*>(&again), 1, &second);
        wrong += second != texel && base::float_of(texel[0]) == base::float_of(texel[0]);
      }
    }
    // Exceptions: none for formats whose codes are evenly spaced; sRGB's two curves of the reference are not inverse.
    EXPECT_TRUE(wrong == 0 || format.is_srgb()) << format.name << " " << wrong;
  }
}

/// NaN may differ in what says nothing: which one it is.
bool same_texels(const FormatDesc& format, const Texel& a, const Texel& b) {
  for (std::size_t c = 0; c < 4; ++c) {
    const float x = base::float_of(a[c]), y = base::float_of(b[c]);
    if (a[c] != b[c] && (format.is_integer() || x == x || y == y)) return false;
  }
  return true;
}

void compare_rows(const FormatDesc& desc) {
  std::mt19937 random(3);
  constexpr std::uint32_t kSpecial[] = {0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345, 0x80000000, 0x477ff000,
                                        0x33800000, 0x337fffff, 0x387fffff, 0x38800000, 0x00000001, 0x3f800001};
  constexpr std::size_t kCount = 1021;
  std::vector<std::byte> stored(kCount * desc.block_bytes), blocks(stored.size()), block(desc.block_bytes);
  for (std::byte& b : stored) b = static_cast<std::byte>(random());
  std::vector<Texel> texels(kCount);
  decode_row(desc, stored.data(), kCount, texels.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    Texel texel;
    texel_decoder(desc)(desc, stored.data() + i * desc.block_bytes, texel);
    EXPECT_TRUE(same_texels(desc, texel, texels[i])) << desc.name;
    for (std::uint32_t& c : texels[i]) {
      c = random() % 8 == 0 ? kSpecial[random() % std::size(kSpecial)]
          : random() % 2    ? bits_of(static_cast<float>(random() % 512) / 510.0f)
                            : static_cast<std::uint32_t>(random());
    }
  }
  if (!can_encode(desc)) return;
  for (const Encoding encoding : {Encoding::kStore, Encoding::kClear, Encoding::kAttachment}) {
    encode_row(desc, encoding, texels.data(), kCount, blocks.data());
    for (std::size_t i = 0; i < kCount; ++i) {
      texel_encoder(desc, encoding)(desc, texels[i], block.data());
      EXPECT_EQ(0, std::memcmp(block.data(), blocks.data() + i * desc.block_bytes, desc.block_bytes))
          << desc.name << " encoding " << static_cast<int>(encoding);
    }
  }
}

TEST(Rows, EqualTexelsOneByOne) {
  base::for_each_simd_target([] {
    for (std::uint32_t i = 1; i <= VK_FORMAT_D24_UNORM_S8_UINT && !testing::Test::HasFailure(); ++i) {
      const FormatDesc& desc = format_desc(static_cast<VkFormat>(i));
      if (can_decode(desc)) compare_rows(desc);
    }
  });
}

TEST(Rsqrt, KnownValues) {
  EXPECT_EQ(bits_of(approximate_rsqrt(1.0f)), 0x3f7ff800u);
  EXPECT_EQ(bits_of(approximate_rsqrt(0.5f)), 0x3fb50000u);
  EXPECT_EQ(bits_of(approximate_rsqrt(4.0f)), 0x3efff800u);
  EXPECT_EQ(bits_of(approximate_rsqrt(0.0f)), 0x7f800000u);
}

// The hash is that of RSQRTPS itself on an AMD processor with AVX-512, in order of the operands.
TEST(Rsqrt, EqualsTheInstructionOfTheRecordedCpu) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  std::uint32_t outside = 0;
  for (std::uint32_t bits = 0x3f000000u; bits < 0x40000000u; bits += 2048) {
    const std::uint32_t result = bits_of(approximate_rsqrt(base::float_of(bits)));
    hash = (hash ^ result) * 0x100000001b3u;
    outside += result != bits_of(approximate_rsqrt(base::float_of(bits | 2047)));
    outside += result - 0x00800000u != bits_of(approximate_rsqrt(base::float_of(bits + 0x01000000u)));
  }
  EXPECT_EQ(hash, 0x5f8d15e90b98a325u);
  EXPECT_EQ(outside, 0u);
}

}  // namespace
}  // namespace vitrine::texel
