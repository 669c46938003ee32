// A scene of random draws, drawn: in a render pass object or dynamic rendering, with what surrounds the draws.
#pragma once

#include <memory>

#include "cases/pipeline/state/draw_state.h"

namespace vitrine::cts {

/// A draw with what it reads.
struct RecordedDraw {
  DrawState state;
  Buffer vertices, indices, command;
  bool indexed = false;
  VkIndexType index_type = VK_INDEX_TYPE_UINT16;
  uint32_t first_vertex = 0, first_instance = 0;  ///< the first vertex is the offset of an indexed draw
  std::optional<VkClearAttachment> clear;         ///< before the draw
  VkRect2D cleared{};
  uint64_t seed = 0;  ///< of the choice of what is left to commands
};

/// Draws everything into fresh attachments and puts them out under `prefix`, with what draws captured and counted.
/// `clears`: colours, then depth.
void render(Run& run, const Scene& scene, const std::vector<VkClearValue>& clears,
            const std::vector<std::unique_ptr<RecordedDraw>>& draws, const std::string& prefix);

}  // namespace vitrine::cts
