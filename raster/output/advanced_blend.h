// Advanced blend operations (Vulkan 1.3.239, The Framebuffer: Advanced Blend Operations): one pixel in floats, by the
// specification's formulas. (This device alone: the reference lacks VK_EXT_blend_operation_advanced.)
#pragma once

#include <array>

#include "raster/draw.h"

namespace vitrine::raster {

/// RGBA of a fragment and of the pixel to what is stored there. `state`: its color_op is advanced. A format without
/// alpha has 1. Colours that the specification calls ill-formed give 0 where it divides by 0.
std::array<float, 4> blend_advanced(const BlendAttachment& state, const std::array<float, 4>& src,
                                    const std::array<float, 4>& dst);

}  // namespace vitrine::raster
