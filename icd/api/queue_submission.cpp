// Queue submission and waiting for queues (Vulkan 1.3.239, Command Buffers: Command Buffer Submission; Synchronization:
// Wait Idle Operations).
#include "icd/entry_points.h"
#include "icd/queue.h"

namespace vitrine::icd::entry {

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits,
                                           VkFence fence) {
  Queue& object = from_handle<Queue>(queue);
  Vector<BatchInfo> batches{HostAllocator<BatchInfo>(object.device.memory, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND)};
  batches.reserve(count + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkSubmitInfo& info = submits[i];
    BatchInfo batch;
    batch.waits = {info.pWaitSemaphores, info.waitSemaphoreCount};
    batch.command_buffers = {info.pCommandBuffers, info.commandBufferCount};
    batch.signals = {info.pSignalSemaphores, info.signalSemaphoreCount};
    batches.push_back(batch);
  }
  if (fence) {
    if (batches.empty()) batches.emplace_back();
    batches.back().fence = fence;
  }
  return submit(object, batches);
}

VKAPI_ATTR VkResult VKAPI_CALL QueueWaitIdle(VkQueue queue) { return wait_idle(from_handle<Queue>(queue)); }

VKAPI_ATTR VkResult VKAPI_CALL DeviceWaitIdle(VkDevice device) { return wait_idle(from_handle<Device>(device).queue); }

/// No sparse binding is claimed: only the semaphores and the fence of a call without binds have a meaning.
VKAPI_ATTR VkResult VKAPI_CALL QueueBindSparse(VkQueue queue, std::uint32_t count, const VkBindSparseInfo* infos,
                                               VkFence fence) {
  Queue& object = from_handle<Queue>(queue);
  Vector<BatchInfo> batches{HostAllocator<BatchInfo>(object.device.memory, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND)};
  batches.resize(count + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    batches[i].waits = {infos[i].pWaitSemaphores, infos[i].waitSemaphoreCount};
    batches[i].signals = {infos[i].pSignalSemaphores, infos[i].signalSemaphoreCount};
  }
  batches.back().fence = fence;
  return submit(object, batches);
}

}  // namespace vitrine::icd::entry
