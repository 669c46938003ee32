// What filters of float values are made of: texels of a tap with border and comparison, and averages of two.

#include "texel/sampler/wave/taps-inl.h"
#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_VALUES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_VALUES_INL_H_
#undef VITRINE_TEXEL_WAVE_VALUES_INL_H_
#else
#define VITRINE_TEXEL_WAVE_VALUES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

inline HWY_NOINLINE void put_border(const Plan& plan, base::LaneMask outside, Components wanted, WaveTexels& texels) {
  for (std::size_t c = 0; c < 4; ++c) {
    if ((wanted >> c & 1) == 0) continue;
    const VF border = as_float(hn::Set(DU(), plan.border[c]));
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
      hn::BlendedStore(border, lanes_mask_from_bits(DF(), outside >> i), DF(), texels.c[c].lane + i);
    }
  }
}

/// The texels of one tap as values; with a comparison its result as 0 or 1 in component 0.
inline HWY_NOINLINE void fetch_tap(Call& call, const TexelPlaces& places, base::LaneMask outside, WaveTexels& out) {
  if (outside != base::kAllLanes) fetch_texels(call.view(), places, call.request.active, call.wanted, out);
  if (outside != 0) put_border(call.plan(), outside, call.wanted, out);
  if (!call.compare) return;
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    const auto holds = compare_lanes(call.plan().sampler->compare_op, hn::Load(DF(), call.reference.lane + i),
                                     hn::Load(DF(), out.c[0].lane + i));
    hn::Store(hn::IfThenElseZero(holds, splat(1.0f)), DF(), out.c[0].lane + i);
  }
}

HWY_INLINE VF lerp(VF weight, VF a, VF b) { return lanes_fma(weight, hn::Sub(b, a), a); }

/// a becomes f(weight, a, b) in every wanted component.
template <class F>
HWY_INLINE void combine(Components wanted, const FloatLanes& weight, WaveTexels& a, const WaveTexels& b, F&& f) {
  for (std::size_t c = 0; c < 4; ++c) {
    if ((wanted >> c & 1) == 0) continue;
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
      const VF value =
          f(hn::Load(DF(), weight.lane + i), hn::Load(DF(), a.c[c].lane + i), hn::Load(DF(), b.c[c].lane + i));
      hn::Store(value, DF(), a.c[c].lane + i);
    }
  }
}

inline HWY_NOINLINE void average(Components wanted, const FloatLanes& weight, WaveTexels& a, const WaveTexels& b) {
  combine(wanted, weight, a, b, [](VF w, VF first, VF second) { return lerp(w, first, second); });
}

/// The operand of comparisons, as texels of the format are.
inline void load_reference(Call& call) {
  const bool fixed_point = call.view().format->channel[0].numeric != Numeric::kSfloat;
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    VF reference = load_lanes(call.request.dref, i);
    if (fixed_point) reference = lanes_max_second(lanes_min_second(reference, splat(1.0f)), splat(0.0f));
    hn::Store(reference, DF(), call.reference.lane + i);
  }
}

/// A comparison gives one component.
inline HWY_NOINLINE void complete_comparison(WaveTexels& texels) {
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    hn::Store(splat(0.0f), DF(), texels.c[1].lane + i);
    hn::Store(splat(0.0f), DF(), texels.c[2].lane + i);
    hn::Store(splat(1.0f), DF(), texels.c[3].lane + i);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
