// Fences, semaphores and events: their host side (Vulkan 1.3.239, Synchronization and Cache Control).
#include <algorithm>
#include <chrono>

#include "glass/sync/sync.h"
#include "glass/timeline.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/sync.h"

namespace vitrine::icd {
namespace {

using Clock = std::chrono::steady_clock;

/// About a century: beyond it the deadline would overflow the clock.
constexpr std::uint64_t kForever = std::uint64_t{3} * 1000 * 1000 * 1000 * 1000 * 1000 * 1000;

/// Waits until `ready` or the timeout; false: timeout. `outside`: a payload that others can signal, if one is among
/// what is waited for; the caller holds it, as the object may give it up meanwhile. They do not wake the condition
/// variable: then the wait is for them, and looks at the rest every millisecond.
template <class Ready>
bool wait_for_change(Device& device, std::unique_lock<std::mutex>& lock, std::uint64_t timeout_ns,
                     const std::shared_ptr<ExternalPayload>& outside, Ready ready) {
  const bool forever = timeout_ns >= kForever;
  const auto deadline = forever ? Clock::time_point::max() : Clock::now() + std::chrono::nanoseconds(timeout_ns);
  if (!outside) {
    if (!forever) return device.sync_changed.wait_until(lock, deadline, ready);
    device.sync_changed.wait(lock, ready);
    return true;
  }
  for (;;) {
    const std::uint32_t seen = outside->changes();
    if (ready()) return true;
    const std::chrono::nanoseconds left = deadline - Clock::now();
    if (left.count() <= 0) return false;
    lock.unlock();
    outside->wait(seen, std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(1)));
    lock.lock();
  }
}

/// The same until `done`: VK_TIMEOUT, VK_SUCCESS or device lost.
template <class Done>
VkResult wait_until(Device& device, std::unique_lock<std::mutex>& lock, std::uint64_t timeout_ns,
                    const std::shared_ptr<ExternalPayload>& outside, Done done) {
  if (!wait_for_change(device, lock, timeout_ns, outside, [&] { return device.lost || done(); })) return VK_TIMEOUT;
  return device.lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

/// What others can signal of a fence or semaphore, or null.
template <class T>
std::shared_ptr<ExternalPayload> outside_of(const T& object) {
  return object.temporary ? object.temporary : object.shared;
}

/// The first such payload of several objects.
template <class T>
std::shared_ptr<ExternalPayload> outside_of(std::span<const typename T::Handle> handles) {
  for (const auto handle : handles)
    if (auto payload = outside_of(from_handle<T>(handle))) return payload;
  return nullptr;
}

/// Does nothing once the device is lost: who was told of the loss may have destroyed the object.
template <class Change>
void change_state(Device& device, Change change) {
  {
    const std::lock_guard lock(device.sync_mutex);
    if (device.lost) return;
    change();
  }
  device.sync_changed.notify_all();
}

/// Tells the tool sync that the host has waited for those of the fences that are signalled.
void tell_waited(Device& device, std::span<const VkFence> fences) {
  glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device);
  if (!hazards) return;
  const std::lock_guard lock(device.sync_mutex);
  for (const VkFence fence : fences)
    if (is_signaled(from_handle<Fence>(fence))) hazards->host_waited(&from_handle<Fence>(fence));
}

/// The same of a value of a timeline semaphore.
void tell_waited(Device& device, VkSemaphore semaphore, std::uint64_t value) {
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device))
    hazards->host_waited_for(&from_handle<Semaphore>(semaphore), value);
}

}  // namespace

void signal_fence(Device& device, Fence& fence) {
  change_state(device, [&] {
    if (const auto payload = outside_of(fence)) return payload->set(true);
    fence.signaled = true;
  });
}

bool is_signaled(const Fence& fence) {
  const auto payload = outside_of(fence);
  return payload ? payload->value() != 0 : fence.signaled;
}

void reset_fence(Fence& fence) {
  fence.temporary.reset();
  fence.signaled = false;
  if (fence.shared) fence.shared->set(false);
}

void signal_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value,
                      const std::shared_ptr<ExternalPayload>& temporary) {
  change_state(device, [&] {
    if (const auto& payload = temporary ? temporary : semaphore.shared) return payload->signal(value);
    semaphore.value = semaphore.timeline ? std::max(semaphore.value, value) : semaphore.value + 1;
  });
}

