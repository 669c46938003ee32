// The object base: what every Vulkan object of this driver shares, handle <-> object casts, creation and destruction.
//
//   struct Buffer : Object<VkBuffer, VK_OBJECT_TYPE_BUFFER> { explicit Buffer(const HostMemory& m) : Object(m) {} };
//   Buffer* b = create_object<Buffer>(device.memory, pAllocator);  *pBuffer = to_handle(b);  // throws std::bad_alloc
//   Buffer& b = from_handle<Buffer>(handle);  destroy_object(b);
#pragma once

#include <vulkan/vk_icd.h>

#include <utility>

#include "icd/edge/allocation.h"

namespace vitrine::icd {

struct ObjectNotes;

/// What every object has, whatever its handle: the host memory that it and everything in it comes from, and what
/// applications have attached to it (icd/object/object_notes.h).
struct ObjectBase {
  explicit ObjectBase(const HostMemory& m) : memory(m) {}
  ObjectBase(const ObjectBase&) = delete;
  ObjectBase& operator=(const ObjectBase&) = delete;
  ~ObjectBase() {
    if (notes) destroy_notes(*this);
  }

  HostMemory memory;
  ObjectNotes* notes = nullptr;  ///< null: none

 private:
  static void destroy_notes(ObjectBase& object) noexcept;
};

/// Base of objects with non-dispatchable handles.
template <class H, VkObjectType Type>
struct Object : ObjectBase {
  using Handle = H;
  static constexpr VkObjectType kType = Type;

  explicit Object(const HostMemory& m) : ObjectBase(m) {}
};

struct LoaderWord {
  VK_LOADER_DATA loader;
};

/// Base of VkInstance, VkPhysicalDevice, VkDevice, VkQueue and VkCommandBuffer: the loader's word comes first.
template <class H, VkObjectType Type>
struct DispatchableObject : LoaderWord, ObjectBase {
  using Handle = H;
  static constexpr VkObjectType kType = Type;

  explicit DispatchableObject(const HostMemory& m) : ObjectBase(m) { loader.loaderMagic = ICD_LOADER_MAGIC; }
};

template <class T>
typename T::Handle to_handle(T* object) {
  return reinterpret_cast<typename T::Handle>(object);
}

/// The object behind a valid handle.
template <class T>
T& from_handle(typename T::Handle handle) {
  return *reinterpret_cast<T*>(handle);
}

/// The object behind a handle that may be VK_NULL_HANDLE.
template <class T>
T* from_nullable(typename T::Handle handle) {
  return reinterpret_cast<T*>(handle);
}

/// Makes a T in memory from `own` (the call's pAllocator) or else `parent`. T's constructor receives that memory first.
/// Throws std::bad_alloc, or what the constructor throws, leaking nothing.
template <class T, class... Args>
T* create_object(const HostMemory& parent, const VkAllocationCallbacks* own, Args&&... args) {
  const bool top = T::kType == VK_OBJECT_TYPE_INSTANCE || T::kType == VK_OBJECT_TYPE_PHYSICAL_DEVICE;
  const VkSystemAllocationScope scope = top                                 ? VK_SYSTEM_ALLOCATION_SCOPE_INSTANCE
                                        : T::kType == VK_OBJECT_TYPE_DEVICE ? VK_SYSTEM_ALLOCATION_SCOPE_DEVICE
                                                                            : VK_SYSTEM_ALLOCATION_SCOPE_OBJECT;
  const HostMemory memory(own, parent);
  void* storage = memory.allocate(sizeof(T), alignof(T), scope);
  try {
    return ::new (storage) T(memory, std::forward<Args>(args)...);
  } catch (...) {
    memory.free(storage);
    throw;
  }
}

/// Destroys an object made by create_object; null is ignored.
template <class T>
void destroy_object(T* object) noexcept {
  if (!object) return;
  const HostMemory memory = object->memory;
  object->~T();
  memory.free(object);
}

/// Destroys the object behind a handle that may be VK_NULL_HANDLE.
template <class T>
void destroy_handle(typename T::Handle handle) noexcept {
  destroy_object(from_nullable<T>(handle));
}

/// Owns an object until release(): for create functions with several steps.
template <class T>
class Owned {
 public:
  explicit Owned(T* object) : object_(object) {}
  ~Owned() { destroy_object(object_); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  T* operator->() const { return object_; }
  T& operator*() const { return *object_; }
  T* release() { return std::exchange(object_, nullptr); }

 private:
  T* object_;
};

}  // namespace vitrine::icd
