// What runs on VkQueue: batches in submission order, on a thread of the queue's own, or on the submitting thread when
// they are small and nothing has to be waited for (a thread switch costs more than small work: bars.md section 4).
#pragma once

#include <cstdint>
#include <span>

#include "icd/object/device.h"

namespace vitrine::icd {

/// A function that the queue calls, besides command buffers: presentation.
struct QueueCall {
  void (*run)(void* object, std::uint32_t argument) = nullptr;
  void* object = nullptr;
  std::uint32_t argument = 0;
};

/// A semaphore to wait for or to signal; `value` counts for timeline semaphores.
struct SemaphoreOp {
  VkSemaphore semaphore = VK_NULL_HANDLE;
  std::uint64_t value = 0;
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  ///< what observers are told
};

/// One batch: waits, then executes, then signals. The spans are copied by submit().
struct BatchInfo {
  std::span<const SemaphoreOp> waits;
  std::span<const VkCommandBuffer> command_buffers;
  std::span<const QueueCall> calls;
  std::span<const SemaphoreOp> signals;
  VkFence fence = VK_NULL_HANDLE;
};

/// Puts batches on the queue, in order; all or none. Throws std::bad_alloc before anything has happened.
/// VK_ERROR_DEVICE_LOST if the device is lost, now or by a batch that ran at once.
VkResult submit(Queue& queue, std::span<const BatchInfo> batches);

/// Blocks until everything submitted has finished. VK_ERROR_DEVICE_LOST if the device is lost.
VkResult wait_idle(Queue& queue);

}  // namespace vitrine::icd
