// Reads texels that are neighbours in memory as vectors, from coordinates to results without arrays in between
// (lavapipe-texture-blend.md A10): the twin of fetch and fetch_buffer for waves of such texels.
#include "texel/load_store/prepared_fetch.h"
#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/wave_rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/load_store/wave_places-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

inline constexpr std::size_t kLanes = hn::MaxLanes(DU());

inline constexpr std::size_t words_of(std::size_t bytes) { return (bytes + 3) / 4; }

/// Bytes from the base; `valid` loses the lanes outside.
HWY_INLINE VI place_lanes(const PreparedFetch& p, std::size_t first, hn::Mask<DI>& valid) {
  VI place = splat(0);
  for (std::size_t i = 0; i < p.axis_count; ++i) {
    const FetchedAxis& axis = p.axis[i];
    const VI at = load_ints(axis.coord, first);
    valid = hn::And(valid, within(at, splat(axis.size)));
    place = hn::Add(place, hn::Mul(at, splat(axis.stride)));
  }
  return place;
}

/// `kCount` adjacent texels of at most a word.
template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE hn::Vec<hn::CappedTag<std::uint32_t, kCount>> load_row(const std::byte* from) {
  const hn::CappedTag<std::uint32_t, kCount> d;
  if constexpr (kBytes == 4) {
    return hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(from));
  } else if constexpr (kBytes == 2) {
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    return hn::PromoteTo(d, hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(from)));
  } else {
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    return hn::PromoteTo(d, hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(from)));
  }
}

/// A vector of adjacent texels.
template <std::size_t kBytes>
HWY_INLINE void load_run(const std::byte* from, VU words[4]) {
  const auto* source = reinterpret_cast<const std::uint32_t*>(from);
  if constexpr (kBytes <= 4) words[0] = load_row<kBytes, kLanes>(from);
  if constexpr (kBytes == 8) hn::LoadInterleaved2(DU(), source, words[0], words[1]);
  if constexpr (kBytes == 16) hn::LoadInterleaved4(DU(), source, words[0], words[1], words[2], words[3]);
}

template <std::size_t kBytes>
HWY_INLINE void load_each(const std::byte* base, VI place, VU words[4]) {
  if constexpr (kBytes <= 4) words[0] = load_narrow_words<kBytes>(base, place);
  if constexpr (kBytes == 8) {
    const WordPair pair = load_word_pairs(base, place);
    words[0] = pair.first;
    words[1] = pair.second;
  }
  if constexpr (kBytes == 16) load_word_quads(base, place, words);
}

/// Channels are whole words of the texel.
struct Words {
  template <std::size_t kCount>
  HWY_INLINE static VU result(const FetchedField& field, const VU words[4]) {
    if constexpr (kCount == 1) return words[0];
    const VU low = field.word == 0 ? words[0] : words[1];
    if constexpr (kCount == 2) return low;
    return field.word < 2 ? low : field.word == 2 ? words[2] : words[3];
  }
};

/// Channels are fields of the texel's words.
template <Numeric kNumeric>
struct Fields {
  template <std::size_t kCount>
  HWY_INLINE static VU result(const FetchedField& field, const VU words[4]) {
    const Channel channel{'R', kNumeric, field.bits, field.shift};
    return as_unsigned(convert_field<kNumeric>(Words::result<kCount>(field, words), channel));
  }
};

/// Lanes of a vector that are no row: those at an edge, above all.
template <class Format, std::size_t kBytes>
HWY_NOINLINE void fetch_each(const PreparedFetch& p, std::size_t first) {
  auto valid = hn::Eq(splat(0), splat(0));
  const VI place = place_lanes(p, first, valid);
  VU words[4] = {hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU())};
  if (!hn::AllFalse(DI(), valid)) {
    // Lanes that want no texel get one that another wants: wherever else they read, another tile may be writing.
    const auto wanted = static_cast<std::uint32_t>(lanes_mask_bits(DI(), valid));
    const VI shared = splat(hn::ExtractLane(place, static_cast<std::size_t>(std::countr_zero(wanted))));
    load_each<kBytes>(p.base, hn::IfThenElse(valid, place, shared), words);
  }
  for (std::size_t i = 0; i < p.field_count; ++i) {
    const VU value = Format::template result<words_of(kBytes)>(p.field[i], words);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(DU(), valid), value), DU(), p.field[i].to->lane + first);
  }
}

