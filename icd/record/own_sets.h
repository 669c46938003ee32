// Descriptor sets that lie in a command buffer: pushed ones, and those of embedded samplers. Replay knows nothing of
// them, and draws already recorded keep what they saw.
#pragma once

#include "icd/record/command_buffer.h"

namespace vitrine::icd {

inline bool has_set(const PipelineLayoutShape& layout, std::uint32_t number) {
  return number < layout.sets.size() && number < spirv::kMaxSets && layout.sets[number];
}

/// A set for `number` of the layout, which has one: null descriptors and immutable samplers. Throws std::bad_alloc.
DescriptorSet& add_own_set(CommandBuffer& buffer, const PipelineLayoutShape& layout, std::uint32_t number);

/// Records that it is bound.
void bind_own_set(CommandBuffer& buffer, VkPipelineBindPoint bind_point, const PipelineLayoutShape& layout,
                  std::uint32_t number, DescriptorSet& set);

}  // namespace vitrine::icd
