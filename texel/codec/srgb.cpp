// sRGB curves of the reference, by tables and by a 12-bit reciprocal square root that is the same on every CPU.
#include "texel/codec/srgb.h"

#include <algorithm>
#include <bit>

#include "base/numeric.h"

namespace vitrine::texel {
namespace {

constexpr float decode_srgb(int code) {
  const float f = static_cast<float>(code);
  if (code <= 15) return f * (1.0f / (12.6f * 255.0f));
  constexpr float c0 = 0.0023f;
  constexpr float c1 = 0.0030f / 255.0f;
  constexpr float c2 = 0.6935f / (255.0f * 255.0f);
  constexpr float c3 = 0.3012f / (255.0f * 255.0f * 255.0f);
  const float square = f * f;
  return base::fma_exact(base::fma_exact(square, c3, c1), f, base::fma_exact(square, c2, c0));
}

/// v rounded to eight significant decimal digits.
constexpr float to_eight_digits(double v) {
  double scale = 1e7;
  while (v * scale < 1e7) scale *= 10;
  return static_cast<float>(static_cast<double>(static_cast<std::int64_t>(v * scale + 0.5)) / scale);
}

constexpr float decode_srgb_exact(int code) {
  const double v = code / 255.0;
  if (code == 0) return 0.0f;
  if (v <= 0.04045) return to_eight_digits(v / 12.92);
  const double y = (v + 0.055) / 1.055;
  double root = 1.0;  // fifth root of y^2 by Newton's iteration: y^2.4 = y^2 * y^0.4
  for (int i = 0; i < 60; ++i) root -= (root - y * y / (root * root * root * root)) / 5;
  return to_eight_digits(y * y * root);
}

/// round(8192 / sqrt(x)) or round(4096 / sqrt(x)), x the middle of interval i of [0.5, 1) and [1, 2): both have 13
/// significant bits. The middle is `odd` / 2^12 or / 2^11, odd = 2049 + 2 * (i mod 1024), so that everything is exact
/// in integers: k rounds correctly when (2k-1)^2 * x < (2 * scale)^2 <= (2k+1)^2 * x.
constexpr std::uint32_t rsqrt_significand(std::uint32_t index) {
  const std::uint64_t odd = 2049 + 2 * (index & 1023);
  const bool upper = index >= 1024;  // [1, 2): results in (0.70, 1], else (1, 1.41]
  const std::uint64_t scale = upper ? 8192 : 4096;
  const std::uint64_t target = 4 * scale * scale << (upper ? 11 : 12);
  std::uint64_t low = 4096, high = 8192;
  while (low < high) {
    const std::uint64_t middle = (low + high) / 2;
    const std::uint64_t edge = 2 * middle + 1;
    if (edge * edge * odd < target) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return static_cast<std::uint32_t>(low);
}

// Smallest binary32 pattern of each code from 1 on, without its 12 low bits, which are zero.
constexpr std::array<std::uint32_t, 255> kClearThresholds = {
    0x391ed, 0x39eed, 0x3a46f, 0x3a8b3, 0x3ab32, 0x3adae, 0x3b014, 0x3b153, 0x3b291, 0x3b3cf, 0x3b50d, 0x3b660, 0x3b7c4,
    0x3b89d, 0x3b963, 0x3ba31, 0x3bb09, 0x3bbed, 0x3bcdb, 0x3bdd4, 0x3bed6, 0x3bfe3, 0x3c07f, 0x3c10f, 0x3c1a7, 0x3c244,
    0x3c2e5, 0x3c38f, 0x3c43b, 0x3c4ee, 0x3c5a9, 0x3c668, 0x3c72e, 0x3c7f9, 0x3c866, 0x3c8d1, 0x3c941, 0x3c9b3, 0x3ca27,
    0x3caa0, 0x3cb1a, 0x3cb9a, 0x3cc1c, 0x3cca2, 0x3cd2a, 0x3cdb6, 0x3ce45, 0x3ced7, 0x3cf6e, 0x3d002, 0x3d052, 0x3d0a2,
    0x3d0f2, 0x3d147, 0x3d19d, 0x3d1f2, 0x3d24c, 0x3d2a7, 0x3d302, 0x3d362, 0x3d3c1, 0x3d423, 0x3d487, 0x3d4ec, 0x3d554,
    0x3d5bd, 0x3d628, 0x3d695, 0x3d703, 0x3d775, 0x3d7e7, 0x3d82e, 0x3d86a, 0x3d8a6, 0x3d8e2, 0x3d921, 0x3d961, 0x3d9a1,
    0x3d9e1, 0x3da23, 0x3da67, 0x3daab, 0x3daef, 0x3db36, 0x3db7d, 0x3dbc5, 0x3dc0d, 0x3dc59, 0x3dca4, 0x3dcef, 0x3dd3d,
    0x3dd8c, 0x3dddb, 0x3de2b, 0x3de7d, 0x3decf, 0x3df22, 0x3df78, 0x3dfcd, 0x3e011, 0x3e03e, 0x3e06b, 0x3e098, 0x3e0c5,
    0x3e0f2, 0x3e122, 0x3e152, 0x3e182, 0x3e1b2, 0x3e1e2, 0x3e213, 0x3e246, 0x3e279, 0x3e2ac, 0x3e2de, 0x3e313, 0x3e348,
    0x3e37e, 0x3e3b4, 0x3e3e9, 0x3e421, 0x3e459, 0x3e491, 0x3e4ca, 0x3e502, 0x3e53d, 0x3e578, 0x3e5b3, 0x3e5ee, 0x3e62b,
    0x3e668, 0x3e6a6, 0x3e6e3, 0x3e722, 0x3e762, 0x3e7a2, 0x3e7e2, 0x3e811, 0x3e833, 0x3e854, 0x3e876, 0x3e898, 0x3e8b9,
    0x3e8db, 0x3e8fd, 0x3e921, 0x3e945, 0x3e968, 0x3e98c, 0x3e9b0, 0x3e9d4, 0x3e9f8, 0x3ea1e, 0x3ea44, 0x3ea6b, 0x3ea91,
    0x3eab7, 0x3eadd, 0x3eb04, 0x3eb2c, 0x3eb54, 0x3eb7c, 0x3eba5, 0x3ebcd, 0x3ebf5, 0x3ec1f, 0x3ec49, 0x3ec73, 0x3ec9d,
    0x3ecc7, 0x3ecf2, 0x3ed1d, 0x3ed4a, 0x3ed76, 0x3eda2, 0x3edce, 0x3edfa, 0x3ee28, 0x3ee56, 0x3ee84, 0x3eeb2, 0x3eee0,
    0x3ef0f, 0x3ef3f, 0x3ef6f, 0x3ef9f, 0x3efcf, 0x3effe, 0x3f017, 0x3f031, 0x3f04a, 0x3f063, 0x3f07c, 0x3f096, 0x3f0af,
    0x3f0c8, 0x3f0e1, 0x3f0fb, 0x3f116, 0x3f130, 0x3f14b, 0x3f166, 0x3f181, 0x3f19c, 0x3f1b7, 0x3f1d2, 0x3f1ed, 0x3f209,
    0x3f225, 0x3f242, 0x3f25e, 0x3f27b, 0x3f298, 0x3f2b4, 0x3f2d1, 0x3f2ed, 0x3f30b, 0x3f329, 0x3f347, 0x3f365, 0x3f383,
    0x3f3a1, 0x3f3bf, 0x3f3de, 0x3f3fc, 0x3f41b, 0x3f43b, 0x3f45a, 0x3f47a, 0x3f49a, 0x3f4b9, 0x3f4d9, 0x3f4f9, 0x3f519,
    0x3f53a, 0x3f55b, 0x3f57d, 0x3f59e, 0x3f5bf, 0x3f5e0, 0x3f601, 0x3f624, 0x3f646, 0x3f669, 0x3f68b, 0x3f6ae, 0x3f6d0,
    0x3f6f3, 0x3f716, 0x3f73a, 0x3f75e, 0x3f782, 0x3f7a6, 0x3f7c9, 0x3f7ed,
};

}  // namespace

constinit const std::array<float, 256> kSrgbToLinear = [] {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[static_cast<std::size_t>(i)] = decode_srgb(i);
  return table;
}();

constinit const std::array<float, 256> kSrgbToLinearExact = [] {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[static_cast<std::size_t>(i)] = decode_srgb_exact(i);
  return table;
}();

constinit const std::array<std::uint16_t, 2048> kRsqrtTable = [] {
  std::array<std::uint16_t, 2048> table{};
  for (std::uint32_t i = 0; i < 2048; ++i) table[i] = static_cast<std::uint16_t>(rsqrt_significand(i) - 4096);
  return table;
}();

std::uint8_t encode_srgb_clear(float linear) {
  if (!(linear > 0.0f)) return 0;
  const std::uint32_t key = std::min(base::bits_of(linear), base::bits_of(1.0f)) >> 12;
  const auto* above = std::upper_bound(kClearThresholds.begin(), kClearThresholds.end(), key);
  return static_cast<std::uint8_t>(above - kClearThresholds.begin());
}

float approximate_rsqrt(float value) {
  const std::uint32_t bits = base::bits_of(value);
  if (bits < 0x00800000u) return base::float_of(0x7f800000u);
  if (bits >= 0x7f800000u) return bits == 0x7f800000u ? 0.0f : value;
  // value = m * 4^k with m in [0.5, 2): the result is table(m) * 2^-k.
  const std::uint32_t exponent = bits >> 23;
  const std::uint32_t upper = exponent & 1;  // biased 127, 129... : m in [1, 2)
  const std::uint32_t significand = kRsqrtTable[upper << 10 | ((bits >> 13) & 1023)];
  const std::int32_t k = (static_cast<std::int32_t>(exponent) - 126 - static_cast<std::int32_t>(upper)) / 2;
  const std::uint32_t start = (upper != 0 ? 126u : 127u) << 23;  // 0.5 or 1.0
  return base::float_of(start + (significand << 11) - (static_cast<std::uint32_t>(k) << 23));
}

std::uint8_t encode_srgb_attachment(float linear) {
  const float x = base::min_second(base::max_second(linear, 0.0f), 1.0f);
  if (!(x > 0.0031308f)) return static_cast<std::uint8_t>(base::round_to_int(x * (12.92f * 255.0f)));
  constexpr float a = static_cast<float>(0.675f * 1.0622 * 255.0f);
  constexpr float b = static_cast<float>(0.325f * 1.0622 * 255.0f);
  constexpr float c = -0.0620f * 255.0f;
  const float t = approximate_rsqrt(x);
  const float x05 = x * t;
  const float x0375 = approximate_rsqrt(approximate_rsqrt(x05 * x));
  const float code = a * x0375 + base::fma_exact(b, x05, c);
  return static_cast<std::uint8_t>(std::clamp(base::round_to_int(code), 0, 255));
}

}  // namespace vitrine::texel
