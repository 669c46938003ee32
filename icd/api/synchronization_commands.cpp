// Recording events and barriers (Vulkan 1.3.239, Synchronization and Cache Control: Events, Pipeline Barriers).
// Commands replay one after the other and memory is coherent, so that a barrier only ends what a render pass has put
// off.
#include <algorithm>

#include "glass/pixel/pixels.h"
#include "glass/session.h"
#include "icd/entry_points.h"
#include "icd/object/image.h"
#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"
#include "icd/record/dependencies.h"

namespace vitrine::icd {
namespace {

bool discards(VkImageLayout from, VkImageLayout to) { return from == VK_IMAGE_LAYOUT_UNDEFINED && from != to; }

/// Records the images whose contents barriers give up, where a tool shadows device memory or watches texels.
template <class Barrier>
void record_discards(VkCommandBuffer buffer, std::span<const Barrier> barriers) {
  if (!glass::session().shadows_memory() && !glass::pixel::pixels()) return;
  const auto gives_up = [](const Barrier& b) { return discards(b.oldLayout, b.newLayout); };
  const auto count = static_cast<std::size_t>(std::count_if(barriers.begin(), barriers.end(), gives_up));
  if (count == 0) return;
  const auto images = from_handle<CommandBuffer>(buffer).arena.add_array<DiscardedImage>(count);
  std::size_t next = 0;
  for (const Barrier& b : barriers)
    if (gives_up(b)) images[next++] = {&from_handle<Image>(b.image), b.subresourceRange};
  record(buffer, CmdDiscardImages{images});
}

void record_discards(VkCommandBuffer buffer, const VkDependencyInfo& info) {
  record_discards(buffer, std::span(info.pImageMemoryBarriers, info.imageMemoryBarrierCount));
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier(VkCommandBuffer buffer, VkPipelineStageFlags first,
                                              VkPipelineStageFlags second, VkDependencyFlags,
                                              std::uint32_t memory_count, const VkMemoryBarrier* memory,
                                              std::uint32_t buffer_count, const VkBufferMemoryBarrier* buffers,
                                              std::uint32_t count, const VkImageMemoryBarrier* images) {
  record(buffer, icd::CmdPipelineBarrier{});
  record_dependency(buffer, DependencyKind::kBarrier, {},
                    {first, second, {memory, memory_count}, {buffers, buffer_count}, {images, count}});
  record_discards(buffer, std::span(images, count));
}

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer buffer, const VkDependencyInfo* info) {
  record(buffer, icd::CmdPipelineBarrier{});
  record_dependency(buffer, DependencyKind::kBarrier, {}, {info, 1});
  record_discards(buffer, *info);
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent2(VkCommandBuffer buffer, VkEvent event, const VkDependencyInfo* info) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), true});
  record_dependency(buffer, DependencyKind::kSetEvent, {&event, 1}, {info, 1});
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent2(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags2) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), false});
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents2(VkCommandBuffer buffer, std::uint32_t count, const VkEvent* events,
                                          const VkDependencyInfo* infos) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdWaitEvents{b.arena.copy_array(events, count)});
  for (std::uint32_t i = 0; i < count; ++i) {
    record_dependency(buffer, DependencyKind::kWaitEvents, {&events[i], 1}, {&infos[i], 1});
    record_discards(buffer, infos[i]);
  }
  b.waits_for_host = true;
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags stages) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), true});
  record_dependency(buffer, DependencyKind::kSetEvent, {&event, 1}, OldBarriers{stages, 0, {}, {}, {}});
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), false});
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents(VkCommandBuffer buffer, std::uint32_t count, const VkEvent* events,
                                         VkPipelineStageFlags first, VkPipelineStageFlags second,
                                         std::uint32_t memory_count, const VkMemoryBarrier* memory,
                                         std::uint32_t buffer_count, const VkBufferMemoryBarrier* buffers,
                                         std::uint32_t image_count, const VkImageMemoryBarrier* images) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdWaitEvents{b.arena.copy_array(events, count)});
  record_dependency(buffer, DependencyKind::kWaitEvents, {events, count},
                    {first, second, {memory, memory_count}, {buffers, buffer_count}, {images, image_count}});
  record_discards(buffer, std::span(images, image_count));
  b.waits_for_host = true;
}

}  // namespace entry
}  // namespace vitrine::icd
