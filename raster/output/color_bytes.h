// Colour output to targets of four bytes, UNORM or sRGB, in any order.
#pragma once

#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// The colour function of the SIMD target in use, or null: another format, or a second colour to blend with.
ColorFunction byte_color_function(const ColorWriter& writer);

}  // namespace vitrine::raster
