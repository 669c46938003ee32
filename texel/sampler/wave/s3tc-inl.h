// BC1 to BC5 texels of a wave straight from their blocks (lavapipe-texture-blend.md C1): the twin of s3tc_rgtc.h.

#include "texel/block/s3tc_rgtc.h"
#include "texel/sampler/wave/fetch-inl.h"
#include "texel/sampler/wave/pairs-inl.h"
#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_S3TC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_S3TC_INL_H_
#undef VITRINE_TEXEL_WAVE_S3TC_INL_H_
#else
#define VITRINE_TEXEL_WAVE_S3TC_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

using DU16 = hn::Repartition<std::uint16_t, DU>;
using VU16 = hn::Vec<DU16>;

/// Eight bytes of a block per lane, as two words.
struct BlockLanes {
  alignas(64) std::uint32_t word[2 * base::kWaveWidth];

  HWY_INLINE void load(const std::byte* base, const IntLanes& offset) {
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
      std::memcpy(word + 2 * lane, base + offset.lane[lane], 8);
    }
  }
  HWY_INLINE void get(std::size_t first, VU& low, VU& high) const {
    const VU a = hn::Load(DU(), word + 2 * first), b = hn::Load(DU(), word + 2 * first + hn::Lanes(DU()));
    low = hn::ConcatEven(DU(), b, a);
    high = hn::ConcatOdd(DU(), b, a);
  }
};

/// Two endpoints and what lies between them, in 16-bit lanes of 8 bits.
struct ColorSteps {
  VU first, second, third, fourth;
};

HWY_INLINE VU16 as_halves(VU v) { return hn::BitCast(DU16(), v); }
HWY_INLINE VU from_halves(VU16 v) { return hn::BitCast(DU(), v); }

/// Steps of both halves: thirds where `four`, else the middle and black.
HWY_INLINE ColorSteps color_steps(VU16 e0, VU16 e1, hn::Mask<DU> four) {
  const VU16 product = hn::Mul(hn::Sub(e1, e0), hn::Set(DU16(), std::uint16_t{85}));
  const VU16 low = hn::Set(DU16(), std::uint16_t{255});
  const VU16 near = hn::And(hn::Add(e0, hn::And(hn::ShiftRight<8>(product), low)), low);
  const VU16 far = hn::And(hn::Add(e0, hn::And(hn::ShiftRight<7>(product), low)), low);
  const VU middle = from_halves(hn::AverageRound(e0, e1));
  return {from_halves(e0), from_halves(e1), hn::IfThenElse(four, from_halves(near), middle),
          hn::IfThenElseZero(four, from_halves(far))};
}

HWY_INLINE VU pick_step(const ColorSteps& steps, VU code) {
  const auto odd = hn::Ne(hn::And(code, hn::Set(DU(), 1u)), hn::Zero(DU()));
  const VU low = hn::IfThenElse(odd, steps.second, steps.first), high = hn::IfThenElse(odd, steps.fourth, steps.third);
  return hn::IfThenElse(hn::Gt(code, hn::Set(DU(), 1u)), high, low);
}

/// R, G, B, A bytes of texel `inner` of a colour block.
HWY_INLINE VU decode_color_lanes(VU ends, VU codes, VU inner, ColorBlock kind) {
  const VU c0 = hn::And(ends, hn::Set(DU(), 0xFFFFu)), c1 = hn::ShiftRight<16>(ends);
  const auto red_blue = [](VU c) {
    const VU fields = hn::And(hn::Or(hn::ShiftRight<11>(c), hn::ShiftLeft<16>(c)), hn::Set(DU(), 0x001F001Fu));
    return hn::Or(hn::ShiftLeft<3>(as_halves(fields)), hn::ShiftRight<2>(as_halves(fields)));
  };
  const auto green = [](VU c) {
    const VU field = hn::And(hn::ShiftRight<5>(c), hn::Set(DU(), 63u));
    return as_halves(hn::Or(hn::ShiftLeft<2>(field), hn::ShiftRight<4>(field)));
  };
  const VU one = hn::Set(DU(), 1u);
  const auto four = kind == ColorBlock::kFourColors ? hn::Eq(one, one) : hn::Gt(c0, c1);
  const VU code = hn::And(hn::Shr(codes, hn::Add(inner, inner)), hn::Set(DU(), 3u));
  const VU rb = pick_step(color_steps(red_blue(c0), red_blue(c1), four), code);
  const VU g = pick_step(color_steps(green(c0), green(c1), four), code);
  const VU opaque = hn::Or(hn::Or(rb, hn::ShiftLeft<8>(g)), hn::Set(DU(), 0xFF000000u));
  if (kind != ColorBlock::kRgba) return opaque;
  return hn::IfThenZeroElse(hn::AndNot(four, hn::Eq(code, hn::Set(DU(), 3u))), opaque);
}

