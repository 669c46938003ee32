// Row codecs of fields by SIMD; bits equal texel_decoder's, texel_encoder's and fetch_bytes's.
#include "texel/codec/field_rows.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/codec/field_rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/four_bytes-inl.h"
#include "texel/codec/half-inl.h"
#include "texel/codec/widen-inl.h"
#include "texel/sampler/wave/fetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

const hn::Rebind<std::uint8_t, DU> kBytes;
const hn::Rebind<std::uint16_t, DU> kHalves;

/// The words of a vector of texels that follow one another.
HWY_INLINE void load_texels(std::size_t bytes, const std::byte* from, VU word[4]) {
  const auto* words = reinterpret_cast<const std::uint32_t*>(from);
  switch (bytes) {
    case 1:
      word[0] = hn::PromoteTo(DU(), hn::LoadU(kBytes, reinterpret_cast<const std::uint8_t*>(from)));
      return;
    case 2:
      word[0] = hn::PromoteTo(DU(), hn::LoadU(kHalves, reinterpret_cast<const std::uint16_t*>(from)));
      return;
    case 4:
      word[0] = hn::LoadU(DU(), words);
      return;
    case 8:
      return hn::LoadInterleaved2(DU(), words, word[0], word[1]);
    default:
      return hn::LoadInterleaved4(DU(), words, word[0], word[1], word[2], word[3]);
  }
}

HWY_INLINE void store_texels(std::size_t bytes, const VU word[4], std::byte* to) {
  auto* words = reinterpret_cast<std::uint32_t*>(to);
  switch (bytes) {
    case 1:
      return hn::StoreU(hn::DemoteTo(kBytes, hn::BitCast(DI(), word[0])), kBytes, reinterpret_cast<std::uint8_t*>(to));
    case 2:
      return hn::StoreU(hn::DemoteTo(kHalves, hn::BitCast(DI(), word[0])), kHalves,
                        reinterpret_cast<std::uint16_t*>(to));
    case 4:
      return hn::StoreU(word[0], DU(), words);
    case 8:
      return hn::StoreInterleaved2(word[0], word[1], DU(), words);
    default:
      return hn::StoreInterleaved4(word[0], word[1], word[2], word[3], DU(), words);
  }
}

template <Numeric kNumeric>
std::size_t decode_fields(const FormatDesc& format, const std::byte* from, std::size_t count, Texel* to) {
  const std::uint32_t one = format.is_integer() ? 1u : 0x3f800000u;
  std::size_t i = 0;
  for (; i + hn::Lanes(DU()) <= count; i += hn::Lanes(DU())) {
    VU word[4], value[4];
    load_texels(format.block_bytes, from + i * format.block_bytes, word);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::int8_t index = format.rgba[c];
      value[c] = hn::Set(DU(), c == 3 ? one : 0u);
      if (index < 0) continue;
      const Channel& channel = format.channel[static_cast<std::size_t>(index)];
      value[c] = as_unsigned(convert_field<kNumeric>(word[channel.offset / 32], channel));
    }
    hn::StoreInterleaved4(value[0], value[1], value[2], value[3], DU(), to[i].data());
  }
  return i;
}

std::size_t decode_any(const FormatDesc& format, const std::byte* from, std::size_t count, Texel* to) {
  return by_numeric(format.channel[0].numeric,
                    [&]<Numeric kNumeric>() { return decode_fields<kNumeric>(format, from, count, to); });
}

template <Numeric kNumeric>
HWY_INLINE VU encode_field(VU value, const Channel& channel) {
  const VF x = as_float(value), zero = splat(0.0f), one = splat(1.0f);
  const auto mask = static_cast<std::uint32_t>((1ull << channel.bits) - 1);
  if constexpr (kNumeric == Numeric::kUnorm) {
    const VF clamped = lanes_min_second(lanes_max_second(x, zero), one);
    if (channel.bits == 8) return hn::BitCast(DU(), unorm_codes(clamped));
    const VF sum = hn::Add(hn::Mul(clamped, splat(65535.0f / 65536.0f)), splat(128.0f));
    return hn::And(as_unsigned(sum), hn::Set(DU(), 0xffffu));
  } else if constexpr (kNumeric == Numeric::kUint) {
    return hn::Min(value, hn::Set(DU(), mask));
  } else if constexpr (kNumeric == Numeric::kSint) {
    const auto largest = static_cast<std::int32_t>(mask >> 1);
    const VI clamped = hn::Max(hn::Min(hn::BitCast(DI(), value), splat(largest)), splat(-largest - 1));
    return hn::And(hn::BitCast(DU(), clamped), hn::Set(DU(), mask));
  } else if constexpr (kNumeric == Numeric::kUfloat) {
    return unsigned_floats_of_floats(x, channel.bits);
  } else {
    if (channel.name == 'D') return as_unsigned(lanes_max_second(lanes_min_second(x, one), zero));
    return channel.bits == 16 ? hn::PromoteTo(DU(), halves_of_floats(x)) : value;
  }
}

