// Depth tests in row order, where a row of the attachment is a vector.
#include "raster/tile/block_depth.h"

#include <bit>
#include <cstring>
#include <type_traits>

#include "base/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile/block_depth.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"
#include "raster/lane_bits-inl.h"
#include "raster/output/depth_formats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::lanes_mask_from_bits;
using base::HWY_NAMESPACE::lanes_max_second;
using base::HWY_NAMESPACE::lanes_min_second;
using base::HWY_NAMESPACE::x86_add;
using base::HWY_NAMESPACE::x86_fma;

/// A vector of a square's pixels, in row order: several whole rows, or a part of one.
template <std::size_t kSide>
struct SquareVector {
  using Floats = hn::CappedTag<float, (kSide < 8 ? 16 : 2 * kSide)>;
  using Words = hn::RebindToSigned<Floats>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Floats());
  static constexpr std::size_t kRowLanes = kLanes < kSide ? kLanes : kSide;
  static constexpr std::size_t kRows = kLanes / kRowLanes;
};

/// Loads `kRows` rows from `texels` on into one vector.
template <class Format, std::size_t kRows, class D>
HWY_INLINE hn::Vec<D> load_rows(D d, const std::byte* texels, std::uint64_t pitch) {
  if constexpr (kRows == 1) {
    return Format::load_row(d, texels);
  } else {
    const hn::Half<D> half;
    const auto upper = load_rows<Format, kRows / 2>(half, texels + kRows / 2 * pitch, pitch);
    return hn::Combine(d, upper, load_rows<Format, kRows / 2>(half, texels, pitch));
  }
}

/// Stores those of the rows that have a lane in `bits`.
template <class Format, std::size_t kRows, class V>
HWY_INLINE void store_rows(V v, std::uint32_t bits, std::byte* texels, std::uint64_t pitch) {
  if constexpr (kRows == 1) {
    if (bits != 0) Format::store_row(v, texels);
  } else {
    const hn::DFromV<V> d;
    const hn::Half<decltype(d)> half;
    constexpr std::size_t n = hn::MaxLanes(half);
    store_rows<Format, kRows / 2>(hn::LowerHalf(half, v), bits & ((1u << n) - 1), texels, pitch);
    store_rows<Format, kRows / 2>(hn::UpperHalf(half, v), bits >> n, texels + kRows / 2 * pitch, pitch);
  }
}

/// Depth test of squares of `kSide` pixels, with what they share. What is known when it is compiled leaves a loop
/// without branches but those on coverage.
template <class Format, std::size_t kSide, VkCompareOp kOp>
class SquareTest {
  using Square = SquareVector<kSide>;
  using Floats = typename Square::Floats;
  using VF = hn::Vec<Floats>;

 public:
  HWY_INLINE SquareTest(const BlockDepthTest& test, const DepthPlane& plane)
      : a0_(hn::Set(Floats(), plane.a0)),
        dadx_(hn::Set(Floats(), plane.dadx)),
        dady_(hn::Set(Floats(), plane.dady)),
        offset_(hn::Set(Floats(), plane.offset)),
        low_(hn::Set(Floats(), test.clamp ? test.clamp->low : 0)),
        high_(hn::Set(Floats(), test.clamp ? test.clamp->high : 1)),
        clamps_(test.clamp != nullptr),
        restricts_(test.restricted),
        write_(test.write) {
    const typename Square::Words d;
    const auto lane = hn::Iota(d, 0);
    lane_row_ = hn::ConvertTo(Floats(), hn::ShiftRight < kSide == 16 ? 4 : kSide == 8 ? 3 : 2 > (lane));
    lane_column_ = hn::ConvertTo(Floats(), hn::And(lane, hn::Set(d, static_cast<std::int32_t>(kSide - 1))));
  }

