// Primitives of a chunk, in whatever piece of the arena they come to lie.
#include "raster/front/primitive_list.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vitrine::raster {
namespace {

TEST(PrimitiveList, KeepsItsPrimitivesWhereverTheArenaGrows) {
  Arena arena;
  PrimitiveList list;
  for (const std::uint32_t expected : {0u, 10u, 5000u}) {
    for (const bool takes : {false, true}) {
      list.begin(arena);
      list.reserve(expected);
      for (std::uint32_t i = 0; i < 1000; ++i) {
        list.append().id = i;
        if (takes) std::memset(arena.take<std::byte>(100), 0xff, 100);
      }
      list.end();
      std::memset(arena.take<std::byte>(4000), 0xff, 4000);
      ASSERT_EQ(list.size(), 1000u);
      for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(list[i].id, i);
    }
  }
}

}  // namespace
}  // namespace vitrine::raster
