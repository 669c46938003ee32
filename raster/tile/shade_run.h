// One run of the fragment shader over a packed wave: for all samples together, or for one of them (sample shading).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// What happens once per run of the shader: for all samples together, or for one (sample shading).
struct ShadeRun {
  TileWorker& worker;
  const PackedWave& wave;
  const PipelinePlan& plan;
  base::LaneMask used;    ///< lanes of packed quads
  base::LaneMask pixels;  ///< lanes with a covered sample of this run
  std::uint32_t first_sample, end_sample;
  base::LaneMask kept[kMaxSamples];  ///< result: coverage after the shader
  base::LaneMask alive;              ///< result: lanes that the shader did not discard
  const float* scale = nullptr;      ///< of perspective planes; null: 1

  bool single() const { return plan.sample_shading; }
  float x() const { return plan.locations->pixel_x(first_sample); }  ///< of the sample being shaded, in its pixel
  float y() const { return plan.locations->pixel_y(first_sample); }
};

/// Pixel positions of all lanes, as floats, plus (dx, dy).
inline void set_points(const PackedWave& wave, float dx, float dy, WavePoints& out) {
  place_points(wave.position, dx, dy, out);
}

inline void add_depth_offset(const PackedWave& wave, float* z) {
  for (std::uint32_t q = 0; q < wave.quads; ++q) {
    const float offset = wave.primitive[wave.slot[q]]->depth_offset;
    for (std::uint32_t i = 0; i < 4; ++i) z[4 * q + i] += offset;
  }
}

}  // namespace vitrine::raster
