// Depth as stored, in vectors of lanes: encoding, loads and stores of quads and rows, comparison
// (lavapipe-rasterization.md 5.3). Include after <hwy/highway.h>, in a file that follows the foreach_target pattern.

#include <vulkan/vulkan_core.h>

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/lane_math-inl.h"

#if defined(VITRINE_RASTER_DEPTH_FORMATS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_RASTER_DEPTH_FORMATS_INL_H_
#undef VITRINE_RASTER_DEPTH_FORMATS_INL_H_
#else
#define VITRINE_RASTER_DEPTH_FORMATS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using I4 = hn::FixedTag<std::int32_t, 4>;
using VI4 = hn::Vec<I4>;

/// Each format: encode() for vectors of any length, load() and store() for a quad (two pixels of each row), load_row()
/// and store_row() for adjacent pixels.
struct D16 {
  static constexpr int kBytes = 2;
  template <class V>
  static HWY_INLINE auto encode(V z) {
    using base::HWY_NAMESPACE::lanes_set;
    const V t = hn::Add(hn::Mul(z, lanes_set<V>(static_cast<float>(65535.0 / 65536.0))), lanes_set<V>(128.0f));
    const auto bits = base::HWY_NAMESPACE::lanes_cast<std::int32_t>(t);
    return hn::And(bits, lanes_set<decltype(bits)>(0xffff));
  }
  static HWY_INLINE VI4 load(const std::byte* row0, const std::byte* row1) {
    std::uint32_t low, high;
    std::memcpy(&low, row0, 4);
    std::memcpy(&high, row1, 4);
    const auto texels = hn::Set(hn::FixedTag<std::uint64_t, 1>(), std::uint64_t{high} << 32 | low);
    return hn::PromoteTo(I4(), hn::BitCast(hn::FixedTag<std::uint16_t, 4>(), texels));
  }
  static HWY_INLINE void store(VI4 v, std::byte* row0, std::byte* row1) {
    const auto texels = hn::DemoteTo(hn::FixedTag<std::uint16_t, 4>(), v);
    const std::uint64_t word = hn::GetLane(hn::BitCast(hn::FixedTag<std::uint64_t, 1>(), texels));
    const auto low = static_cast<std::uint32_t>(word), high = static_cast<std::uint32_t>(word >> 32);
    std::memcpy(row0, &low, 4);
    std::memcpy(row1, &high, 4);
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> load_row(D d, const std::byte* row) {
    return hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint16_t, D>(), reinterpret_cast<const std::uint16_t*>(row)));
  }
  template <class V>
  static HWY_INLINE void store_row(V v, std::byte* row) {
    const hn::Rebind<std::uint16_t, hn::DFromV<V>> d16;
    hn::StoreU(hn::DemoteTo(d16, v), d16, reinterpret_cast<std::uint16_t*>(row));
  }
};

/// Formats of 32-bit words. Halves of a quad are loaded and stored as halves: a whole vector assembled in memory would
/// wait for its stores.
struct DepthWord {
  static constexpr int kBytes = 4;
  using I2 = hn::FixedTag<std::int32_t, 2>;
  static HWY_INLINE VI4 load(const std::byte* row0, const std::byte* row1) {
    const auto top = hn::LoadU(I2(), reinterpret_cast<const std::int32_t*>(row0));
    const auto bottom = hn::LoadU(I2(), reinterpret_cast<const std::int32_t*>(row1));
    return hn::Combine(I4(), bottom, top);
  }
  static HWY_INLINE void store(VI4 v, std::byte* row0, std::byte* row1) {
    hn::StoreU(hn::LowerHalf(I2(), v), I2(), reinterpret_cast<std::int32_t*>(row0));
    hn::StoreU(hn::UpperHalf(I2(), v), I2(), reinterpret_cast<std::int32_t*>(row1));
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> load_row(D d, const std::byte* row) {
    return hn::LoadU(d, reinterpret_cast<const std::int32_t*>(row));
  }
  template <class V>
  static HWY_INLINE void store_row(V v, std::byte* row) {
    hn::StoreU(v, hn::DFromV<V>(), reinterpret_cast<std::int32_t*>(row));
  }
};

struct D24 : DepthWord {
  template <class V>
  static HWY_INLINE auto encode(V z) {
    return base::HWY_NAMESPACE::lanes_round_to_int(hn::Mul(z, base::HWY_NAMESPACE::lanes_set<V>(16777215.0f)));
  }
  template <class V>
  static HWY_INLINE V value_of(V word) {
    return hn::And(word, base::HWY_NAMESPACE::lanes_set<V>(0xffffff));
  }
  static HWY_INLINE VI4 load(const std::byte* row0, const std::byte* row1) {
    return value_of(DepthWord::load(row0, row1));
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> load_row(D d, const std::byte* row) {
    return value_of(DepthWord::load_row(d, row));
  }
};

struct D32 : DepthWord {
  template <class V>
  static HWY_INLINE auto encode(V z) {
    return base::HWY_NAMESPACE::lanes_cast<std::int32_t>(z);
  }
};

/// Unsigned 24-bit values compare as signed ones; floats compare true when unordered, but for NEVER.
template <class Format, class V>
HWY_INLINE auto compare(VkCompareOp op, V value, V stored) {
  const hn::DFromV<V> d;
  if constexpr (std::is_same_v<Format, D32>) {
    const auto a = base::HWY_NAMESPACE::lanes_cast<float>(value), b = base::HWY_NAMESPACE::lanes_cast<float>(stored);
    const auto mask = [&](auto m) { return hn::RebindMask(d, m); };
    switch (op) {
      case VK_COMPARE_OP_NEVER:
        return hn::MaskFromVec(hn::Zero(d));
      case VK_COMPARE_OP_LESS:
        return mask(hn::Not(hn::Ge(a, b)));
      case VK_COMPARE_OP_EQUAL:
        return mask(hn::Not(hn::Or(hn::Lt(a, b), hn::Gt(a, b))));
      case VK_COMPARE_OP_LESS_OR_EQUAL:
        return mask(hn::Not(hn::Gt(a, b)));
      case VK_COMPARE_OP_GREATER:
        return mask(hn::Not(hn::Le(a, b)));
      case VK_COMPARE_OP_NOT_EQUAL:
        return mask(hn::Not(hn::Eq(a, b)));
      case VK_COMPARE_OP_GREATER_OR_EQUAL:
        return mask(hn::Not(hn::Lt(a, b)));
      default:
        return hn::Not(hn::MaskFromVec(hn::Zero(d)));
    }
  } else {
    switch (op) {
      case VK_COMPARE_OP_NEVER:
        return hn::MaskFromVec(hn::Zero(d));
      case VK_COMPARE_OP_LESS:
        return hn::Lt(value, stored);
      case VK_COMPARE_OP_EQUAL:
        return hn::Eq(value, stored);
      case VK_COMPARE_OP_LESS_OR_EQUAL:
        return hn::Not(hn::Gt(value, stored));
      case VK_COMPARE_OP_GREATER:
        return hn::Gt(value, stored);
      case VK_COMPARE_OP_NOT_EQUAL:
        return hn::Ne(value, stored);
      case VK_COMPARE_OP_GREATER_OR_EQUAL:
        return hn::Not(hn::Lt(value, stored));
      default:
        return hn::Not(hn::MaskFromVec(hn::Zero(d)));
    }
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
