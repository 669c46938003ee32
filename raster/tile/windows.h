// Primitives whose coverage the front end found (Primitive::window): windows of 8x8 pixels one by one, those of 4x4 in
// groups.
#pragma once

#include <cstdint>

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// One such primitive.
void emit_window(TileWorker& worker, const Primitive& primitive);

/// Whether such a primitive may go into a group: a window of 4x4 pixels that nothing cuts.
bool is_small_window(const TileWorker& worker, const Primitive& primitive);

/// Small windows of one draw and one viewport, at most kWindowGroup. Each step is done for all of them before the next,
/// so that none waits for the results of the one before.
void emit_small_windows(TileWorker& worker, const Primitive* const* primitives, std::uint32_t count);

}  // namespace vitrine::raster
