// The vertices of a chunk while the front end works on them: one thread's memory, kept between chunks.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/front/viewport.h"
#include "raster/primitive.h"
#include "raster/stage.h"

namespace vitrine::raster {

struct VertexScratch {
  StageRunner runner;  ///< of the vertex shader
  Stage bound;
  TransformedWave transformed;
  // per position of the chunk
  std::vector<std::uint16_t> slot;
  // per vertex (slot) of the chunk
  std::vector<std::uint32_t> vertex, instance;
  std::vector<float> clip;                          ///< 4 each
  std::vector<float> clip_distance, cull_distance;  ///< kMaxClipDistances each
  std::vector<std::uint32_t> layer, viewport_index, shading_rate;
  std::vector<ClipCode> code;
  std::vector<std::int32_t> snapped;  ///< 2 each
  Vertex* records = nullptr;
  // index de-duplication
  std::vector<std::uint64_t> hash_key;
  std::vector<std::uint16_t> hash_slot;
};

/// Outputs of a wave of vertices by register: of a stage, or words of vertices that were gathered.
struct WaveOutputs {
  const StageRunner* runner;
  const base::WaveRegister* words;
  const base::WaveRegister& at(std::uint32_t reg) const { return runner ? runner->output(reg) : words[reg]; }
};

}  // namespace vitrine::raster
