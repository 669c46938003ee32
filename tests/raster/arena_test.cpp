// The bump allocator: what is taken never overlaps, also at the ends of blocks and after room was given back.
#include "raster/arena.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace vitrine::raster {
namespace {

TEST(Arena, KeepsWhatIsTakenApartAfterTrimming) {
  struct Piece {
    std::byte* memory;
    std::size_t size;
    int value;
  };
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    Arena arena;
    std::vector<Piece> pieces;
    for (int i = 0; i < 2000; ++i) {
      const std::size_t room = 1 + random() % 3000;
      auto* memory = arena.take<std::byte>(room);
      const std::size_t size = random() % 2 == 0 ? room : random() % (room + 1);
      std::memset(memory, i & 0xff, room);
      arena.trim(memory, size);
      pieces.push_back({memory, size, i & 0xff});
    }
    for (const Piece& piece : pieces)
      for (std::size_t i = 0; i < piece.size; ++i) ASSERT_EQ(static_cast<int>(piece.memory[i]), piece.value);
  }
}

}  // namespace
}  // namespace vitrine::raster
