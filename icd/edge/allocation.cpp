// Host memory through VkAllocationCallbacks (Vulkan 1.3.239, Memory Allocation: Host Memory).
#include "icd/edge/allocation.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace vitrine::icd {

void* HostMemory::allocate(std::size_t size, std::size_t alignment, VkSystemAllocationScope scope) const {
  size = std::max<std::size_t>(size, 1);
  void* memory = nullptr;
  if (callbacks_.pfnAllocation) {
    memory = callbacks_.pfnAllocation(callbacks_.pUserData, size, alignment, scope);
  } else if (alignment <= alignof(std::max_align_t)) {
    memory = std::malloc(size);
  } else if (size <= std::numeric_limits<std::size_t>::max() - alignment) {
    memory = std::aligned_alloc(alignment, (size + alignment - 1) & ~(alignment - 1));
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

void* HostMemory::allocate_zeros(std::size_t size, VkSystemAllocationScope scope) const {
  if (callbacks_.pfnAllocation) return std::memset(allocate(size, alignof(std::max_align_t), scope), 0, size);
  void* memory = std::calloc(std::max<std::size_t>(size, 1), 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

void HostMemory::free(void* memory) const noexcept {
  if (!memory) return;
  if (callbacks_.pfnFree) {
    callbacks_.pfnFree(callbacks_.pUserData, memory);
  } else {
    std::free(memory);
  }
}

base::ArenaBlock* HostBlocks::take(std::size_t size) const {
  void* block = memory.allocate(sizeof(base::ArenaBlock) + size, alignof(std::max_align_t), scope);
  return ::new (block) base::ArenaBlock{nullptr, size};
}

void HostBlocks::give_back(base::ArenaBlock* first) const noexcept {
  while (first) memory.free(std::exchange(first, first->next));
}

}  // namespace vitrine::icd
