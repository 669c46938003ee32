// Interpolation: plane equations per primitive and their evaluation over a wave (lavapipe-rasterization.md 4, 6.3,
// 7.2). Origin is the framebuffer's pixel (0, 0).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/pixel_order.h"
#include "raster/plan.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// Planes in this order: z, 1/w, perspective varyings (times 1/w), linear varyings, gl_PointCoord x and y (times 1/w).
inline constexpr std::uint32_t kDepthPlane = 0, kReciprocalWPlane = 1, kFirstVaryingPlane = 2;
inline constexpr std::uint32_t kMaxPlanes = (kFirstVaryingPlane + kMaxVaryings + 2 + 15) & ~15u;

struct PlaneSet {
  alignas(64) float a0[kMaxPlanes];
  alignas(64) float dadx[kMaxPlanes];
  alignas(64) float dady[kMaxPlanes];
  bool unit_w;  ///< 1/w is 1 everywhere, so that perspective planes need no division
};

/// All planes of a primitive.
void compute_planes(const PipelinePlan& plan, const Primitive& primitive, PlaneSet& out);

/// z and the depth bias beside it.
struct DepthPlane {
  float a0, dadx, dady, offset;
};
inline DepthPlane depth_plane(const PlaneSet& planes, const Primitive& primitive) {
  return {planes.a0[kDepthPlane], planes.dadx[kDepthPlane], planes.dady[kDepthPlane], primitive.depth_offset};
}

/// The primitives of a wave's quads, each a stretch of them.
struct WavePlanes {
  std::uint32_t slots = 0;                   ///< primitives
  const PlaneSet* set[base::kQuadsPerWave];  ///< by slot
  std::uint8_t end[base::kQuadsPerWave];     ///< by slot: one past its last quad
};

/// Evaluation points of all lanes, as floats.
struct WavePoints {
  alignas(64) float x[base::kWaveWidth];
  alignas(64) float y[base::kWaveWidth];
};

/// Points of the pixels of all quads, moved by (dx, dy).
void place_points(const QuadPositions& quads, float dx, float dy, WavePoints& out);

/// The same of quads of larger fragments, whose centres are taken for those of pixels.
void place_fragments(const QuadPositions& quads, FragmentRate rate, float dx, float dy, WavePoints& out);

/// fma(dady, y, fma(dadx, x, a0)), times `scale` per lane if given (1/w of perspective planes).
void evaluate_plane(const WavePlanes& wave, std::uint32_t plane, const WavePoints& points, const float* scale,
                    float* out);

/// out = 1 / in, per lane.
void reciprocal(const float* in, float* out);

/// z of the 64 lanes of a block whose first point is (x, y), in quad order: plane, plus bias, clamped to [0, 1] where
/// `restricted` (5.3).
void evaluate_block_depth(const DepthPlane& plane, float x, float y, bool restricted, float* out);

}  // namespace vitrine::raster