/// Three bits of the codes in bits 16.. of a block.
HWY_INLINE VU channel_code(VU low, VU high, VU inner) {
  const auto second_half = hn::Gt(inner, hn::Set(DU(), 7u));
  const VU codes =
      hn::IfThenElse(second_half, hn::ShiftRight<8>(high), hn::Or(hn::ShiftRight<16>(low), hn::ShiftLeft<16>(high)));
  const VU index = hn::And(inner, hn::Set(DU(), 7u));
  return hn::And(hn::Shr(codes, hn::Add(index, hn::Add(index, index))), hn::Set(DU(), 7u));
}

/// One unsigned channel of BC3 to BC5, a byte.
HWY_INLINE VU decode_channel_lanes(VU low, VU high, VU inner) {
  const VU byte = hn::Set(DU(), 255u);
  const VU a0 = hn::And(low, byte), a1 = hn::And(hn::ShiftRight<8>(low), byte);
  const VU code = channel_code(low, high, inner);
  const auto sevenths = hn::Gt(a0, a1);
  const VU scale = hn::IfThenElse(sevenths, hn::Set(DU(), kSevenths), hn::Set(DU(), kFifths));
  const VU step = hn::Sub(code, hn::Set(DU(), 1u));
  const VU weight = hn::ShiftRight<6>(hn::Mul(scale, step));
  const VU product = hn::And(hn::Mul(hn::Sub(a1, a0), weight), hn::Set(DU(), 0xFFFFu));
  VU value = hn::And(hn::Add(a0, hn::ShiftRight<8>(product)), byte);
  const VU extreme = hn::IfThenElseZero(hn::Eq(code, hn::Set(DU(), 7u)), byte);
  value = hn::IfThenElse(hn::AndNot(sevenths, hn::Gt(code, hn::Set(DU(), 5u))), extreme, value);
  return hn::IfThenElse(hn::Gt(code, hn::Set(DU(), 1u)), value, hn::IfThenElse(hn::Eq(code, hn::Zero(DU())), a0, a1));
}

/// BC2: four bits per texel.
HWY_INLINE VU decode_explicit_alpha_lanes(VU low, VU high, VU inner) {
  const VU nibbles = hn::IfThenElse(hn::Gt(inner, hn::Set(DU(), 7u)), high, low);
  const VU shift = hn::ShiftLeft<2>(hn::And(inner, hn::Set(DU(), 7u)));
  return hn::Mul(hn::And(hn::Shr(nibbles, shift), hn::Set(DU(), 15u)), hn::Set(DU(), 17u));
}

/// What the halves of a block hold.
enum class S3tcKind : std::uint8_t { kNone, kRgb, kRgba, kExplicitAlpha, kAlpha, kRed, kRedGreen };

inline S3tcKind s3tc_kind(const FormatDesc& format) {
  switch (format.format) {
    case VK_FORMAT_BC1_RGB_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGB_SRGB_BLOCK:
      return S3tcKind::kRgb;
    case VK_FORMAT_BC1_RGBA_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGBA_SRGB_BLOCK:
      return S3tcKind::kRgba;
    case VK_FORMAT_BC2_UNORM_BLOCK:
    case VK_FORMAT_BC2_SRGB_BLOCK:
      return S3tcKind::kExplicitAlpha;
    case VK_FORMAT_BC3_UNORM_BLOCK:
    case VK_FORMAT_BC3_SRGB_BLOCK:
      return S3tcKind::kAlpha;
    case VK_FORMAT_BC4_UNORM_BLOCK:
      return S3tcKind::kRed;
    case VK_FORMAT_BC5_UNORM_BLOCK:
      return S3tcKind::kRedGreen;
    default:
      return S3tcKind::kNone;
  }
}

/// Whether blocks are 16 bytes.
constexpr bool has_two_parts(S3tcKind kind) { return kind > S3tcKind::kRgba && kind != S3tcKind::kRed; }

