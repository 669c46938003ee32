// Gathers texels of a vector of lanes and converts them to floats: the twin of decode_row for formats whose texels are
// fields of at most 32 bits in up to four words.

#include <array>

#include "texel/codec/srgb-inl.h"
#include "texel/sampler/wave/address-inl.h"

#if defined(VITRINE_TEXEL_WAVE_FETCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_FETCH_INL_H_
#undef VITRINE_TEXEL_WAVE_FETCH_INL_H_
#else
#define VITRINE_TEXEL_WAVE_FETCH_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// 32-bit words at byte offsets from `base`. Layouts have room for the bytes that narrower texels do not own.
HWY_INLINE VU gather_words(const std::byte* base, VI offset) {
  return hn::BitCast(DU(), hn::GatherOffset(DI(), reinterpret_cast<const std::int32_t*>(base), offset));
}

#if HWY_TARGET <= HWY_AVX3
/// As lanes_half_to_float; VCVTPH2PS quiets signalling NaN, which the general code keeps.
HWY_INLINE VF half_field_to_float(VU half) {
  const VU magnitude = hn::And(half, hn::Set(DU(), 0x7fffu));
  const VF value{_mm512_cvtph_ps(_mm512_cvtepi32_epi16(half.raw))};
  const VU kept = hn::AndNot(hn::ShiftLeft<13>(hn::Set(DU(), 0x200u)), as_unsigned(value));
  const VU quiet = hn::ShiftLeft<13>(hn::And(half, hn::Set(DU(), 0x200u)));
  return hn::IfThenElse(hn::RebindMask(DF(), hn::Gt(magnitude, hn::Set(DU(), 0x7c00u))), as_float(hn::Or(kept, quiet)),
                        value);
}
#else
HWY_INLINE VF half_field_to_float(VU half) { return lanes_half_to_float(half); }
#endif

/// 1 / (2^bits - 1): a division for every vector would take longer than the rest of the conversion.
inline constexpr std::array<float, 33> kReciprocal = [] {
  std::array<float, 33> table{};
  for (std::uint32_t bits = 1; bits < table.size(); ++bits)
    table[bits] = static_cast<float>(1.0 / static_cast<double>((1ull << bits) - 1));
  return table;
}();

/// How a channel's bits become a value.
template <Numeric kNumeric>
HWY_INLINE VF convert_field(VU word, const Channel& channel) {
  const std::uint32_t shift = channel.offset & 31u;
  const std::uint32_t bits = channel.bits;
  const auto mask = static_cast<std::uint32_t>((1ull << bits) - 1);
  const VU field = hn::And(hn::ShiftRightSame(word, static_cast<int>(shift)), hn::Set(DU(), mask));
  if constexpr (kNumeric == Numeric::kUnorm) {
    return hn::Mul(lanes_int_to_float(hn::BitCast(DI(), field)), splat(kReciprocal[bits]));
  } else if constexpr (kNumeric == Numeric::kSnorm) {
    const int unused = static_cast<int>(32 - bits);
    const VI value = hn::ShiftRightSame(hn::ShiftLeftSame(hn::BitCast(DI(), field), unused), unused);
    return lanes_max_second(hn::Mul(lanes_int_to_float(value), splat(kReciprocal[bits - 1])), splat(-1.0f));
  } else if constexpr (kNumeric == Numeric::kSrgb) {
    if (channel.name == 'A') return hn::Mul(lanes_int_to_float(hn::BitCast(DI(), field)), splat(1.0f / 255.0f));
    return srgb_to_linear(hn::BitCast(DI(), field));
  } else if constexpr (kNumeric == Numeric::kUfloat) {
    return half_field_to_float(hn::ShiftLeftSame(field, static_cast<int>(15 - bits)));
  } else if constexpr (kNumeric == Numeric::kUint) {
    return as_float(field);
  } else if constexpr (kNumeric == Numeric::kSint) {
    const int unused = static_cast<int>(32 - bits);
    const VI value = hn::ShiftRightSame(hn::ShiftLeftSame(hn::BitCast(DI(), field), unused), unused);
    return as_float(hn::BitCast(DU(), value));
  } else {
    return bits == 16 ? half_field_to_float(field) : as_float(word);
  }
}

/// What body<numeric>() returns. Scaled formats, which convert_field does not know, count as kSfloat.
template <class Body>
HWY_INLINE auto by_numeric(Numeric numeric, Body&& body) {
  switch (numeric) {
    case Numeric::kUnorm:
      return body.template operator()<Numeric::kUnorm>();
    case Numeric::kSnorm:
      return body.template operator()<Numeric::kSnorm>();
    case Numeric::kUint:
      return body.template operator()<Numeric::kUint>();
    case Numeric::kSint:
      return body.template operator()<Numeric::kSint>();
    case Numeric::kUfloat:
      return body.template operator()<Numeric::kUfloat>();
    case Numeric::kSrgb:
      return body.template operator()<Numeric::kSrgb>();
    default:
      return body.template operator()<Numeric::kSfloat>();
  }
}

/// The same for numeric formats that filters average: not those of integers.
template <class Body>
HWY_INLINE auto by_averaged_numeric(Numeric numeric, Body&& body) {
  switch (numeric) {
    case Numeric::kUnorm:
      return body.template operator()<Numeric::kUnorm>();
    case Numeric::kSnorm:
      return body.template operator()<Numeric::kSnorm>();
    case Numeric::kUfloat:
      return body.template operator()<Numeric::kUfloat>();
    case Numeric::kSrgb:
      return body.template operator()<Numeric::kSrgb>();
    default:
      return body.template operator()<Numeric::kSfloat>();
  }
}

struct TexelLanes {
  VF r, g, b, a;
};

template <Numeric kNumeric>
HWY_INLINE VF fetch_channel(const FormatDesc& format, std::int8_t index, const std::byte* base, VI offset, VU first,
                            VF missing) {
  if (index < 0) return missing;
  const Channel& channel = format.channel[static_cast<std::size_t>(index)];
  const std::int32_t word = channel.offset / 32;
  const VU bits = word == 0 ? first : gather_words(base, hn::Add(offset, splat(word * 4)));
  return convert_field<kNumeric>(bits, channel);
}

template <Numeric kNumeric>
HWY_INLINE TexelLanes fetch_lanes(const FormatDesc& format, const std::byte* base, VI offset) {
  const VU first = gather_words(base, offset);
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  const VF zero = splat(0.0f);
  const VF one = kInteger ? as_float(hn::Set(DU(), 1u)) : splat(1.0f);
  return {fetch_channel<kNumeric>(format, format.rgba[0], base, offset, first, zero),
          fetch_channel<kNumeric>(format, format.rgba[1], base, offset, first, zero),
          fetch_channel<kNumeric>(format, format.rgba[2], base, offset, first, zero),
          fetch_channel<kNumeric>(format, format.rgba[3], base, offset, first, one)};
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
