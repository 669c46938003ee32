// One run of the fragment shader over a packed wave: for all samples together, or for one of them (sample shading).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Which fragment of a wave the pixels of a wave of their own belong to.
struct FragmentSpread {
  std::uint8_t lane[base::kWaveWidth];       ///< of the fragment, by the pixel's lane
  std::uint8_t first_bit[base::kWaveWidth];  ///< of the pixel's samples in masks of the fragment's
};

inline void spread_lanes(const FragmentSpread& spread, const base::WaveRegister& given, base::WaveRegister& out) {
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) out.lane[lane] = given.lane[spread.lane[lane]];
}

/// What happens once per run of the shader: for all samples together, or for one (sample shading).
struct ShadeRun {
  TileWorker& worker;
  const PackedWave& wave;
  const PipelinePlan& plan;
  base::LaneMask used;    ///< lanes of packed quads
  base::LaneMask pixels;  ///< lanes with a covered sample of this run
  std::uint32_t first_sample, end_sample;
  base::LaneMask kept[kMaxSamples];        ///< result: coverage after the shader
  base::LaneMask alive;                    ///< result: lanes that the shader did not discard
  const float* scale = nullptr;            ///< of perspective planes; null: 1
  FragmentRate rate = 0;                   ///< size of the fragments that the shader runs for
  const CoarseWave* coarse = nullptr;      ///< what they cover; null: as the wave says
  const FragmentSpread* spread = nullptr;  ///< the shader has run for larger fragments than the wave's pixels

  bool single() const { return plan.sample_shading; }
  float x() const { return plan.locations->pixel_x(first_sample); }  ///< of the sample being shaded, in its pixel
  float y() const { return plan.locations->pixel_y(first_sample); }
};

/// What the shader gave for the fragments of all lanes. `scratch`: room for it.
inline const base::WaveRegister& output_of(const ShadeRun& run, std::uint32_t reg, base::WaveRegister& scratch) {
  const base::WaveRegister& given = run.worker.runner.output(reg);
  if (!run.spread) return given;
  spread_lanes(*run.spread, given, scratch);
  return scratch;
}

/// Pixel positions of all lanes, as floats, plus (dx, dy). Of larger fragments: of the pixel that would have its centre
/// where the fragment has it.
inline void set_points(const ShadeRun& run, float dx, float dy, WavePoints& out) {
  if (run.rate == 0)
    place_points(run.wave.position, dx, dy, out);
  else
    place_fragments(run.wave.position, run.rate, dx, dy, out);
}

inline void add_depth_offset(const PackedWave& wave, float* z) {
  for (std::uint32_t q = 0; q < wave.quads; ++q) {
    const float offset = wave.primitive[wave.slot[q]]->depth_offset;
    for (std::uint32_t i = 0; i < 4; ++i) z[4 * q + i] += offset;
  }
}

}  // namespace vitrine::raster
