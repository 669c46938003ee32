// One packed wave: interpolation, fragment shader, coverage changes, late tests, colour (Vulkan 1.3.239, Fragment
// Operations). lavapipe-rasterization.md 4.2, 5.3, 8.
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numeric.h"
#include "raster/tile/tile.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;
using base::WaveRegister;

/// What happens once per run of the shader: for all samples together, or for one (sample shading).
struct ShadeRun {
  TileWorker& worker;
  const PackedWave& wave;
  const PipelinePlan& plan;
  LaneMask used;    ///< lanes of packed quads
  LaneMask pixels;  ///< lanes with a covered sample of this run
  std::uint32_t first_sample, end_sample;
  LaneMask kept[kMaxSamples];    ///< result: coverage after the shader
  LaneMask alive;                ///< result: lanes that the shader did not discard
  const float* scale = nullptr;  ///< of perspective planes; null: 1

  bool single() const { return plan.sample_shading; }
  float x() const { return plan.locations->pixel_x(first_sample); }  ///< of the sample being shaded, in its pixel
  float y() const { return plan.locations->pixel_y(first_sample); }
};

void splat(WaveRegister& out, std::uint32_t value) { std::fill_n(out.lane, base::kWaveWidth, value); }

float* as_floats(WaveRegister& reg) { return reinterpret_cast<float*>(reg.lane); }

