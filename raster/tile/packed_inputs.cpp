// Interpolation over packed waves (lavapipe-rasterization.md 4.2, 8.4) and the built-ins of their fragments.
#include "raster/tile/packed_inputs.h"

#include <algorithm>
#include <bit>

#include "raster/tile/coarse.h"
#include "raster/tile/fragment_inputs.h"

namespace vitrine::raster {

namespace {

using base::LaneMask;
using base::WaveRegister;

/// The same of larger fragments: the first covered sample is that of the first pixel with one, rows first.
void set_coarse_centroids(const ShadeRun& run, WavePoints& out) {
  out = run.worker.center;
  const CoarseWave& coarse = *run.coarse;
  const std::uint32_t width = width_of(run.rate), height = height_of(run.rate);
  const float center = run.plan.raster_samples > 1 ? 0.5f : 0.0f;
  base::for_each_lane(run.used, [&](std::size_t lane) {
    std::uint32_t missing = 0, first = ~0u;  // pixel * kMaxSamples + sample
    for (std::uint32_t pixel = 0; pixel < pixels_of(run.rate); ++pixel) {
      // The pixel's place in the quad of fragments.
      const auto x = static_cast<std::uint32_t>(lane & 1) * width + pixel % width;
      const auto y = static_cast<std::uint32_t>(lane >> 1 & 1) * height + pixel / width;
      const std::size_t at = (lane & ~std::size_t{3}) + (y & 1) * 2 + (x & 1);
      for (std::uint32_t s = 0; s < run.plan.samples; ++s) {
        if ((coarse.coverage[y / 2 * width + x / 2][s] >> at & 1) == 0)
          ++missing;
        else
          first = std::min(first, pixel * kMaxSamples + s);
      }
    }
    if (missing == 0 || first == ~0u) return;
    const std::uint32_t pixel = first / kMaxSamples, sample = first % kMaxSamples;
    const std::uint32_t column = pixel % width, row = pixel / width;
    const bool located = run.plan.raster_samples > 1;
    const float left = out.x[lane] - center - static_cast<float>(width - 1) / 2;
    const float top = out.y[lane] - center - static_cast<float>(height - 1) / 2;
    out.x[lane] = left + static_cast<float>(column) + (located ? run.plan.locations->pixel_x(sample) : 0.0f);
    out.y[lane] = top + static_cast<float>(row) + (located ? run.plan.locations->pixel_y(sample) : 0.0f);
  });
}

/// 8.4: the centre where all samples are covered or none is, else the first covered sample.
void set_centroids(const ShadeRun& run, WavePoints& out) {
  const PackedWave& wave = run.wave;
  out = run.worker.center;
  base::for_each_lane(run.used, [&](std::size_t lane) {
    std::uint32_t covered = 0;
    for (std::uint32_t s = 0; s < run.plan.samples; ++s)
      covered |= static_cast<std::uint32_t>(wave.coverage[s] >> lane & 1) << s;
    if (covered == 0 || covered == (1u << run.plan.samples) - 1) return;
    const auto s = static_cast<std::uint32_t>(std::countr_zero(covered));
    out.x[lane] = (out.x[lane] - 0.5f) + run.plan.locations->pixel_x(s);
    out.y[lane] = (out.y[lane] - 0.5f) + run.plan.locations->pixel_y(s);
  });
}

/// Points of a location other than the centre, in worker.place.
const WavePoints& points_of(ShadeRun& run, spirv::SampleLocation location, spirv::SampleLocation& prepared) {
  TileWorker& worker = run.worker;
  if (location == spirv::SampleLocation::kCenter) return worker.center;
  if ((run.plan.raster_samples == 1 || run.rate != 0) && !run.coarse) return worker.center;
  if (location == spirv::SampleLocation::kSample && !run.single()) return worker.center;
  if (prepared != location) {
    if (location == spirv::SampleLocation::kCentroid)
      (run.coarse ? set_coarse_centroids : set_centroids)(run, worker.place);
    else
      set_points(run, run.x(), run.y(), worker.place);
    prepared = location;
  }
  return worker.place;
}

/// A plane's coefficients for interpolateAt*.
void copy_plane_part(const WavePlanes& planes, std::uint32_t plane, spirv::InputPart part, WaveRegister& out) {
  std::uint32_t* lane = out.lane;
  for (std::uint32_t slot = 0; slot < planes.slots; ++slot) {
    const PlaneSet& set = *planes.set[slot];
    const float* coefficients = part == spirv::InputPart::kPlaneOrigin ? set.a0
                                : part == spirv::InputPart::kPlaneX    ? set.dadx
                                                                       : set.dady;
    std::uint32_t* const end = out.lane + 4 * planes.end[slot];
    for (const std::uint32_t value = base::bits_of(coefficients[plane]); lane != end; ++lane) *lane = value;
  }
}

bool is_flat(const PipelinePlan& plan, const VaryingRead& read) {
  return read.varying >= plan.perspective_count + plan.linear_count;
}

/// A perspective or linear varying. `prepared`: whose points worker.place has.
void read_smooth(ShadeRun& run, const VaryingRead& read, spirv::SampleLocation& prepared, WaveRegister& out) {
  const std::uint32_t plane = kFirstVaryingPlane + read.varying;
  if (read.part != spirv::InputPart::kValue) return copy_plane_part(run.wave.planes, plane, read.part, out);
  const float* scale = read.varying < run.plan.perspective_count ? run.scale : nullptr;
  evaluate_plane(run.wave.planes, plane, points_of(run, read.location, prepared), scale, as_floats(out));
}

void read_varyings(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  auto prepared = spirv::SampleLocation::kCenter;
  for (std::uint32_t i = 0; i < plan.read_count; ++i)
    if (const VaryingRead& read = plan.read[i]; !is_flat(plan, read))
      read_smooth(run, read, prepared, run.worker.runner.input(read.reg));
}

/// Where interpolateAt* evaluates planes.
void set_interpolation_places(ShadeRun& run) {
  const FragmentRegisters& frag = run.plan.frag;
  TileWorker& worker = run.worker;
  const auto copy = [&](const float* from, std::uint32_t reg) {
    if (reg != kNoReg) std::copy_n(from, base::kWaveWidth, as_floats(worker.runner.input(reg)));
  };
  copy(worker.center.x, frag.interpolation_center[0]);
  copy(worker.center.y, frag.interpolation_center[1]);
  if (run.scale)
    copy(run.scale, frag.interpolation_scale);
  else if (frag.interpolation_scale != kNoReg)
    splat(worker.runner.input(frag.interpolation_scale), base::bits_of(1.0f));
  for (std::uint32_t s = 0; s < kMaxSamples; ++s) {
    const std::uint32_t x = frag.interpolation_sample[2 * s], y = frag.interpolation_sample[2 * s + 1];
    if (x == kNoReg && y == kNoReg) continue;
    WavePoints points;
    // Of the pixel that has the centre of a larger fragment, or is right and below of it.
    const bool located = run.plan.raster_samples > 1;
    const float right = located && log_width(run.rate) != 0 ? 0.5f : 0,
                down = located && log_height(run.rate) != 0 ? 0.5f : 0;
    set_points(run, run.plan.locations->pixel_x(s) + right, run.plan.locations->pixel_y(s) + down, points);
    copy(points.x, x);
    copy(points.y, y);
  }
}

/// Vulkan 1.3.239, Multisampling: "the coverage index j is determined as a function of the pixel index p": the last
/// pixel of a fragment has the lowest bits.
void set_coarse_mask(const ShadeRun& run, WaveRegister& out) {
  out = {};
  const auto& samples = run.plan.fragment->post_depth_coverage ? run.coarse->coverage : run.coarse->rasterized;
  for (std::uint32_t part = 0; part < pixels_of(run.rate); ++part) {
    const FragmentSpread spread = spread_of(run.rate, part, run.plan.samples);
    for (std::uint32_t s = 0; s < run.plan.samples; ++s)
      base::for_each_lane(samples[part][s],
                          [&](std::size_t lane) { out.lane[spread.lane[lane]] |= 1u << (spread.first_bit[lane] + s); });
  }
}

void set_sample_inputs(ShadeRun& run) {
  const FragmentRegisters& frag = run.plan.frag;
  StageRunner& runner = run.worker.runner;
  const bool located = run.plan.raster_samples > 1 && run.single();
  if (frag.sample_id != kNoReg) splat(runner.input(frag.sample_id), located ? run.first_sample : 0);
  if (frag.sample_position[0] != kNoReg)
    splat(runner.input(frag.sample_position[0]), base::bits_of(located ? run.x() : 0.5f));
  if (frag.sample_position[1] != kNoReg)
    splat(runner.input(frag.sample_position[1]), base::bits_of(located ? run.y() : 0.5f));
  if (frag.sample_mask_in == kNoReg) return;
  if (run.coarse) return set_coarse_mask(run, runner.input(frag.sample_mask_in));
  const LaneMask* samples = run.plan.fragment->post_depth_coverage ? run.wave.coverage : run.wave.rasterized;
  WaveRegister& out = runner.input(frag.sample_mask_in);
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    std::uint32_t mask = 0;
    for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
      mask |= static_cast<std::uint32_t>(samples[s] >> lane & 1) << s;
    out.lane[lane] = run.plan.samples == 1 || run.plan.as_reference.one_sample_masks ? 1 : mask;
  }
}

/// The fragments of a packed wave, of several primitives (fragment_inputs.h).
struct PackedFragments {
  const ShadeRun& run;

