// Colour output: what happens to a fragment's colour after the shader and the tests (Vulkan 1.3.239, The Framebuffer:
// Blending, Logical Operations, Color Write Mask). Bits: lavapipe-texture-blend.md parts D and E.
// Takes waves of quads; knows nothing of coverage, depth or primitives.
#pragma once

#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// The writer of an attachment, with the fastest functions that give the right bits.
ColorWriter make_color_writer(VkFormat format, const BlendAttachment& blend, const State& state);

/// The same writer with the general function alone: for tests, which compare it with the fast ones.
ColorWriter make_general_color_writer(VkFormat format, const BlendAttachment& blend, const State& state);

}  // namespace vitrine::raster
