// VkFence, VkSemaphore, VkEvent. Their states are guarded by one mutex of the device, and every change wakes whoever
// waits: waits are rare and short lists, so one condition variable serves them all.
#pragma once

#include "icd/device.h"

namespace vitrine::icd {

struct Fence : Object<VkFence, VK_OBJECT_TYPE_FENCE> {
  using Object::Object;
  bool signaled = false;
};

struct Semaphore : Object<VkSemaphore, VK_OBJECT_TYPE_SEMAPHORE> {
  using Object::Object;
  bool signaled = false;  ///< binary
};

struct Event : Object<VkEvent, VK_OBJECT_TYPE_EVENT> {
  using Object::Object;
  bool set = false;
};

/// For the queue thread and for presentation: change the state and wake all waiters.
void signal_fence(Device& device, Fence& fence);
void signal_semaphore(Device& device, Semaphore& semaphore);
void set_event(Device& device, Event& event, bool set);

/// Blocks until the semaphore is signalled, then unsignals it. False if the device was lost while waiting.
bool wait_semaphore(Device& device, Semaphore& semaphore);
/// Blocks until all events are set. False if the device was lost while waiting.
bool wait_events(Device& device, const VkEvent* events, std::uint32_t count);

/// Marks the device lost and wakes all waiters; every later wait or submission returns VK_ERROR_DEVICE_LOST.
void lose_device(Device& device, const char* reason);

}  // namespace vitrine::icd
