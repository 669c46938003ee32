// Writes texels by integer coordinates with SIMD (lavapipe-texture-blend.md part B): the twin of store and
// store_buffer.
#include <cstring>

#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/wave_store.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/half-inl.h"
#include "texel/load_store/wave_places-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

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
HWY_NOINLINE void encode_texels(const FormatDesc& format, const StoredValue& value, WordLanes words[4]) {
  const std::size_t count = (std::size_t{format.block_bytes} + 3) / 4;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    VU word[4] = {hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU())};
    for (std::size_t i = 0; i < format.channel_count; ++i) {
      const Channel& channel = format.channel[i];
      const base::WaveRegister* const component = value[format.component[i]];
      const VU field = encode_field<kNumeric>(hn::BitCast(DU(), load_or_zero(component, first)), channel.bits);
      VU& to = word[channel.offset / 32];
      to = hn::Or(to, hn::ShiftLeftSame(field, channel.offset % 32));
    }
    for (std::size_t i = 0; i < count; ++i) hn::Store(word[i], DU(), words[i].lane + first);
  }
}

/// A vector of adjacent texels.
template <std::size_t kBytes>
HWY_INLINE void store_adjacent(const WordLanes words[4], std::size_t first, std::byte* to) {
  auto* target = reinterpret_cast<std::uint32_t*>(to);
  const auto word = [&](std::size_t i) HWY_ATTR { return hn::Load(DU(), words[i].lane + first); };
  if constexpr (kBytes == 1) {
    const hn::Rebind<std::uint8_t, DU> d8;
    hn::StoreU(hn::DemoteTo(d8, hn::BitCast(DI(), word(0))), d8, reinterpret_cast<std::uint8_t*>(to));
  } else if constexpr (kBytes == 2) {
    const hn::Rebind<std::uint16_t, DU> d16;
    hn::StoreU(hn::DemoteTo(d16, hn::BitCast(DI(), word(0))), d16, reinterpret_cast<std::uint16_t*>(to));
  } else if constexpr (kBytes == 4) {
    hn::StoreU(word(0), DU(), target);
  } else if constexpr (kBytes == 8) {
    hn::StoreInterleaved2(word(0), word(1), DU(), target);
  } else {
    hn::StoreInterleaved4(word(0), word(1), word(2), word(3), DU(), target);
  }
}

/// In increasing order of lanes.
template <std::size_t kBytes>
HWY_NOINLINE void store_texels(const Places& places, const WordLanes words[4], std::byte* base) {
  constexpr std::size_t kWords = (kBytes + 3) / 4;
  constexpr bool kVectors = kBytes == 1 || kBytes == 2 || kBytes == 4 || kBytes == 8 || kBytes == 16;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    if constexpr (kVectors) {
      if (places.adjacent(first, kBytes)) {
        store_adjacent<kBytes>(words, first, base + places.offset.lane[first]);
        continue;
      }
    }
    const base::LaneMask lanes = places.wanted & base::first_lanes(hn::Lanes(DU())) << first;
    base::for_each_lane(lanes, [&](std::size_t lane) {
      std::uint32_t texel[kWords];
      for (std::size_t i = 0; i < kWords; ++i) texel[i] = words[i].lane[lane];
      std::memcpy(base + places.offset.lane[lane], texel, kBytes);
    });
  }
}

template <Numeric kNumeric>
HWY_INLINE void store_any(const FormatDesc& format, const Places& places, const StoredValue& value, std::byte* base) {
  WordLanes words[4];
  encode_texels<kNumeric>(format, value, words);
  by_texel_bytes(format, [&]<std::size_t kBytes>() { store_texels<kBytes>(places, words, base); });
}

void store_at(const FormatDesc& format, const Places& places, const StoredValue& value, std::byte* base) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return store_any<Numeric::kUnorm>(format, places, value, base);
    case Numeric::kSnorm:
      return store_any<Numeric::kSnorm>(format, places, value, base);
    case Numeric::kUint:
      return store_any<Numeric::kUint>(format, places, value, base);
    case Numeric::kSint:
      return store_any<Numeric::kSint>(format, places, value, base);
    default:
      return store_any<Numeric::kSfloat>(format, places, value, base);
  }
}

void store_image(const ImageView& view, const FetchRequest& request, const StoredValue& value) {
  Places places;
  place_texels(view, request, places);
  store_at(*view.format, places, value, view.base);
}

void store_buffer_texels(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                         const StoredValue& value) {
  Places places;
  place_texels(view, active, index, places);
  store_at(*view.format, places, value, view.data);
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(store_image);
HWY_EXPORT(store_buffer_texels);

constexpr std::uint64_t kSpanLimit = (std::uint64_t{1} << 31) - 64;

/// Whether encode_field encodes its channels.
bool has_vector_encoder(const FormatDesc& format) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
    case Numeric::kSnorm:
      return format.channel[0].bits <= 16;
    case Numeric::kUint:
    case Numeric::kSint:
    case Numeric::kSfloat:
      return true;
    default:
      return false;
  }
}

}  // namespace

bool offsets_fit(const ImageView& view) {
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span =
      (view.layer_count - 1) * view.layer_stride + last.offset + view.samples * view.level[0].sample_stride;
  return view.format->plain && span < kSpanLimit;
}

bool offsets_fit(const BufferTexelView& view) {
  return view.format->plain && view.count * view.format->block_bytes < kSpanLimit;
}

bool store_wave(const ImageView& view, const FetchRequest& request, const StoredValue& value) {
  if (!has_vector_encoder(*view.format) || !offsets_fit(view)) return false;
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(store_image)(view, request, value);
  return true;
}

bool store_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       const StoredValue& value) {
  if (!has_vector_encoder(*view.format) || !offsets_fit(view)) return false;
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(store_buffer_texels)(view, active, index, value);
  return true;
}

}  // namespace vitrine::texel

#endif
