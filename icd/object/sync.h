// VkFence, VkSemaphore, VkEvent. Their states are guarded by one mutex of the device, and every change wakes whoever
// waits: waits are rare and short lists, so one condition variable serves them all.
#pragma once

#include "icd/object/device.h"

namespace vitrine::icd {

struct Fence : Object<VkFence, VK_OBJECT_TYPE_FENCE> {
  using Object::Object;
  bool signaled = false;
};

struct Semaphore : Object<VkSemaphore, VK_OBJECT_TYPE_SEMAPHORE> {
  using Object::Object;
  bool timeline = false;
  /// Timeline: the counter. Binary: signals that no wait has taken yet; more than one where an application acquires an
  /// image with a semaphore whose last wait is still in the queue, which must not cost it a signal.
  std::uint64_t value = 0;
};

struct Event : Object<VkEvent, VK_OBJECT_TYPE_EVENT> {
  using Object::Object;
  bool set = false;
};

/// For the queue thread and for presentation: change the state and wake all waiters.
void signal_fence(Device& device, Fence& fence);
void signal_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value);
void set_event(Device& device, Event& event, bool set);

/// Whether a wait for `value` would end at once. The caller holds Device::sync_mutex.
bool is_reached(const Semaphore& semaphore, std::uint64_t value);
/// Blocks until a timeline semaphore has reached `value`, or a binary one is signalled, and takes that signal then.
/// False if the device was lost while waiting.
bool wait_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value);
/// Blocks until all events are set. False if the device was lost while waiting.
bool wait_events(Device& device, const VkEvent* events, std::uint32_t count);

/// Marks the device lost and wakes all waiters; every later wait or submission returns VK_ERROR_DEVICE_LOST.
/// The first loss counts.
void lose_device(Device& device, DeviceLoss loss) noexcept;

}  // namespace vitrine::icd
