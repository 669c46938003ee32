// Direct-mapped tables of decoded blocks.
#include "texel/block/cache.h"

#include <array>
#include <cstring>

#include "base/lasting.h"
#include "texel/block/block.h"

namespace vitrine::texel {
namespace {

/// What identifies a block: up to 16 bytes of it and its format.
struct Key {
  std::uint64_t low = 0, high = 0;
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool operator==(const Key&) const = default;
};

Key key_of(const FormatDesc& format, const std::byte* block) {
  Key key;
  std::memcpy(&key.low, block, sizeof(key.low));
  if (format.block_bytes == 16) std::memcpy(&key.high, block + sizeof(key.low), sizeof(key.high));
  key.format = format.format;
  return key;
}

template <class T, std::size_t kCount>
struct Table {
  struct Entry {
    Key key;
    std::array<T, kMaxBlockTexels> texel;
  };
  std::array<Entry, kCount> entry;

  /// The entry that may hold the block: by its content, so that equal blocks share one.
  Entry& of(const Key& key) {
    const std::uint64_t mixed = (key.low ^ key.high * 0x9E3779B97F4A7C15u) * 0xD6E8FEB86659FD93u;
    return entry[mixed >> 32 & (kCount - 1)];
  }
};

}  // namespace

struct BlockCache::Entries {
  Table<std::uint32_t, 128> bytes{};
  Table<Texel, 64> texels{};
};

BlockCache::BlockCache() = default;
BlockCache::~BlockCache() = default;

const std::uint32_t* BlockCache::bytes(const FormatDesc& format, const std::byte* block) {
  if (!entries_) entries_ = std::make_unique<Entries>();
  const Key key = key_of(format, block);
  auto& entry = entries_->bytes.of(key);
  if (entry.key != key) {
    decode_block_bytes(format, block, entry.texel.data());
    entry.key = key;
  }
  return entry.texel.data();
}

const Texel* BlockCache::texels(const FormatDesc& format, const std::byte* block) {
  if (!entries_) entries_ = std::make_unique<Entries>();
  const Key key = key_of(format, block);
  auto& entry = entries_->texels.of(key);
  if (entry.key != key) {
    decode_block_texels(format, block, entry.texel.data());
    entry.key = key;
  }
  return entry.texel.data();
}

BlockCache& block_cache() { return base::per_thread<BlockCache>(); }

}  // namespace vitrine::texel
