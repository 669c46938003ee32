// Level of detail and cube projection of single lanes (lavapipe-texture-blend.md A4, A5). The twin for waves:
// texel/sampler/wave/state-inl.h.
#pragma once

#include "texel/sampler/plan.h"

namespace vitrine::texel {

/// Coordinates of a lane where texels are selected, with the derivatives that its level of detail uses.
struct LanePoint {
  float coord[3] = {};
  std::uint32_t face = 0;  ///< of cubes
  float ddx[3] = {};
  float ddy[3] = {};
};

/// Differences of a coordinate within the lane's quad: the reference's coarse pair (right and lower neighbour of the
/// first pixel) and the fine pair (own row, own column).
struct QuadDerivative {
  float dx = 0;
  float dy = 0;
};
QuadDerivative coarse_derivative(const base::WaveRegister& coord, std::size_t lane);
QuadDerivative fine_derivative(const base::WaveRegister& coord, std::size_t lane);

/// Coordinates and derivatives of one lane; cubes are projected to their face.
LanePoint locate(const Plan& plan, const SampleRequest& request, std::size_t lane);

/// The level of detail at a point. Not called unless plan.lod_needed.
Lod level_of_detail(const Plan& plan, const SampleRequest& request, const LanePoint& point, std::size_t lane);

}  // namespace vitrine::texel