/// Pixel positions of all lanes, as floats, plus (dx, dy).
void set_points(const PackedWave& wave, float dx, float dy, WavePoints& out) {
  place_points(wave.position, dx, dy, out);
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
  if (location == spirv::SampleLocation::kCenter || run.plan.raster_samples == 1) return worker.center;
  if (location == spirv::SampleLocation::kSample && !run.single()) return worker.center;
  if (prepared != location) {
    if (location == spirv::SampleLocation::kCentroid)
      set_centroids(run, worker.place);
    else
      set_points(run.wave, run.x(), run.y(), worker.place);
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

/// One word per primitive, over its quads.
template <class F>
void per_quad(ShadeRun& run, std::uint32_t reg, F&& value) {
  if (reg == kNoReg) return;
  WaveRegister& out = run.worker.runner.input(reg);
  const PackedWave& wave = run.wave;
  if (wave.slots == 1) {
    splat(out, value(*wave.primitive[0]));
    return;
  }
  std::uint32_t* lane = out.lane;
  for (std::uint32_t slot = 0; slot < wave.slots; ++slot) {
    std::uint32_t* const end = out.lane + 4 * wave.planes.end[slot];
    for (const std::uint32_t word = value(*wave.primitive[slot]); lane != end; ++lane) *lane = word;
  }
}

void read_varyings(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  TileWorker& worker = run.worker;
  auto prepared = spirv::SampleLocation::kCenter;
  const std::uint32_t smooth = plan.perspective_count + plan.linear_count;
  for (std::uint32_t i = 0; i < plan.read_count; ++i) {
    const VaryingRead& read = plan.read[i];
    const std::uint32_t plane = kFirstVaryingPlane + read.varying;
    if (read.varying >= smooth) {
      per_quad(run, read.reg, [&](const Primitive& p) { return base::bits_of(p.v[p.provoking][4 + read.varying]); });
    } else if (read.part != spirv::InputPart::kValue) {
      copy_plane_part(run.wave.planes, plane, read.part, worker.runner.input(read.reg));
    } else {
      const float* scale = read.varying < plan.perspective_count ? run.scale : nullptr;
      evaluate_plane(run.wave.planes, plane, points_of(run, read.location, prepared), scale,
                     as_floats(worker.runner.input(read.reg)));
    }
  }
}

void add_depth_offset(const PackedWave& wave, float* z) {
  for (std::uint32_t q = 0; q < wave.quads; ++q) {
    const float offset = wave.primitive[wave.slot[q]]->depth_offset;
    for (std::uint32_t i = 0; i < 4; ++i) z[4 * q + i] += offset;
  }
}

void set_frag_coord(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const auto& reg = run.plan.frag.frag_coord;
  const bool sampled = run.single();
  const float dx = sampled ? run.x() : 0.5f, dy = sampled ? run.y() : 0.5f;
  WavePoints points;
  if (reg[0] != kNoReg || reg[1] != kNoReg) {
    set_points(run.wave, dx, dy, points);
    if (reg[0] != kNoReg) std::copy_n(points.x, base::kWaveWidth, as_floats(worker.runner.input(reg[0])));
    if (reg[1] != kNoReg) std::copy_n(points.y, base::kWaveWidth, as_floats(worker.runner.input(reg[1])));
  }
  if (reg[2] != kNoReg) {
    float* z = as_floats(worker.runner.input(reg[2]));
    if (sampled) set_points(run.wave, dx, dy, points);
    evaluate_plane(run.wave.planes, kDepthPlane, sampled ? points : worker.center, nullptr, z);
    add_depth_offset(run.wave, z);
  }
  if (reg[3] != kNoReg)
    evaluate_plane(run.wave.planes, kReciprocalWPlane, worker.center, nullptr, as_floats(worker.runner.input(reg[3])));
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
    set_points(run.wave, run.plan.locations->pixel_x(s), run.plan.locations->pixel_y(s), points);
    copy(points.x, x);
    copy(points.y, y);
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
  const LaneMask* samples = run.plan.fragment->post_depth_coverage ? run.wave.coverage : run.wave.rasterized;
  WaveRegister& out = runner.input(frag.sample_mask_in);
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    std::uint32_t mask = 0;
    for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
      mask |= static_cast<std::uint32_t>(samples[s] >> lane & 1) << s;
    out.lane[lane] = run.plan.samples == 1 ? 1 : mask;
  }
}

void set_built_ins(ShadeRun& run) {
  const FragmentRegisters& frag = run.plan.frag;
  StageRunner& runner = run.worker.runner;
  set_frag_coord(run);
  const std::uint32_t point_plane = kFirstVaryingPlane + run.plan.perspective_count + run.plan.linear_count;
  for (std::uint32_t c = 0; c < 2; ++c)
    if (frag.point_coord[c] != kNoReg)
      evaluate_plane(run.wave.planes, point_plane + c, run.worker.center, run.scale,
                     as_floats(runner.input(frag.point_coord[c])));
  per_quad(run, frag.front_facing, [](const Primitive& p) { return p.front ? ~0u : 0u; });
  per_quad(run, frag.primitive_id, [](const Primitive& p) { return p.id; });
  if (frag.view_index != kNoReg)
    splat(runner.input(frag.view_index), run.worker.pass->view_mask != 0 ? run.worker.target.layer : 0);
  if (frag.helper != kNoReg) {
    WaveRegister& out = runner.input(frag.helper);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      out.lane[lane] = (run.pixels >> lane & 1) != 0 ? 0u : ~0u;
  }
  set_sample_inputs(run);
  set_interpolation_places(run);
}

/// 6.5: how much of each pixel a smooth line covers, across it times along it.
void cover_smooth_lines(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const std::uint32_t first = kFirstVaryingPlane + run.plan.perspective_count - 4;
  alignas(64) float across[base::kWaveWidth], half_width[base::kWaveWidth];
  alignas(64) float along[base::kWaveWidth], half_length[base::kWaveWidth];
  float* const values[] = {across, half_width, along, half_length};
  for (std::uint32_t i = 0; i < 4; ++i) evaluate_plane(run.wave.planes, first + i, worker.center, run.scale, values[i]);
  const auto saturate = [](float v) { return v > 0 ? (v < 1 ? v : 1) : 0; };
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
    worker.line_coverage[lane] =
        saturate(half_width[lane] - std::fabs(across[lane])) * saturate(half_length[lane] - std::fabs(along[lane]));
}

/// 8.6, and gl_SampleMask.
void change_coverage(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  StageRunner& runner = run.worker.runner;
  if (plan.frag.sample_mask != kNoReg) {
    const std::uint32_t* mask = runner.output(plan.frag.sample_mask).lane;
    for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
      for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
        if ((mask[lane] >> s & 1) == 0) run.kept[s] &= ~(LaneMask{1} << lane);
  }
  if (!plan.state->alpha_to_coverage || plan.frag.color[0][3] == kNoReg) return;
  const std::uint32_t* alpha = runner.output(plan.frag.color[0][3]).lane;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) {
    const float limit = plan.samples == 1 ? 0.5f : static_cast<float>(s) / static_cast<float>(plan.samples);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      if (base::float_of(alpha[lane]) * (plan.smooth_lines ? run.worker.line_coverage[lane] : 1.0f) <=
          limit)  // NaN: kept
        run.kept[s] &= ~(LaneMask{1} << lane);
  }
}

