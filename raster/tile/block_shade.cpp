// Shading of whole blocks without packing: varyings from plane equations into the shader's registers, the shader, late
// depth test, rows of colours. Draws whose fragments all have the same colours skip the first two.
#include "raster/tile/block_shade.h"

#include <algorithm>
#include <bit>

#include "base/lane_count.h"
#include "raster/tile/early_tests.h"
#include "raster/tile/fragment_inputs.h"
#include "raster/tile/fragment_outputs.h"
#include "raster/tile/observed.h"
#include "raster/tile/primitive_planes.h"
#include "spirv/counted_runs.h"
#include "spirv/shader_cost.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;
using base::WaveRegister;

/// x and y of pixels as planes, so that FragCoord is evaluated like a varying.
struct PositionPlanes {
  PlaneSet planes{};
  constexpr PositionPlanes() { planes.dadx[0] = planes.dady[1] = 1; }
};
constexpr PositionPlanes kPositionPlanes;

/// Where planes are evaluated: the 64 pixels of a block, from (x, y) on.
struct BlockPlace {
  int x, y;
  void evaluate(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float center,
                const float* scale) const {
    evaluate_block(planes, varying, count, static_cast<float>(x) + center, static_cast<float>(y) + center, scale);
  }
};

/// Or those of a wave of spans.
struct SpanPlace {
  const SpanWave& wave;
  void evaluate(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float center,
                const float* scale) const {
    evaluate_spans(planes, varying, count, wave, center, scale);
  }
};

/// The fragments of one primitive there (fragment_inputs.h).
template <class Place>
struct PlacedFragments {
  const Primitive& primitive;
  const PlaneSet& planes;
  const Place& place;
  float center;

  void evaluate(const PlaneSet& set, std::uint32_t plane, float at, float* out) const {
    const BlockVarying varying{plane, out};
    place.evaluate(set, &varying, 1, at, nullptr);
  }
  bool has_unit_w() const { return planes.unit_w; }
  void reciprocal_w(float* out) const { evaluate(planes, kReciprocalWPlane, center, out); }
  void position(float* x, float* y) const {
    if (x) evaluate(kPositionPlanes.planes, 0, 0.5f, x);
    if (y) evaluate(kPositionPlanes.planes, 1, 0.5f, y);
  }
  void depth(float* out) const {
    evaluate(planes, kDepthPlane, center, out);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) out[lane] += primitive.depth_offset;
  }
  template <class F>
  void per_primitive(WaveRegister& out, F&& word) const {
    splat(out, word(primitive));
  }
};

template <class Place>
void set_inputs(TileWorker& worker, const Primitive& primitive, const Place& place) {
  const PipelinePlan& plan = *worker.draw->plan;
  const BlockDraw& draw = worker.block_draw;
  const PlaneSet& planes = current_planes(worker, primitive);
  const float center = plan.raster_samples > 1 ? 0.5f : 0.0f;
  const PlacedFragments<Place> fragments{primitive, planes, place, center};
  const float* scale = draw.perspective != 0 ? perspective_scale(worker, fragments) : nullptr;
  const BlockVarying* linear = draw.varying.data() + draw.perspective;
  if (scale) {
    place.evaluate(planes, draw.varying.data(), draw.perspective, center, scale);
    if (draw.varying.size() > draw.perspective)
      place.evaluate(planes, linear, draw.varying.size() - draw.perspective, center, nullptr);
  } else if (!draw.varying.empty()) {
    place.evaluate(planes, draw.varying.data(), draw.varying.size(), center, nullptr);
  }
  set_common_inputs(worker, fragments);
}

/// All lanes of quads with a lane in `lanes`.
LaneMask whole_quads(LaneMask lanes) { return base::quads_of_lanes(lanes) * 15; }

void write_block(TileWorker& worker, int x, int y, const LaneMask* kept) {
  const PipelinePlan& plan = *worker.draw->plan;
  BlockDraw& draw = worker.block_draw;
  QuadPositions quads;
  bool placed = false;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    const ColorWriter& writer = plan.writer[i];
    if (!writer.function || worker.target.layer >= view.layer_count) continue;
    if (!writer.block) {
      if (!placed) place_block(x, y, quads);
      placed = true;
      const ColorRegisters color = collect_color(worker, plan.frag.color[i], false, worker.color);
      for (std::uint32_t s = 0; s < plan.samples; ++s)
        write_color(writer, {&view, worker.target.layer, s, &quads, kept[s], color, nullptr});
      continue;
    }
    const auto pixels = [&](std::uint32_t sample) {
      return BlockPixels{
          view.block(0, worker.target.layer, sample, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0),
          view.level[0].row_pitch};
    };
    if (!draw.solid && plan.samples == 1) {
      writer.block->write(writer, collect_color(worker, plan.frag.color[i], false, worker.color), pixels(0),
                          rows_of_quads(kept[0]));
      continue;
    }
    if (!draw.solid)
      writer.block->pack(writer, collect_color(worker, plan.frag.color[i], false, worker.color), draw.color[i]);
    for (std::uint32_t s = 0; s < plan.samples; ++s)
      if (kept[s]) writer.block->write_packed(writer, draw.color[i], pixels(s), rows_of_quads(kept[s]));
  }
}

