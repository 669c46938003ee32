// Transform feedback (VK_EXT_transform_feedback; Vulkan 1.3.239, Transform Feedback): chunks gather the outputs of the
// last stage before rasterization, primitive by primitive; afterwards, chunk after chunk, they are written to buffers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/arena.h"
#include "raster/front/assembly.h"
#include "raster/front/chunk.h"
#include "raster/front/vertex_scratch.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// What a chunk captured: words of the stream's captures for every vertex of every primitive.
struct CaptureOutput {
  struct Stream {
    const std::uint32_t* words = nullptr;
    std::uint32_t primitives = 0;
  };
  Stream stream[kMaxStreams];
};

/// Working memory of one thread.
struct CaptureScratch {
  bool active = false;
  std::vector<std::uint32_t> vertices;            ///< captures of stream 0, vertex after vertex
  std::vector<std::uint32_t> words[kMaxStreams];  ///< as CaptureOutput
  std::uint32_t primitives[kMaxStreams] = {};
};

/// Whether transform feedback or a query of its primitives is active.
bool is_captured(const DrawCall& draw);

/// Outputs of vertices [base, base + lanes) of stream 0.
void capture_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                  CaptureScratch& scratch);
/// A primitive of those vertices.
void capture_primitive(const PipelinePlan& plan, const std::uint32_t* slot, CaptureScratch& scratch);
/// All primitives of a chunk that has no stages behind the vertex shader.
void capture_runs(const Chunk& chunk, const VertexScratch& vertices, CaptureScratch& scratch);
/// Primitives of a geometry shader: `emitted` are words of `memory` where their vertices lie.
void capture_emitted(const PipelinePlan& plan, std::uint32_t stream, std::span<const ListedPrimitive> primitives,
                     std::span<const std::uint32_t> emitted, const std::uint32_t* memory, CaptureScratch& scratch);

/// What was captured since the last call, in `arena`; null if nothing was.
const CaptureOutput* finish_capture(Arena& arena, CaptureScratch& scratch);

/// Writes to the buffers of the draw and counts for its queries. Chunks in order, one thread.
void write_capture(const DrawRecord& draw, const CaptureOutput& output);

}  // namespace vitrine::raster
