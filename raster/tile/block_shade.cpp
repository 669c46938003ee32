// Shading of whole blocks without packing: varyings from plane equations into the shader's registers, the shader, late
// depth test, rows of colours. Draws whose fragments all have the same colours skip the first two.
#include <algorithm>
#include <bit>

#include "base/numeric.h"
#include "raster/tile/spans.h"
#include "raster/tile/tile.h"
#include "spirv/shader_cost.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;
using base::WaveRegister;

float* as_floats(WaveRegister& reg) { return reinterpret_cast<float*>(reg.lane); }

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

template <class Place>
void set_varyings(TileWorker& worker, const PlaneSet& planes, const Place& place, float center) {
  const BlockDraw& draw = worker.block_draw;
  const float* scale = nullptr;
  if (draw.perspective != 0 && !planes.unit_w) {
    const BlockVarying w{kReciprocalWPlane, worker.reciprocal_w};
    place.evaluate(planes, &w, 1, center, nullptr);
    reciprocal(worker.reciprocal_w, worker.reciprocal_w);
    scale = worker.reciprocal_w;
  }
  const BlockVarying* linear = draw.varying.data() + draw.perspective;
  if (scale) {
    place.evaluate(planes, draw.varying.data(), draw.perspective, center, scale);
    if (draw.varying.size() > draw.perspective)
      place.evaluate(planes, linear, draw.varying.size() - draw.perspective, center, nullptr);
  } else if (!draw.varying.empty()) {
    place.evaluate(planes, draw.varying.data(), draw.varying.size(), center, nullptr);
  }
}

template <class Place>
void set_frag_coord(TileWorker& worker, const PlaneSet& planes, const Primitive& primitive, const Place& place,
                    float center) {
  const auto& reg = worker.draw->plan->frag.frag_coord;
  for (std::uint32_t c = 0; c < 2; ++c)
    if (reg[c] != kNoReg) {
      const BlockVarying position{c, as_floats(worker.runner.input(reg[c]))};
      place.evaluate(kPositionPlanes.planes, &position, 1, 0.5f, nullptr);
    }
  if (reg[2] != kNoReg) {
    float* z = as_floats(worker.runner.input(reg[2]));
    const BlockVarying depth{kDepthPlane, z};
    place.evaluate(planes, &depth, 1, center, nullptr);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) z[lane] += primitive.depth_offset;
  }
  if (reg[3] != kNoReg) {
    const BlockVarying w{kReciprocalWPlane, as_floats(worker.runner.input(reg[3]))};
    place.evaluate(planes, &w, 1, center, nullptr);
  }
}

void splat(TileWorker& worker, std::uint32_t reg, std::uint32_t value) {
  if (reg != kNoReg) std::fill_n(worker.runner.input(reg).lane, base::kWaveWidth, value);
}

template <class Place>
void set_inputs(TileWorker& worker, const Primitive& primitive, const Place& place) {
  const PipelinePlan& plan = *worker.draw->plan;
  const PlaneSet& planes = current_planes(worker, primitive);
  const float center = plan.raster_samples > 1 ? 0.5f : 0.0f;
  set_varyings(worker, planes, place, center);
  const std::uint32_t smooth = plan.perspective_count + plan.linear_count;
  for (std::uint32_t i = 0; i < plan.read_count; ++i)
    if (const VaryingRead& read = plan.read[i]; read.varying >= smooth)
      splat(worker, read.reg, base::bits_of(primitive.v[primitive.provoking][4 + read.varying]));
  set_frag_coord(worker, planes, primitive, place, center);
  splat(worker, plan.frag.front_facing, primitive.front ? ~0u : 0u);
  splat(worker, plan.frag.primitive_id, primitive.id);
}

/// All lanes of quads with a lane in `lanes`.
LaneMask whole_quads(LaneMask lanes) { return base::quads_of_lanes(lanes) * 15; }

/// The four registers of a colour, copied where they are not adjacent. Components that are not written are 0.
const WaveRegister* collect_color(TileWorker& worker, const std::array<std::uint32_t, 4>& regs) {
  const StageRunner& runner = worker.runner;
  const bool adjacent = regs[0] != kNoReg && regs[1] == regs[0] + 1 && regs[2] == regs[0] + 2 && regs[3] == regs[0] + 3;
  if (adjacent) return &runner.output(regs[0]);
  for (std::uint32_t c = 0; c < 4; ++c) {
    if (regs[c] == kNoReg)
      worker.color[c] = {};
    else
      worker.color[c] = runner.output(regs[c]);
  }
  return worker.color;
}

void write_block(TileWorker& worker, int x, int y, const LaneMask* kept) {
  const PipelinePlan& plan = *worker.draw->plan;
  BlockDraw& draw = worker.block_draw;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    const ColorWriter& writer = plan.writer[i];
    if (!writer.function || worker.target.layer >= view.layer_count) continue;
    if (!writer.block) {
      QuadPositions quads;
      place_block(x, y, quads);
      const WaveRegister* color = collect_color(worker, plan.frag.color[i]);
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
      writer.block->write(writer, collect_color(worker, plan.frag.color[i]), pixels(0), rows_of_quads(kept[0]));
      continue;
    }
    if (!draw.solid) writer.block->pack(writer, collect_color(worker, plan.frag.color[i]), draw.color[i]);
    for (std::uint32_t s = 0; s < plan.samples; ++s)
      if (kept[s]) writer.block->write_packed(writer, draw.color[i], pixels(s), rows_of_quads(kept[s]));
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
                           collect_color(worker, plan.frag.color[i]), nullptr});
      continue;
    }
    const BlockPixels pixels{view.block(0, worker.target.layer, 0, 0, 0, 0), view.level[0].row_pitch};
    if (draw.solid)
      writer.block->write_packed_spans(writer, draw.color[i], pixels, wave);
    else
      writer.block->write_spans(writer, collect_color(worker, plan.frag.color[i]), pixels, wave);
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
  for (std::uint32_t i = 0; i < plan.color_count; ++i)
    for (const std::uint32_t reg : plan.frag.color[i])
      if (plan.writer[i].function && reg != kNoReg) draw.solid = draw.solid && worker.runner.is_constant(reg);
  if (!draw.solid) return;
  for (std::uint32_t i = 0; i < plan.color_count; ++i)
    if (const BlockColorFunctions* functions = plan.writer[i].block)
      functions->pack(plan.writer[i], collect_color(worker, plan.frag.color[i]), draw.color[i]);
}