/// What the shader has given to the attachments.
void tell_coloring(TileWorker& worker) {
  const PipelinePlan& plan = *worker.draw->plan;
  for (std::uint32_t i = 0; i < plan.color_count; ++i)
    if (plan.writer[i].function)
      worker.watch->coloring(worker.told.group, i, collect_color(worker, plan.frag.color[i], false, worker.color));
}

void tell_written_colors(TileWorker& worker, const LaneMask* kept) {
  const PipelinePlan& plan = *worker.draw->plan;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    if (plan.writer[i].function && worker.target.layer < view.layer_count)
      tell_colors(worker, view, kept, 0, plan.samples);
  }
}

/// What discarding has left, `alive`, and the late depth test: `kept`; null: there is none.
void tell_shaded(TileWorker& worker, const Primitive& primitive, const BlockCoverage& block, LaneMask alive,
                 const LaneMask* kept) {
  const std::uint32_t samples = worker.draw->plan->samples;
  LaneMask shaded[kMaxSamples];
  for (std::uint32_t s = 0; s < samples; ++s) shaded[s] = block.lanes[s] & alive;
  if ((any_sample(block, samples) & ~alive) != 0) tell_lost(worker, FragmentTest::kDiscard, shaded, 0, samples);
  if (kept == nullptr) return;
  FailedTests failed[kMaxSamples];
  for (std::uint32_t s = 0; s < samples; ++s) failed[s].depth = shaded[s] & ~kept[s];
  tell_tests(worker, failed, primitive.front ? 0xffffu : 0, 0, samples, true);
}

/// shade_block() and shade_observed_block().
template <bool kObserved>
void shade(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const LaneMask pixels = any_sample(block, plan.samples);
  const LaneMask active = plan.fragment->needs_helpers ? whole_quads(pixels) : pixels;
  LaneMask alive = pixels;
  if (!worker.block_draw.solid) {
    set_inputs(worker, primitive, BlockPlace{x, y});
    if constexpr (kObserved) worker.watch->shading(worker.told.group);
    alive = worker.runner.run(active, active & ~pixels);
  } else if (kObserved && worker.block_draw.counted) {
    spirv::count_runs(*worker.draw->fragment.bound, active, active & ~pixels, 1);
  }
  if (worker.counts) worker.fragment_invocations += static_cast<std::uint64_t>(std::popcount(pixels));
  const bool counts_early = plan.counts_early;  // also what the shader discards
  const bool late = plan.depth_order == TestOrder::kLate;
  LaneMask kept[kMaxSamples];
  for (std::uint32_t s = 0; s < plan.samples; ++s) {
    kept[s] = block.lanes[s] & alive;
    if constexpr (kObserved)
      if (late) tell_block_depths(worker, primitive, x, y, s);
    if (late) test_blocks(worker, primitive, s, x, y, 1, &kept[s], true);
    count_samples(worker, counts_early ? block.lanes[s] : kept[s]);
  }
  if constexpr (kObserved) {
    tell_shaded_block(worker, x, y, pixels, active & ~pixels);
    tell_shaded(worker, primitive, block, alive, late ? kept : nullptr);
    tell_coloring(worker);
  }
  if (std::any_of(kept, kept + plan.samples, [](LaneMask lanes) { return lanes != 0; }))
    write_block(worker, x, y, kept);
  if constexpr (kObserved) {
    tell_written_colors(worker, kept);
    tell_passed(worker);
  }
}

/// The quads of a wave; those beyond are at the window's first pixel.
void place_quads(const SpanWave& wave, QuadPositions& out) {
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    out.x[q] = static_cast<std::uint16_t>(wave.x + static_cast<int>(wave.quad_x >> 4 * q & 15) * 2);
    out.y[q] = static_cast<std::uint16_t>(wave.y + static_cast<int>(wave.quad_y >> 4 * q & 15) * 2);
  }
}