std::uint32_t facing_bits(const PackedWave& wave) {
  std::uint32_t bits = 0;
  std::uint32_t quad = 1;
  for (std::uint32_t q = 0; q < wave.quads; ++q, quad <<= 1)
    if (wave.primitive[wave.slot[q]]->front) bits |= quad;
  return bits;
}

/// z of one sample of all lanes into worker.depth, clamped (5.3).
void late_depth(ShadeRun& run, std::uint32_t sample) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  if (plan.frag.depth != kNoReg) {
    const WaveRegister& written = worker.runner.output(plan.frag.depth);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) worker.depth[lane] = base::float_of(written.lane[lane]);
  } else {
    const bool located = plan.raster_samples > 1;
    WavePoints points;
    if (located) set_points(run.wave, plan.locations->pixel_x(sample), plan.locations->pixel_y(sample), points);
    evaluate_plane(run.wave.planes, kDepthPlane, located ? points : worker.center, nullptr, worker.depth);
    add_depth_offset(run.wave, worker.depth);
  }
  DepthRange range[base::kQuadsPerWave];
  if (plan.state->depth_clamp)
    for (std::uint32_t q = 0; q < run.wave.quads; ++q)
      range[q] = depth_range(plan, run.wave.primitive[run.wave.slot[q]]->viewport);
  clamp_depth(plan.state->depth_clamp ? range : nullptr, plan.restricts_depth, run.wave.quads, worker.depth);
}

void test_late(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  const std::uint32_t front = facing_bits(run.wave);
  const std::uint32_t* reference = plan.frag.stencil != kNoReg ? worker.runner.output(plan.frag.stencil).lane : nullptr;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) {
    if (!run.kept[s]) continue;
    if (plan.depth_test) late_depth(run, s);
    run.kept[s] = test_depth_stencil(plan, worker.target.depth_stencil[s], run.wave.position, front, worker.depth,
                                     reference, run.kept[s], true);
  }
}

/// The four registers of a colour: the shader's own where they lie next to each other, else copies in `scratch`.
/// Components that are not written are 0. `scaled`: smooth lines scale the alpha.
const WaveRegister* collect_color(const ShadeRun& run, const std::array<std::uint32_t, 4>& regs, bool scaled,
                                  WaveRegister scratch[4]) {
  const StageRunner& runner = run.worker.runner;
  const bool written = std::find(regs.begin(), regs.end(), kNoReg) == regs.end();
  if (written && !run.plan.state->alpha_to_one && !run.plan.smooth_lines) {
    const WaveRegister* first = &runner.output(regs[0]);
    if (&runner.output(regs[1]) == first + 1 && &runner.output(regs[2]) == first + 2 &&
        &runner.output(regs[3]) == first + 3)
      return first;
  }
  for (std::uint32_t c = 0; c < 4; ++c) {
    if (regs[c] == kNoReg)
      splat(scratch[c], 0);
    else
      scratch[c] = runner.output(regs[c]);
  }
  if (run.plan.smooth_lines && scaled)
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      scratch[3].lane[lane] = base::bits_of(base::float_of(scratch[3].lane[lane]) * run.worker.line_coverage[lane]);
  if (run.plan.state->alpha_to_one) splat(scratch[3], base::bits_of(1.0f));
  return scratch;
}

