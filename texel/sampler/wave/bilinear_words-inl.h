// Averages of four texels of two or four bytes each, or of comparisons with them, in two dimensions and one level or
// two: vector by vector from coordinates to results. The bits of the general float sampler.

#include "texel/sampler/wave/square-inl.h"
#include "texel/sampler/wave/words-inl.h"

#if defined(VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#undef VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// One axis of a level.
struct FloatAxis {
  const AxisLanes* axis = nullptr;

  void set(const AxisLanes& a) { axis = &a; }
  HWY_INLINE TapLanes taps(VF s) const { return lanes_linear(*axis, s); }
};

/// Texels around the points of a vector of lanes, with their weights.
using WeighedSquare = SquareReader<FloatAxis>::Weighed;

HWY_INLINE VF mix_values(VF weight, VF a, VF b) { return lanes_fma(weight, hn::Sub(b, a), a); }

/// Component c of the format.
template <Numeric kNumeric>
HWY_INLINE VF average_component(const FormatDesc& format, std::size_t c, const WeighedSquare& s) {
  const std::int8_t index = format.rgba[c];
  const Channel& channel = format.channel[static_cast<std::size_t>(index < 0 ? 0 : index)];
  const VF missing = splat(c == 3 ? 1.0f : 0.0f);  // averaged too: a weight may be NaN
  const auto row = [&](const WordPair& pair) {
    const VF a = index < 0 ? missing : convert_field<kNumeric>(pair.first, channel);
    const VF b = index < 0 ? missing : convert_field<kNumeric>(pair.second, channel);
    return mix_values(s.x, a, b);
  };
  return mix_values(s.y, row(s.words.top), row(s.words.bottom));
}

/// The depth to compare with, clamped where texels are fixed-point.
template <Numeric kNumeric>
HWY_INLINE VF load_reference(const SampleRequest& request, std::size_t first) {
  const VF reference = load_lanes(request.dref, first);
  if constexpr (kNumeric == Numeric::kSfloat) return reference;
  return lanes_max_second(lanes_min_second(reference, splat(1.0f)), splat(0.0f));
}

/// The average of comparisons, along x weighted by selection.
template <Numeric kNumeric>
HWY_INLINE VF average_comparison(const Channel& channel, VkCompareOp op, VF reference, const WeighedSquare& s) {
  const VF rest = hn::Sub(splat(1.0f), s.x);
  const auto row = [&](const WordPair& pair) {
    const auto second = compare_lanes(op, reference, convert_field<kNumeric>(pair.second, channel));
    const auto first = compare_lanes(op, reference, convert_field<kNumeric>(pair.first, channel));
    return hn::Add(hn::IfThenElseZero(second, s.x), hn::IfThenElseZero(first, rest));
  };
  return mix_values(s.y, row(s.words.top), row(s.words.bottom));
}

/// Calls body(first, over_levels) for vectors with active lanes.
template <std::size_t kBytes, class Body>
HWY_INLINE void for_each_square(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                Body&& body) {
  const bool two_levels = p.plan.mip == MipFilter::kLinear && p.plan.lod_needed;
  const auto for_each_vector = [&](auto&& read) HWY_ATTR {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t first = v * hn::Lanes(DF());
      if ((request.active >> first & base::first_lanes(hn::Lanes(DF()))) != 0) read(v, first);
    }
  };
  SquareReader<FloatAxis, kBytes> nearer(p, request, state, 0);
  if (!two_levels) {
    return for_each_vector([&](std::size_t v, std::size_t first) HWY_ATTR {
      const WeighedSquare near = nearer.read(v);
      body(first, [&](auto&& average) { return average(near); });
    });
  }
  SquareReader<FloatAxis, kBytes> farther(p, request, state, 1);
  for_each_vector([&](std::size_t v, std::size_t first) HWY_ATTR {
    const WeighedSquare near = nearer.read(v), far = farther.read(v);
    const VF fraction = hn::Load(DF(), state.fraction.lane + first);
    body(first, [&](auto&& average) { return mix_values(fraction, average(near), average(far)); });
  });
}

template <Numeric kNumeric, std::size_t kBytes>
HWY_NOINLINE void sample_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                               const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  for_each_square<kBytes>(p, request, state, [&](std::size_t first, auto&& over_levels) {
    VF value[6];
    const auto component = [&](std::size_t c) {
      return over_levels([&](const WeighedSquare& s) { return average_component<kNumeric>(*view.format, c, s); });
    };
    const Components wanted = wanted_components(view, result);
    for (std::size_t c = 0; c < 4; ++c) {
      if (wanted >> c & 1) value[c] = component(c);
    }
    value[4] = splat(0.0f);
    value[5] = splat(1.0f);
    for (std::size_t c = 0; c < 4; ++c) {
      if (result[c] != nullptr) store_lanes(as_unsigned(value[view.swizzle[c]]), request.active, first, *result[c]);
    }
  });
}

template <Numeric kNumeric, std::size_t kBytes>
HWY_NOINLINE void compare_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  const Channel channel = view.format->channel[0];
  const VkCompareOp op = p.plan.sampler->compare_op;
  for_each_square<kBytes>(p, request, state, [&](std::size_t first, auto&& over_levels) {
    const VF reference = load_reference<kNumeric>(request, first);
    const VF average =
        over_levels([&](const WeighedSquare& s) { return average_comparison<kNumeric>(channel, op, reference, s); });
    for (std::size_t c = 0; c < 4; ++c) {
      if (result[c] == nullptr) continue;
      const std::uint8_t source = view.swizzle[c];
      const VF value = source == 0 ? average : splat(source == 3 || source == 5 ? 1.0f : 0.0f);
      store_lanes(as_unsigned(value), request.active, first, *result[c]);
    }
  });
}

template <std::size_t kBytes>
inline void sample_words_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                  const SampleResult& result) {
  by_averaged_numeric(p.plan.view->format->channel[0].numeric,
                      [&]<Numeric kNumeric>() { sample_words<kNumeric, kBytes>(p, request, state, result); });
}

template <std::size_t kBytes>
inline void compare_words_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                   const SampleResult& result) {
  return p.plan.view->format->channel[0].numeric == Numeric::kUnorm
             ? compare_words<Numeric::kUnorm, kBytes>(p, request, state, result)
             : compare_words<Numeric::kSfloat, kBytes>(p, request, state, result);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
