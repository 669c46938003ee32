// Blocks of recorded commands: order, data beside commands, reuse.
#include "icd/record/command_arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

struct Number {
  std::uint64_t value;
};

void add(CommandArena& arena, std::uint32_t type, std::uint64_t value) {
  ::new (arena.add_command(type, sizeof(Number))) Number{value};
}

/// What a replay would see: (type, value) of every command in order.
std::vector<std::pair<std::uint32_t, std::uint64_t>> commands_of(const CommandArena& arena) {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> out;
  for (const CommandHeader* header = arena.first(); header; header = header->next)
    out.emplace_back(header->type, static_cast<const Number*>(header->command())->value);
  return out;
}

TEST(CommandArena, KeepsOrderOverManyBlocks) {
  BlockStore store{HostMemory()};
  CommandArena arena(store);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    add(arena, i, i * std::uint64_t{3});
    arena.add_data(i % 100);
  }
  const auto commands = commands_of(arena);
  ASSERT_EQ(commands.size(), 5000u);
  for (std::uint32_t i = 0; i < 5000; ++i) EXPECT_EQ(commands[i], std::make_pair(i, i * std::uint64_t{3}));
}

TEST(CommandArena, DataOfAnySizeStaysIntact) {
  BlockStore store{HostMemory()};
  CommandArena arena(store);
  std::vector<std::vector<std::uint32_t>> sources;
  std::vector<std::span<const std::uint32_t>> copies;
  for (const std::size_t count : {0u, 1u, 7u, 4000u, 5000u, 100000u, 3u}) {
    sources.emplace_back(count, static_cast<std::uint32_t>(count));
    copies.push_back(arena.copy_array(sources.back().data(), count));
    add(arena, 1, count);
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    EXPECT_TRUE(std::equal(copies[i].begin(), copies[i].end(), sources[i].begin(), sources[i].end()));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(copies[i].data()) % 8, 0u);
  }
  EXPECT_EQ(commands_of(arena).size(), sources.size());
}

TEST(CommandArena, ReleasedBlocksAreUsedAgainAndTrimmed) {
  CountingAllocator allocator;
  BlockStore store{HostMemory(allocator.callbacks(), HostMemory())};
  {
    CommandArena arena(store);
    const auto record_much = [&] {
      for (std::uint32_t i = 0; i < 3000; ++i) add(arena, i, i);
      arena.release();
      EXPECT_EQ(arena.first(), nullptr);
    };
    record_much();
    allocator.fail_after(0);
    record_much();
    EXPECT_FALSE(allocator.failed()) << "the second round took new memory";
  }
  EXPECT_GT(allocator.live(), 0u);
  store.trim();
  EXPECT_EQ(allocator.live(), 0u);
}

TEST(CommandArena, GiganticDataThrows) {
  BlockStore store{HostMemory()};
  CommandArena arena(store);
  EXPECT_THROW(arena.add_data(std::size_t{1} << 40), std::bad_alloc);
  EXPECT_THROW(arena.add_array<std::uint64_t>(~std::size_t{0} / 4), std::bad_alloc);
}

}  // namespace
}  // namespace vitrine::icd::test