  /// One square whose first sample is at (x, y); rows in, rows that passed out.
  HWY_INLINE base::LaneMask run(float x, float y, std::byte* first, std::uint64_t pitch, base::LaneMask rows) const {
    const Floats f;
    const typename Square::Words d;
    constexpr std::size_t n = Square::kLanes;
    constexpr std::uint32_t all = (1u << n) - 1;
    base::LaneMask passed = 0;
    // All sums of places are exact: whole numbers, or a sample's eighths on top of them.
    for (std::size_t c = 0; c < kSide; c += Square::kRowLanes) {
      const VF fx = hn::Add(hn::Set(f, x + static_cast<float>(c)), lane_column_);
      const VF inner = x86_fma(dadx_, fx, a0_);
      VF fy = hn::Add(hn::Set(f, y), lane_row_);
      std::byte* texels = first + c * Format::kBytes;
      for (std::size_t r = 0; r < kSide; r += Square::kRows) {
        const auto covered = static_cast<std::uint32_t>(rows >> (kSide * r + c)) & all;
        if (covered != 0) {
          const auto value = Format::encode(restrict(x86_fma(dady_, fy, inner)));
          const auto stored = load_rows<Format, Square::kRows>(d, texels, pitch);
          const auto bits = static_cast<std::uint32_t>(bits_of_mask(compare<Format>(kOp, value, stored))) & covered;
          passed |= base::LaneMask{bits} << (kSide * r + c);
          if (write_)
            store_rows<Format, Square::kRows>(hn::IfThenElse(lanes_mask_from_bits(d, bits), value, stored), bits,
                                              texels, pitch);
        }
        fy = hn::Add(fy, hn::Set(f, static_cast<float>(Square::kRows)));
        texels += Square::kRows * pitch;
      }
    }
    return passed;
  }

  /// The rows of a window as wide as the square, four at a time: branches on single rows would be guessed wrong.
  HWY_INLINE bool run_window(float x, float y, std::byte* first, std::uint64_t pitch, LargeWindow& window) const {
    const Floats f;
    const typename Square::Words d;
    constexpr std::size_t n = Square::kRowLanes;
    constexpr std::uint64_t all = base::first_lanes(n) * 0x0001000100010001;
    std::uint64_t any = 0;
    for (std::size_t c = 0; c < kSide; c += n) {
      const VF fx = hn::Add(hn::Set(f, x + static_cast<float>(c)), lane_column_);
      const VF inner = x86_fma(dadx_, fx, a0_);
      for (std::size_t w = 0; w < LargeWindow::kWords; ++w) {
        const std::uint64_t covered = window.rows[w] >> c & all;
        if (covered == 0) continue;
        VF fy = hn::Set(f, y + static_cast<float>(4 * w));
        std::byte* texels = first + c * Format::kBytes + 4 * w * pitch;
        std::uint64_t passed = 0;
        for (std::size_t r = 0; r < 4; ++r, texels += pitch) {
          const auto value = Format::encode(restrict(x86_fma(dady_, fy, inner)));
          fy = hn::Add(fy, hn::Set(f, 1.0f));
          const auto stored = Format::load_row(d, texels);
          const std::uint64_t bits = bits_of_mask(compare<Format>(kOp, value, stored)) & covered >> 16 * r & all;
          const auto row = static_cast<std::uint32_t>(bits & 0xffff);
          passed |= std::uint64_t{row} << 16 * r;
          if (write_) Format::store_row(hn::IfThenElse(lanes_mask_from_bits(d, row), value, stored), texels);
        }
        window.rows[w] ^= (covered ^ passed) << c;
        any |= passed;
      }
    }
    return any != 0;
  }

 private:
  /// The plane's value to a depth: bias, clamps.
  HWY_INLINE VF restrict(VF z) const {
    const Floats f;
    z = x86_add(z, offset_);
    if (restricts_) z = lanes_max_second(lanes_min_second(z, hn::Set(f, 1.0f)), hn::Zero(f));
    return clamps_ ? lanes_max_second(lanes_min_second(z, high_), low_) : z;
  }

  VF a0_, dadx_, dady_, offset_, low_, high_;
  VF lane_row_, lane_column_;  ///< places in the square
  bool clamps_, restricts_, write_;
};

