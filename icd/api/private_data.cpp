// Private data of objects (Vulkan 1.3.239, Private Data), and the notes that hold it.
#include <algorithm>

#include "icd/entry_points.h"
#include "icd/object/object_notes.h"

namespace vitrine::icd {
namespace {

bool is_dispatchable(VkObjectType type) {
  return type == VK_OBJECT_TYPE_INSTANCE || type == VK_OBJECT_TYPE_PHYSICAL_DEVICE || type == VK_OBJECT_TYPE_DEVICE ||
         type == VK_OBJECT_TYPE_QUEUE || type == VK_OBJECT_TYPE_COMMAND_BUFFER;
}

std::mutex& mutex_of(VkDevice device) { return from_handle<Device>(device).physical_device.instance.notes_mutex; }

}  // namespace

void ObjectBase::destroy_notes(ObjectBase& object) noexcept {
  object.notes->~ObjectNotes();
  object.memory.free(object.notes);
}

ObjectBase& object_of(VkObjectType type, std::uint64_t handle) {
  // All dispatchable objects begin alike.
  if (is_dispatchable(type)) return *reinterpret_cast<DispatchableObject<VkQueue, VK_OBJECT_TYPE_QUEUE>*>(handle);
  return *reinterpret_cast<ObjectBase*>(handle);
}

ObjectNotes& notes_of(ObjectBase& object) {
  if (!object.notes) {
    const HostMemory& memory = object.memory;
    void* storage = memory.allocate(sizeof(ObjectNotes), alignof(ObjectNotes), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
    object.notes = ::new (storage) ObjectNotes(memory);
  }
  return *object.notes;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreatePrivateDataSlot(VkDevice device, const VkPrivateDataSlotCreateInfo*,
                                                     const VkAllocationCallbacks* allocator, VkPrivateDataSlot* slot) {
  Device& d = from_handle<Device>(device);
  PrivateDataSlot* object = create_object<PrivateDataSlot>(d.memory, allocator);
  object->number = d.next_private_data_slot.fetch_add(1);
  *slot = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyPrivateDataSlot(VkDevice, VkPrivateDataSlot slot, const VkAllocationCallbacks*) {
  destroy_handle<PrivateDataSlot>(slot);
}

VKAPI_ATTR VkResult VKAPI_CALL SetPrivateData(VkDevice device, VkObjectType type, std::uint64_t handle,
                                              VkPrivateDataSlot slot, std::uint64_t data) {
  const std::uint64_t number = from_handle<PrivateDataSlot>(slot).number;
  const std::lock_guard lock(mutex_of(device));
  Vector<ObjectNotes::Value>& values = notes_of(object_of(type, handle)).values;
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const ObjectNotes::Value& v) { return v.slot == number; });
  if (found == values.end()) {
    values.push_back({number, data});
  } else {
    found->data = data;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetPrivateData(VkDevice device, VkObjectType type, std::uint64_t handle,
                                          VkPrivateDataSlot slot, std::uint64_t* data) {
  const std::uint64_t number = from_handle<PrivateDataSlot>(slot).number;
  *data = 0;
  const std::lock_guard lock(mutex_of(device));
  const ObjectNotes* notes = object_of(type, handle).notes;
  if (!notes) return;
  for (const ObjectNotes::Value& v : notes->values) {
    if (v.slot == number) *data = v.data;
  }
}

}  // namespace entry
}  // namespace vitrine::icd
