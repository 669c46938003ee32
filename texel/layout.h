// Layouts of images whose planes lie where somebody else has put them: pictures that devices share.
#pragma once

#include <cstdint>
#include <span>

#include "texel/view.h"

namespace vitrine::texel {

/// Where a plane of an image of one level is to lie.
struct PlanePlace {
  std::uint64_t offset = 0;        ///< bytes from the start of the memory: the image's, or the plane's own
  std::uint64_t row_pitch = 0;     ///< bytes between block rows
  std::uint64_t layer_stride = 0;  ///< bytes between array layers; of no meaning for one layer
};

/// A place for each plane of a colour image of one level. False as for other images, and also if the places are not as
/// many as the planes, or if rows or layers overlap or do not begin on the alignment that all images of this device
/// have.
bool make_image_layout(const ImageDesc& desc, std::span<const PlanePlace> places, ImageLayout& layout);

/// Bytes of memory of its own that a plane of a disjoint image needs.
constexpr std::uint64_t end_of(const PlaneLayout& plane) { return plane.offset + plane.size; }

}  // namespace vitrine::texel
