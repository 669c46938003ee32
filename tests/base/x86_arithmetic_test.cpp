// base/x86_arithmetic.h and its twin for lanes: NaNs, and results beside the smallest normal number, are those of
// x86-64 in every SIMD target and on every CPU.
#include "base/x86_arithmetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/numeric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/base/x86_arithmetic_test.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/x86_arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::base::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Six results, one behind the other: a + b, a - b, a * b, a / b, a * b + c, sqrt(a).
HWY_ATTR void run_operations(const float* a, const float* b, const float* c, float* out, std::size_t count) {
  const hn::ScalableTag<float> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto va = hn::LoadU(d, a + i), vb = hn::LoadU(d, b + i), vc = hn::LoadU(d, c + i);
    hn::StoreU(x86_add(va, vb), d, out + i);
    hn::StoreU(x86_sub(va, vb), d, out + count + i);
    hn::StoreU(x86_mul(va, vb), d, out + 2 * count + i);
    hn::StoreU(x86_div(va, vb), d, out + 3 * count + i);
    hn::StoreU(x86_fma(va, vb, vc), d, out + 4 * count + i);
    hn::StoreU(x86_sqrt(va), d, out + 5 * count + i);
  }
}

}  // namespace vitrine::base::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "tests/simd_targets.h"
namespace vitrine::base {
namespace {

HWY_EXPORT(run_operations);

constexpr std::size_t kCount = 1 << 15;
constexpr float kSmallestNormal = 0x1p-126f;
constexpr std::uint32_t kOwnNan = 0xffc00000, kQuiet = 0x00400000;

float random_operand(std::mt19937& random) {
  static constexpr std::uint32_t kSpecials[] = {0,          0x80000000, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc00000,
                                                0x7fc12345, 0xff800001, 0x7fa00000, 0x3f800000, 0x00800000, 0x7f7fffff};
  if (random() % 2 == 0) return float_of(kSpecials[random() % std::size(kSpecials)]);
  return float_of(static_cast<std::uint32_t>(random() & 0x807fffff) + ((1 + random() % 253) << 23));
}

/// x86's result: `exact` in binary64 (rounded there, which only matters as far from a tie as no quotient comes),
/// `value` rounded from it to binary32. Operands in the order in which their NaNs count.
std::uint32_t as_on_x86(double exact, float value, std::initializer_list<float> operands, Denormals mode) {
  for (const float operand : operands)
    if (std::isnan(operand)) return bits_of(operand) | kQuiet;
  if (std::isnan(value)) return kOwnNan;
  if (mode == Denormals::kHonour || std::fabs(exact) >= kSmallestNormal) return bits_of(value);
  // Tiny after rounding, as though exponents had no end: from half a unit below the smallest normal number on it is
  // not.
  const double magnitude = std::fabs(exact) >= kSmallestNormal * (1 - 0x1p-25) ? kSmallestNormal : 0;
  return bits_of(static_cast<float>(std::copysign(magnitude, exact)));
}

/// An operand as the operation sees it.
float read(float operand, Denormals mode) {
  const bool flushed = mode == Denormals::kFlush && std::fabs(operand) < kSmallestNormal;
  return flushed ? std::copysign(0.0f, operand) : operand;
}

/// Of two NaNs the compiler chooses on x86; SSE4's FMA, which has two steps, takes 0 * infinity for one.
bool is_decided(float a, float b, float c) {
  return std::isnan(a) + std::isnan(b) + std::isnan(c) + std::isnan(a * b) * !std::isnan(a) * !std::isnan(b) < 2;
}

TEST(X86Arithmetic, LanesHaveItsNansAndItsSmallestNormals) {
  std::mt19937 random(1);
  std::vector<float> a(kCount), b(kCount), c(kCount), out(6 * kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    a[i] = random_operand(random), b[i] = random_operand(random), c[i] = random_operand(random);
    if (i % 2 == 0) continue;
    // Products and quotients around the smallest normal number.
    const float near_one = float_of(static_cast<std::uint32_t>(random() & 0x807fffff) | 0x3f800000);
    const auto nudged = [&](float value) {
      return float_of(bits_of(value) + static_cast<std::uint32_t>(random() % 5) - 2);
    };
    const bool product = i % 4 == 1;
    a[i] = product ? near_one : nudged(near_one * 2 * kSmallestNormal);
    b[i] = product ? nudged(kSmallestNormal / near_one * 2) / 2 : nudged(near_one * 2);
    c[i] = random() % 2 == 0 ? 0.0f : -0.0f;
  }
  for (const Denormals mode : {Denormals::kHonour, Denormals::kFlush}) {
    for_each_simd_target([&] {
      {
        const ScopedFloatMode scope(mode);
        HWY_DYNAMIC_DISPATCH(run_operations)(a.data(), b.data(), c.data(), out.data(), kCount);
      }
      for (std::size_t i = 0; i < kCount; ++i) {
        const float x = read(a[i], mode), y = read(b[i], mode), z = read(c[i], mode);
        if (!is_decided(x, y, z)) continue;
        const double dx = x, dy = y, dz = z;
        const std::uint32_t want[] = {as_on_x86(dx + dy, x + y, {x, y}, mode),
                                      as_on_x86(dx - dy, x - y, {x, y}, mode),
                                      as_on_x86(dx * dy, x * y, {x, y}, mode),
                                      as_on_x86(dx / dy, x / y, {x, y}, mode),
                                      as_on_x86(std::fma(dx, dy, dz), std::fma(x, y, z), {x, y, z}, mode),
                                      as_on_x86(std::sqrt(dx), std::sqrt(x), {x}, mode)};
        for (std::size_t op = 0; op < std::size(want); ++op)
          ASSERT_EQ(want[op], bits_of(out[op * kCount + i]))
              << std::hex << "operation " << op << " of " << bits_of(x) << " " << bits_of(y) << " " << bits_of(z);
      }
    });
  }
}

TEST(X86Arithmetic, SingleFloatsHaveItsNans) {
  std::mt19937 random(2);
  for (std::size_t i = 0; i < kCount; ++i) {
    const float x = random_operand(random), y = random_operand(random);
    if (!is_decided(x, y, 0)) continue;
    const auto want = [&](float value) { return as_on_x86(0, value, {x, y}, Denormals::kHonour); };
    ASSERT_EQ(bits_of(x86_add(x, y)), want(x + y)) << bits_of(x) << " " << bits_of(y);
    ASSERT_EQ(bits_of(x86_sub(x, y)), want(x - y)) << bits_of(x) << " " << bits_of(y);
    ASSERT_EQ(bits_of(x86_mul(x, y)), want(x * y)) << bits_of(x) << " " << bits_of(y);
    ASSERT_EQ(bits_of(x86_div(x, y)), want(x / y)) << bits_of(x) << " " << bits_of(y);
  }
}

}  // namespace
}  // namespace vitrine::base
#endif  // HWY_ONCE
