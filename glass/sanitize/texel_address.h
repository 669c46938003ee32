// The bytes of the texel that a lane of an image instruction names.
#pragma once

#include "glass/sanitize/image_lanes.h"
#include "texel/sampler.h"

namespace vitrine::glass::sanitize {

struct TexelBytes {
  std::uintptr_t address = 0;
  std::uint32_t bytes = 0;  ///< 0: the view has no such texel, or none that is in one place
};

/// Of loads, stores and atomic operations: coordinates are whole numbers.
TexelBytes texel_bytes(const spirv::Descriptor& image, const spirv::ImageOp& op, const ImageLanes& operands,
                       std::size_t lane);

}  // namespace vitrine::glass::sanitize
