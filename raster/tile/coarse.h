// Fragments of more than one pixel (Vulkan 1.3.239, Fragment Shading Rates): coverage and early tests are those of
// pixels; then quads of fragments are packed into waves, and what their shader gives goes back to waves of pixels.
#pragma once

#include "raster/tile/shade_run.h"

namespace vitrine::raster {

/// The rate of a primitive's fragments in the block at (x, y).
FragmentRate rate_in_block(const TileWorker& worker, const Primitive& primitive, int x, int y);

/// Of the pixels in quad `part` of each quad of fragments.
FragmentSpread spread_of(FragmentRate rate, std::uint32_t part, std::uint32_t samples);

/// Fragments of the packed wave with a covered sample.
base::LaneMask covered_fragments(const TileWorker& worker);

/// The quads of pixels numbered `part` of the packed wave that have covered pixels, as a wave in worker.block.
/// `spread`: where its pixels come from. Returns whether there are any.
bool take_pixels(TileWorker& worker, std::uint32_t part, FragmentSpread& spread);

}  // namespace vitrine::raster
