// From quads of fragments to those of their pixels.
#include "raster/tile/coarse.h"

#include <algorithm>
#include <bit>

namespace vitrine::raster {
namespace {

/// Lanes of a quad of fragments by lane of a quad of pixels.
struct QuadSpread {
  std::uint32_t lane[4], first_bit[4];
};

QuadSpread spread_quad(FragmentRate rate, std::uint32_t part, std::uint32_t samples) {
  QuadSpread spread;
  const std::uint32_t width = width_of(rate), height = height_of(rate);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t x = 2 * (part % width) + (i & 1), y = 2 * (part / width) + (i >> 1);
    spread.lane[i] = y / height * 2 + x / width;
    spread.first_bit[i] = samples * (width * height - 1 - (y % height * width + x % width));
  }
  return spread;
}

}  // namespace

FragmentRate rate_in_block(const TileWorker& worker, const Primitive& primitive, int x, int y) {
  const texel::ImageView* const view = worker.pass->shading_rate;
  std::uint32_t texel = 0;
  if (view) {
    // Attachment Fragment Shading Rate. Outside of the attachment reads what is outside of an image.
    const VkExtent2D region = worker.pass->shading_rate_texel;
    const std::uint32_t column = static_cast<std::uint32_t>(x) / region.width;
    const std::uint32_t row = static_cast<std::uint32_t>(y) / region.height;
    const std::uint32_t layer = view->layer_count > 1 ? worker.target.layer : 0;
    if (column < view->level[0].extent.width && row < view->level[0].extent.height && layer < view->layer_count)
      texel = std::to_integer<std::uint32_t>(*view->block(0, layer, 0, column, row, 0));
  }
  return worker.draw->plan->rates.with_attachment(primitive.rate, texel);
}

FragmentSpread spread_of(FragmentRate rate, std::uint32_t part, std::uint32_t samples) {
  const QuadSpread quad = spread_quad(rate, part, samples);
  FragmentSpread spread;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) {
    spread.lane[lane] = static_cast<std::uint8_t>((lane & ~3u) + quad.lane[lane & 3]);
    spread.first_bit[lane] = static_cast<std::uint8_t>(quad.first_bit[lane & 3]);
  }
  return spread;
}

base::LaneMask covered_fragments(const TileWorker& worker) {
  const CoarseWave& coarse = worker.coarse;
  base::LaneMask fragments = 0;
  for (std::uint32_t part = 0; part < pixels_of(coarse.rate); ++part) {
    const QuadSpread spread = spread_quad(coarse.rate, part, 1);
    base::LaneMask any = 0;
    for (std::uint32_t s = 0; s < worker.draw->plan->samples; ++s) any |= coarse.coverage[part][s];
    for (std::uint32_t i = 0; i < 4; ++i) fragments |= (any >> i & base::kFirstOfQuads) << spread.lane[i];
  }
  return fragments;
}

bool take_pixels(TileWorker& worker, std::uint32_t part, FragmentSpread& spread) {
  const CoarseWave& coarse = worker.coarse;
  const PackedWave& from = worker.wave;
  PackedWave& to = worker.block;
  const std::uint32_t samples = worker.draw->plan->samples;
  const FragmentSpread all = spread_of(coarse.rate, part, samples);
  base::LaneMask any = 0;
  for (std::uint32_t s = 0; s < samples; ++s) any |= coarse.coverage[part][s];
  base::LaneMask quads = base::quads_of_lanes(any);
  to.quads = 0;
  to.slots = to.planes.slots = from.slots;
  std::copy_n(from.primitive, from.slots, to.primitive);
  std::copy_n(from.planes.set, from.slots, to.planes.set);
  std::fill_n(to.planes.end, from.slots, std::uint8_t{0});
  std::fill_n(to.coverage, samples, 0);
  for (; quads != 0; quads &= quads - 1, ++to.quads) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(quads));
    const std::uint32_t quad = lane / 4, width = width_of(coarse.rate);
    to.position.x[to.quads] = static_cast<std::uint16_t>(from.position.x[quad] + 2 * (part % width));
    to.position.y[to.quads] = static_cast<std::uint16_t>(from.position.y[quad] + 2 * (part / width));
    to.slot[to.quads] = from.slot[quad];
    std::fill(to.planes.end + from.slot[quad], to.planes.end + from.slots, static_cast<std::uint8_t>(to.quads + 1));
    for (std::uint32_t s = 0; s < samples; ++s)
      to.coverage[s] |= (coarse.coverage[part][s] >> lane & 15) << 4 * to.quads;
    std::copy_n(all.lane + lane, 4, spread.lane + 4 * to.quads);
    std::copy_n(all.first_bit + lane, 4, spread.first_bit + 4 * to.quads);
  }
  std::fill(std::begin(spread.lane) + 4 * to.quads, std::end(spread.lane), std::uint8_t{0});
  std::fill(std::begin(spread.first_bit) + 4 * to.quads, std::end(spread.first_bit), std::uint8_t{0});
  std::fill(to.position.x + to.quads, std::end(to.position.x), to.position.x[0]);
  std::fill(to.position.y + to.quads, std::end(to.position.y), to.position.y[0]);
  return to.quads != 0;
}

}  // namespace vitrine::raster
