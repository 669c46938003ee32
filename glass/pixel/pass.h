// The watched texels of the attachments of a pass, tile by tile, and what fragments do to them.
#pragma once

#include <map>
#include <tuple>

#include "glass/pixel/tile_pixels.h"
#include "raster/observe.h"
#include "raster/pass_desc.h"

namespace vitrine::glass::pixel {

class PassPixels final : public raster::TileObserver {
 public:
  /// Null: no attachment has a watched texel.
  static std::shared_ptr<PassPixels> make(Pixels& pixels, const raster::PassDesc& desc);

  bool watches(const raster::TilePlace& place) const override { return tile_at(place) != nullptr; }
  std::unique_ptr<raster::DrawWatch> watch_tile(const spirv::ObservedCommand* command,
                                                const raster::TilePlace& place) override;
  /// Whether all of these pixels lie in the rectangle.
  bool inside(const VkRect2D& area) const;
  /// All of them.
  const std::vector<PassTexel>& texels() const { return all_; }

 private:
  using Key = std::tuple<std::uint32_t, int, int>;  ///< layer, row, column

  explicit PassPixels(Pixels& pixels) : pixels_(pixels) {}
  void add(Texel& texel, std::uint32_t slot, const texel::ImageView& view);
  TilePixels* tile_at(const raster::TilePlace& place) const;

  Pixels& pixels_;
  std::map<Key, std::unique_ptr<TilePixels>> tiles_;
  std::vector<PassTexel> all_;
};

}  // namespace vitrine::glass::pixel