/// Calls run(type) with the type of SquareTest for this format and comparison.
template <class Format, std::size_t kSide, class F>
HWY_INLINE void with_comparison(VkCompareOp compare, F&& run) {
  switch (compare) {
    case VK_COMPARE_OP_NEVER:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_NEVER>>());
    case VK_COMPARE_OP_LESS:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_LESS>>());
    case VK_COMPARE_OP_EQUAL:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_EQUAL>>());
    case VK_COMPARE_OP_LESS_OR_EQUAL:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_LESS_OR_EQUAL>>());
    case VK_COMPARE_OP_GREATER:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_GREATER>>());
    case VK_COMPARE_OP_NOT_EQUAL:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_NOT_EQUAL>>());
    case VK_COMPARE_OP_GREATER_OR_EQUAL:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_GREATER_OR_EQUAL>>());
    default:
      return run(std::type_identity<SquareTest<Format, kSide, VK_COMPARE_OP_ALWAYS>>());
  }
}

template <std::size_t kSide, class F>
HWY_INLINE void with_square_test(const BlockDepthTest& test, F&& run) {
  switch (test.format) {
    case DepthFormat::kD16:
      return with_comparison<D16, kSide>(test.compare, run);
    case DepthFormat::kD24:
      return with_comparison<D24, kSide>(test.compare, run);
    default:
      return with_comparison<D32, kSide>(test.compare, run);
  }
}

std::byte* pixel_of(const BlockDepthTest& test, const BlockPixels& pixels, int x, int y) {
  return pixels.first + static_cast<std::uint64_t>(y) * pixels.pitch +
         static_cast<std::uint64_t>(x) * depth_bytes(test.format);
}

}  // namespace

base::LaneMask test_blocks(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                           const BlockPixels& pixels, base::LaneMask places, base::LaneMask* lanes) {
  base::LaneMask failed = 0;
  with_square_test<8>(test, [&](auto type) HWY_ATTR {
    const typename decltype(type)::type square(test, plane);
    for (base::LaneMask left = places; left != 0; left &= left - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
      if (lanes[place] == 0) continue;
      const int bx = lane_x(place) * kBlockSize, by = lane_y(place) * kBlockSize;
      lanes[place] =
          quads_of_rows(square.run(x + static_cast<float>(bx), y + static_cast<float>(by),
                                   pixel_of(test, pixels, bx, by), pixels.pitch, rows_of_quads(lanes[place])));
      if (lanes[place] == 0) failed |= base::LaneMask{1} << place;
    }
  });
  return failed;
}

void test_windows(const BlockDepthTest& test, const BlockPixels& pixels, DepthWindow* windows, std::size_t count) {
  with_square_test<4>(test, [&](auto type) HWY_ATTR {
    for (DepthWindow* w = windows; w != windows + count; ++w) {
      const typename decltype(type)::type square(test, w->plane);
      w->rows = static_cast<std::uint32_t>(square.run(static_cast<float>(w->x), static_cast<float>(w->y),
                                                      pixel_of(test, pixels, w->x, w->y), pixels.pitch, w->rows));
    }
  });
}

bool test_large_window(const BlockDepthTest& test, const DepthPlane& plane, float x, float y, const BlockPixels& pixels,
                       LargeWindow& window) {
  bool any = false;
  with_square_test<kLargeWindow>(test, [&](auto type) HWY_ATTR {
    any = typename decltype(type)::type(test, plane).run_window(x, y, pixels.first, pixels.pitch, window);
  });
  return any;
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(test_blocks);
HWY_EXPORT(test_windows);
HWY_EXPORT(test_large_window);

base::LaneMask test_block_depths(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                 const BlockPixels& pixels, base::LaneMask places, base::LaneMask* lanes) {
  return HWY_DYNAMIC_DISPATCH(test_blocks)(test, plane, x, y, pixels, places, lanes);
}

void test_window_depths(const BlockDepthTest& test, const BlockPixels& pixels, DepthWindow* windows,
                        std::size_t count) {
  HWY_DYNAMIC_DISPATCH(test_windows)(test, pixels, windows, count);
}

bool test_large_window_depths(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                              const BlockPixels& pixels, LargeWindow& window) {
  return HWY_DYNAMIC_DISPATCH(test_large_window)(test, plane, x, y, pixels, window);
}

}  // namespace vitrine::raster
#endif
