// One blit of one aspect, as the paths of this folder see it (lavapipe-rasterization.md 11.3).
#pragma once

#include <cstdint>
#include <cstdlib>

#include "base/numeric.h"
#include "texel/sampler.h"
#include "texel/transfer/box.h"

namespace vitrine::texel {

/// One axis of a region, destination from low to high; a descending source is a flip.
struct Span {
  std::int32_t to0 = 0, to1 = 0;
  std::int32_t from0 = 0, from1 = 0;

  std::int32_t to_size() const { return to1 - to0; }
  std::int32_t from_size() const { return std::abs(from1 - from0); }
  bool flipped() const { return from1 < from0; }
  bool scaled() const { return to_size() != from_size(); }
  /// The source texel of an unscaled span.
  std::int32_t source(std::int32_t to) const { return flipped() ? from0 - 1 - (to - to0) : from0 + (to - to0); }
};

/// One aspect of a region with everything that its rows need.
struct Blit {
  const ImageMemory* source = nullptr;
  VkImageAspectFlagBits aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  VkImageSubresourceLayers source_layers{};
  Box to;  ///< of the destination, cut
  Span x, y, z;
  Extent from_extent;  ///< of the source level
  Extent to_extent;
  bool scaled = false;
  VkFilter filter = VK_FILTER_NEAREST;
  bool rectangle = false;  ///< one plane for both triangles
};

/// value(px, py) = a0 + dadx * px + dady * py.
struct PlaneEquation {
  float a0 = 0, dadx = 0, dady = 0;
  float at(float px, float py) const { return base::fma_exact(dady, py, base::fma_exact(dadx, px, a0)); }
};

/// Planes of u and v for the upper right [0] and the lower left [1] triangle.
struct Quad {
  PlaneEquation u[2], v[2];
};

/// Where the first texel of the cut box lies in destination texels.
struct Start {
  std::int32_t x = 0, y = 0, z = 0;
};

/// Scales a two-dimensional region row by row, with taps of columns and rows found once: the bits of sampling every
/// texel. `view` gives the source level that a slice of the destination reads. False, with nothing done, for regions
/// that this cannot scale.
bool scale_rows(const Blit& blit, const Quad& quad, const Start& start, const Sampler& sampler,
                base::FunctionRef<ImageView(std::uint32_t)> view);

/// blit_image by its general path: every texel sampled or fetched by itself.
void blit_image_by_texels(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region,
                          VkFilter filter);

/// Index of the first texel of row `row` that the upper right triangle covers, in destination texels from the region's
/// left: the diagonal belongs to that triangle, whose left edge it is.
std::int32_t first_upper_texel(const Blit& blit, std::int32_t row);

}  // namespace vitrine::texel