/// Whether kCount lanes have successive first coordinates and the others in common, all inside; their first texel.
/// Tells by coordinates, not by places, so that these need not be computed. kAxes: how many there are; 0: any number.
template <std::size_t kBytes, std::size_t kAxes, std::size_t kCount>
HWY_INLINE const std::byte* row_of(const PreparedFetch& p, std::size_t first) {
  const hn::CappedTag<std::int32_t, kCount> d;
  const auto coordinates = [&](const FetchedAxis& axis) HWY_ATTR {
    return hn::Load(d, reinterpret_cast<const std::int32_t*>(axis.coord->lane + first));
  };
  const std::uint32_t x = p.axis[0].coord->lane[first];
  const auto size = static_cast<std::uint32_t>(p.axis[0].size);
  if (size < kCount || x > size - kCount) return nullptr;
  auto same = hn::Eq(coordinates(p.axis[0]), hn::Add(hn::Set(d, static_cast<std::int32_t>(x)), hn::Iota(d, 0)));
  const std::byte* at = p.base + std::size_t{x} * kBytes;
  const std::size_t count = kAxes != 0 ? kAxes : p.axis_count;
  for (std::size_t i = 1; i < count; ++i) {
    const FetchedAxis& axis = p.axis[i];
    const std::uint32_t coord = axis.coord->lane[first];
    if (coord >= static_cast<std::uint32_t>(axis.size)) return nullptr;
    same = hn::And(same, hn::Eq(coordinates(axis), hn::Set(d, static_cast<std::int32_t>(coord))));
    at += std::ptrdiff_t{static_cast<std::int32_t>(coord)} * axis.stride;
  }
  return hn::AllTrue(d, same) ? at : nullptr;
}

/// Texels of a vector that is a row, or two.
template <std::size_t kBytes, std::size_t kAxes>
HWY_INLINE bool load_rows(const PreparedFetch& p, std::size_t first, VU words[4]) {
  if (const std::byte* const row = row_of<kBytes, kAxes, kLanes>(p, first)) {
    load_run<kBytes>(row, words);
    return true;
  }
  if constexpr (kBytes <= 4 && kLanes == 16) {
    constexpr std::size_t kHalf = kLanes / 2;
    const std::byte* const low = row_of<kBytes, kAxes, kHalf>(p, first);
    if (low == nullptr) return false;
    const std::byte* const high = row_of<kBytes, kAxes, kHalf>(p, first + kHalf);
    if (high == nullptr) return false;
    words[0] = hn::Combine(DU(), load_row<kBytes, kHalf>(high), load_row<kBytes, kHalf>(low));
    return true;
  }
  return false;
}

/// False, with nothing done, where the first lanes are no row: then few others will be. Results may be the registers of
/// coordinates: of a vector of lanes nothing may be read behind what is stored.
template <class Format, std::size_t kBytes, std::size_t kAxes>
HWY_INLINE bool fetch_vectors(const PreparedFetch& p) {
  VU words[4];
  if (!load_rows<kBytes, kAxes>(p, 0, words)) return false;
  for (std::size_t first = 0;;) {
    for (std::size_t i = 0; i < p.field_count; ++i) {
      const FetchedField& field = p.field[i];
      hn::Store(Format::template result<words_of(kBytes)>(field, words), DU(), field.to->lane + first);
    }
    for (;;) {
      first += kLanes;
      if (first == base::kWaveWidth) return true;
      if (load_rows<kBytes, kAxes>(p, first, words)) break;
      fetch_each<Format, kBytes>(p, first);
    }
  }
}

template <class Format, std::size_t kBytes>
HWY_NOINLINE bool fetch_rows(const PreparedFetch& p) {
  const bool done = p.axis_count == 2 ? fetch_vectors<Format, kBytes, 2>(p) : fetch_vectors<Format, kBytes, 0>(p);
  if (!done) return false;
  for (std::size_t i = 0; i < p.constant_count; ++i) {
    for (std::size_t first = 0; first < base::kWaveWidth; first += kLanes)
      hn::Store(hn::Set(DU(), p.constant[i]), DU(), p.constant_to[i]->lane + first);
  }
  return true;
}

PreparedFetch::Kernel kernel_of_words(std::uint32_t bytes) {
  switch (bytes) {
    case 4:
      return fetch_rows<Words, 4>;
    case 8:
      return fetch_rows<Words, 8>;
    case 16:
      return fetch_rows<Words, 16>;
    default:
      return nullptr;
  }
}

