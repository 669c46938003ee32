// Averages of four texels of one word each, or of comparisons with them, in two dimensions and one level or two: vector
// by vector from coordinates to results. The bits of the general float sampler.

#include "texel/sampler/wave_square-inl.h"
#include "texel/sampler/wave_words-inl.h"

#if defined(VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#undef VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_BILINEAR_WORDS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Texels around the points of a vector of lanes, with their weights.
struct WeighedSquare {
  WordSquare words;
  VF x, y;
};

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

/// One of the view's levels: `which` of the two that a lane reads.
struct LevelReader {
  const PreparedSampler& p;
  const SampleRequest& request;
  const WaveState& state;
  int which;
  bool same_level;
  LevelLanes level{};
  SquareLevel square{};

  LevelReader(const PreparedSampler& prepared, const SampleRequest& r, const WaveState& s, int w)
      : p(prepared), request(r), state(s), which(w), same_level(level_is_uniform(prepared, r, false)) {
    if (same_level) load(0);
  }

  HWY_INLINE void load(std::size_t first) {
    level = load_level<2>(p, request, state, which, first, false);
    square = SquareLevel(level);
  }

  HWY_INLINE WeighedSquare read(std::size_t first) {
    if (!same_level) load(first);
    const TapLanes x = lanes_linear(level.axis[0], hn::LoadU(DF(), state.coord[0] + first));
    const TapLanes y = lanes_linear(level.axis[1], hn::LoadU(DF(), state.coord[1] + first));
    const SquarePlaces places{{x.first, x.second}, {y.first, y.second}};
    return {load_square(p.plan.view->base, square, places), x.weight, y.weight};
  }
};

/// Calls body(first, square) or body(first, nearer, farther, fraction) for vectors with active lanes.
template <class Body>
HWY_INLINE void for_each_square(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                Body&& body) {
  const bool two_levels = p.plan.mip == MipFilter::kLinear && p.plan.lod_needed;
  LevelReader nearer(p, request, state, 0);
  LevelReader farther(p, request, state, two_levels ? 1 : 0);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if ((request.active >> first & base::first_lanes(hn::Lanes(DF()))) == 0) continue;
    const WeighedSquare near = nearer.read(first);
    if (!two_levels) {
      body(first, [&](auto&& average) { return average(near); });
    } else {
      const WeighedSquare far = farther.read(first);
      const VF fraction = hn::Load(DF(), state.fraction.lane + first);
      body(first, [&](auto&& average) { return mix_values(fraction, average(near), average(far)); });
    }
  }
}

template <Numeric kNumeric>
HWY_NOINLINE void sample_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                               const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  for_each_square(p, request, state, [&](std::size_t first, auto&& over_levels) {
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

template <Numeric kNumeric>
HWY_NOINLINE void compare_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  const Channel channel = view.format->channel[0];
  const VkCompareOp op = p.plan.sampler->compare_op;
  for_each_square(p, request, state, [&](std::size_t first, auto&& over_levels) {
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

inline void sample_words_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                  const SampleResult& result) {
  switch (p.plan.view->format->channel[0].numeric) {
    case Numeric::kUnorm:
      return sample_words<Numeric::kUnorm>(p, request, state, result);
    case Numeric::kSnorm:
      return sample_words<Numeric::kSnorm>(p, request, state, result);
    case Numeric::kSrgb:
      return sample_words<Numeric::kSrgb>(p, request, state, result);
    case Numeric::kUfloat:
      return sample_words<Numeric::kUfloat>(p, request, state, result);
    default:
      return sample_words<Numeric::kSfloat>(p, request, state, result);
  }
}

inline void compare_words_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                   const SampleResult& result) {
  return p.plan.view->format->channel[0].numeric == Numeric::kUnorm
             ? compare_words<Numeric::kUnorm>(p, request, state, result)
             : compare_words<Numeric::kSfloat>(p, request, state, result);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
