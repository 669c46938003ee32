// sRGB codes to linear values, a vector at a time.

#include "base/lane_math-inl.h"
#include "texel/codec/srgb.h"

#if defined(VITRINE_TEXEL_SRGB_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_SRGB_INL_H_
#undef VITRINE_TEXEL_SRGB_INL_H_
#else
#define VITRINE_TEXEL_SRGB_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

/// kSrgbToLinear of codes in [0, 255]: by its formula, on vectors faster than the table, where there is an FMA.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> srgb_to_linear(hn::Vec<hn::ScalableTag<std::int32_t>> codes) {
  const hn::ScalableTag<float> d;
#if HWY_TARGET == HWY_SSE4
  return hn::GatherIndex(d, kSrgbToLinear.data(), codes);
#else
  const auto code = lanes_int_to_float(codes), square = hn::Mul(code, code);
  const auto upper = lanes_fma(square, hn::Set(d, 0.3012f / (255.0f * 255.0f * 255.0f)), hn::Set(d, 0.0030f / 255.0f));
  const auto lower = lanes_fma(square, hn::Set(d, 0.6935f / (255.0f * 255.0f)), hn::Set(d, 0.0023f));
  return hn::IfThenElse(hn::Le(code, hn::Set(d, 15.0f)), hn::Mul(code, hn::Set(d, 1.0f / (12.6f * 255.0f))),
                        lanes_fma(upper, code, lower));
#endif
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
