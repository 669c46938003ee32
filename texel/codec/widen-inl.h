// Channels of at most 8 bits as bytes, the way the reference's 8-bit path widens them (lavapipe-texture-blend.md A2).

#include "base/lane_math-inl.h"
#include "texel/format.h"

#if defined(VITRINE_TEXEL_WIDEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WIDEN_INL_H_
#undef VITRINE_TEXEL_WIDEN_INL_H_
#else
#define VITRINE_TEXEL_WIDEN_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Widens every channel to 8 bits by repeating its bits, in R, G, B, A order; missing alpha is 255.
HWY_INLINE hn::Vec<hn::ScalableTag<std::uint32_t>> widen_fields(const FormatDesc& desc,
                                                                hn::Vec<hn::ScalableTag<std::uint32_t>> word) {
  const hn::ScalableTag<std::uint32_t> d;
  auto packed = hn::Set(d, desc.rgba[3] < 0 ? 0xFF000000u : 0u);
  for (std::size_t i = 0; i < desc.channel_count; ++i) {
    const int bits = desc.channel[i].bits;
    const auto field = hn::And(hn::ShiftRightSame(word, desc.channel[i].offset), hn::Set(d, (1u << bits) - 1));
    const auto wide = bits == 1 ? hn::Sub(hn::ShiftLeft<8>(field), field)
                                : hn::Or(hn::ShiftLeftSame(field, 8 - bits), hn::ShiftRightSame(field, 2 * bits - 8));
    packed = hn::Or(packed, hn::ShiftLeftSame(wide, 8 * desc.component[i]));
  }
  return packed;
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
