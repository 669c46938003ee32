// Queue submission and waiting for queues (Vulkan 1.3.239, Command Buffers: Command Buffer Submission; Synchronization:
// Wait Idle Operations).
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/queue.h"

namespace vitrine::icd {
namespace {

/// The batches of one call, and the arrays that they point to.
class BatchBuilder {
 public:
  explicit BatchBuilder(Queue& queue)
      : queue_(queue), batches_(memory()), semaphores_(memory()), command_buffers_(memory()) {}

  /// Room for everything, so that what points into the arrays stays valid.
  void reserve(std::size_t batches, std::size_t semaphores, std::size_t command_buffers) {
    batches_.reserve(batches + 1);
    semaphores_.reserve(semaphores);
    command_buffers_.reserve(command_buffers);
  }
  BatchInfo& add_batch() { return batches_.emplace_back(); }

  std::span<const SemaphoreOp> add_semaphores(const VkSemaphore* handles, std::uint32_t count,
                                              const std::uint64_t* values, std::uint32_t value_count,
                                              const VkPipelineStageFlags* stages = nullptr) {
    const std::size_t first = semaphores_.size();
    for (std::uint32_t i = 0; i < count; ++i) {
      semaphores_.push_back({handles[i], values && i < value_count ? values[i] : 0});
      if (stages) semaphores_.back().stages = stages[i];
    }
    return {semaphores_.data() + first, count};
  }
  std::span<const SemaphoreOp> add_semaphores(const VkSemaphoreSubmitInfo* infos, std::uint32_t count) {
    const std::size_t first = semaphores_.size();
    for (std::uint32_t i = 0; i < count; ++i)
      semaphores_.push_back({infos[i].semaphore, infos[i].value, infos[i].stageMask});
    return {semaphores_.data() + first, count};
  }
  std::span<const VkCommandBuffer> add_command_buffers(const VkCommandBufferSubmitInfo* infos, std::uint32_t count) {
    const std::size_t first = command_buffers_.size();
    for (std::uint32_t i = 0; i < count; ++i) command_buffers_.push_back(infos[i].commandBuffer);
    return {command_buffers_.data() + first, count};
  }

  VkResult submit(VkFence fence) {
    if (fence) {
      if (batches_.empty()) batches_.emplace_back();
      batches_.back().fence = fence;
    }
    return icd::submit(queue_, batches_);
  }

 private:
  HostAllocator<BatchInfo> memory() const { return {queue_.device.memory, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND}; }

  Queue& queue_;
  Vector<BatchInfo> batches_;
  Vector<SemaphoreOp> semaphores_;
  Vector<VkCommandBuffer> command_buffers_;
};

/// Of vkQueueSubmit or vkQueueBindSparse: waits and signals of one batch.
template <class Info>
void add_semaphores(const Info& info, BatchBuilder& builder, BatchInfo& batch) {
  const VkPipelineStageFlags* stages = nullptr;
  if constexpr (requires { info.pWaitDstStageMask; }) stages = info.pWaitDstStageMask;
  const auto* values = find_in_chain<VkTimelineSemaphoreSubmitInfo>(info.pNext);
  batch.waits = builder.add_semaphores(info.pWaitSemaphores, info.waitSemaphoreCount,
                                       values ? values->pWaitSemaphoreValues : nullptr,
                                       values ? values->waitSemaphoreValueCount : 0, stages);
  batch.signals = builder.add_semaphores(info.pSignalSemaphores, info.signalSemaphoreCount,
                                         values ? values->pSignalSemaphoreValues : nullptr,
                                         values ? values->signalSemaphoreValueCount : 0);
}

template <class Info>
std::size_t count_semaphores(const Info* infos, std::uint32_t count) {
  std::size_t total = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    total += std::size_t{infos[i].waitSemaphoreCount} + infos[i].signalSemaphoreCount;
  }
  return total;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits,
                                           VkFence fence) {
  BatchBuilder builder(from_handle<Queue>(queue));
  builder.reserve(count, count_semaphores(submits, count), 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    BatchInfo& batch = builder.add_batch();
    batch.command_buffers = {submits[i].pCommandBuffers, submits[i].commandBufferCount};
    add_semaphores(submits[i], builder, batch);
  }
  return builder.submit(fence);
}

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* submits,
                                            VkFence fence) {
  BatchBuilder builder(from_handle<Queue>(queue));
  std::size_t semaphores = 0, command_buffers = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    semaphores += std::size_t{submits[i].waitSemaphoreInfoCount} + submits[i].signalSemaphoreInfoCount;
    command_buffers += submits[i].commandBufferInfoCount;
  }
  builder.reserve(count, semaphores, command_buffers);
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkSubmitInfo2& info = submits[i];
    BatchInfo& batch = builder.add_batch();
    batch.waits = builder.add_semaphores(info.pWaitSemaphoreInfos, info.waitSemaphoreInfoCount);
    batch.command_buffers = builder.add_command_buffers(info.pCommandBufferInfos, info.commandBufferInfoCount);
    batch.signals = builder.add_semaphores(info.pSignalSemaphoreInfos, info.signalSemaphoreInfoCount);
  }
  return builder.submit(fence);
}

VKAPI_ATTR VkResult VKAPI_CALL QueueWaitIdle(VkQueue queue) { return wait_idle(from_handle<Queue>(queue)); }

VKAPI_ATTR VkResult VKAPI_CALL DeviceWaitIdle(VkDevice device) { return wait_idle(from_handle<Device>(device).queue); }

/// No sparse binding is claimed: only the semaphores and the fence of a call without binds have a meaning.
VKAPI_ATTR VkResult VKAPI_CALL QueueBindSparse(VkQueue queue, std::uint32_t count, const VkBindSparseInfo* infos,
                                               VkFence fence) {
  BatchBuilder builder(from_handle<Queue>(queue));
  builder.reserve(count, count_semaphores(infos, count), 0);
  for (std::uint32_t i = 0; i < count; ++i) add_semaphores(infos[i], builder, builder.add_batch());
  return builder.submit(fence);
}

}  // namespace entry
}  // namespace vitrine::icd
