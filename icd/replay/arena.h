// Memory of one replay: values that draws point to until their pass is flushed. Reset keeps the blocks, so that the
// steady state allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "icd/edge/allocation.h"

namespace vitrine::icd {

class ReplayArena {
 public:
  explicit ReplayArena(const HostMemory& m) : memory_(m), blocks_(m) {}
  ~ReplayArena() {
    for (std::byte* block : blocks_) memory_.free(block);
  }
  ReplayArena(const ReplayArena&) = delete;
  ReplayArena& operator=(const ReplayArena&) = delete;

  /// `count` default-initialised values; count * sizeof(T) is at most kBlockBytes. Throws std::bad_alloc.
  template <class T>
  T* make(std::size_t count = 1) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
    return ::new (allocate(count * sizeof(T))) T[count];
  }

  void reset() {
    block_ = 0;
    used_ = 0;
  }
  /// Bytes handed out since the last reset, in whole blocks.
  std::size_t size() const { return block_ * kBlockBytes; }

 private:
  static constexpr std::size_t kBlockBytes = 256 * 1024;
  static constexpr std::size_t kAlignment = 16;

  void* allocate(std::size_t bytes) {
    bytes = (bytes + kAlignment - 1) & ~(kAlignment - 1);
    if (blocks_.empty() || used_ + bytes > kBlockBytes) next_block();
    std::byte* out = blocks_[block_] + used_;
    used_ += bytes;
    return out;
  }
  void next_block() {
    const std::size_t wanted = blocks_.empty() ? 0 : block_ + 1;
    if (wanted == blocks_.size()) {
      blocks_.reserve(wanted + 1);
      blocks_.push_back(
          static_cast<std::byte*>(memory_.allocate(kBlockBytes, kAlignment, VK_SYSTEM_ALLOCATION_SCOPE_DEVICE)));
    }
    block_ = wanted;
    used_ = 0;
  }

  HostMemory memory_;
  Vector<std::byte*> blocks_;
  std::size_t block_ = 0;
  std::size_t used_ = 0;
};

}  // namespace vitrine::icd
