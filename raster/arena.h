// A bump allocator whose blocks are kept: after the first frames nothing is allocated any more (design.md section 6).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace vitrine::raster {

class Arena {
 public:
  /// Uninitialised memory for `count` values, aligned to 64 bytes; valid until reset(). Throws std::bad_alloc.
  template <class T>
  T* take(std::size_t count) {
    static_assert(std::is_trivially_destructible_v<T>);
    return reinterpret_cast<T*>(take_bytes(count * sizeof(T)));
  }

  /// Gives back what was taken beyond `count` values by the latest take<T>.
  template <class T>
  void trim(T* taken, std::size_t count) {
    cursor_ = std::min(align(reinterpret_cast<std::byte*>(taken + count)), end_);
  }

  /// Forgets everything, keeps the blocks.
  void reset();

  /// Bytes handed out since reset(), including what was lost at the ends of blocks.
  std::size_t used() const { return finished_ + static_cast<std::size_t>(cursor_ - start_); }

 private:
  struct Block {
    std::unique_ptr<std::byte[]> memory;
    std::size_t size = 0;
  };
  static std::byte* align(std::byte* pointer);
  std::byte* take_bytes(std::size_t bytes);
  void open_block(std::size_t bytes);

  std::vector<Block> blocks_;
  std::size_t next_ = 0;      // block opened next
  std::size_t finished_ = 0;  // bytes of blocks before the open one
  std::byte* start_ = nullptr;
  std::byte* cursor_ = nullptr;
  std::byte* end_ = nullptr;
};

}  // namespace vitrine::raster
