// The bump allocator of chunk and draw memory.
#include "raster/arena.h"

#include <algorithm>
#include <cstdint>

namespace vitrine::raster {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kSlack = 128;  // readable past every allocation, so that whole vectors may be loaded
constexpr std::size_t kFirstBlock = std::size_t{64} << 10;
constexpr std::size_t kLargestBlock = std::size_t{1} << 20;

}  // namespace

std::byte* Arena::align(std::byte* pointer) {
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  return pointer + ((kAlignment - address % kAlignment) % kAlignment);
}

void Arena::open_block(std::size_t bytes) {
  finished_ += static_cast<std::size_t>(cursor_ - start_);
  while (next_ < blocks_.size() && blocks_[next_].size < bytes + kAlignment + kSlack) ++next_;
  if (next_ == blocks_.size()) {
    const std::size_t grown = std::min(kLargestBlock, kFirstBlock << std::min<std::size_t>(blocks_.size(), 4));
    const std::size_t size = std::max(grown, bytes + kAlignment + kSlack);
    blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(size), size});
  }
  Block& block = blocks_[next_++];
  start_ = block.memory.get();
  cursor_ = align(start_);
  end_ = start_ + block.size - kSlack;
}

std::byte* Arena::take_bytes(std::size_t bytes) {
  if (static_cast<std::size_t>(end_ - cursor_) < bytes) open_block(bytes);
  std::byte* result = cursor_;
  cursor_ = std::min(align(cursor_ + bytes), end_);
  return result;
}

void Arena::reset() {
  next_ = 0;
  finished_ = 0;
  start_ = cursor_ = end_ = nullptr;
}

}  // namespace vitrine::raster
