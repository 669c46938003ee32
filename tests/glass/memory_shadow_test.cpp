// States of bytes: written, given up, mapped, copied; regions that come and go.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "glass/range_shadow.h"

namespace vitrine::glass::test {
namespace {

/// Memory that the shadow knows.
struct Known {
  explicit Known(std::size_t size) : bytes(size) { add_shadow(bytes.data(), size); }
  ~Known() { remove_shadow(bytes.data()); }
  std::uintptr_t at(std::size_t offset) const { return reinterpret_cast<std::uintptr_t>(bytes.data()) + offset; }
  bool written(std::size_t offset, std::size_t count, Contents contents = Contents::kBytes) const {
    return find_shadow(bytes.data())->written(at(offset), count, contents);
  }
  std::vector<std::byte> bytes;
};

TEST(MemoryShadow, KnowsMemoryWhileItIsThere) {
  std::byte unknown{};
  EXPECT_EQ(find_shadow(&unknown), nullptr);
  std::vector<std::byte> bytes(101);
  add_shadow(bytes.data(), 100);
  EXPECT_NE(find_shadow(&bytes[99]), nullptr);
  EXPECT_EQ(find_shadow(&bytes[99]), find_shadow(&bytes[0]));
  EXPECT_EQ(find_shadow(&bytes[100]), nullptr);
  remove_shadow(bytes.data());
  EXPECT_EQ(find_shadow(&bytes[0]), nullptr);
}

TEST(MemoryShadow, KnowsBytesThatAreWritten) {
  const Known memory(64);
  const ShadowRegion& region = *find_shadow(memory.bytes.data());
  EXPECT_FALSE(memory.written(0, 1));
  region.mark(memory.at(8), 4);
  region.mark(memory.at(13), 2);
  EXPECT_TRUE(memory.written(8, 4));
  EXPECT_FALSE(memory.written(8, 5));
  EXPECT_TRUE(memory.written(13, 2));
  EXPECT_FALSE(memory.written(12, 4));
  EXPECT_TRUE(memory.written(60, 8)) << "what lies outside is another's";
}

TEST(MemoryShadow, HostsWriteBytesButNoTexels) {
  const Known memory(64);
  ShadowRegion& region = *find_shadow(memory.bytes.data());
  region.map(memory.at(16), 32);
  for (const Contents contents : {Contents::kBytes, Contents::kTexels}) {
    EXPECT_TRUE(memory.written(16, 32, contents));
    EXPECT_FALSE(memory.written(12, 8, contents));
  }
  fill_shadow(memory.bytes.data() + 16, 8, ByteState::kDiscarded);
  EXPECT_TRUE(memory.written(16, 8, Contents::kBytes));
  EXPECT_FALSE(memory.written(16, 8, Contents::kTexels));
}

TEST(MemoryShadow, CopiesCarryStates) {
  const Known from(64), to(64);
  fill_shadow(from.bytes.data() + 4, 4, ByteState::kWritten);
  fill_shadow(to.bytes.data(), 64, ByteState::kWritten);
  copy_shadow(from.bytes.data(), const_cast<std::byte*>(to.bytes.data()) + 32, 16);
  EXPECT_TRUE(to.written(0, 32));
  EXPECT_FALSE(to.written(32, 4));
  EXPECT_TRUE(to.written(36, 4));
  std::vector<std::byte> unknown(64);
  copy_shadow(unknown.data(), const_cast<std::byte*>(to.bytes.data()), 64);
  EXPECT_TRUE(to.written(0, 64));
}

TEST(MemoryShadow, MappedBytesAreCopiedAsWritten) {
  const Known from(64), to(64);
  find_shadow(from.bytes.data())->map(from.at(0), 16);
  copy_shadow(from.bytes.data(), const_cast<std::byte*>(to.bytes.data()), 32);
  EXPECT_TRUE(to.written(0, 16));
  EXPECT_FALSE(to.written(16, 1));
}

TEST(MemoryShadow, AnotherWriterIsNotForgotten) {
  const Known memory(64);
  const ShadowRegion& region = *find_shadow(memory.bytes.data());
  region.mark(memory.at(0), 4, ByteState::kDerived);
  EXPECT_FALSE(memory.written(0, 4));
  region.mark(memory.at(0), 4);
  region.mark(memory.at(0), 4, ByteState::kDerived);
  EXPECT_TRUE(memory.written(0, 4));
}

TEST(MemoryShadow, ThreadsMarkTogether) {
  const Known memory(4096);
  const ShadowRegion& region = *find_shadow(memory.bytes.data());
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      for (std::size_t i = thread; i < 2048; i += 2) region.mark(memory.at(i * 2), 2);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(memory.written(0, 4096));
}

}  // namespace
}  // namespace vitrine::glass::test
