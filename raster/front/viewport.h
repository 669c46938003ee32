// Clip test and viewport transform of one wave of vertices (lavapipe-rasterization.md 1.2 form A, 1.3, 3.1).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Clip codes: bit 0 x > w, 1 x < -w, 2 y > w, 3 y < -w, 4 near, 5 far, 6+i clip distance i.
using ClipCode = std::uint32_t;
inline constexpr ClipCode kClipXY = 0xf, kClipZ = 0x30;
inline constexpr std::uint32_t kFirstUserPlane = 6;

struct TransformedWave {
  alignas(64) float x[base::kWaveWidth];
  alignas(64) float y[base::kWaveWidth];
  alignas(64) float z[base::kWaveWidth];
  alignas(64) float w[base::kWaveWidth];                 ///< 1 / clip w
  alignas(64) std::int32_t snapped_x[base::kWaveWidth];  ///< 24.8
  alignas(64) std::int32_t snapped_y[base::kWaveWidth];  ///< 24.8
  alignas(64) ClipCode code[base::kWaveWidth];           ///< planes 0..5
};

struct TransformParameters {
  ViewportTransform viewport;
  float pixel_offset;
  bool depth_clip;
  bool negative_one_to_one;
  bool fused;       ///< form A of 1.2, else form B
  bool guard_band;  ///< form B: in x and y against twice the volume
};

/// `clip`: registers of x, y, z, w.
void transform_wave(const float* const clip[4], const TransformParameters& parameters, TransformedWave& out);

/// Form B, one vertex: separate roundings. `window` gets x, y, z, 1/w.
void transform_vertex(const float clip[4], const ViewportTransform& viewport, float window[4]);

}  // namespace vitrine::raster