/// Writes the covered pixels of a wave.
void write_spans(TileWorker& worker, const SpanWave& wave) {
  const PipelinePlan& plan = *worker.draw->plan;
  const BlockDraw& draw = worker.block_draw;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    const ColorWriter& writer = plan.writer[i];
    if (!writer.function || worker.target.layer >= view.layer_count) continue;
    if (!writer.block) {
      QuadPositions quads;
      place_quads(wave, quads);
      write_color(writer, {&view, worker.target.layer, 0, &quads, lanes_of_spans(wave.rows),
                           collect_color(worker, plan.frag.color[i], false, worker.color), nullptr});
      continue;
    }
    const BlockPixels pixels{view.block(0, worker.target.layer, 0, 0, 0, 0), view.level[0].row_pitch};
    if (draw.solid)
      writer.block->write_packed_spans(writer, draw.color[i], pixels, wave);
    else
      writer.block->write_spans(writer, collect_color(worker, plan.frag.color[i], false, worker.color), pixels, wave);
  }
}

}  // namespace

void begin_blocks(TileWorker& worker) {
  const PipelinePlan& plan = *worker.draw->plan;
  if (!plan.shades_blocks) return;
  BlockDraw& draw = worker.block_draw;
  draw.varying.clear();
  draw.perspective = 0;
  const auto add_varyings = [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = 0; i < plan.read_count; ++i)
      if (const VaryingRead& read = plan.read[i]; read.varying >= first && read.varying < end)
        draw.varying.push_back({kFirstVaryingPlane + read.varying, as_floats(worker.runner.input(read.reg))});
  };
  add_varyings(0, plan.perspective_count);
  draw.perspective = draw.varying.size();
  add_varyings(plan.perspective_count, plan.perspective_count + plan.linear_count);
  const spirv::BoundShader* shader = worker.draw->fragment.bound;
  draw.is_short = shader == nullptr || spirv::is_short(shader->shader());
  draw.solid = !plan.may_kill && !plan.fragment->writes_memory;
  draw.counted = draw.solid && worker.watch && shader != nullptr && spirv::is_counted(*shader);
  for (std::uint32_t i = 0; i < plan.color_count; ++i)
    for (const std::uint32_t reg : plan.frag.color[i])
      if (plan.writer[i].function && reg != kNoReg)
        draw.solid =
            draw.solid && (draw.counted ? spirv::is_counted_constant(*shader, reg) : worker.runner.is_constant(reg));
  if (!draw.solid) return;
  for (std::uint32_t i = 0; i < plan.color_count; ++i)
    if (const BlockColorFunctions* functions = plan.writer[i].block)
      functions->pack(plan.writer[i], collect_color(worker, plan.frag.color[i], false, worker.color), draw.color[i]);
}

void shade_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  shade<false>(worker, primitive, x, y, block);
}

void shade_observed_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  tell_block(worker, primitive, x, y, block);
  shade<true>(worker, primitive, x, y, block);
}

void shade_whole_blocks(TileWorker& worker, const Primitive& primitive, LaneMask places, bool hidden) {
  const BlockDraw& draw = worker.block_draw;
  if (draw.counted && (draw.solid || hidden))
    spirv::count_runs(*worker.draw->fragment.bound, base::kAllLanes, 0, base::count_lanes(places));
  if (draw.counted && hidden) return;
  BlockCoverage block;
  std::fill_n(block.lanes, worker.draw->plan->samples, base::kAllLanes);
  const bool only_writes = draw.solid && !worker.counts && worker.draw->plan->depth_order != TestOrder::kLate;
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    const int x = worker.target.x + lane_x(place) * kBlockSize, y = worker.target.y + lane_y(place) * kBlockSize;
    if (only_writes)
      write_block(worker, x, y, block.lanes);
    else
      shade<false>(worker, primitive, x, y, block);
  }
}

void shade_spans(TileWorker& worker, const Primitive& primitive, SpanWave& wave) {
  const PipelinePlan& plan = *worker.draw->plan;
  const auto covered = static_cast<std::uint64_t>(std::popcount(wave.rows));
  if (!worker.block_draw.solid) {
    const LaneMask pixels = lanes_of_spans(wave.rows);
    set_inputs(worker, primitive, SpanPlace{wave});
    const LaneMask active = plan.fragment->needs_helpers ? whole_quads(pixels) : pixels;
    const LaneMask alive = worker.runner.run(active, active & ~pixels);
    if ((pixels & ~alive) != 0) wave.rows = rows_of_spans(pixels & alive);
  }
  if (worker.counts) {
    const bool counts_early = plan.counts_early;  // also what the shader discards
    worker.fragment_invocations += covered;
    worker.samples_passed += counts_early ? covered : static_cast<std::uint64_t>(std::popcount(wave.rows));
  }
  if (wave.rows != 0) write_spans(worker, wave);
}

}  // namespace vitrine::raster