void write_colors(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  LaneMask any = 0;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) any |= run.kept[s];
  if (!any) return;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    if (!plan.writer[i].function || worker.target.layer >= view.layer_count) continue;
    const texel::Numeric numeric = view.format->channel[0].numeric;
    const bool scaled = numeric != texel::Numeric::kUint && numeric != texel::Numeric::kSint;
    const WaveRegister* color = collect_color(run, plan.frag.color[i], scaled, worker.color);
    const bool dual = i == 0 && plan.dual_source;
    const WaveRegister* second = dual ? collect_color(run, plan.frag.color_second, scaled, worker.second) : nullptr;
    for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
      write_color(plan.writer[i], {&view, worker.target.layer, s, &run.wave.position, run.kept[s], color, second});
  }
}

void count_samples(ShadeRun& run) {
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
    run.worker.samples_passed += static_cast<std::uint64_t>(std::popcount(run.kept[s]));
}

void shade(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  run.pixels = 0;
  run.alive = base::kAllLanes;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) {
    run.kept[s] = run.wave.coverage[s];
    run.pixels |= run.kept[s];
  }
  if (!run.pixels) return;
  // Vulkan 1.3.239, Early Fragment Tests: sample counting is performed before the shader runs, too.
  if (worker.counts && plan.fragment->early_fragment_tests) count_samples(run);
  read_varyings(run);
  set_built_ins(run);
  const LaneMask active = plan.fragment->needs_helpers ? run.used : run.pixels;
  run.alive = worker.runner.run(active, active & ~run.pixels);
  if (worker.counts) worker.fragment_invocations += static_cast<std::uint64_t>(std::popcount(run.pixels));
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) run.kept[s] &= run.alive;
  if (plan.smooth_lines) cover_smooth_lines(run);
  if (plan.may_kill) change_coverage(run);
  if (plan.depth_order == TestOrder::kLate) test_late(run);
  if (worker.counts && !plan.fragment->early_fragment_tests) count_samples(run);
  write_colors(run);
}

}  // namespace

void shade_wave(TileWorker& worker, PackedWave& wave) {
  const PipelinePlan& plan = *worker.draw->plan;
  ShadeRun run{worker, wave, plan, base::first_lanes(4 * wave.quads), 0, 0, plan.samples, {}, 0};
  wave.planes.slots = wave.slots;
  // Lanes that no quad fills compute where the first one is: from a feedback loop they load nothing that other tiles
  // write.
  std::fill(wave.position.x + wave.quads, std::end(wave.position.x), wave.position.x[0]);
  std::fill(wave.position.y + wave.quads, std::end(wave.position.y), wave.position.y[0]);
  const float center = plan.raster_samples > 1 ? 0.5f : 0.0f;
  const bool interpolates = plan.perspective_count + plan.linear_count != 0 || plan.depth_order == TestOrder::kLate ||
                            plan.frag.frag_coord[2] != kNoReg || plan.frag.frag_coord[3] != kNoReg ||
                            plan.frag.point_coord[0] != kNoReg || plan.frag.point_coord[1] != kNoReg;
  if (interpolates) set_points(wave, center, center, worker.center);
  if (plan.perspective_count || plan.frag.point_coord[0] != kNoReg || plan.frag.point_coord[1] != kNoReg) {
    const bool unit = std::all_of(wave.planes.set, wave.planes.set + wave.slots, [](auto* set) { return set->unit_w; });
    if (!unit) {
      evaluate_plane(wave.planes, kReciprocalWPlane, worker.center, nullptr, worker.reciprocal_w);
      reciprocal(worker.reciprocal_w, worker.reciprocal_w);
      run.scale = worker.reciprocal_w;
    }
  }
  if (!plan.sample_shading) {
    shade(run);
  } else {
    for (std::uint32_t s = 0; s < plan.samples; ++s) {
      run.first_sample = s;
      run.end_sample = s + 1;
      shade(run);
      wave.coverage[s] &= run.alive;  // 8.4: the centroids of later samples do not see what was discarded
    }
  }
  release_planes(worker, wave);
  wave.quads = wave.slots = 0;
}

}  // namespace vitrine::raster
