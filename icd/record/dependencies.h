// Recording what orders commands, for the tool sync (glass/sync/sync.h). Nothing is recorded where it is off.
#pragma once

#include "icd/record/command_buffer.h"

namespace vitrine::icd {

/// Barriers of the first form: stages are the command's.
struct OldBarriers {
  VkPipelineStageFlags first_stages = 0, second_stages = 0;
  std::span<const VkMemoryBarrier> memory;
  std::span<const VkBufferMemoryBarrier> buffers;
  std::span<const VkImageMemoryBarrier> images;
};

using DependencyKind = CmdDependency::Kind;

void record_dependency(VkCommandBuffer buffer, DependencyKind kind, std::span<const VkEvent> events,
                       std::span<const VkDependencyInfo> infos);
void record_dependency(VkCommandBuffer buffer, DependencyKind kind, std::span<const VkEvent> events,
                       const OldBarriers& barriers);

}  // namespace vitrine::icd
