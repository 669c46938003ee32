// Texels of one word each without a filter, in two dimensions and one level: the nearest of each lane, and gathers;
// vector by vector from coordinates to results. The bits of the general float sampler.

#include "texel/sampler/wave_bilinear_words-inl.h"

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

  void set(const AxisLanes& a) { axis = &a; }
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

inline HWY_NOINLINE VF convert_channel(VU word, const Channel& channel) {
  switch (channel.numeric) {
    case Numeric::kUnorm:
      return convert_field<Numeric::kUnorm>(word, channel);
    case Numeric::kSnorm:
      return convert_field<Numeric::kSnorm>(word, channel);
    case Numeric::kUscaled:
      return convert_field<Numeric::kUscaled>(word, channel);
    case Numeric::kSscaled:
      return convert_field<Numeric::kSscaled>(word, channel);
    case Numeric::kUint:
      return convert_field<Numeric::kUint>(word, channel);
    case Numeric::kSint:
      return convert_field<Numeric::kSint>(word, channel);
    case Numeric::kUfloat:
      return convert_field<Numeric::kUfloat>(word, channel);
    case Numeric::kSrgb:
      return convert_field<Numeric::kSrgb>(word, channel);
    default:
      return convert_field<Numeric::kSfloat>(word, channel);
  }
}

/// A channel of words, or how a reference compares with it.
struct WordValue {
  const SampleRequest& request;
  VkCompareOp op;
  Channel channel;

  WordValue(const PreparedSampler& p, const SampleRequest& r, std::int8_t index)
      : request(r),
        op(p.plan.sampler->compare_op),
        channel(p.plan.view->format->channel[static_cast<std::size_t>(index)]) {}

  /// The depth to compare with, clamped where texels are fixed-point.
  HWY_INLINE VF reference(std::size_t first) const {
    if (request.dref == nullptr) return splat(0.0f);
    return channel.numeric == Numeric::kSfloat ? load_reference<Numeric::kSfloat>(request, first)
                                               : load_reference<Numeric::kUnorm>(request, first);
  }
  HWY_INLINE VU operator()(VU word, VF reference) const {
    const VF value = convert_channel(word, channel);
    if (request.dref == nullptr) return as_unsigned(value);
    return as_unsigned(hn::IfThenElseZero(compare_lanes(op, reference, value), splat(1.0f)));
  }
};

HWY_INLINE bool vector_is_active(const SampleRequest& request, std::size_t first) {
  return (request.active >> first & base::first_lanes(hn::Lanes(DF()))) != 0;
}

inline HWY_NOINLINE void sample_words_nearest(const PreparedSampler& p, const SampleRequest& request,
                                              const WaveState& state, const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  const FormatDesc& format = *view.format;
  const bool compare = request.dref != nullptr;
  const std::uint32_t one = format.is_integer() ? 1u : 0x3f800000u;
  SquareReader<NearestFloatAxis, false> reader(p, request, state, 0);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (!vector_is_active(request, first)) continue;
    const VU word = reader.read_first(v);
    const VF reference = WordValue(p, request, 0).reference(first);
    for (std::size_t c = 0; c < 4; ++c) {
      if (result[c] == nullptr) continue;
      const std::uint8_t source = view.swizzle[c];
      const bool exists = source < 4 && (compare ? source == 0 : format.rgba[source] >= 0);
      VU value = hn::Set(DU(), source == 3 || source == 5 ? one : 0u);
      if (exists) value = WordValue(p, request, compare ? std::int8_t{0} : format.rgba[source])(word, reference);
      store_lanes(value, request.active, first, *result[c]);
    }
  }
}

/// Which channel a gather reads; -1: a constant.
inline std::int8_t gathered_channel(const ImageView& view, const SampleRequest& request) {
  if (request.dref != nullptr) return 0;
  const std::uint8_t source = view.swizzle[request.gather_component & 3];
  return source < 4 ? view.format->rgba[source] : std::int8_t{-1};
}

/// `words`: in the order of the results.
HWY_INLINE void put_gathered(const WordValue& value, const VU words[4], VF reference, std::size_t first,
                             const SampleResult& result) {
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr) store_lanes(value(words[c], reference), value.request.active, first, *result[c]);
  }
}

/// The four texels around each point.
inline HWY_NOINLINE void gather_words(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                      const SampleResult& result) {
  const WordValue value(p, request, gathered_channel(*p.plan.view, request));
  SquareReader<GatherAxis, true> reader(p, request, state, 0);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (!vector_is_active(request, first)) continue;
    const WordSquare square = reader.read(v).words;
    const VU words[4] = {square.bottom.first, square.bottom.second, square.top.second, square.top.first};
    put_gathered(value, words, value.reference(first), first, result);
  }
}

/// A texel for each of four offsets.
inline HWY_NOINLINE void gather_moved_words(const PreparedSampler& p, const SampleRequest& request,
                                            const WaveState& state, const SampleResult& result) {
  using Reader = SquareReader<GatherAxis, false>;
  const WordValue value(p, request, gathered_channel(*p.plan.view, request));
  const auto& offsets = *request.gather_offsets;
  Reader readers[4] = {{p, request, state, 0, &offsets[0]},
                       {p, request, state, 0, &offsets[1]},
                       {p, request, state, 0, &offsets[2]},
                       {p, request, state, 0, &offsets[3]}};
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (!vector_is_active(request, first)) continue;
    VU words[4];
    for (std::size_t i = 0; i < 4; ++i) words[i] = readers[i].read_first(v);
    put_gathered(value, words, value.reference(first), first, result);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
