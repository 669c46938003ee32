// Colour output to targets of 16-bit floats or 32-bit words whose channels lie in the order R, G, B, A.
#pragma once

#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// The colour function of the SIMD target in use, or null: another format.
ColorFunction float_color_function(const ColorWriter& writer);

}  // namespace vitrine::raster
