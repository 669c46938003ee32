// Blocks of command memory: taking, reusing, releasing.
#include "icd/record/command_arena.h"

#include <algorithm>

namespace vitrine::icd {

CommandBlock* BlockStore::take(std::uint32_t capacity) {
  CommandBlock* block = free_;
  if (block && block->capacity >= capacity) {
    free_ = block->next;
  } else {
    void* memory =
        memory_.allocate(sizeof(CommandBlock) + capacity, alignof(CommandBlock), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
    block = ::new (memory) CommandBlock;
    block->capacity = capacity;
  }
  block->next = nullptr;
  block->front = 0;
  block->back = block->capacity;
  return block;
}

void BlockStore::give_back(CommandBlock* first) noexcept {
  while (first) {
    CommandBlock* next = first->next;
    first->next = free_;
    free_ = first;
    first = next;
  }
}

void BlockStore::trim() noexcept {
  while (free_) {
    CommandBlock* next = free_->next;
    memory_.free(free_);
    free_ = next;
  }
}

void CommandArena::release() noexcept {
  store_.give_back(first_);
  first_ = last_ = nullptr;
}

CommandBlock* CommandArena::add_block(std::uint32_t bytes) {
  CommandBlock* block = store_.take(std::max(bytes, kBlockBytes));
  (last_ ? last_->next : first_) = block;
  last_ = block;
  return block;
}

}  // namespace vitrine::icd
