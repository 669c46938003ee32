// Results from the words of texels (lavapipe-texture-blend.md A10), and words from what is stored (part B).
#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/fields.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/half-inl.h"
#include "texel/sampler/wave/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

/// Stored for active lanes only.
template <Numeric kNumeric>
HWY_NOINLINE void convert(const PreparedFetch& prepared, base::LaneMask active, const WordLanes words[4]) {
  for (std::size_t i = 0; i < prepared.field_count; ++i) {
    const TexelField<base::WaveRegister> field = prepared.field[i];
    const WordLanes& from = words[field.word];
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
      const VF value = convert_field<kNumeric>(hn::Load(DU(), from.lane + first), field.channel);
      store_lanes(as_unsigned(value), active, first, *field.values);
    }
  }
  for (std::size_t i = 0; i < prepared.constant_count; ++i) {
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU()))
      store_lanes(hn::Set(DU(), prepared.constant[i]), active, first, *prepared.constant_to[i]);
  }
}

/// A channel's bits, as the encoder of Encoding::kStore gives them.
template <Numeric kNumeric>
HWY_INLINE VU encode_field(VU value, std::uint32_t bits) {
  const VF x = as_float(value), one = splat(1.0f);
  const auto mask = static_cast<std::uint32_t>((1ull << bits) - 1);
  const auto largest = static_cast<std::int32_t>(mask >> 1);
  if constexpr (kNumeric == Numeric::kUnorm) {
    // The addition leaves the integer in the low bits of the mantissa.
    const float scale = static_cast<float>(static_cast<double>(mask) / static_cast<double>(1u << bits));
    const VF clamped = lanes_max_second(lanes_min_second(x, one), splat(0.0f));
    const VF sum = hn::Add(hn::Mul(clamped, splat(scale)), splat(static_cast<float>(1u << (23 - bits))));
    return hn::And(as_unsigned(sum), hn::Set(DU(), mask));
  } else if constexpr (kNumeric == Numeric::kSnorm) {
    const VF clamped = lanes_max_second(lanes_min_second(x, one), splat(-1.0f));
    const VI rounded = lanes_round_to_int(hn::Mul(clamped, splat(static_cast<float>(largest))));
    return hn::And(hn::BitCast(DU(), rounded), hn::Set(DU(), mask));
  } else if constexpr (kNumeric == Numeric::kUint) {
    return hn::Min(value, hn::Set(DU(), mask));
  } else if constexpr (kNumeric == Numeric::kSint) {
    const VI clamped = hn::Max(hn::Min(hn::BitCast(DI(), value), splat(largest)), splat(-largest - 1));
    return hn::And(hn::BitCast(DU(), clamped), hn::Set(DU(), mask));
  } else {
    return bits == 16 ? hn::PromoteTo(DU(), halves_of_floats(x)) : value;
  }
}

/// The words of texels of a whole wave.
template <Numeric kNumeric>
HWY_NOINLINE void encode(const PreparedStore& prepared, WordLanes words[4]) {
  for (std::size_t i = 0; i < prepared.word_count; ++i) {
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU()))
      hn::Store(hn::Zero(DU()), DU(), words[i].lane + first);
  }
  for (std::size_t i = 0; i < prepared.field_count; ++i) {
    const TexelField<const base::WaveRegister> field = prepared.field[i];
    const int shift = field.channel.offset;
    WordLanes& word = words[field.word];
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
      const VU value = encode_field<kNumeric>(hn::Load(DU(), field.values->lane + first), field.channel.bits);
      const VU others = hn::Load(DU(), word.lane + first);
      hn::Store(hn::Or(others, hn::ShiftLeftSame(value, shift)), DU(), word.lane + first);
    }
  }
}

PreparedFetch::Convert convert_of(Numeric numeric) {
  return by_numeric(numeric, []<Numeric kNumeric>() -> PreparedFetch::Convert { return convert<kNumeric>; });
}

PreparedStore::Encode encode_of(Numeric numeric) {
  switch (numeric) {
    case Numeric::kUnorm:
      return encode<Numeric::kUnorm>;
    case Numeric::kSnorm:
      return encode<Numeric::kSnorm>;
    case Numeric::kUint:
      return encode<Numeric::kUint>;
    case Numeric::kSint:
      return encode<Numeric::kSint>;
    default:
      return encode<Numeric::kSfloat>;
  }
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(convert_of);
HWY_EXPORT(encode_of);

/// Whether vectors convert its texels. Those of unsigned floats include shared exponents.
bool has_vector_conversion(Numeric numeric) {
  return numeric != Numeric::kUfloat && numeric != Numeric::kUscaled && numeric != Numeric::kSscaled;
}

/// Whether encode_field encodes its channels.
bool has_vector_encoder(const Channel& channel) {
  switch (channel.numeric) {
    case Numeric::kUnorm:
    case Numeric::kSnorm:
      return channel.bits <= 16;
    case Numeric::kUint:
    case Numeric::kSint:
    case Numeric::kSfloat:
      return true;
    default:
      return false;
  }
}

}  // namespace

PreparedFetch::Convert field_conversion(const FormatDesc& format) {
  const Numeric numeric = format.channel[0].numeric;
  if (!format.plain || !has_vector_conversion(numeric)) return nullptr;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(convert_of)(numeric);
}

PreparedStore::Encode field_encoder(const FormatDesc& format) {
  if (!format.plain || !has_vector_encoder(format.channel[0])) return nullptr;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(encode_of)(format.channel[0].numeric);
}

}  // namespace vitrine::texel

#endif