/// Of fields narrower than a word: for the numeric formats and sizes that storage images mostly have.
PreparedFetch::Kernel kernel_of(const FormatDesc& format) {
  const std::uint32_t bytes = format.block_bytes;
  const Numeric numeric = format.channel[0].numeric;
  if (format.channel[0].bits == 32) return kernel_of_words(bytes);
  if (numeric == Numeric::kUnorm) {
    return bytes == 4   ? fetch_rows<Fields<Numeric::kUnorm>, 4>
           : bytes == 1 ? fetch_rows<Fields<Numeric::kUnorm>, 1>
           : bytes == 2 ? fetch_rows<Fields<Numeric::kUnorm>, 2>
                        : nullptr;
  }
  if (numeric == Numeric::kSfloat) {
    return bytes == 8   ? fetch_rows<Fields<Numeric::kSfloat>, 8>
           : bytes == 4 ? fetch_rows<Fields<Numeric::kSfloat>, 4>
           : bytes == 2 ? fetch_rows<Fields<Numeric::kSfloat>, 2>
                        : nullptr;
  }
  if (numeric == Numeric::kUint) {
    return bytes == 4   ? fetch_rows<Fields<Numeric::kUint>, 4>
           : bytes == 1 ? fetch_rows<Fields<Numeric::kUint>, 1>
           : bytes == 2 ? fetch_rows<Fields<Numeric::kUint>, 2>
                        : nullptr;
  }
  return nullptr;
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(kernel_of);

/// The same numeric format in all channels, each inside one word, and no others.
bool is_uniform(const FormatDesc& format) {
  for (std::size_t i = 0; i < format.channel_count; ++i) {
    const Channel& channel = format.channel[i];
    const bool whole = (channel.bits == 32) == (format.channel[0].bits == 32);
    if (channel.name == 0 || channel.numeric != format.channel[0].numeric || !whole) return false;
    if (channel.offset % 32 + channel.bits > 32) return false;
  }
  return true;
}

void add_result(const FormatDesc& format, std::uint8_t source, base::WaveRegister* to, PreparedFetch& prepared) {
  const std::int8_t index = source < 4 ? format.rgba[source] : std::int8_t{-1};
  if (index < 0) {
    const std::uint32_t one = format.is_integer() ? 1u : 0x3f800000u;
    prepared.constant[prepared.constant_count] = source == 3 || source == 5 ? one : 0;
    prepared.constant_to[prepared.constant_count++] = to;
    return;
  }
  const Channel& channel = format.channel[static_cast<std::size_t>(index)];
  prepared.field[prepared.field_count++] = {to, static_cast<std::uint8_t>(channel.offset / 32),
                                            static_cast<std::uint8_t>(channel.offset % 32), channel.bits};
}

void prepare_format(const FormatDesc& format, const std::array<std::uint8_t, 4>& swizzle, const SampleResult& result,
                    PreparedFetch& prepared) {
  if (!is_uniform(format)) return;
  base::select_simd_target();
  prepared.kernel = HWY_DYNAMIC_DISPATCH(kernel_of)(format);
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr) add_result(format, swizzle[c], result[c], prepared);
  }
}

void add_axis(const base::WaveRegister* coord, std::uint64_t size, std::uint64_t stride, PreparedFetch& prepared) {
  prepared.axis[prepared.axis_count++] = {coord, static_cast<std::int32_t>(size), static_cast<std::int32_t>(stride)};
}

/// Whether the coordinates of all dimensions are registers as they are, and there is but one level.
bool is_plain(const FetchRequest& request, const Shape& shape) {
  if (request.lod != nullptr) return false;
  for (std::uint32_t i = 0; i < shape.dims + (shape.layered ? 1 : 0); ++i) {
    if (request.coord[i] == nullptr || request.offset[i] != nullptr) return false;
  }
  return true;
}

}  // namespace

PreparedFetch prepare_fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result) {
  PreparedFetch prepared;
  const Shape shape = shape_of(view.type);
  if (!offsets_fit(view) || view.min_level != 0 || !is_plain(request, shape)) return prepared;
  const LevelLayout& level = view.level[0];
  prepared.base = view.base + level.offset;
  add_axis(request.coord[0], level.extent.width, view.format->block_bytes, prepared);
  if (shape.dims > 1) add_axis(request.coord[1], level.extent.height, level.row_pitch, prepared);
  if (shape.dims > 2) add_axis(request.coord[2], level.extent.depth, level.slice_pitch, prepared);
  if (shape.layered) add_axis(request.coord[shape.dims], view.layer_count, view.layer_stride, prepared);
  if (request.sample != nullptr) add_axis(request.sample, view.samples, level.sample_stride, prepared);
  prepare_format(*view.format, view.swizzle, result, prepared);
  return prepared;
}

PreparedFetch prepare_fetch(const BufferTexelView& view, const base::WaveRegister& index, const SampleResult& result) {
  constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
  PreparedFetch prepared;
  if (!offsets_fit(view)) return prepared;
  prepared.base = view.data;
  add_axis(&index, view.count, view.format->block_bytes, prepared);
  prepare_format(*view.format, kIdentity, result, prepared);
  return prepared;
}

}  // namespace vitrine::texel

#endif
