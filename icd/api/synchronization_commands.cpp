// Recording events and barriers (Vulkan 1.3.239, Synchronization and Cache Control: Events, Pipeline Barriers).
// Commands replay one after the other and memory is coherent, so that a barrier only ends what a render pass has put
// off.
#include "icd/entry_points.h"
#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd::entry {

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier(VkCommandBuffer buffer, VkPipelineStageFlags, VkPipelineStageFlags,
                                              VkDependencyFlags, std::uint32_t, const VkMemoryBarrier*, std::uint32_t,
                                              const VkBufferMemoryBarrier*, std::uint32_t,
                                              const VkImageMemoryBarrier*) {
  record(buffer, icd::CmdPipelineBarrier{});
}

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer buffer, const VkDependencyInfo*) {
  record(buffer, icd::CmdPipelineBarrier{});
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent2(VkCommandBuffer buffer, VkEvent event, const VkDependencyInfo*) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), true});
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent2(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags2) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), false});
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents2(VkCommandBuffer buffer, std::uint32_t count, const VkEvent* events,
                                          const VkDependencyInfo*) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdWaitEvents{b.arena.copy_array(events, count)});
  b.waits_for_host = true;
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), true});
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent(VkCommandBuffer buffer, VkEvent event, VkPipelineStageFlags) {
  record(buffer, icd::CmdSetEvent{&from_handle<Event>(event), false});
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents(VkCommandBuffer buffer, std::uint32_t count, const VkEvent* events,
                                         VkPipelineStageFlags, VkPipelineStageFlags, std::uint32_t,
                                         const VkMemoryBarrier*, std::uint32_t, const VkBufferMemoryBarrier*,
                                         std::uint32_t, const VkImageMemoryBarrier*) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdWaitEvents{b.arena.copy_array(events, count)});
  b.waits_for_host = true;
}

}  // namespace vitrine::icd::entry
