// Memory of recorded commands: an arena of blocks that belong to a command pool. Commands form a list; the arrays they
// point to lie among them. Nothing has a destructor, so forgetting everything is free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "base/arena.h"
#include "icd/edge/allocation.h"

namespace vitrine::icd {

/// Blocks not in use. Externally synchronised with the pool, as the specification says of command pools.
class BlockStore {
 public:
  explicit BlockStore(const HostMemory& m) : memory_{m} {}
  ~BlockStore() { trim(); }
  BlockStore(const BlockStore&) = delete;
  BlockStore& operator=(const BlockStore&) = delete;

  /// A block of at least `size` bytes. Throws std::bad_alloc.
  base::ArenaBlock* take(std::size_t size);
  void give_back(base::ArenaBlock* first) noexcept;
  /// Returns unused blocks to the heap.
  void trim() noexcept;

 private:
  HostBlocks memory_;
  base::ArenaBlock* free_ = nullptr;
};

/// What comes before each command.
struct CommandHeader {
  CommandHeader* next = nullptr;
  std::uint32_t type = 0;  ///< CommandType (icd/record/commands.h)

  const void* command() const { return this + 1; }
};

class CommandArena {
 public:
  explicit CommandArena(BlockStore& store) : memory_(StoreBlocks{&store}) {}
  CommandArena(const CommandArena&) = delete;
  CommandArena& operator=(const CommandArena&) = delete;

  /// Room for a command of `size` bytes. Throws std::bad_alloc.
  void* add_command(std::uint32_t type, std::size_t size) {
    auto* header = ::new (memory_.take_bytes(sizeof(CommandHeader) + size)) CommandHeader{nullptr, type};
    (last_ ? last_->next : first_) = header;
    last_ = header;
    return header + 1;
  }

  /// Memory for data that commands refer to, aligned to 8 bytes. Throws std::bad_alloc.
  void* add_data(std::size_t size) {
    if (size > kLargestData) throw std::bad_alloc();
    return memory_.take_bytes(size);
  }

  template <class T>
  std::span<T> add_array(std::size_t count) {
    static_assert(alignof(T) <= kAlignment);
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
  void release() noexcept {
    memory_.release();
    first_ = last_ = nullptr;
  }

  /// The first command; null: none.
  const CommandHeader* first() const { return first_; }

 private:
  static constexpr std::size_t kLargestData = std::size_t{1} << 30;
  static constexpr std::size_t kBlockBytes = 16 * 1024;
  static constexpr std::size_t kAlignment = 8;

  struct StoreBlocks {
    BlockStore* store;
    base::ArenaBlock* take(std::size_t size) { return store->take(size); }
    void give_back(base::ArenaBlock* first) noexcept { store->give_back(first); }
  };

  base::Arena<base::ArenaShape{kAlignment, 0, kBlockBytes, kBlockBytes}, StoreBlocks> memory_;
  CommandHeader* first_ = nullptr;
  CommandHeader* last_ = nullptr;
};

}  // namespace vitrine::icd