/// R, G, B, A bytes of texel `inner` of blocks whose eight bytes, or second eight, are (low, high).
template <S3tcKind kKind>
HWY_INLINE VU decode_s3tc_lanes(VU low, VU high, VU low2, VU high2, VU inner) {
  const VU opaque = hn::Set(DU(), 0xFF000000u);
  if constexpr (kKind == S3tcKind::kRgb || kKind == S3tcKind::kRgba) {
    return decode_color_lanes(low, high, inner, kKind == S3tcKind::kRgb ? ColorBlock::kRgb : ColorBlock::kRgba);
  } else if constexpr (kKind == S3tcKind::kRed) {
    return hn::Or(decode_channel_lanes(low, high, inner), opaque);
  } else if constexpr (kKind == S3tcKind::kRedGreen) {
    const VU red = decode_channel_lanes(low, high, inner), green = decode_channel_lanes(low2, high2, inner);
    return hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)), opaque);
  } else {
    const VU alpha = kKind == S3tcKind::kExplicitAlpha ? decode_explicit_alpha_lanes(low, high, inner)
                                                       : decode_channel_lanes(low, high, inner);
    const VU color = decode_color_lanes(low2, high2, inner, ColorBlock::kFourColors);
    return hn::Or(hn::AndNot(opaque, color), hn::ShiftLeft<24>(alpha));
  }
}

template <S3tcKind kKind>
HWY_NOINLINE void decode_s3tc(const std::byte* base, const IntLanes& offset, const IntLanes& inner, std::uint32_t* to) {
  constexpr bool kTwoParts = has_two_parts(kKind);
  BlockLanes part, second;
  part.load(base, offset);
  if constexpr (kTwoParts) second.load(base + 8, offset);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    const VU index = hn::BitCast(DU(), hn::Load(DI(), inner.lane + first));
    VU low, high, low2 = hn::Zero(DU()), high2 = hn::Zero(DU());
    part.get(first, low, high);
    if constexpr (kTwoParts) second.get(first, low2, high2);
    hn::Store(decode_s3tc_lanes<kKind>(low, high, low2, high2, index), DU(), to + first);
  }
}

/// The same for one vector of lanes.
template <S3tcKind kKind>
HWY_INLINE VU gather_s3tc(const std::byte* base, VI offset, VI inner) {
  const VU index = hn::BitCast(DU(), inner);
  if constexpr (has_two_parts(kKind)) {
    VU word[4];
    load_word_quads(base, offset, word);
    return decode_s3tc_lanes<kKind>(word[0], word[1], word[2], word[3], index);
  }
  const WordPair word = load_word_pairs(base, offset);
  return decode_s3tc_lanes<kKind>(word.first, word.second, hn::Zero(DU()), hn::Zero(DU()), index);
}

/// Not for kNone.
inline HWY_NOINLINE VU gather_s3tc(S3tcKind kind, const std::byte* base, VI offset, VI inner) {
  switch (kind) {
    case S3tcKind::kRgb:
      return gather_s3tc<S3tcKind::kRgb>(base, offset, inner);
    case S3tcKind::kExplicitAlpha:
      return gather_s3tc<S3tcKind::kExplicitAlpha>(base, offset, inner);
    case S3tcKind::kAlpha:
      return gather_s3tc<S3tcKind::kAlpha>(base, offset, inner);
    case S3tcKind::kRed:
      return gather_s3tc<S3tcKind::kRed>(base, offset, inner);
    case S3tcKind::kRedGreen:
      return gather_s3tc<S3tcKind::kRedGreen>(base, offset, inner);
    default:
      return gather_s3tc<S3tcKind::kRgba>(base, offset, inner);
  }
}

/// R, G, B, A bytes of a texel per lane; false, and nothing is written, for formats that other code decodes.
inline bool decode_s3tc(const FormatDesc& format, const std::byte* base, const IntLanes& offset, const IntLanes& inner,
                        std::uint32_t* to) {
  switch (s3tc_kind(format)) {
    case S3tcKind::kNone:
      return false;
    case S3tcKind::kRgb:
      decode_s3tc<S3tcKind::kRgb>(base, offset, inner, to);
      break;
    case S3tcKind::kRgba:
      decode_s3tc<S3tcKind::kRgba>(base, offset, inner, to);
      break;
    case S3tcKind::kExplicitAlpha:
      decode_s3tc<S3tcKind::kExplicitAlpha>(base, offset, inner, to);
      break;
    case S3tcKind::kAlpha:
      decode_s3tc<S3tcKind::kAlpha>(base, offset, inner, to);
      break;
    case S3tcKind::kRed:
      decode_s3tc<S3tcKind::kRed>(base, offset, inner, to);
      break;
    case S3tcKind::kRedGreen:
      decode_s3tc<S3tcKind::kRedGreen>(base, offset, inner, to);
      break;
  }
  return true;
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
