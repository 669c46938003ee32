// Stage memory.
#include "raster/front/stages/stage_scratch.h"

#include <algorithm>

#include "spirv/stage_memory.h"

namespace vitrine::raster {

std::size_t StageScratch::take(std::size_t words) {
  const std::size_t first = used;
  used += words;
  if (memory.size() < used) memory.resize(std::max(used, memory.size() * 2));
  std::fill(memory.begin() + static_cast<std::ptrdiff_t>(first), memory.begin() + static_cast<std::ptrdiff_t>(used),
            0u);
  return first;
}

void bind_stage(StageRunner& runner, Stage& bound, const Stage& stage) {
  if (!(bound == stage)) runner.bind(stage);
  bound = stage;
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

}  // namespace vitrine::raster
