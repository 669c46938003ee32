// Anisotropic filtering by EWA, an elliptical weighted average of the texels of a footprint (lavapipe-texture-blend.md
// A8).
#pragma once

#include <array>

#include "texel/sampler/model/level.h"
#include "texel/sampler/model/lod.h"

namespace vitrine::texel {

/// exp(-2 i / 1023) to six decimals; the reference's table differs in the last digit of a few entries.
extern const std::array<float, 1024> kEwaWeights;

/// The same in tables that fit into registers: entry 32 i + k is the fused product of kMillionth with
/// m = whole[i] + round(whole[i] * less[k] + rest[i]), plus m * kMillionthRest.
struct EwaFactors {
  static constexpr float kMillionth = 1e-6f;
  static constexpr float kMillionthRest = static_cast<float>(1e-6 - static_cast<double>(kMillionth));
  alignas(64) float whole[32];  ///< millionths, of entry 32 i
  alignas(64) float rest[32];   ///< parts of a millionth, where the rounded weights leave room
  alignas(64) float less[32];   ///< exp(-2 k / 1023) - 1
};
extern const EwaFactors kEwaFactors;

/// The average around a point on one level: texels (u, v) of the box around the ellipse A U^2 + B U V + C V^2 = F, with
/// U, V counted from the point in texels, are weighted by the table at 1023 / F of that form, found by differences
/// along a row; those beyond the ellipse have no part. With the derivatives dx, dy of the coordinates (s, t), times
/// width or height of the image's level 0 and 2^-level: A = dtx^2 + dty^2 + 1, B = -2 (dsx dtx + dsy dty),
/// C = dsx^2 + dsy^2 + 1, F = A C - B^2 / 4. Each texel is a nearest lookup at (u, v) over the level's size: of the
/// point's slice of a volume. Without a weight (an ellipse that is not finite) the lookup is linear. Neither the
/// sampler's filters nor the degree of its anisotropy, if it is at least 2, change anything but the choice of a level.
Texel sample_anisotropic(const LaneSample& lane, const LanePoint& point, std::uint32_t level);

}  // namespace vitrine::texel
