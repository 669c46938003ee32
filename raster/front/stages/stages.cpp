// Drives the stages of a chunk: vertex waves into stage memory, then primitives or patches of its runs.
#include "raster/front/stages/stages.h"

#include <algorithm>

#include "raster/front/assembly.h"
#include "raster/front/front.h"
#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

/// Shades `count` gathered vertices into stage memory; returns their first word.
std::size_t shade_vertices(const StageContext& c, std::uint32_t count) {
  FrontScratch& s = c.scratch;
  const DrawRecord& draw = *c.chunk.draw;
  const std::uint32_t words = c.plan.stages.vertex_words;
  const std::size_t first = s.stages.take(std::size_t{count} * words);
  VertexLanes lanes;
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    shade_vertex_wave(draw, base, std::min<std::uint32_t>(count - base, base::kWaveWidth), c.chunk.view, lanes, s);
    store_stage_outputs(c.plan.vertex->outputs, s.runner, lanes.count, s.stages, first + std::size_t{base} * words,
                        words);
  }
  return first;
}

/// Calls f(entry of position p in scratch.slot, its run, primitive) for every primitive of the chunk.
template <class F>
void each_primitive(const StageContext& c, F&& f) {
  std::uint32_t first_entry = 0;
  for (std::uint32_t r = 0; r < c.chunk.run_count; ++r) {
    const Run& run = c.chunk.runs[r];
    const RunSpan span = run_span(c.plan.shape, run);
    const auto slot_of = [&](std::uint32_t position) -> std::uint32_t {
      return c.scratch.slot[first_entry + span.entry(position)];
    };
    for (std::uint32_t i = run.begin; i < run.end; ++i) f(run, i, slot_of);
    first_entry += span.count();
  }
}

void list_inputs(const StageContext& c, std::uint32_t base, std::uint32_t stride) {
  std::vector<GeometryInput>& inputs = c.scratch.stages.inputs;
  inputs.clear();
  const State& state = *c.plan.state;
  each_primitive(c, [&](const Run& run, std::uint32_t i, const auto& slot_of) {
    const bool last_of_strip = run.ends && i + 1 == run.end;
    const InputVertices vertices = input_vertices(state.topology, state.provoking_vertex_last, i, last_of_strip);
    GeometryInput& input = inputs.emplace_back();
    for (std::uint32_t v = 0; v < 6; ++v)
      input.vertex[v] = base + stride * slot_of(vertices.at[v < vertices.count ? v : 0]);
    input.id = run.first_id + i;
  });
}

void list_patches(const StageContext& c, std::uint32_t base, std::uint32_t stride) {
  StageScratch& s = c.scratch.stages;
  s.patch_vertices.clear();
  s.patch_ids.clear();
  const std::uint32_t points = c.plan.shape.step;
  each_primitive(c, [&](const Run& run, std::uint32_t i, const auto& slot_of) {
    for (std::uint32_t v = 0; v < points; ++v) s.patch_vertices.push_back(base + stride * slot_of(i * points + v));
    s.patch_ids.push_back(run.first_id + i);
  });
}

}  // namespace

std::size_t StageScratch::take(std::size_t words) {
  const std::size_t first = used;
  used += words;
  if (memory.size() < used) memory.resize(std::max(used, memory.size() * 2));
  std::fill(memory.begin() + static_cast<std::ptrdiff_t>(first), memory.begin() + static_cast<std::ptrdiff_t>(used),
            0u);
  return first;
}

void store_stage_outputs(const std::vector<spirv::InterfaceSlot>& outputs, const StageRunner& runner,
                         std::uint32_t lanes, StageScratch& scratch, std::size_t first, std::uint32_t words) {
  for (const spirv::InterfaceSlot& slot : outputs) {
    const std::uint32_t word = spirv::vertex_word(slot);
    if (word >= words) continue;
    const std::uint32_t* lane = runner.output(slot.reg).lane;
    std::uint32_t* to = scratch.memory.data() + first + word;
    for (std::uint32_t i = 0; i < lanes; ++i, to += words) *to = lane[i];
  }
}

void count_statistic(const StageContext& c, std::uint32_t index, std::uint64_t count) {
  if (std::atomic<std::uint64_t>* statistics = c.chunk.draw->call.queries.statistics)
    statistics[index].fetch_add(count, std::memory_order_relaxed);
}

void process_stages(const Chunk& chunk, const PassDesc& pass, Arena& arena, FrontScratch& scratch) {
  const StageContext c{chunk, pass, arena, scratch, *chunk.draw->plan};
  StageScratch& s = scratch.stages;
  s.used = 0;
  const std::uint32_t count = gather_vertices(chunk, scratch);
  count_assembly(chunk, count);
  const auto base = static_cast<std::uint32_t>(shade_vertices(c, count) * 4);
  const std::uint32_t stride = c.plan.stages.vertex_words * 4;
  if (c.plan.stages.evaluation) {
    list_patches(c, base, stride);
    run_tessellation(c);
  } else {
    list_inputs(c, base, stride);
    run_geometry(c, s.inputs);
  }
}

}  // namespace vitrine::raster
