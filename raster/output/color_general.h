// Colour output in general: any format, any state, lane by lane. What the fast functions are compared with.
#pragma once

#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// A ColorFunction for every writer.
void write_color_general(const ColorWriter& writer, const ColorWave& wave);

}  // namespace vitrine::raster