template <Numeric kNumeric>
std::size_t encode_fields(const FormatDesc& format, const Texel* from, std::size_t count, std::byte* to) {
  std::size_t i = 0;
  for (; i + hn::Lanes(DU()) <= count; i += hn::Lanes(DU())) {
    VU value[4], word[4] = {hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU())};
    hn::LoadInterleaved4(DU(), from[i].data(), value[0], value[1], value[2], value[3]);
    for (std::size_t c = 0; c < format.channel_count; ++c) {
      const Channel& channel = format.channel[c];
      const VU field = encode_field<kNumeric>(value[format.component[c]], channel);
      VU& into = word[channel.offset / 32];
      into = hn::Or(into, hn::ShiftLeftSame(field, channel.offset % 32));
    }
    store_texels(format.block_bytes, word, to + i * format.block_bytes);
  }
  return i;
}

std::size_t encode_any(const FormatDesc& format, const Texel* from, std::size_t count, std::byte* to) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return encode_fields<Numeric::kUnorm>(format, from, count, to);
    case Numeric::kUint:
      return encode_fields<Numeric::kUint>(format, from, count, to);
    case Numeric::kSint:
      return encode_fields<Numeric::kSint>(format, from, count, to);
    case Numeric::kUfloat:
      return encode_fields<Numeric::kUfloat>(format, from, count, to);
    default:
      return encode_fields<Numeric::kSfloat>(format, from, count, to);
  }
}

std::size_t widen_row(const FormatDesc& format, const std::byte* from, std::size_t count, std::uint32_t* to) {
  std::size_t i = 0;
  for (; i + hn::Lanes(DU()) <= count; i += hn::Lanes(DU())) {
    VU word[4];
    load_texels(format.block_bytes, from + i * format.block_bytes, word);
    hn::StoreU(widen_fields(format, word[0]), DU(), to + i);
  }
  return i;
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(decode_any);
HWY_EXPORT(encode_any);
HWY_EXPORT(widen_row);

/// Whether load_texels and store_texels know texels of this size.
bool has_loads(const FormatDesc& format) {
  const std::uint32_t bytes = format.block_bytes;
  return format.plain && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8 || bytes == 16);
}

bool has_encoder(const Channel& channel) {
  switch (channel.numeric) {
    case Numeric::kUnorm:
      return (channel.bits == 8 || channel.bits == 16) && channel.name != 'D';
    case Numeric::kUint:
    case Numeric::kSint:
    case Numeric::kUfloat:
    case Numeric::kSfloat:
      return true;
    default:
      return false;
  }
}

bool is_shared_exponent(const FormatDesc& format) { return format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32; }

/// Whether it is stored as Texel is.
bool is_texel(const FormatDesc& format) {
  return format.block_bytes == sizeof(Texel) && format.component == std::array<std::uint8_t, 4>{0, 1, 2, 3};
}

}  // namespace

std::size_t decode_field_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out) {
  const Numeric numeric = format.channel[0].numeric;
  if (numeric == Numeric::kUscaled || numeric == Numeric::kSscaled) return 0;
  if (!has_loads(format) || is_shared_exponent(format)) return 0;
  if (is_texel(format)) {
    std::memcpy(out, blocks, count * sizeof(Texel));
    return count;
  }
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(decode_any)(format, blocks, count, out);
}

std::size_t encode_field_row(const FormatDesc& format, const Texel* texels, std::size_t count, std::byte* blocks) {
  if (!has_loads(format) || is_shared_exponent(format)) return 0;
  if (is_texel(format)) {
    std::memcpy(blocks, texels, count * sizeof(Texel));
    return count;
  }
  if (!std::all_of(format.channel.begin(), format.channel.begin() + format.channel_count, has_encoder)) return 0;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(encode_any)(format, texels, count, blocks);
}

std::size_t decode_byte_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, std::uint32_t* out) {
  if (!has_loads(format) || format.block_bytes > 4) return 0;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(widen_row)(format, blocks, count, out);
}

}  // namespace vitrine::texel

#endif
