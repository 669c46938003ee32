// Drives the stages of a chunk: vertex waves into stage memory, then primitives or patches of its runs.
#include "raster/front/stages/stages.h"

#include <algorithm>

#include "raster/front/gather.h"
#include "raster/front/stages/geometry.h"
#include "raster/front/stages/tessellation.h"
#include "raster/front/vertices.h"

namespace vitrine::raster {
namespace {

/// Shades `count` gathered vertices into stage memory; returns their first word.
std::size_t shade_vertices(const StageContext& c, std::uint32_t count) {
  StageScratch& s = c.stages;
  const DrawRecord& draw = *c.chunk.draw;
  const std::uint32_t words = c.plan.stages.vertex_words;
  const std::size_t first = s.take(std::size_t{count} * words);
  VertexLanes lanes;
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    shade_vertex_wave(draw, base, std::min<std::uint32_t>(count - base, base::kWaveWidth), c.chunk.view, lanes,
                      c.vertices);
    store_stage_outputs(c.plan.vertex->outputs, c.vertices.runner, lanes.count, s, first + std::size_t{base} * words,
                        words);
  }
  return first;
}

void list_inputs(const StageContext& c, std::uint32_t base, std::uint32_t stride) {
  std::vector<GeometryInput>& inputs = c.stages.inputs;
  inputs.clear();
  const State& state = *c.plan.state;
  for_each_primitive(c.chunk, [&](const Run& run, std::uint32_t i, const auto& entry_of) {
    const bool last_of_strip = run.ends && i + 1 == run.end;
    const InputVertices vertices = input_vertices(state.topology, state.provoking_vertex_last, i, last_of_strip);
    GeometryInput& input = inputs.emplace_back();
    for (std::uint32_t v = 0; v < 6; ++v)
      input.vertex[v] = base + stride * c.vertices.slot[entry_of(vertices.at[v < vertices.count ? v : 0])];
    input.id = input.source = run.first_id + i;
    input.instance = run.instance;
  });
}

void list_patches(const StageContext& c, std::uint32_t base, std::uint32_t stride) {
  StageScratch& s = c.stages;
  s.patch_vertices.clear();
  s.patch_ids.clear();
  s.patch_instances.clear();
  const std::uint32_t points = c.plan.shape.step;
  for_each_primitive(c.chunk, [&](const Run& run, std::uint32_t i, const auto& entry_of) {
    for (std::uint32_t v = 0; v < points; ++v)
      s.patch_vertices.push_back(base + stride * c.vertices.slot[entry_of(i * points + v)]);
    s.patch_ids.push_back(run.first_id + i);
    s.patch_instances.push_back(run.instance);
  });
}

}  // namespace

bool process_stages(const StageContext& c) {
  StageScratch& s = c.stages;
  s.used = 0;
  const std::uint32_t count = gather_vertices(c.chunk, c.vertices);
  count_assembly(c.chunk, count);
  const auto base = static_cast<std::uint32_t>(shade_vertices(c, count) * 4);
  const std::uint32_t stride = c.plan.stages.vertex_words * 4;
  if (c.plan.stages.evaluation) {
    list_patches(c, base, stride);
    run_tessellation(c);
    return false;
  }
  list_inputs(c, base, stride);
  return run_geometry(c, s.inputs);
}

}  // namespace vitrine::raster