  bool has_unit_w() const {
    const WavePlanes& planes = run.wave.planes;
    return std::all_of(planes.set, planes.set + run.wave.slots, [](const PlaneSet* set) { return set->unit_w; });
  }
  void reciprocal_w(float* out) const {
    evaluate_plane(run.wave.planes, kReciprocalWPlane, run.worker.center, nullptr, out);
  }
  void position(float* x, float* y) const {
    WavePoints points;
    set_points(run, run.single() ? run.x() : 0.5f, run.single() ? run.y() : 0.5f, points);
    if (x) std::copy_n(points.x, base::kWaveWidth, x);
    if (y) std::copy_n(points.y, base::kWaveWidth, y);
  }
  void depth(float* out) const {
    WavePoints points;
    if (run.single()) set_points(run, run.x(), run.y(), points);
    evaluate_plane(run.wave.planes, kDepthPlane, run.single() ? points : run.worker.center, nullptr, out);
    add_depth_offset(run.wave, out);
  }
  template <class F>
  void per_primitive(WaveRegister& out, F&& word) const {
    const PackedWave& wave = run.wave;
    if (wave.slots == 1) return splat(out, word(*wave.primitive[0]));
    std::uint32_t* lane = out.lane;
    for (std::uint32_t slot = 0; slot < wave.slots; ++slot) {
      std::uint32_t* const end = out.lane + 4 * wave.planes.end[slot];
      for (const std::uint32_t value = word(*wave.primitive[slot]); lane != end; ++lane) *lane = value;
    }
  }
};

}  // namespace

