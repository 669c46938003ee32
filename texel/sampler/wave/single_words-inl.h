// Texels of one word each without a filter, in two dimensions and one level: the nearest of each lane, and gathers;
// vector by vector from coordinates to results. The bits of the general float sampler.

#include "texel/sampler/wave/bilinear_words-inl.h"
#include "texel/sampler/wave/points-inl.h"

#if defined(VITRINE_TEXEL_WAVE_SINGLE_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_SINGLE_WORDS_INL_H_
#undef VITRINE_TEXEL_WAVE_SINGLE_WORDS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_SINGLE_WORDS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// One axis of a level for nearest texels.
struct NearestFloatAxis {
  const AxisLanes* axis = nullptr;

  HWY_INLINE TapLanes taps(VF s) const {
    const VI i = lanes_nearest(*axis, s);
    return {i, i, splat(0.0f)};
  }
};

/// One axis of a level for gathers.
struct GatherAxis {
  const AxisLanes* axis = nullptr;

  void set(const AxisLanes& a) { axis = &a; }
  HWY_INLINE TapLanes taps(VF s) const { return lanes_gather(*axis, s); }
};

/// What texels are compared with, clamped where they are fixed-point. A copy: results may go to the request's
/// registers.
struct WordReference {
  bool compare;
  VkCompareOp op;
  FloatLanes lanes;  ///< only with `compare`

  WordReference(const PreparedSampler& p, const SampleRequest& request)
      : compare(request.dref != nullptr), op(p.plan.sampler->compare_op) {
    const bool floats = p.plan.view->format->channel[0].numeric == Numeric::kSfloat;
    for (std::size_t first = 0; compare && first < base::kWaveWidth; first += hn::Lanes(DF())) {
      const VF reference =
          floats ? load_reference<Numeric::kSfloat>(request, first) : load_reference<Numeric::kUnorm>(request, first);
      hn::Store(reference, DF(), lanes.lane + first);
    }
  }
};

template <Numeric kNumeric>
HWY_INLINE void put_channel(const WordLanes& words, const Channel& of, const WordReference& reference,
                            const SampleRequest& request, base::WaveRegister& to) {
  const Channel channel = of;  // which no store below can change
  VF value[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) {
    value[v] = convert_field<kNumeric>(hn::Load(DU(), words.lane + v * hn::Lanes(DF())), channel);
  }
  if (reference.compare) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const VF ref = hn::Load(DF(), reference.lanes.lane + v * hn::Lanes(DF()));
      value[v] = hn::IfThenElseZero(compare_lanes(reference.op, ref, value[v]), splat(1.0f));
    }
  }
  const base::LaneMask active = request.active;
  if (active == base::kAllLanes) {
    for (std::size_t v = 0; v < kVectors; ++v) hn::Store(as_unsigned(value[v]), DU(), to.lane + v * hn::Lanes(DF()));
    return;
  }
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    store_lanes(as_unsigned(value[v]), active, first, to);
  }
}

/// A channel of a wave of words, or how it compares.
inline HWY_NOINLINE void put_words(const WordLanes& words, const Channel& channel, const WordReference& reference,
                                   const SampleRequest& request, base::WaveRegister& to) {
  by_numeric(channel.numeric,
             [&]<Numeric kNumeric>() { put_channel<kNumeric>(words, channel, reference, request, to); });
}

inline void put_constant(std::uint32_t value, base::LaneMask active, base::WaveRegister& to) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU()))
    store_lanes(hn::Set(DU(), value), active, first, to);
}

/// Calls body(vector, first lane) for vectors with active lanes.
template <class Body>
HWY_INLINE void for_each_active(const SampleRequest& request, Body&& body) {
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (vector_is_active(request, first)) body(v, first);
  }
}

/// Two dimensions, the nearest texel of one level.
inline HWY_NOINLINE void sample_words_nearest(const PreparedSampler& p, const SampleRequest& request,
                                              const WaveState& state, const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  const FormatDesc& format = *view.format;
  const WordReference reference(p, request);
  const std::uint32_t one = format.is_integer() ? 1u : 0x3f800000u;
  WordLanes words;
  PointReader<NearestFloatRule>(p, request, state).read(words);
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    const std::uint8_t source = view.swizzle[c];
    std::int8_t index = source < 4 ? format.rgba[source] : std::int8_t{-1};
    if (reference.compare && source != 0) index = -1;
    if (index < 0) {
      put_constant(source == 3 || source == 5 ? one : 0u, request.active, *result[c]);
    } else {
      put_words(words, format.channel[static_cast<std::size_t>(index)], reference, request, *result[c]);
    }
  }
}

/// Which channel a gather reads; -1: a constant.
inline std::int8_t gathered_channel(const ImageView& view, const SampleRequest& request) {
  if (request.dref != nullptr) return 0;
  const std::uint8_t source = view.swizzle[request.gather_component & 3];
  return source < 4 ? view.format->rgba[source] : std::int8_t{-1};
}

/// The four texels around each point, in the order of the results.
inline HWY_NOINLINE void read_squares(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                      WordLanes words[4]) {
  SquareReader<GatherAxis> reader(p, request, state, 0);
  for_each_active(request, [&](std::size_t v, std::size_t first) HWY_ATTR {
    const WordSquare square = reader.read(v).words;
    hn::Store(square.bottom.first, DU(), words[0].lane + first);
    hn::Store(square.bottom.second, DU(), words[1].lane + first);
    hn::Store(square.top.second, DU(), words[2].lane + first);
    hn::Store(square.top.first, DU(), words[3].lane + first);
  });
}

/// The texels around each point, or one for each of four offsets.
inline HWY_NOINLINE void gather_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                      const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  const WordReference reference(p, request);
  WordLanes words[4];
  if (request.gather_offsets == nullptr) {
    read_squares(p, request, state, words);
  } else {
    PointReader<GatherRule> reader(p, request, state);
    for (std::size_t i = 0; i < 4; ++i) {
      if (result[i] != nullptr) reader.read_moved((*request.gather_offsets)[i], words[i]);
    }
  }
  const Channel& channel = view.format->channel[static_cast<std::size_t>(gathered_channel(view, request))];
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr) put_words(words[c], channel, reference, request, *result[c]);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
