// Anisotropic filtering by an elliptical weighted average (lavapipe-texture-blend.md A8).
#pragma once

#include "texel/sampler/lod.h"
#include "texel/sampler/scalar.h"

namespace vitrine::texel {

/// The average around a point on one level.
Texel sample_anisotropic(const LaneSample& lane, const LanePoint& point, std::uint32_t level);

}  // namespace vitrine::texel
