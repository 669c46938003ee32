// sRGB curves of the reference, by tables and by the 12-bit reciprocal square root of one kind of CPU.
#include "texel/codec/srgb.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "base/numeric.h"

#ifdef __SSE__
#include <immintrin.h>
#endif

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
  const auto digits = static_cast<std::int64_t>(v * scale + 0.5);  // NOLINT(bugprone-incorrect-roundings): v >= 0
  return static_cast<float>(static_cast<double>(digits) / scale);
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

// RSQRTPS of AMD's AVX-512 processors (family 25, model 17; all 2^24 operands of two binades measured): a bipartite
// table. A block is 2^-8 of a binade, the first half for operands in [0.5, 1), the second for [1, 2): the result at its
// start, less 4096, in units of 2^-12 (first half) or 2^-13 (second).
constexpr std::array<std::uint16_t, 512> kRsqrtBlocks = {
    1696, 1685, 1674, 1662, 1651, 1641, 1630, 1619, 1608, 1597, 1587, 1576, 1565, 1555, 1544, 1534, 1523, 1513, 1503,
    1492, 1482, 1472, 1462, 1452, 1442, 1433, 1423, 1413, 1403, 1394, 1384, 1375, 1365, 1355, 1346, 1337, 1327, 1318,
    1309, 1300, 1291, 1282, 1273, 1264, 1255, 1246, 1237, 1228, 1219, 1211, 1202, 1193, 1185, 1176, 1168, 1159, 1151,
    1143, 1134, 1126, 1118, 1109, 1101, 1093, 1085, 1077, 1069, 1061, 1053, 1045, 1037, 1029, 1021, 1013, 1006, 998,
    990,  983,  975,  968,  960,  953,  945,  938,  930,  923,  916,  908,  901,  894,  887,  879,  872,  865,  858,
    851,  844,  837,  830,  823,  816,  809,  802,  795,  789,  782,  775,  768,  762,  755,  748,  742,  735,  729,
    722,  716,  709,  703,  696,  690,  684,  677,  671,  665,  658,  652,  646,  640,  633,  627,  621,  615,  609,
    603,  597,  591,  585,  579,  573,  567,  561,  555,  549,  544,  538,  532,  526,  521,  515,  509,  503,  498,
    492,  487,  481,  475,  470,  464,  459,  453,  448,  443,  437,  432,  426,  421,  416,  410,  405,  400,  394,
    389,  384,  379,  374,  368,  363,  358,  353,  348,  343,  338,  333,  328,  323,  318,  313,  308,  303,  298,
    293,  288,  282,  278,  273,  268,  263,  258,  253,  249,  244,  239,  234,  230,  225,  220,  216,  211,  206,
    202,  197,  193,  188,  183,  179,  174,  170,  165,  161,  156,  152,  147,  143,  139,  134,  130,  125,  121,
    117,  112,  108,  104,  99,   95,   91,   87,   82,   78,   74,   70,   65,   61,   57,   53,   49,   45,   41,
    36,   32,   28,   24,   20,   16,   12,   8,    4,    4095, 4079, 4063, 4048, 4032, 4016, 4001, 3986, 3970, 3955,
    3940, 3925, 3910, 3895, 3880, 3866, 3851, 3836, 3822, 3807, 3793, 3779, 3765, 3751, 3737, 3723, 3709, 3695, 3681,
    3668, 3654, 3641, 3627, 3614, 3600, 3587, 3574, 3561, 3548, 3535, 3522, 3509, 3497, 3484, 3471, 3459, 3446, 3434,
    3421, 3409, 3396, 3384, 3372, 3360, 3348, 3336, 3324, 3312, 3301, 3289, 3277, 3266, 3254, 3243, 3230, 3219, 3208,
    3196, 3185, 3174, 3163, 3152, 3141, 3130, 3119, 3108, 3097, 3086, 3076, 3065, 3054, 3044, 3033, 3023, 3012, 3002,
    2991, 2981, 2971, 2961, 2950, 2940, 2930, 2920, 2910, 2900, 2890, 2880, 2870, 2860, 2850, 2841, 2831, 2821, 2812,
    2802, 2793, 2783, 2774, 2764, 2755, 2746, 2736, 2727, 2718, 2708, 2699, 2690, 2681, 2672, 2663, 2654, 2645, 2636,
    2627, 2619, 2610, 2601, 2593, 2584, 2575, 2567, 2558, 2550, 2541, 2533, 2524, 2516, 2507, 2499, 2491, 2482, 2474,
    2466, 2457, 2449, 2441, 2433, 2425, 2417, 2409, 2401, 2393, 2385, 2377, 2369, 2361, 2354, 2346, 2338, 2330, 2322,
    2315, 2307, 2299, 2292, 2284, 2277, 2269, 2262, 2254, 2247, 2239, 2232, 2225, 2217, 2210, 2203, 2196, 2189, 2181,
    2174, 2167, 2160, 2153, 2146, 2139, 2132, 2125, 2118, 2111, 2104, 2096, 2089, 2082, 2076, 2069, 2062, 2055, 2048,
    2042, 2035, 2028, 2022, 2015, 2008, 2002, 1995, 1989, 1982, 1976, 1969, 1963, 1956, 1950, 1943, 1937, 1931, 1924,
    1918, 1912, 1905, 1899, 1893, 1886, 1880, 1874, 1868, 1862, 1856, 1850, 1843, 1837, 1831, 1825, 1819, 1813, 1807,
    1801, 1795, 1789, 1783, 1777, 1771, 1765, 1760, 1754, 1748, 1742, 1736, 1731, 1725, 1719, 1713, 1708, 1702,
};

