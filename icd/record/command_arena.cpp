// Blocks of command memory: taking, reusing, returning.
#include "icd/record/command_arena.h"

#include <utility>

namespace vitrine::icd {

using base::ArenaBlock;

ArenaBlock* BlockStore::take(std::size_t size) {
  if (free_ && free_->size >= size) {
    ArenaBlock* block = std::exchange(free_, free_->next);
    block->next = nullptr;
    return block;
  }
  return memory_.take(size);
}

void BlockStore::give_back(ArenaBlock* first) noexcept {
  while (first) {
    ArenaBlock* next = first->next;
    first->next = free_;
    free_ = first;
    first = next;
  }
}

void BlockStore::trim() noexcept { memory_.give_back(std::exchange(free_, nullptr)); }

}  // namespace vitrine::icd