void set_event(Device& device, Event& event, bool set) {
  change_state(device, [&] { event.set = set; });
}

std::uint64_t counter(const Semaphore& semaphore) {
  const auto payload = outside_of(semaphore);
  return payload ? payload->value() : semaphore.value;
}

bool is_reached(const Semaphore& semaphore, std::uint64_t value) {
  return counter(semaphore) >= (semaphore.timeline ? value : 1);
}

bool wait_semaphore(Device& device, Semaphore& semaphore, std::uint64_t value,
                    const std::shared_ptr<ExternalPayload>& temporary) {
  std::unique_lock lock(device.sync_mutex);
  if (device.lost) return false;  // the semaphore may be gone, see change_state
  const std::shared_ptr<ExternalPayload> payload = temporary ? temporary : semaphore.shared;
  const auto take = [&] {
    if (semaphore.timeline) return (payload ? payload->value() : semaphore.value) >= value;
    if (payload) return payload->take();
    if (semaphore.value == 0) return false;
    --semaphore.value;
    return true;
  };
  bool taken = false;
  wait_for_change(device, lock, kForever, payload, [&] { return device.lost || (taken = take()); });
  return taken;
}

bool wait_fence(Device& device, const Fence& fence) {
  std::unique_lock lock(device.sync_mutex);
  const auto done = [&] { return is_signaled(fence); };
  return wait_until(device, lock, kForever, outside_of(fence), done) == VK_SUCCESS;
}

bool wait_events(Device& device, const VkEvent* events, std::uint32_t count) {
  const auto all_set = [&] {
    return std::all_of(events, events + count, [](VkEvent e) { return from_handle<Event>(e).set; });
  };
  std::unique_lock lock(device.sync_mutex);
  device.sync_changed.wait(lock, [&] { return device.lost || all_set(); });
  return !device.lost;
}

void lose_device(Device& device, DeviceLoss loss) noexcept {
  report_error(device, ref(device), "device-lost", loss.reason);
  change_state(device, [&] {
    device.lost = true;
    device.loss = std::move(loss);
  });
}