namespace {

BlockPixels depth_pixels(const DepthStencilTarget& target, int x, int y) {
  const std::uint64_t texel_bytes = target.format == DepthFormat::kD16 ? 2 : 4;
  return {
      target.depth + static_cast<std::uint64_t>(y) * target.depth_pitch + static_cast<std::uint64_t>(x) * texel_bytes,
      target.depth_pitch};
}

BlockDepthTest depth_test(const PipelinePlan& plan, const DepthStencilTarget& target, bool write,
                          const DepthRange& range) {
  return {target.format, plan.state->depth_compare, write && plan.depth_write,
          plan.state->depth_clamp ? &range : nullptr, plan.restricts_depth};
}

/// `range`: room for the primitive's depth clamp.
HierarchicalTest hierarchical_test(TileWorker& worker, const Primitive& primitive, DepthRange& range) {
  const PipelinePlan& plan = *worker.draw->plan;
  const TileTarget& target = worker.target;
  range = depth_range(plan, primitive.viewport);
  return {depth_test(plan, target.depth_stencil[0], false, range),
          depth_plane(current_planes(worker, primitive), primitive), static_cast<float>(target.x),
          static_cast<float>(target.y), plan.locations};
}

}  // namespace

void test_windows(TileWorker& worker, std::uint32_t viewport, DepthWindow* windows, std::size_t count) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[0];
  const DepthRange range = depth_range(plan, viewport);
  test_window_depths(depth_test(plan, target, plan.depth_order == TestOrder::kEarly, range), depth_pixels(target, 0, 0),
                     windows, count);
}

LaneMask test_blocks(TileWorker& worker, const Primitive& primitive, std::uint32_t sample, int x, int y,
                     LaneMask places, LaneMask* lanes, bool write) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[sample];
  const float dx = plan.locations->pixel_x(sample), dy = plan.locations->pixel_y(sample);
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  const DepthRange range = depth_range(plan, primitive.viewport);
  return test_block_depths(depth_test(plan, target, write, range), plane, static_cast<float>(x) + dx,
                           static_cast<float>(y) + dy, depth_pixels(target, x, y), places, lanes);
}

bool test_large_window(TileWorker& worker, const Primitive& primitive, int x, int y, LargeWindow& window) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[0];
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  const DepthRange range = depth_range(plan, primitive.viewport);
  return test_large_window_depths(depth_test(plan, target, plan.depth_order == TestOrder::kEarly, range), plane,
                                  static_cast<float>(x), static_cast<float>(y), depth_pixels(target, x, y), window);
}

LaneMask unhidden_places(TileWorker& worker, const Primitive& primitive, LaneMask places) {
  DepthRange range;
  return unhidden_blocks(worker.hierarchy, hierarchical_test(worker, primitive, range), places);
}

void learn_hidden_places(TileWorker& worker, const Primitive& primitive, LaneMask places) {
  DepthRange range;
  const TileTarget& target = worker.target;
  const std::uint32_t samples = worker.draw->plan->samples;
  BlockPixels pixels[kMaxSamples];
  for (std::uint32_t s = 0; s < samples; ++s) pixels[s] = depth_pixels(target.depth_stencil[s], target.x, target.y);
  learn_depths(worker.hierarchy, hierarchical_test(worker, primitive, range), pixels, samples, places);
}

void shade_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const LaneMask pixels = any_sample(block, plan.samples);
  LaneMask alive = pixels;
  if (!worker.block_draw.solid) {
    set_inputs(worker, primitive, BlockPlace{x, y});
    const LaneMask active = plan.fragment->needs_helpers ? whole_quads(pixels) : pixels;
    alive = worker.runner.run(active, active & ~pixels);
  }
  if (worker.counts) worker.fragment_invocations += static_cast<std::uint64_t>(std::popcount(pixels));
  const bool counts_early = plan.fragment->early_fragment_tests;  // also what the shader discards
  LaneMask kept[kMaxSamples];
  for (std::uint32_t s = 0; s < plan.samples; ++s) {
    kept[s] = block.lanes[s] & alive;
    if (plan.depth_order == TestOrder::kLate) test_blocks(worker, primitive, s, x, y, 1, &kept[s], true);
    if (worker.counts)
      worker.samples_passed += static_cast<std::uint64_t>(std::popcount(counts_early ? block.lanes[s] : kept[s]));
  }
  if (std::any_of(kept, kept + plan.samples, [](LaneMask lanes) { return lanes != 0; }))
    write_block(worker, x, y, kept);
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
    const bool counts_early = plan.fragment->early_fragment_tests;  // also what the shader discards
    worker.fragment_invocations += covered;
    worker.samples_passed += counts_early ? covered : static_cast<std::uint64_t>(std::popcount(wave.rows));
  }
  if (wave.rows != 0) write_spans(worker, wave);
}

}  // namespace vitrine::raster
