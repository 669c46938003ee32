// Host memory of objects: VkAllocationCallbacks where the application gives them, the C heap otherwise. Failure throws
// std::bad_alloc, which the API edge turns into VK_ERROR_OUT_OF_HOST_MEMORY.
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "base/arena.h"
#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// The callbacks in force for an object and everything it owns; by value, because the application's structure need not
/// outlive the call.
class HostMemory {
 public:
  HostMemory() = default;
  /// `own` (pAllocator of the call) if not null, else the parent's.
  HostMemory(const VkAllocationCallbacks* own, const HostMemory& parent) : callbacks_(own ? *own : parent.callbacks_) {}

  /// Throws std::bad_alloc. `alignment` is a power of two.
  void* allocate(std::size_t size, std::size_t alignment, VkSystemAllocationScope scope) const;
  /// Zeros, aligned for any scalar; of the C heap they take no pages until they are written to.
  void* allocate_zeros(std::size_t size, VkSystemAllocationScope scope) const;
  void free(void* memory) const noexcept;

 private:
  VkAllocationCallbacks callbacks_{};  ///< pfnAllocation null: the C heap
};

/// STL allocator over HostMemory, so that containers inside objects honour the callbacks too.
template <class T>
struct HostAllocator {
  using value_type = T;
  HostMemory memory;
  VkSystemAllocationScope scope = VK_SYSTEM_ALLOCATION_SCOPE_OBJECT;

  HostAllocator(const HostMemory& m, VkSystemAllocationScope s = VK_SYSTEM_ALLOCATION_SCOPE_OBJECT)  // NOLINT: implicit
      : memory(m), scope(s) {}
  template <class U>
  HostAllocator(const HostAllocator<U>& other) : memory(other.memory), scope(other.scope) {}  // NOLINT: implicit

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(memory.allocate(count * sizeof(T), alignof(T), scope));
  }
  void deallocate(T* p, std::size_t) noexcept { memory.free(p); }
  template <class U>
  bool operator==(const HostAllocator<U>&) const {
    return true;  // containers of one object share one HostMemory
  }
};

/// Blocks of an arena from host memory.
struct HostBlocks {
  HostMemory memory;
  VkSystemAllocationScope scope = VK_SYSTEM_ALLOCATION_SCOPE_OBJECT;

  base::ArenaBlock* take(std::size_t size) const;
  void give_back(base::ArenaBlock* first) const noexcept;
};

template <class T>
using Vector = std::vector<T, HostAllocator<T>>;
using String = std::basic_string<char, std::char_traits<char>, HostAllocator<char>>;

}  // namespace vitrine::icd
