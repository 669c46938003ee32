// Tessellation and geometry stages of a chunk (Vulkan 1.3.239, Tessellation; Geometry Shading): vertices go from stage
// to stage through stage memory (spirv/stage_memory.h), in waves of patches, domain points and primitives; what the
// last stage gives is assembled in API order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/arena.h"
#include "raster/front/stages/tessellator.h"
#include "raster/primitive.h"

namespace vitrine::raster {

struct Chunk;
struct FrontScratch;

/// Byte offsets of vertices in stage memory, for one geometry shader primitive; unused ones repeat the first.
struct GeometryInput {
  std::uint32_t vertex[6];
  std::uint32_t id;  ///< gl_PrimitiveIDIn
};

/// A primitive between assembly and clipping: slots of the last stage's vertices.
struct ListedPrimitive {
  std::uint32_t slot[3];
  std::uint32_t id;        ///< gl_PrimitiveID
  bool continues = false;  ///< a strip: the line stipple pattern goes on
};

/// A domain point of one of the patches at hand.
struct PatchPoint {
  float u, v;
  std::uint32_t patch;
};

/// Working memory of one thread, kept between chunks.
struct StageScratch {
  StageRunner control, evaluation, geometry;
  Stage bound_control, bound_evaluation, bound_geometry;
  std::vector<std::uint32_t> memory;  ///< stage memory
  std::size_t used = 0;               ///< words of it
  Tessellator tessellator;
  std::vector<std::uint32_t> patch_vertices, patch_ids;  ///< byte offsets, State::patch_control_points a patch
  std::vector<PatchPoint> points;
  std::vector<GeometryInput> inputs;
  std::vector<std::uint32_t> emitted;  ///< words in stage memory of vertices for the rasterizer
  std::vector<ListedPrimitive> listed;
  std::vector<base::WaveRegister> staging;  ///< emitted vertices of one wave, a register per word

  /// `words` words of zeros behind what is in use; their first word.
  std::size_t take(std::size_t words);
};

/// What the stages of one chunk work with.
struct StageContext {
  const Chunk& chunk;
  const PassDesc& pass;
  Arena& arena;
  FrontScratch& scratch;
  const PipelinePlan& plan;
};

/// Shades the chunk's vertices, runs the stages, and leaves the visible primitives in scratch.primitives.
void process_stages(const Chunk& chunk, const PassDesc& pass, Arena& arena, FrontScratch& scratch);

/// geometry.cpp: primitives in, primitives assembled.
void run_geometry(const StageContext& context, std::span<const GeometryInput> inputs);

/// tessellation.cpp: the patches of StageScratch in, primitives assembled or handed to run_geometry().
void run_tessellation(const StageContext& context);

/// Outputs of the lanes just run to vertices of `words` words each, at word `first` of stage memory.
void store_stage_outputs(const std::vector<spirv::InterfaceSlot>& outputs, const StageRunner& runner,
                         std::uint32_t lanes, StageScratch& scratch, std::size_t first, std::uint32_t words);

/// Adds to counter `index` of an active pipeline statistics query.
void count_statistic(const StageContext& context, std::uint32_t index, std::uint64_t count);

}  // namespace vitrine::raster
