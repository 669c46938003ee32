// See staged.h.
#include "glass/pixel/staged.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass::pixel {
namespace {

/// Bytes that are kept of all rows; the oldest go.
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;

}  // namespace

void Staged::keep(Row row) {
  bytes_ += row.bytes.size();
  rows_.push_back(std::move(row));
  for (; bytes_ > kMostBytes; rows_.pop_front()) bytes_ -= rows_.front().bytes.size();
}

void Staged::add(const std::byte* at, std::uint64_t bytes, const StagedTexel& first, std::uint32_t block) {
  keep({at, first, block, std::vector<std::byte>(at, at + bytes)});
}

void Staged::copied(const std::byte* from, const std::byte* to, std::uint64_t bytes) {
  const std::size_t known = rows_.size();
  std::vector<Row> found;
  for (std::size_t i = 0; i < known; ++i) {
    const Row& row = rows_[i];
    const std::uint32_t each = row.first.format->block_bytes;
    const std::byte *const begin = std::max(from, row.at), *const end =
                                                               std::min(from + bytes, row.at + row.bytes.size());
    if (begin >= end) continue;
    // Whole blocks alone.
    const std::uint64_t first = (static_cast<std::uint64_t>(begin - row.at) + each - 1) / each;
    const std::uint64_t last = static_cast<std::uint64_t>(end - row.at) / each;
    if (first >= last) continue;
    const std::byte* const part = row.at + first * each;
    if (std::memcmp(to + (part - from), row.bytes.data() + first * each, (last - first) * each) != 0) continue;
    Row moved{to + (part - from), row.first, row.block, {}};
    moved.first.texel.x += static_cast<std::uint32_t>(first) * row.block;
    moved.bytes.assign(moved.at, moved.at + (last - first) * each);
    found.push_back(std::move(moved));
  }
  for (Row& row : found) keep(std::move(row));
}

std::optional<StagedTexel> Staged::find(const std::byte* at, std::uint32_t bytes) const {
  for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) {
    const std::uint32_t each = row->first.format->block_bytes;
    if (at < row->at || at + bytes > row->at + row->bytes.size()) continue;
    const auto offset = static_cast<std::uint64_t>(at - row->at);
    // What has been written since is somebody else's, and hides what was there before.
    if (offset % each != 0 || std::memcmp(at, row->bytes.data() + offset, bytes) != 0) return std::nullopt;
    StagedTexel found = row->first;
    found.texel.x += static_cast<std::uint32_t>(offset / each) * row->block;
    return found;
  }
  return std::nullopt;
}

}  // namespace vitrine::glass::pixel
