// Anisotropic filtering by an elliptical weighted average (lavapipe-texture-blend.md A8).
#pragma once

#include <array>

#include "texel/sampler/lod.h"
#include "texel/sampler/scalar.h"

namespace vitrine::texel {

/// exp(-2 i / 1023) to six decimals; the reference's table differs in the last digit of a few entries.
extern const std::array<float, 1024> kEllipseWeights;

/// The average around a point on one level.
Texel sample_anisotropic(const LaneSample& lane, const LanePoint& point, std::uint32_t level);

}  // namespace vitrine::texel