// What the 16 parts of a block subtract from that, four bits each from the lowest, for every 16 blocks.
constexpr std::array<std::uint64_t, 32> kRsqrtSlopes = {
    0xa998776554332110, 0x9987765543322100, 0x8877665443322100, 0x8776655443322100, 0x7766554433221100,
    0x7666554433221110, 0x6655544332221100, 0x6655444332221100, 0x5554433322211000, 0x5544433322211100,
    0x5544433322211100, 0x5544443332221110, 0x4443332222111000, 0x4443332222111000, 0x4433332222111100,
    0x4433332222111100, 0xedcba98776543210, 0xdcbaa98765433210, 0xcbba987665432210, 0xbaa9877654432210,
    0xa998776554322100, 0xa988766554332110, 0x9887665443322100, 0x8876655443221100, 0x8776655443322110,
    0x7766554433221100, 0x7665544333221100, 0x7666554433222110, 0x6655443332211100, 0x6555444332221100,
    0x6555443332211100, 0x5544433322111000,
};

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

std::uint8_t encode_srgb_clear(float linear) {
  if (!(linear > 0.0f)) return 0;
  const std::uint32_t key = std::min(base::bits_of(linear), base::bits_of(1.0f)) >> 12;
  const auto* above = std::upper_bound(kClearThresholds.begin(), kClearThresholds.end(), key);
  return static_cast<std::uint8_t>(above - kClearThresholds.begin());
}

constinit const std::array<std::uint16_t, 8193> kRsqrtSteps = [] {
  std::array<std::uint16_t, 8193> steps{};
  for (std::uint32_t i = 0; i < 8192; ++i) {
    const auto slope = static_cast<std::uint32_t>(kRsqrtSlopes[i >> 8] >> (i & 15) * 4) & 15;
    steps[i] = static_cast<std::uint16_t>(kRsqrtBlocks[i >> 4] - slope);
  }
  return steps;
}();

float approximate_rsqrt(float value) {
  const std::uint32_t bits = base::bits_of(value);
  if (bits < 0x00800000u) return base::float_of(0x7f800000u);
  if (bits >= 0x7f800000u) return bits == 0x7f800000u ? 0.0f : value;
  // value = m * 4^k with m in [0.5, 2): the result is table(m) * 2^-k.
  const std::uint32_t exponent = bits >> 23;
  const std::uint32_t upper = exponent & 1;  // biased 127, 129... : m in [1, 2)
  const std::uint32_t significand = kRsqrtSteps[(bits >> 11) & 0x1fff];
  const std::int32_t k = (static_cast<std::int32_t>(exponent) - 126 - static_cast<std::int32_t>(upper)) / 2;
  const std::uint32_t start = (upper != 0 ? 126u : 127u) << 23;  // 0.5 or 1.0
  return base::float_of(start + (significand << 11) - (static_cast<std::uint32_t>(k) << 23));
}

namespace {

float rsqrt_of_cpu(float value) {
#ifdef __SSE__
  return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(value)));
#else
  return approximate_rsqrt(value);
#endif
}

using Rsqrt = float (*)(float);

Rsqrt wanted_rsqrt() {
  const char* value = std::getenv("VITRINE_RSQRT");
  return value != nullptr && std::string_view(value) == "cpu" ? rsqrt_of_cpu : nullptr;
}

Rsqrt other_rsqrt() {
  static const Rsqrt other = wanted_rsqrt();
  return other;
}

float rsqrt(float value) {
  const Rsqrt other = other_rsqrt();
  return other != nullptr ? other(value) : approximate_rsqrt(value);
}

#ifdef __SSE__
/// Every entry of the table, at both its ends and between them.
bool cpu_equals_table() {
  constexpr std::uint32_t kFirst = 0x3f000000, kEnd = 0x40000000, kEntry = 1u << 11;  // [0.5, 2)
  for (std::uint32_t entry = kFirst; entry < kEnd; entry += kEntry) {
    for (const std::uint32_t low : {0u, kEntry / 3, 2 * kEntry / 3, kEntry - 1}) {
      const float value = base::float_of(entry + low);
      if (base::bits_of(rsqrt_of_cpu(value)) != base::bits_of(approximate_rsqrt(value))) return false;
    }
  }
  return true;
}
#endif

}  // namespace

bool encodes_by_cpu() { return other_rsqrt() != nullptr; }

bool cpu_has_rsqrt() {
#ifdef __SSE__
  static const bool same = encodes_by_cpu() || cpu_equals_table();
  return same;
#else
  return false;
#endif
}

std::uint8_t encode_srgb_attachment(float linear) {
  const float x = base::min_second(base::max_second(linear, 0.0f), 1.0f);
  if (!(x > kSrgbLinearEnd)) return static_cast<std::uint8_t>(base::round_to_int(x * kSrgbLinearScale));
  constexpr float a = kSrgbCurve[0], b = kSrgbCurve[1], c = kSrgbCurve[2];
  const float t = rsqrt(x);
  const float x05 = x * t;
  const float x0375 = rsqrt(rsqrt(x05 * x));
  const float code = a * x0375 + base::fma_exact(b, x05, c);
  return static_cast<std::uint8_t>(std::clamp(base::round_to_int(code), 0, 255));
}

}  // namespace vitrine::texel