void begin_packed_inputs(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  const float center = plan.raster_samples > 1 ? 0.5f : 0.0f;
  const bool interpolates = plan.perspective_count + plan.linear_count != 0 || plan.depth_order == TestOrder::kLate ||
                            plan.frag.frag_coord[2] != kNoReg || plan.frag.frag_coord[3] != kNoReg ||
                            plan.frag.point_coord[0] != kNoReg || plan.frag.point_coord[1] != kNoReg;
  if (interpolates) set_points(run, center, center, run.worker.center);
  if (has_perspective(plan)) run.scale = perspective_scale(run.worker, PackedFragments{run});
}

void read_varying(ShadeRun& run, const VaryingRead& read, WaveRegister& out) {
  auto prepared = spirv::SampleLocation::kCenter;
  if (is_flat(run.plan, read))
    PackedFragments{run}.per_primitive(out, [&](const Primitive& p) { return flat_word(p, read); });
  else
    read_smooth(run, read, prepared, out);
}

void set_packed_inputs(ShadeRun& run) {
  read_varyings(run);
  set_common_inputs(run.worker, PackedFragments{run});
  const FragmentRegisters& frag = run.plan.frag;
  StageRunner& runner = run.worker.runner;
  const std::uint32_t point_plane = kFirstVaryingPlane + run.plan.perspective_count + run.plan.linear_count;
  for (std::uint32_t c = 0; c < 2; ++c)
    if (frag.point_coord[c] != kNoReg)
      evaluate_plane(run.wave.planes, point_plane + c, run.worker.center, run.scale,
                     as_floats(runner.input(frag.point_coord[c])));
  if (frag.view_index != kNoReg)
    splat(runner.input(frag.view_index), run.worker.pass->view_mask != 0 ? run.worker.target.layer : 0);
  if (frag.shading_rate != kNoReg) splat(runner.input(frag.shading_rate), run.rate);
  if (frag.helper != kNoReg) {
    WaveRegister& out = runner.input(frag.helper);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      out.lane[lane] = (run.pixels >> lane & 1) != 0 ? 0u : ~0u;
  }
  set_sample_inputs(run);
  set_interpolation_places(run);
}

}  // namespace vitrine::raster
