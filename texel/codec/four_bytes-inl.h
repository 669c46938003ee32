// Texels of four bytes as they lie in memory to floats and back, a vector of components at a time: the bits of
// texel_decoder's and texel_encoder's.

#include "texel/codec/srgb-inl.h"
#include "texel/codec/srgb_encode-inl.h"

#if defined(VITRINE_TEXEL_FOUR_BYTES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_FOUR_BYTES_INL_H_
#undef VITRINE_TEXEL_FOUR_BYTES_INL_H_
#else
#define VITRINE_TEXEL_FOUR_BYTES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

using ComponentTag = hn::ScalableTag<float>;
using ComponentLanes = hn::Vec<ComponentTag>;
using CodeLanes = hn::Vec<hn::RebindToSigned<ComponentTag>>;

/// Which lanes hold the fourth component.
HWY_INLINE hn::Mask<ComponentTag> alpha_lanes() {
  const hn::RebindToSigned<ComponentTag> di;
  return hn::RebindMask(ComponentTag(), hn::Eq(hn::And(hn::Iota(di, 0), hn::Set(di, 3)), hn::Set(di, 3)));
}

HWY_INLINE CodeLanes load_codes(const std::byte* from) {
  const hn::Rebind<std::uint8_t, ComponentTag> d8;
  return hn::PromoteTo(hn::RebindToSigned<ComponentTag>(), hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(from)));
}
/// Codes beyond [0, 255] are clamped.
HWY_INLINE void store_codes(CodeLanes codes, std::byte* to) {
  const hn::Rebind<std::uint8_t, ComponentTag> d8;
  hn::StoreU(hn::DemoteTo(d8, codes), d8, reinterpret_cast<std::uint8_t*>(to));
}

HWY_INLINE ComponentLanes unorm_values(CodeLanes codes) {
  return hn::Mul(lanes_int_to_float(codes), hn::Set(ComponentTag(), 1.0f / 255.0f));
}
/// Of values in [0, 1].
HWY_INLINE CodeLanes unorm_codes(ComponentLanes x) {
  const ComponentTag d;
  const hn::RebindToSigned<ComponentTag> di;
  const auto sum = hn::Add(hn::Mul(x, hn::Set(d, 255.0f / 256.0f)), hn::Set(d, 32768.0f));
  return hn::And(hn::BitCast(di, sum), hn::Set(di, 255));
}

/// Three sRGB codes and a UNORM one.
HWY_INLINE ComponentLanes srgb_texel_values(hn::Mask<ComponentTag> alpha, CodeLanes codes) {
  return hn::IfThenElse(alpha, unorm_values(codes), srgb_to_linear(codes));
}
/// As a colour attachment.
template <class Rsqrt>
HWY_INLINE CodeLanes srgb_texel_codes(hn::Mask<ComponentTag> alpha, ComponentLanes value) {
  const ComponentTag d;
  const auto x = lanes_min_second(lanes_max_second(value, hn::Zero(d)), hn::Set(d, 1.0f));
  const hn::RebindToSigned<ComponentTag> di;
  return hn::IfThenElse(hn::RebindMask(di, alpha), unorm_codes(x), srgb_codes(Rsqrt(), x));
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
