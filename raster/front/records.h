// Registers of a wave to records in memory, one per lane, and back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/lanes.h"

namespace vitrine::raster {

/// out[i * stride + c] = from[c][i] for lanes i of [0, lanes) and c of [0, 4).
void store_records(const std::uint32_t* const from[4], std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride);

/// to[c][i] = word c of the record at at[i], for lanes i of [0, lanes) and c of [0, 4); null: not wanted. All four
/// words of a record are read, and up to three lanes of registers behind the last are written.
void load_records(const std::byte* const* at, std::uint32_t lanes, std::uint32_t* const to[4]);

}  // namespace vitrine::raster
