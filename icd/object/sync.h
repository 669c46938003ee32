// VkFence, VkSemaphore, VkEvent. Their states are guarded by one mutex of the device, and every change wakes whoever
// waits: waits are rare and short lists, so one condition variable serves them all.
#pragma once

#include "icd/object/device.h"
#include "icd/object/external_payload.h"

namespace vitrine::icd {

struct Fence : Object<VkFence, VK_OBJECT_TYPE_FENCE> {
  using Object::Object;
  bool signaled = false;
  std::shared_ptr<ExternalPayload> shared;     ///< counts instead of `signaled` where there is one
  std::shared_ptr<ExternalPayload> temporary;  ///< counts before both, until the fence is reset
};

struct Semaphore : Object<VkSemaphore, VK_OBJECT_TYPE_SEMAPHORE> {
  using Object::Object;
  bool timeline = false;
  /// Timeline: the counter. Binary: signals that no wait has taken yet; more than one where an application acquires an
  /// image with a semaphore whose last wait is still in the queue, which must not cost it a signal.
  std::uint64_t value = 0;
  std::shared_ptr<ExternalPayload> shared;     ///< counts instead of `value` where there is one
  std::shared_ptr<ExternalPayload> temporary;  ///< what the next wait is for, before both
};

/// How the payload of a semaphore of this type is shared.
inline ExternalPayload::Kind semaphore_kind(const Semaphore& semaphore) {
  return semaphore.timeline ? ExternalPayload::Kind::kTimeline : ExternalPayload::Kind::kBinary;
}

struct Event : Object<VkEvent, VK_OBJECT_TYPE_EVENT> {
  using Object::Object;
  bool set = false;
};

/// For the queue thread and for presentation: change the state and wake all waiters. `temporary`: the payload that the
/// semaphore had when the signal was submitted, if that was none of its own.
void signal_fence(Device& device, Fence& fence);
void signal_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value,
                      const std::shared_ptr<ExternalPayload>& temporary = nullptr);
void set_event(Device& device, Event& event, bool set);

/// The caller of these holds Device::sync_mutex. Whether a wait for `value` would end at once:
bool is_reached(const Semaphore& semaphore, std::uint64_t value);
bool is_signaled(const Fence& fence);
std::uint64_t counter(const Semaphore& semaphore);
/// Makes the fence unsignalled, with the payload that it had before a temporary one.
void reset_fence(Fence& fence);

/// Blocks until a timeline semaphore has reached `value`, or a binary one is signalled, and takes that signal then.
/// `temporary`: the payload that the semaphore had for this wait alone. False if the device was lost while waiting.
bool wait_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value,
                    const std::shared_ptr<ExternalPayload>& temporary = nullptr);
/// Blocks until the fence is signalled. False if the device was lost while waiting.
bool wait_fence(Device& device, const Fence& fence);
/// Blocks until all events are set. False if the device was lost while waiting.
bool wait_events(Device& device, const VkEvent* events, std::uint32_t count);

/// Marks the device lost and wakes all waiters. The first loss counts. From then on every command that may return
/// VK_ERROR_DEVICE_LOST does (Vulkan 1.4.309, Lost Device; without maintenance5 it may).
void lose_device(Device& device, DeviceLoss loss) noexcept;
bool is_lost(Device& device);

}  // namespace vitrine::icd