bool is_lost(Device& device) {
  const std::lock_guard lock(device.sync_mutex);
  return device.lost;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateFence(VkDevice device, const VkFenceCreateInfo* info,
                                           const VkAllocationCallbacks* allocator, VkFence* fence) {
  Owned<Fence> object(create_object<Fence>(from_handle<Device>(device).memory, allocator));
  object->signaled = info->flags & VK_FENCE_CREATE_SIGNALED_BIT;
  const auto* exported = find_in_chain<VkExportFenceCreateInfo>(info->pNext);
  if (exported && (exported->handleTypes & VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT)) {
    object->shared = ExternalPayload::make(ExternalPayload::Kind::kFence, object->signaled);
    if (!object->shared) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  *fence = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyFence(VkDevice, VkFence fence, const VkAllocationCallbacks*) {
  destroy_handle<Fence>(fence);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetFences(VkDevice device, std::uint32_t count, const VkFence* fences) {
  const std::lock_guard lock(from_handle<Device>(device).sync_mutex);
  for (std::uint32_t i = 0; i < count; ++i) reset_fence(from_handle<Fence>(fences[i]));
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetFenceStatus(VkDevice device, VkFence fence) {
  Device& d = from_handle<Device>(device);
  tell_waited(d, {&fence, 1});
  const std::lock_guard lock(d.sync_mutex);
  if (d.lost) return VK_ERROR_DEVICE_LOST;
  return is_signaled(from_handle<Fence>(fence)) ? VK_SUCCESS : VK_NOT_READY;
}

VKAPI_ATTR VkResult VKAPI_CALL WaitForFences(VkDevice device, std::uint32_t count, const VkFence* fences,
                                             VkBool32 wait_all, std::uint64_t timeout) {
  const glass::Span span("wait", "vkWaitForFences");
  const auto signaled = [](VkFence fence) { return is_signaled(from_handle<Fence>(fence)); };
  Device& d = from_handle<Device>(device);
  std::unique_lock lock(d.sync_mutex);
  const VkResult result = wait_until(d, lock, timeout, outside_of<Fence>({fences, count}), [&] {
    return wait_all ? std::all_of(fences, fences + count, signaled) : std::any_of(fences, fences + count, signaled);
  });
  lock.unlock();
  if (result == VK_SUCCESS) tell_waited(d, {fences, count});
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateSemaphore(VkDevice device, const VkSemaphoreCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkSemaphore* semaphore) {
  Owned<Semaphore> object(create_object<Semaphore>(from_handle<Device>(device).memory, allocator));
  if (const auto* type = find_in_chain<VkSemaphoreTypeCreateInfo>(info->pNext)) {
    object->timeline = type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
    object->value = type->initialValue;
  }
  const auto* exported = find_in_chain<VkExportSemaphoreCreateInfo>(info->pNext);
  if (exported && (exported->handleTypes & VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT)) {
    object->shared = ExternalPayload::make(semaphore_kind(*object), object->value);
    if (!object->shared) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  *semaphore = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetSemaphoreCounterValue(VkDevice device, VkSemaphore semaphore, std::uint64_t* value) {
  Device& d = from_handle<Device>(device);
  const std::lock_guard lock(d.sync_mutex);
  *value = counter(from_handle<Semaphore>(semaphore));
  tell_waited(d, semaphore, *value);
  return d.lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL SignalSemaphore(VkDevice device, const VkSemaphoreSignalInfo* info) {
  Device& d = from_handle<Device>(device);
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&d))
    hazards->signal_by_host(&from_handle<Semaphore>(info->semaphore), info->value);
  signal_semaphore(d, from_handle<Semaphore>(info->semaphore), info->value);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL WaitSemaphores(VkDevice device, const VkSemaphoreWaitInfo* info, std::uint64_t timeout) {
  const glass::Span span("wait", "vkWaitSemaphores");
  const auto done = [&] {
    std::uint32_t reached = 0;
    for (std::uint32_t i = 0; i < info->semaphoreCount; ++i) {
      reached += is_reached(from_handle<Semaphore>(info->pSemaphores[i]), info->pValues[i]);
    }
    return (info->flags & VK_SEMAPHORE_WAIT_ANY_BIT) ? reached > 0 : reached == info->semaphoreCount;
  };
  Device& d = from_handle<Device>(device);
  std::unique_lock lock(d.sync_mutex);
  const VkResult result =
      wait_until(d, lock, timeout, outside_of<Semaphore>({info->pSemaphores, info->semaphoreCount}), done);
  if (result != VK_SUCCESS || !glass::sync::is_on()) return result;
  for (std::uint32_t i = 0; i < info->semaphoreCount; ++i)
    if (is_reached(from_handle<Semaphore>(info->pSemaphores[i]), info->pValues[i]))
      tell_waited(d, info->pSemaphores[i], info->pValues[i]);
  return result;
}

VKAPI_ATTR void VKAPI_CALL DestroySemaphore(VkDevice, VkSemaphore semaphore, const VkAllocationCallbacks*) {
  destroy_handle<Semaphore>(semaphore);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateEvent(VkDevice device, const VkEventCreateInfo*,
                                           const VkAllocationCallbacks* allocator, VkEvent* event) {
  *event = to_handle(create_object<Event>(from_handle<Device>(device).memory, allocator));
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyEvent(VkDevice, VkEvent event, const VkAllocationCallbacks*) {
  destroy_handle<Event>(event);
}

VKAPI_ATTR VkResult VKAPI_CALL GetEventStatus(VkDevice device, VkEvent event) {
  Device& d = from_handle<Device>(device);
  const std::lock_guard lock(d.sync_mutex);
  if (d.lost) return VK_ERROR_DEVICE_LOST;
  return from_handle<Event>(event).set ? VK_EVENT_SET : VK_EVENT_RESET;
}

VKAPI_ATTR VkResult VKAPI_CALL SetEvent(VkDevice device, VkEvent event) {
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&from_handle<Device>(device)))
    hazards->set_event_by_host(&from_handle<Event>(event));
  set_event(from_handle<Device>(device), from_handle<Event>(event), true);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL ResetEvent(VkDevice device, VkEvent event) {
  set_event(from_handle<Device>(device), from_handle<Event>(event), false);
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
