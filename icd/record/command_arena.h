// Memory of recorded commands: blocks that belong to a command pool. Commands are appended in order; the arrays they
// point to lie beside them. Nothing has a destructor, so forgetting everything is free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "icd/edge/allocation.h"

namespace vitrine::icd {

/// Commands grow from the front of a block, data from its back.
struct CommandBlock {
  CommandBlock* next = nullptr;
  std::uint32_t front = 0;  ///< bytes of commands
  std::uint32_t back = 0;   ///< offset of the lowest data byte
  std::uint32_t capacity = 0;

  std::byte* bytes() { return reinterpret_cast<std::byte*>(this + 1); }
  const std::byte* bytes() const { return reinterpret_cast<const std::byte*>(this + 1); }
};

/// Blocks not in use. Externally synchronised with the pool, as the specification says of command pools.
class BlockStore {
 public:
  explicit BlockStore(const HostMemory& m) : memory_(m) {}
  ~BlockStore() { trim(); }
  BlockStore(const BlockStore&) = delete;
  BlockStore& operator=(const BlockStore&) = delete;

  /// An empty block of at least `capacity` bytes. Throws std::bad_alloc.
  CommandBlock* take(std::uint32_t capacity);
  void give_back(CommandBlock* first) noexcept;
  /// Returns unused blocks to the heap.
  void trim() noexcept;

 private:
  HostMemory memory_;
  CommandBlock* free_ = nullptr;
};

/// What comes before each command in a block.
struct CommandHeader {
  std::uint32_t type;  ///< index in Commands (icd/record/commands.h)
  std::uint32_t size;  ///< bytes to the next header
};

class CommandArena {
 public:
  explicit CommandArena(BlockStore& store) : store_(store) {}
  ~CommandArena() { release(); }
  CommandArena(const CommandArena&) = delete;
  CommandArena& operator=(const CommandArena&) = delete;

  /// Room for a command of `size` bytes. Throws std::bad_alloc.
  void* add_command(std::uint32_t type, std::size_t size) {
    const auto bytes = static_cast<std::uint32_t>(sizeof(CommandHeader) + round_up(size));
    std::byte* at = reserve(bytes)->bytes() + last_->front;
    last_->front += bytes;
    const CommandHeader header{type, bytes};
    std::memcpy(at, &header, sizeof header);
    return at + sizeof header;
  }

  /// Memory for data that commands refer to, aligned to 8 bytes. Throws std::bad_alloc.
  void* add_data(std::size_t size) {
    if (size > kLargestData) throw std::bad_alloc();
    const auto bytes = static_cast<std::uint32_t>(round_up(size));
    CommandBlock* block = reserve(bytes);
    block->back -= bytes;
    return block->bytes() + block->back;
  }

  template <class T>
  std::span<T> add_array(std::size_t count) {
    static_assert(alignof(T) <= 8);
    if (count > kLargestData / sizeof(T)) throw std::bad_alloc();
    return {::new (add_data(count * sizeof(T))) T[count], count};
  }
  template <class T>
  std::span<const T> copy_array(const T* source, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count == 0) return {};
    if (count > kLargestData / sizeof(T)) throw std::bad_alloc();
    void* memory = add_data(count * sizeof(T));
    std::memcpy(memory, source, count * sizeof(T));
    return {static_cast<const T*>(memory), count};
  }

  /// Forgets the commands and gives the blocks back to the store.
  void release() noexcept;

  const CommandBlock* first() const { return first_; }

 private:
  static constexpr std::size_t kLargestData = std::size_t{1} << 30;
  static constexpr std::uint32_t kBlockBytes = 16 * 1024;
  static constexpr std::size_t round_up(std::size_t size) { return (size + 7) & ~std::size_t{7}; }

  CommandBlock* reserve(std::uint32_t bytes) {
    if (last_ && last_->back - last_->front >= bytes) return last_;
    return add_block(bytes);
  }
  CommandBlock* add_block(std::uint32_t bytes);

  BlockStore& store_;
  CommandBlock* first_ = nullptr;
  CommandBlock* last_ = nullptr;
};

}  // namespace vitrine::icd
