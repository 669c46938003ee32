// What tessellation and geometry stages of one thread work with: vertices go from stage to stage through stage memory
// (spirv/stage_memory.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/arena.h"
#include "raster/front/feedback.h"
#include "raster/front/primitives.h"
#include "raster/front/stages/tessellator.h"
#include "raster/front/vertex_scratch.h"

namespace vitrine::raster {

/// Byte offsets of vertices in stage memory, for one geometry shader primitive; unused ones repeat the first.
struct GeometryInput {
  std::uint32_t vertex[6];
  std::uint32_t id;          ///< gl_PrimitiveIDIn
  std::uint32_t source;      ///< primitive, or patch, of the draw that it comes from
  std::uint32_t instance;    ///< without first_instance
  std::uint32_t number = 0;  ///< among those of its patch
};

/// A domain point of one of the patches at hand.
struct PatchPoint {
  float u, v;
  std::uint32_t patch;
  std::uint32_t number;  ///< in the patch
};

/// Working memory of one thread, kept between chunks.
struct StageScratch {
  StageRunner control, evaluation, geometry;
  Stage bound_control, bound_evaluation, bound_geometry;
  std::vector<std::uint32_t> memory;  ///< stage memory
  std::size_t used = 0;               ///< words of it
  Tessellator tessellator;
  std::vector<std::uint32_t> patch_vertices;              ///< byte offsets, State::patch_control_points a patch
  std::vector<std::uint32_t> patch_ids, patch_instances;  ///< gl_PrimitiveID; without first_instance
  std::vector<PatchPoint> points;
  std::vector<GeometryInput> inputs;
  std::vector<std::uint32_t> emitted;  ///< words in stage memory of vertices for the rasterizer
  std::vector<ListedPrimitive> listed;
  std::vector<ListedPrimitive> segment;     ///< those of the waves before, where they are worked on together
  std::vector<base::WaveRegister> staging;  ///< emitted vertices of one wave, a register per word

  /// `words` words of zeros behind what is in use; their first word.
  std::size_t take(std::size_t words);
};

/// What the stages of one chunk work with.
struct StageContext {
  const Chunk& chunk;
  const PassDesc& pass;
  Arena& arena;
  VertexScratch& vertices;
  PrimitiveList& primitives;
  StageScratch& stages;
  CaptureScratch& capture;
  const PipelinePlan& plan;

  PrimitiveContext primitive_context() const { return {chunk, pass, arena, vertices, primitives}; }
  const QueryCounters& queries() const { return chunk.draw->call.queries; }
};

/// Makes a stage the runner's, if it is not.
void bind_stage(StageRunner& runner, Stage& bound, const Stage& stage);

/// Outputs of the lanes just run to vertices of `words` words each, at word `first` of stage memory.
void store_stage_outputs(const std::vector<spirv::InterfaceSlot>& outputs, const StageRunner& runner,
                         std::uint32_t lanes, StageScratch& scratch, std::size_t first, std::uint32_t words);

}  // namespace vitrine::raster
