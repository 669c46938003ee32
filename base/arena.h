// The one bump allocator: memory is handed out of blocks and forgotten all at once, so nothing in it has a destructor.
// Its users differ in where blocks come from and in their shape, which are parameters: commands
// (icd/record/command_arena.h), what replay keeps for draws (icd/replay/replay.h), chunks of draws (raster/arena.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>

namespace vitrine::base {

/// Head of a block; its memory follows.
struct ArenaBlock {
  ArenaBlock* next = nullptr;
  std::size_t size = 0;  ///< bytes that follow

  std::byte* begin() { return reinterpret_cast<std::byte*>(this + 1); }
};

/// Where an arena gets its blocks: the C++ heap. Others have the same two functions, and throw std::bad_alloc too.
struct HeapBlocks {
  /// A block of at least `size` bytes.
  ArenaBlock* take(std::size_t size) { return ::new (::operator new(sizeof(ArenaBlock) + size)) ArenaBlock{{}, size}; }
  /// Takes a list of blocks back.
  void give_back(ArenaBlock* first) noexcept {
    while (first) ::operator delete(std::exchange(first, first->next));
  }
};

struct ArenaShape {
  std::size_t alignment;                   ///< of what is handed out; a power of two
  std::size_t slack;                       ///< bytes that may be read past what is handed out: whole vectors
  std::size_t first_block, largest_block;  ///< bytes; each block is twice as large as the one before
};

template <ArenaShape kShape, class Blocks = HeapBlocks>
class Arena {
 public:
  explicit Arena(Blocks blocks = {}) : source_(blocks) {}
  ~Arena() { release(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Uninitialised memory. Throws std::bad_alloc.
  std::byte* take_bytes(std::size_t bytes) {
    if (static_cast<std::size_t>(end_ - cursor_) < bytes) open_block(bytes);
    std::byte* result = cursor_;
    cursor_ = std::min(align(cursor_ + bytes), end_);
    return result;
  }
  /// Uninitialised memory for `count` values.
  template <class T>
  T* take(std::size_t count) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kShape.alignment);
    return reinterpret_cast<T*>(take_bytes(count * sizeof(T)));
  }
  /// Gives back what was taken beyond `count` values by the latest take<T>.
  template <class T>
  void trim(T* taken, std::size_t count) {
    cursor_ = std::min(align(reinterpret_cast<std::byte*>(taken + count)), end_);
  }

  /// Forgets everything and keeps the blocks: after the first rounds nothing is allocated any more.
  void reset() {
    open_ = nullptr;
    start_ = cursor_ = end_ = nullptr;
    finished_ = 0;
  }
  /// Forgets everything and gives the blocks back.
  void release() noexcept {
    reset();
    source_.give_back(std::exchange(first_, nullptr));
    last_ = nullptr;
    grown_ = kShape.first_block;
  }
  /// Bytes handed out since the last of these two, with what was lost at the ends of blocks.
  std::size_t used() const { return finished_ + static_cast<std::size_t>(cursor_ - start_); }

 private:
  static std::byte* align(std::byte* pointer) {
    const auto address = reinterpret_cast<std::uintptr_t>(pointer);
    return pointer + (-address & (kShape.alignment - 1));
  }

  /// The next kept block that is large enough (those before it lie idle until the reset), or a new one.
  [[gnu::noinline]] void open_block(std::size_t bytes) {
    finished_ = used();
    const std::size_t needed = bytes + kShape.alignment + kShape.slack;
    if (needed < bytes) throw std::bad_alloc();
    ArenaBlock* block = open_ ? open_->next : first_;
    while (block && block->size < needed) block = block->next;
    if (!block) block = add_block(needed);
    open_ = block;
    start_ = block->begin();
    cursor_ = align(start_);
    end_ = start_ + block->size - kShape.slack;
  }
  ArenaBlock* add_block(std::size_t needed) {
    ArenaBlock* block = source_.take(std::max(grown_, needed));
    grown_ = std::min(2 * grown_, kShape.largest_block);
    (last_ ? last_->next : first_) = block;
    last_ = block;
    return block;
  }

  [[no_unique_address]] Blocks source_;
  ArenaBlock* first_ = nullptr;
  ArenaBlock* last_ = nullptr;
  ArenaBlock* open_ = nullptr;  ///< null: none yet
  std::size_t grown_ = kShape.first_block;
  std::size_t finished_ = 0;  ///< bytes of blocks before the open one
  std::byte* start_ = nullptr;
  std::byte* cursor_ = nullptr;
  std::byte* end_ = nullptr;
};

}  // namespace vitrine::base
