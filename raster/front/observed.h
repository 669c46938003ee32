// The end of an observed chunk: which of its primitives cover samples, and how far they would reach without scissor.
#pragma once

#include "raster/front/chunk.h"
#include "raster/front/primitive_list.h"
#include "raster/pass_desc.h"

namespace vitrine::raster {

/// Tells chunk.watch of the primitives that are rasterized or cover no sample, and lets all of them reach over the
/// scissor to the ends of the framebuffer: the back end then tells of fragments that fail the scissor test.
void finish_observed(const Chunk& chunk, const PassDesc& pass, PrimitiveList& primitives);

}  // namespace vitrine::raster
