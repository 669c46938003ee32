// Every SIMD target of base/lane_math-inl.h against scalar arithmetic, in both denormal modes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/lanes.h"
#include "base/numeric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/base/lane_math_test.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::base::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::ScalableTag<float>;
using DU = hn::ScalableTag<std::uint32_t>;

HWY_ATTR void run_fma(const float* a, const float* b, const float* c, float* out, std::size_t count) {
  const DF d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(lanes_fma(hn::LoadU(d, a + i), hn::LoadU(d, b + i), hn::LoadU(d, c + i)), d, out + i);
}

HWY_ATTR void run_conversions(const std::uint32_t* in, std::uint32_t* out, std::size_t count) {
  const DU d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto bits = hn::LoadU(d, in + i);
    const auto value = lanes_cast<float>(bits);
    hn::StoreU(lanes_cast<std::uint32_t>(lanes_truncate_to_int(value)), d, out + i);
    hn::StoreU(lanes_cast<std::uint32_t>(lanes_round_to_int(value)), d, out + count + i);
    hn::StoreU(lanes_truncate_to_uint(value), d, out + 2 * count + i);
    hn::StoreU(lanes_cast<std::uint32_t>(lanes_uint_to_float(bits)), d, out + 3 * count + i);
    hn::StoreU(lanes_float_to_half(value), d, out + 4 * count + i);
    hn::StoreU(lanes_cast<std::uint32_t>(lanes_half_to_float(bits)), d, out + 5 * count + i);
  }
}

HWY_ATTR LaneMask run_masks(LaneMask mask) {
  const DU d;
  LaneMask result = 0;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d))
    result |= lanes_mask_bits(d, lanes_mask_from_bits(d, mask >> i)) << i;
  return result;
}

}  // namespace vitrine::base::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "tests/simd_targets.h"
namespace vitrine::base {
namespace {

HWY_EXPORT(run_fma);
HWY_EXPORT(run_conversions);
HWY_EXPORT(run_masks);

/// Bit patterns of all kinds: random, near-equal exponents, specials.
std::uint32_t interesting_bits(std::mt19937& random) {
  static constexpr std::uint32_t kSpecials[] = {
      0,          0x80000000, 1,          0x80000001, 0x007fffff, 0x00800000, 0x7f7fffff, 0x7f800000, 0xff800000,
      0x7fc00001, 0xff800001, 0x3f800000, 0xbf800000, 0x4f000000, 0x4f7fffff, 0x4f800000, 0xcf000000, 0xbf7fffff,
      0x477fe000, 0x477fefff, 0x477ff000, 0x38800000, 0x387fffff, 0x33000000, 0x33000001, 0x387fe000, 0x4effffff};
  switch (random() % 4) {
    case 0:
      return random();
    case 1:
      return kSpecials[random() % std::size(kSpecials)];
    case 2:
      return (random() & 0x83ffffff) | 0x3c000000;
    default:
      return (random() & 0x801fffff) + ((random() % 255) << 23);
  }
}

/// Equal bits, or both NaN.
bool same(std::uint32_t a, std::uint32_t b) { return a == b || (std::isnan(float_of(a)) && std::isnan(float_of(b))); }

constexpr std::size_t kCount = 1 << 16;

TEST(LaneMath, FmaRoundsOnce) {
  std::mt19937 random(1);
  std::vector<float> a(kCount), b(kCount), c(kCount), out(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    a[i] = float_of(interesting_bits(random));
    b[i] = float_of(interesting_bits(random));
    c[i] = i % 3 == 0 ? -a[i] * b[i] : float_of(interesting_bits(random));
  }
  for (const Denormals mode : {Denormals::kHonour, Denormals::kFlush}) {
    for_each_simd_target([&] {
      const ScopedFloatMode scope(mode);
      HWY_DYNAMIC_DISPATCH(run_fma)(a.data(), b.data(), c.data(), out.data(), kCount);
      const auto input = [&](float value) {  // DAZ, for a libm that may compute in integers
        const std::uint32_t bits = bits_of(value);
        return mode == Denormals::kFlush && (bits & 0x7f800000) == 0 ? float_of(bits & 0x80000000) : value;
      };
      for (std::size_t i = 0; i < kCount; ++i) {
        const std::uint32_t want = bits_of(input(std::fma(input(a[i]), input(b[i]), input(c[i]))));
        ASSERT_TRUE(same(want, bits_of(out[i]))) << std::hex << bits_of(a[i]) << " " << bits_of(b[i]) << " "
                                                 << bits_of(c[i]) << " want " << want << " got " << bits_of(out[i]);
      }
    });
  }
}

TEST(LaneMath, ConversionsEqualTheScalarOnes) {
  std::mt19937 random(2);
  std::vector<std::uint32_t> in(kCount), out(kCount * 6);
  for (auto& bits : in) bits = interesting_bits(random);
  for (std::uint32_t half = 0; half < 0x10000; ++half)
    if (half % 2 == 0) in[half] = half;
  for (const Denormals mode : {Denormals::kHonour, Denormals::kFlush}) {
    for_each_simd_target([&] {
      const ScopedFloatMode scope(mode);
      HWY_DYNAMIC_DISPATCH(run_conversions)(in.data(), out.data(), kCount);
      for (std::size_t i = 0; i < kCount; ++i) {
        const std::uint32_t bits = in[i];
        const float value = float_of(bits);
        ASSERT_EQ(out[i], static_cast<std::uint32_t>(truncate_to_int(value))) << std::hex << bits;
        ASSERT_EQ(out[kCount + i], static_cast<std::uint32_t>(round_to_int(value))) << std::hex << bits;
        ASSERT_EQ(out[2 * kCount + i], truncate_to_uint(value)) << std::hex << bits;
        ASSERT_EQ(out[3 * kCount + i], bits_of(static_cast<float>(bits))) << std::hex << bits;
        ASSERT_EQ(out[4 * kCount + i], float_to_half_nearest(value)) << std::hex << bits;
        ASSERT_EQ(out[5 * kCount + i], bits_of(half_to_float(static_cast<std::uint16_t>(bits)))) << std::hex << bits;
      }
    });
  }
}

TEST(LaneMath, MasksAreBitsInLaneOrder) {
  std::mt19937_64 random(3);
  for_each_simd_target([&] {
    for (int i = 0; i < 1000; ++i) {
      const LaneMask mask = random();
      ASSERT_EQ(HWY_DYNAMIC_DISPATCH(run_masks)(mask), mask);
    }
  });
}

}  // namespace
}  // namespace vitrine::base
#endif  // HWY_ONCE
