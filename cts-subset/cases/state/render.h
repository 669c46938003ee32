// A scene of random draws, drawn: in a render pass object or dynamic rendering, with what surrounds the draws.
#pragma once

#include <memory>

#include "cases/state/draw_state.h"

namespace vitrine::cts {

/// A draw with what it reads.
struct RecordedDraw {
  DrawState state;
  Buffer vertices, indices, command;
  bool indexed = false;
  uint64_t seed = 0;  ///< of the choice of what is left to commands
};

/// Draws everything into fresh attachments and puts them out under `prefix`, with what draws captured and counted.
/// `clears`: colours, then depth.
void render(Run& run, const Scene& scene, const std::vector<VkClearValue>& clears,
            const std::vector<std::unique_ptr<RecordedDraw>>& draws, const std::string& prefix);

}  // namespace vitrine::cts
