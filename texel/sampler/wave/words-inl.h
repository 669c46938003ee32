// Averages of four or eight texels of at most one word each, and of comparisons with them, vector by vector. The bits
// of the general float sampler.

#include "texel/sampler/wave/fetch-inl.h"
#include "texel/sampler/wave/pairs-inl.h"
#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_WORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_WORDS_INL_H_
#undef VITRINE_TEXEL_WAVE_WORDS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_WORDS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

HWY_INLINE hn::Mask<DF> compare_lanes(VkCompareOp op, VF reference, VF texel) {
  switch (op) {
    case VK_COMPARE_OP_LESS:
      return hn::Lt(reference, texel);
    case VK_COMPARE_OP_EQUAL:
      return hn::Eq(reference, texel);
    case VK_COMPARE_OP_LESS_OR_EQUAL:
      return hn::Le(reference, texel);
    case VK_COMPARE_OP_GREATER:
      return hn::Gt(reference, texel);
    case VK_COMPARE_OP_NOT_EQUAL:
      return hn::Not(hn::Eq(reference, texel));
    case VK_COMPARE_OP_GREATER_OR_EQUAL:
      return hn::Ge(reference, texel);
    case VK_COMPARE_OP_ALWAYS:
      return hn::RebindMask(DF(), hn::Eq(hn::Zero(DU()), hn::Zero(DU())));
    default:
      return hn::RebindMask(DF(), hn::Ne(hn::Zero(DU()), hn::Zero(DU())));
  }
}

/// Texels to average: tap k is the second of x if bit 0 is set, of y by bit 1, of z by bit 2.
struct WordTaps {
  const ImageView& view;
  const TexelPlaces* place;
  const FloatLanes* weight;  ///< of each axis
  bool neighbours = false;   ///< every second texel in x follows the first in memory
};

template <std::uint32_t kTaps>
HWY_INLINE void load_taps(const WordTaps& taps, std::size_t first, VU words[kTaps]) {
  const std::byte* const base = taps.view.base;
  const auto offset = [&](std::uint32_t k) { return hn::Load(DI(), taps.place[k].offset.lane + first); };
  for (std::uint32_t k = 0; k < kTaps; k += 2) {
    if (taps.neighbours && taps.view.format->block_bytes == 4) {
      const WordPair pair = load_word_pairs(base, offset(k));
      words[k] = pair.first;
      words[k + 1] = pair.second;
    } else {
      words[k] = load_narrow_words(base, offset(k), taps.view.format->block_bytes);
      words[k + 1] = load_narrow_words(base, offset(k + 1), taps.view.format->block_bytes);
    }
  }
}

/// Averages along y and z of values already averaged along x.
template <std::uint32_t kTaps>
HWY_INLINE VF average_rows(const WordTaps& taps, std::size_t first, const VF row[kTaps / 2]) {
  const auto lerp = [](VF w, VF a, VF b) { return lanes_fma(w, hn::Sub(b, a), a); };
  const VF y = hn::Load(DF(), taps.weight[1].lane + first);
  const VF near = lerp(y, row[0], row[1]);
  if constexpr (kTaps == 4) return near;
  return lerp(hn::Load(DF(), taps.weight[2].lane + first), near, lerp(y, row[kTaps / 2 - 2], row[kTaps / 2 - 1]));
}

template <Numeric kNumeric, std::uint32_t kTaps>
HWY_NOINLINE void average_words(const WordTaps& taps, Components wanted, WaveTexels& out) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  static_assert(!kInteger);
  const FormatDesc& format = *taps.view.format;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    VU words[kTaps];
    load_taps<kTaps>(taps, first, words);
    const VF x = hn::Load(DF(), taps.weight[0].lane + first);
    for (std::size_t c = 0; c < 4; ++c) {
      if ((wanted >> c & 1) == 0) continue;
      const std::int8_t index = format.rgba[c];
      const Channel channel = format.channel[static_cast<std::size_t>(index < 0 ? 0 : index)];
      const VF missing = splat(c == 3 ? 1.0f : 0.0f);  // averaged too: a weight may be NaN
      VF row[kTaps / 2];
      for (std::uint32_t k = 0; k < kTaps; k += 2) {
        const VF a = index < 0 ? missing : convert_field<kNumeric>(words[k], channel);
        const VF b = index < 0 ? missing : convert_field<kNumeric>(words[k + 1], channel);
        row[k / 2] = lanes_fma(x, hn::Sub(b, a), a);
      }
      hn::Store(average_rows<kTaps>(taps, first, row), DF(), out.c[c].lane + first);
    }
  }
}

/// Component 0: the average of comparisons, along x weighted by selection.
template <Numeric kNumeric, std::uint32_t kTaps>
HWY_NOINLINE void average_comparisons(const WordTaps& taps, VkCompareOp op, const FloatLanes& reference,
                                      WaveTexels& out) {
  const Channel channel = taps.view.format->channel[0];
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    VU words[kTaps];
    load_taps<kTaps>(taps, first, words);
    const VF x = hn::Load(DF(), taps.weight[0].lane + first), rest = hn::Sub(splat(1.0f), x);
    const VF ref = hn::Load(DF(), reference.lane + first);
    const auto holds = [&](std::uint32_t k) {
      return compare_lanes(op, ref, convert_field<kNumeric>(words[k], channel));
    };
    VF row[kTaps / 2];
    for (std::uint32_t k = 0; k < kTaps; k += 2) {
      row[k / 2] = hn::Add(hn::IfThenElseZero(holds(k + 1), x), hn::IfThenElseZero(holds(k), rest));
    }
    hn::Store(average_rows<kTaps>(taps, first, row), DF(), out.c[0].lane + first);
  }
}

template <std::uint32_t kTaps>
inline void average_words(const WordTaps& taps, Components wanted, WaveTexels& out) {
  by_averaged_numeric(taps.view.format->channel[0].numeric,
                      [&]<Numeric kNumeric>() { average_words<kNumeric, kTaps>(taps, wanted, out); });
}

template <std::uint32_t kTaps>
inline void average_comparisons(const WordTaps& taps, VkCompareOp op, const FloatLanes& reference, WaveTexels& out) {
  return taps.view.format->channel[0].numeric == Numeric::kUnorm
             ? average_comparisons<Numeric::kUnorm, kTaps>(taps, op, reference, out)
             : average_comparisons<Numeric::kSfloat, kTaps>(taps, op, reference, out);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
