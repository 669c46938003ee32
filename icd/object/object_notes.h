// What applications attach to objects: debug names (VK_EXT_debug_utils) and private data (Vulkan 1.3.239, Private
// Data).
#pragma once

#include "icd/object/device.h"

namespace vitrine::icd {

/// Values are kept with the objects, by the slot's number: an object's end ends them.
struct PrivateDataSlot : Object<VkPrivateDataSlot, VK_OBJECT_TYPE_PRIVATE_DATA_SLOT> {
  using Object::Object;
  std::uint64_t number = 0;  ///< no two slots of a device share it, alive or not
};

/// Guarded by Instance::notes_mutex.
struct ObjectNotes {
  explicit ObjectNotes(const HostMemory& m) : name(m), values(m) {}

  struct Value {
    std::uint64_t slot;
    std::uint64_t data;
  };
  String name;
  Vector<Value> values;
};

/// The object behind a handle of any type of this driver.
ObjectBase& object_of(VkObjectType type, std::uint64_t handle);

/// The object's notes, made if there are none. Throws std::bad_alloc. The caller holds the mutex.
ObjectNotes& notes_of(ObjectBase& object);

}  // namespace vitrine::icd
