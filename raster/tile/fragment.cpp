// One packed wave: fragment shader, coverage changes, late tests, colour (Vulkan 1.3.239, Fragment Operations).
// lavapipe-rasterization.md 5.3, 8.
#include "raster/tile/fragment.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numeric.h"
#include "raster/tile/coarse.h"
#include "raster/tile/fragment_outputs.h"
#include "raster/tile/observed.h"
#include "raster/tile/packed_inputs.h"
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;
using base::WaveRegister;

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

/// gl_SampleMask of fragments of several pixels.
void mask_spread_coverage(ShadeRun& run) {
  WaveRegister scratch;
  const std::uint32_t* mask = output_of(run, run.plan.frag.sample_mask, scratch).lane;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      if ((mask[lane] >> (run.spread->first_bit[lane] + s) & 1) == 0) run.kept[s] &= ~(LaneMask{1} << lane);
}

/// gl_SampleMask.
void mask_coverage(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  if (plan.frag.sample_mask == kNoReg) return;
  if (run.spread) return mask_spread_coverage(run);
  const std::uint32_t* mask = run.worker.runner.output(plan.frag.sample_mask).lane;
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      if ((mask[lane] >> (plan.as_reference.one_sample_masks ? 0 : s) & 1) == 0) run.kept[s] &= ~(LaneMask{1} << lane);
}

/// 8.6.
void cover_by_alpha(ShadeRun& run) {
  const PipelinePlan& plan = run.plan;
  if (!plan.state->alpha_to_coverage || plan.frag.color[0][3] == kNoReg) return;
  WaveRegister scratch;
  const std::uint32_t* alpha = output_of(run, plan.frag.color[0][3], scratch).lane;
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
    WaveRegister scratch;
    const WaveRegister& written = output_of(run, plan.frag.depth, scratch);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) worker.depth[lane] = base::float_of(written.lane[lane]);
  } else {
    const bool located = plan.raster_samples > 1;
    WavePoints points;
    if (located) set_points(run, plan.locations->pixel_x(sample), plan.locations->pixel_y(sample), points);
    evaluate_plane(run.wave.planes, kDepthPlane, located ? points : worker.center, nullptr, worker.depth);
    add_depth_offset(run.wave, worker.depth);
  }
  DepthRange range[base::kQuadsPerWave];
  if (plan.clamps_depth)
    for (std::uint32_t q = 0; q < run.wave.quads; ++q)
      range[q] = depth_range(plan, run.wave.primitive[run.wave.slot[q]]->viewport);
  clamp_depth(plan.clamps_depth ? range : nullptr, plan.restricts_depth, run.wave.quads, worker.depth);
}

template <bool kObserved>
void test_late(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  const std::uint32_t front = facing_bits(run.wave);
  WaveRegister scratch;
  const std::uint32_t* reference =
      plan.frag.stencil != kNoReg ? output_of(run, plan.frag.stencil, scratch).lane : nullptr;
  [[maybe_unused]] FailedTests failed[kObserved ? kMaxSamples : 1];
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) {
    if (!run.kept[s]) continue;
    if (plan.tests.depth) {
      late_depth(run, s);
      if constexpr (kObserved) worker.watch->testing(worker.told.group, s, worker.depth);
    }
    run.kept[s] = test_depth_stencil(plan.tests, worker.target.depth_stencil[s], run.wave.position, front, worker.depth,
                                     reference, run.kept[s], true, kObserved ? failed + s : nullptr);
    if (!plan.as_reference.first_sample_depth) continue;
    std::fill(run.kept + s, run.kept + run.end_sample, run.kept[s]);
    break;
  }
  if constexpr (kObserved) tell_tests(worker, failed, front, run.first_sample, run.end_sample, true);
}

template <bool kObserved>
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
    const bool integer = numeric == texel::Numeric::kUint || numeric == texel::Numeric::kSint;
    const bool scaled = !integer || plan.as_reference.scales_integers;
    const ColorRegisters color = collect_color(worker, plan.frag.color[i], scaled, worker.color, run.spread);
    if constexpr (kObserved) worker.watch->coloring(worker.told.group, i, color);
    const bool dual = i == 0 && plan.dual_source;
    const ColorRegisters second =
        dual ? collect_color(worker, plan.frag.color_second, scaled, worker.second, run.spread) : nullptr;
    for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s)
      write_color(plan.writer[i], {&view, worker.target.layer, s, &run.wave.position, run.kept[s], color, second});
    if constexpr (kObserved) tell_colors(worker, view, run.kept, run.first_sample, run.end_sample);
  }
}

void count_kept(ShadeRun& run) {
  if (run.plan.as_reference.one_sample_masks) return count_samples(run.worker, run.kept[0]);
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) count_samples(run.worker, run.kept[s]);
}

