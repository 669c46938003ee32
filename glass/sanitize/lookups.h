// Lookups through samplers, lane by lane.
#pragma once

#include "glass/sanitize/footprint.h"
#include "glass/sanitize/image_lanes.h"

namespace vitrine::glass::sanitize {

/// Whether a view has the dimension that the instruction gives coordinates for.
bool has_dimension(spirv::ir::ImageDim dim, VkImageViewType type);

Lookup lookup_of(const spirv::ImageOp& op, const ImageLanes& operands, std::size_t lane);

/// What a lane looks up through; null: nothing is there.
const texel::Sampler* sampler_of(const spirv::Wave& wave, const spirv::ImageOp& op, const spirv::Descriptor& image,
                                 std::size_t lane);

}  // namespace vitrine::glass::sanitize
