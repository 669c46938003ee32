// Reads, writes and queries by integer coordinates (lavapipe-texture-blend.md A10 and part B; Vulkan 1.3.239, Image
// Operations Overview).
#include <algorithm>

#include "texel/block/block.h"
#include "texel/capabilities.h"
#include "texel/codec.h"
#include "texel/load_store/prepared_access.h"
#include "texel/load_store/shape.h"
#include "texel/load_store/wave_access.h"
#include "texel/sampler.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {
namespace {

std::uint32_t unsigned_at(const base::WaveRegister* values, std::size_t lane) {
  return values != nullptr ? values->lane[lane] : 0;
}

/// A texel's place; coordinates as unsigned, so that negative ones are out of range too.
struct Place {
  std::uint32_t at[3] = {};
  std::uint32_t layer = 0;
  std::uint32_t level = 0;
  std::uint32_t sample = 0;
};

Place place_of(const Shape& shape, const FetchRequest& request, std::size_t lane) {
  Place place;
  for (std::uint32_t i = 0; i < shape.dims; ++i) {
    place.at[i] = unsigned_at(request.coord[i], lane) + unsigned_at(request.offset[i], lane);
  }
  if (shape.layered) place.layer = unsigned_at(request.coord[shape.dims], lane);
  place.level = unsigned_at(request.lod, lane);
  place.sample = unsigned_at(request.sample, lane);
  return place;
}

bool in_range(const ImageView& view, const Place& place) {
  if (place.level < view.min_level || place.level >= view.level_count || place.layer >= view.layer_count ||
      place.sample >= view.samples)
    return false;
  const Extent& extent = view.level[place.level].extent;
  return place.at[0] < extent.width && place.at[1] < extent.height && place.at[2] < extent.depth;
}

std::byte* address_of(const ImageView& view, const Place& place) {
  const FormatDesc& format = *view.format;
  return view.block(place.level, place.layer, place.sample, place.at[0] / format.block_width,
                    place.at[1] / format.block_height, place.at[2]);
}

/// What lies outside: 0, but 1 in an alpha that the format does not have.
Texel outside_texel(const FormatDesc& format) {
  const std::uint32_t one = format.kind == Kind::kFloat ? 0x3f800000u : 1u;
  return {0, 0, 0, format.rgba[3] < 0 ? one : 0u};
}

void put(const Texel& texel, std::size_t lane, const SampleResult& result) {
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr) result[c]->lane[lane] = texel[c];
  }
}

Texel gather_texel(const StoredValue& value, std::size_t lane) {
  Texel texel{};
  for (std::size_t c = 0; c < 4; ++c) {
    if (value[c] != nullptr) texel[c] = value[c]->lane[lane];
  }
  return texel;
}

}  // namespace

void fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result) {
  if (const PreparedFetch prepared = prepare_fetch(view, request, result); prepared.is_ready())
    return fetch(prepared, request.active);
  if (const PreparedFetch prepared = prepare_conversion(view, result); prepared.convert != nullptr) {
    base::WaveRegister words[4];
    load_levels(view, request, words);
    return prepared.convert(prepared, request.active, words);
  }
  if (view.planes != nullptr) return fetch(*view.planes, request, result);
  const FormatDesc& format = *view.format;
  const Shape shape = shape_of(view.type);
  const TexelDecoder decode = texel_decoder(format);
  base::for_each_lane(request.active, [&](std::size_t lane) {
    const Place place = place_of(shape, request, lane);
    Texel texel = outside_texel(format);
    if (in_range(view, place)) {
      const std::byte* address = address_of(view, place);
      if (decode != nullptr) {
        decode(format, address, texel);
      } else {
        decode_block_texel(format, address, place.at[0] % format.block_width, place.at[1] % format.block_height, texel);
      }
    }
    apply_swizzle(view, texel);
    put(texel, lane, result);
  });
}

void fetch_buffer(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  const SampleResult& result) {
  if (const PreparedFetch prepared = prepare_fetch(view, index, result); prepared.is_ready())
    return fetch(prepared, active);
  const FormatDesc& format = *view.format;
  const TexelDecoder decode = texel_decoder(format);
  base::for_each_lane(active, [&](std::size_t lane) {
    Texel texel = outside_texel(format);
    const std::uint64_t i = index.lane[lane];
    if (i < view.count && decode != nullptr) decode(format, view.data + i * format.block_bytes, texel);
    put(texel, lane, result);
  });
}

void store(const ImageView& view, const FetchRequest& request, const StoredValue& value) {
  if (!can_store(*view.format)) return;
  if (const PreparedStore prepared = prepare_store(view, request, value); prepared.is_ready())
    return store(prepared, request.active);
  const Shape shape = shape_of(view.type);
  const TexelEncoder encode = texel_encoder(*view.format, Encoding::kStore);
  base::for_each_lane(request.active, [&](std::size_t lane) {
    const Place place = place_of(shape, request, lane);
    if (in_range(view, place)) encode(*view.format, gather_texel(value, lane), address_of(view, place));
  });
}

void store_buffer(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  const StoredValue& value) {
  if (!can_store(*view.format)) return;
  if (const PreparedStore prepared = prepare_store(view, index, value); prepared.is_ready())
    return store(prepared, active);
  const TexelEncoder encode = texel_encoder(*view.format, Encoding::kStore);
  base::for_each_lane(active, [&](std::size_t lane) {
    const std::uint64_t i = index.lane[lane];
    if (i < view.count) encode(*view.format, gather_texel(value, lane), view.data + i * view.format->block_bytes);
  });
}

std::byte* texel_address(const ImageView& view, std::uint32_t bytes, const std::array<std::int32_t, 3>& coord,
                         std::uint32_t sample) {
  const Shape shape = shape_of(view.type);
  Place place;
  for (std::uint32_t i = 0; i < shape.dims; ++i) place.at[i] = static_cast<std::uint32_t>(coord[i]);
  if (shape.layered) place.layer = static_cast<std::uint32_t>(coord[shape.dims]);
  place.sample = sample;
  return view.format->block_bytes == bytes && in_range(view, place) ? address_of(view, place) : nullptr;
}

std::array<std::uint32_t, 3> query_size(const ImageView& view, std::int32_t lod) {
  const Shape shape = shape_of(view.type);
  const bool cube_array = view.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  const bool layers = shape.layered && view.type != VK_IMAGE_VIEW_TYPE_CUBE;
  std::array<std::uint32_t, 3> size{};
  if (lod >= 0 && static_cast<std::uint32_t>(lod) < view.level_count) {
    const Extent& extent = view.level[static_cast<std::size_t>(lod)].extent;
    const std::uint32_t all[3] = {extent.width, extent.height, extent.depth};
    std::copy_n(all, shape.dims, size.begin());
  }
  if (layers) size[shape.dims] = cube_array ? view.layer_count / 6 : view.layer_count;
  return size;
}

}  // namespace vitrine::texel