/// What becomes of `kept` behind the shader.
template <bool kObserved>
void finish(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  const auto tell = [&](FragmentTest test) {
    if constexpr (kObserved) tell_lost(worker, test, run.kept, run.first_sample, run.end_sample);
  };
  tell(FragmentTest::kDiscard);
  if (plan.smooth_lines) cover_smooth_lines(run);
  if (plan.may_kill) {
    mask_coverage(run);
    tell(FragmentTest::kShaderMask);
    cover_by_alpha(run);
    tell(FragmentTest::kAlphaToCoverage);
  }
  if (plan.depth_order == TestOrder::kLate) test_late<kObserved>(run);
  if (!plan.counts_early) count_kept(run);
  write_colors<kObserved>(run);
}

template <bool kObserved>
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
  if (plan.counts_early) count_kept(run);
  set_packed_inputs(run);
  const LaneMask active = plan.fragment->needs_helpers ? run.used : run.pixels;
  if constexpr (kObserved) worker.watch->shading(worker.told.group);
  run.alive = worker.runner.run(active, active & ~run.pixels);
  if (worker.counts) worker.fragment_invocations += static_cast<std::uint64_t>(std::popcount(run.pixels));
  for (std::uint32_t s = run.first_sample; s < run.end_sample; ++s) run.kept[s] &= run.alive;
  if constexpr (kObserved) worker.watch->shaded(worker.told.group, run.pixels, active & ~run.pixels);
  finish<kObserved>(run);
}

/// What becomes of the pixels in quad `part` of each quad of fragments, which the shader has run for.
template <bool kObserved>
void finish_pixels(const ShadeRun& fragments, std::uint32_t part) {
  TileWorker& worker = fragments.worker;
  const PipelinePlan& plan = fragments.plan;
  FragmentSpread spread;
  if (!take_pixels(worker, part, spread)) return;
  ShadeRun run{worker, worker.block, plan, base::first_lanes(4 * worker.block.quads), 0, 0, plan.samples, {}, 0};
  run.spread = &spread;
  if (plan.depth_order == TestOrder::kLate || plan.smooth_lines) begin_packed_inputs(run);
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
    run.alive |= (fragments.alive >> spread.lane[lane] & 1) << lane;
  for (std::uint32_t s = 0; s < plan.samples; ++s) run.kept[s] = worker.block.coverage[s] & run.alive;
  if constexpr (kObserved) tell_wave(worker, worker.block);
  finish<kObserved>(run);
  if constexpr (kObserved) tell_passed(worker);
}

/// The packed wave of a draw whose fragments may cover several pixels: the shader runs once for each, tests and colours
/// are of pixels.
template <bool kObserved>
void shade_coarse(ShadeRun& run) {
  TileWorker& worker = run.worker;
  const PipelinePlan& plan = run.plan;
  const CoarseWave& coarse = worker.coarse;
  run.pixels = covered_fragments(worker);
  for (std::uint32_t part = 0; plan.counts_early && part < pixels_of(run.rate); ++part)
    for (std::uint32_t s = 0; s < plan.samples; ++s) count_samples(worker, coarse.coverage[part][s]);
  set_packed_inputs(run);
  const LaneMask active = plan.fragment->needs_helpers ? run.used : run.pixels;
  if constexpr (kObserved) {
    tell_fragments(worker);
    worker.watch->shading(worker.told.group);
  }
  run.alive = worker.runner.run(active, active & ~run.pixels);
  if (worker.counts) worker.fragment_invocations += static_cast<std::uint64_t>(std::popcount(run.pixels));
  if constexpr (kObserved) {
    worker.watch->shaded(worker.told.group, run.pixels, active & ~run.pixels);
    worker.told.group.rate = 0;
  }
  for (std::uint32_t part = 0; part < pixels_of(run.rate); ++part) finish_pixels<kObserved>(run, part);
}

/// All runs of a wave.
template <bool kObserved>
void shade_samples(ShadeRun& run, PackedWave& wave) {
  if constexpr (kObserved) tell_wave(run.worker, wave);
  if (!run.plan.sample_shading) return shade<kObserved>(run);
  for (std::uint32_t s = 0; s < run.plan.samples; ++s) {
    run.first_sample = s;
    run.end_sample = s + 1;
    shade<kObserved>(run);
    wave.coverage[s] &= run.alive;  // 8.4: the centroids of later samples do not see what was discarded
  }
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
  if (plan.rates.any) {
    run.coarse = &worker.coarse;
    run.rate = worker.coarse.rate;
  }
  begin_packed_inputs(run);
  if (plan.rates.any) {
    worker.watch ? shade_coarse<true>(run) : shade_coarse<false>(run);
  } else if (worker.watch) {
    shade_samples<true>(run, wave);
    tell_passed(worker);
  } else {
    shade_samples<false>(run, wave);
  }
  release_planes(worker, wave);
  wave.quads = wave.slots = 0;
}

}  // namespace vitrine::raster
