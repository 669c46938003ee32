// Registers of a wave to records in memory, one per lane.
#pragma once

#include <cstdint>

#include "base/lanes.h"

namespace vitrine::raster {

/// out[i * stride + c] = from[c][i] for lanes i of [0, lanes) and c of [0, 4).
void store_records(const std::uint32_t* const from[4], std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride);

}  // namespace vitrine::raster
