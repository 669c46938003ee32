// See pass.h.
#include "glass/pixel/pass.h"

#include <algorithm>

#include "glass/pixel/tile_watch.h"

namespace vitrine::glass::pixel {
namespace {

constexpr int kTile = 64;  // raster::kTileSize

/// The layer of a view in which a texel lies; nothing: it does not. (Fragments may lie outside of the render area.)
std::optional<std::uint32_t> layer_in(const texel::ImageView& view, const Texel& texel) {
  const texel::Extent& extent = view.level[0].extent;
  const TexelId& id = texel.id;
  const bool inside = id.x < extent.width && id.y < extent.height && id.sample < std::max(view.samples, 1u);
  for (std::uint32_t layer = 0; inside && layer < view.layer_count; ++layer)
    if (view.block(0, layer, id.sample, id.x, id.y, 0) == texel.address) return layer;
  return std::nullopt;
}

}  // namespace

std::shared_ptr<PassPixels> PassPixels::make(Pixels& pixels, const raster::PassDesc& desc) {
  const std::shared_ptr<PassPixels> pass(new PassPixels(pixels));
  for (Texel* texel : pixels.texels()) {
    for (std::uint32_t i = 0; i < desc.color_count; ++i) pass->add(*texel, i, desc.color[i]);
    pass->add(*texel, kDepthSlot, desc.depth);
    pass->add(*texel, kStencilSlot, desc.stencil);
  }
  return pass->all_.empty() ? nullptr : pass;
}

void PassPixels::add(Texel& texel, std::uint32_t slot, const texel::ImageView& view) {
  if (!view.format) return;
  const std::optional<std::uint32_t> layer = layer_in(view, texel);
  if (!layer) return;
  const auto x = static_cast<int>(texel.id.x), y = static_cast<int>(texel.id.y);
  std::unique_ptr<TilePixels>& tile = tiles_[{*layer, y / kTile, x / kTile}];
  if (!tile) tile = std::make_unique<TilePixels>();
  std::uint16_t& index = tile->at[static_cast<std::size_t>(y % kTile * kTile + x % kTile)];
  if (index == 0) {
    tile->pixels.push_back({texel.id.x, texel.id.y, {}});
    index = static_cast<std::uint16_t>(tile->pixels.size());
    tile->quads[static_cast<std::size_t>(y % kTile / 2)] |= 1u << x % kTile / 2;
  }
  tile->pixels[index - 1u].texels.push_back({&texel, slot, *layer});
  all_.push_back({&texel, slot, *layer});
}

bool PassPixels::inside(const VkRect2D& area) const {
  return std::ranges::all_of(all_, [&](const PassTexel& at) {
    const std::int64_t x = at.texel->id.x, y = at.texel->id.y;
    return x >= area.offset.x && y >= area.offset.y && x - area.offset.x < area.extent.width &&
           y - area.offset.y < area.extent.height;
  });
}

TilePixels* PassPixels::tile_at(const raster::TilePlace& place) const {
  const auto at = tiles_.find({place.layer, place.y / kTile, place.x / kTile});
  return at == tiles_.end() ? nullptr : at->second.get();
}

std::unique_ptr<raster::DrawWatch> PassPixels::watch_tile(const spirv::ObservedCommand* command,
                                                          const raster::TilePlace& place) {
  const TilePixels* const tile = tile_at(place);
  if (tile == nullptr || command == nullptr) return nullptr;
  return std::make_unique<TileWatch>(pixels_, *tile, command, place);
}

}  // namespace vitrine::glass::pixel
