// The bump allocator: alignment, growth, and where its blocks go.
#include "base/arena.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace vitrine::base {
namespace {

/// Counts the blocks that are out.
struct CountedBlocks {
  int* out;
  ArenaBlock* take(std::size_t size) {
    ++*out;
    return HeapBlocks().take(size);
  }
  void give_back(ArenaBlock* first) noexcept {
    for (ArenaBlock* block = first; block; block = block->next) --*out;
    HeapBlocks().give_back(first);
  }
};
using Counted = Arena<ArenaShape{32, 64, 256, 1024}, CountedBlocks>;

TEST(Arena, AlignsWhatItHandsOut) {
  int out = 0;
  Counted arena{CountedBlocks{&out}};
  for (std::size_t size = 1; size < 2000; size += 37)
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arena.take<std::byte>(size)) % 32, 0u) << size;
}

TEST(Arena, KeepsItsBlocksOverAResetAndReturnsThemOnRelease) {
  int out = 0;
  {
    Counted arena{CountedBlocks{&out}};
    const auto fill = [&] {
      for (int i = 0; i < 100; ++i) arena.take<std::uint64_t>(20);
    };
    fill();
    const int blocks = out;
    EXPECT_GT(blocks, 1);
    EXPECT_GE(arena.used(), 100 * 160u);
    arena.reset();
    EXPECT_EQ(arena.used(), 0u);
    fill();
    EXPECT_EQ(out, blocks) << "the second round took new memory";
    arena.release();
    EXPECT_EQ(out, 0);
    fill();
  }
  EXPECT_EQ(out, 0);
}

TEST(Arena, RefusesSizesThatNoMemoryHas) {
  int out = 0;
  Counted arena{CountedBlocks{&out}};
  EXPECT_THROW(arena.take_bytes(~std::size_t{0}), std::bad_alloc);
}

}  // namespace
}  // namespace vitrine::base
