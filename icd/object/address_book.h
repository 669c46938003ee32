// Objects by the memory that shaders know them by: a buffer's bytes, what descriptors point to in views and samplers.
// A device keeps it only where tools are on; descriptors themselves hold addresses alone.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>

#include "icd/edge/diagnostics.h"

namespace vitrine::icd {

class AddressBook {
 public:
  /// Without memory the object stays unknown.
  void add(const void* first, std::uint64_t bytes, ObjectRef object) noexcept;
  void remove(ObjectRef object) noexcept;
  /// The object that has all these bytes; of several the smallest. Without a handle: there is none.
  ObjectRef find(const void* first, std::uint64_t bytes) const;

 private:
  struct Entry {
    std::uintptr_t first;
    std::uint64_t bytes;
    VkObjectType type;
  };

  mutable std::mutex mutex_;
  std::map<std::uint64_t, Entry> entries_;  ///< by handle
};

/// Enters an object in the device's book, if it keeps one.
template <class T>
void enter_address(const Device& device, const void* first, std::uint64_t bytes, const T& object) {
  if (device.addresses && first) device.addresses->add(first, bytes, ref(object));
}
template <class T>
void leave_address(const Device& device, const T* object) {
  if (device.addresses && object) device.addresses->remove(ref(*object));
}

}  // namespace vitrine::icd
