// Recording what orders commands, for the tool sync (glass/sync/sync.h). Nothing is recorded where it is off.
#pragma once

#include "glass/sync/sync.h"
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

void record_layouts(VkCommandBuffer buffer, std::span<const UsedLayout> used);
/// Of the subresources that regions name.
template <class Region>
void record_layouts(VkCommandBuffer buffer, const Image& image, VkImageLayout layout, std::span<const Region> regions,
                    VkImageSubresourceLayers Region::*part) {
  if (!glass::sync::is_on()) return;
  std::vector<UsedLayout> used;
  for (const Region& region : regions) {
    const VkImageSubresourceLayers& layers = region.*part;
    used.push_back({&image, {layers.aspectMask, layers.mipLevel, 1, layers.baseArrayLayer, layers.layerCount}, layout});
  }
  record_layouts(buffer, used);
}
inline void record_layouts(VkCommandBuffer buffer, const Image& image, VkImageLayout layout,
                           std::span<const VkImageSubresourceRange> ranges) {
  if (!glass::sync::is_on()) return;
  std::vector<UsedLayout> used;
  for (const VkImageSubresourceRange& range : ranges) used.push_back({&image, range, layout});
  record_layouts(buffer, used);
}

}  // namespace vitrine::icd
