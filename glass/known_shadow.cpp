// What a thread knows of whole ranges and images.
#include "glass/known_shadow.h"

#include <algorithm>
#include <array>

#include "base/lasting.h"

namespace vitrine::glass {
namespace {

std::uintptr_t number_of(const std::byte* address) { return reinterpret_cast<std::uintptr_t>(address); }

/// What tells ranges and views of one memory apart.
struct Key {
  const ShadowRegion* region = nullptr;
  std::uintptr_t first = 0;
  std::uint64_t size = 0, pitch = 0;  ///< of a view: its texels, its counts and where its rows lie
  const void* format = nullptr;       ///< null: a range of bytes
  bool operator==(const Key&) const = default;
};

struct Entry {
  Key key;
  std::uint64_t generation = 0;
  bool written = false;
  const void* command = nullptr;  ///< for which it was not
  std::uint32_t failures = 0;     ///< in a row
  std::uint32_t skipped = 0;      ///< commands since the last one
};

/// Looking in vain costs the more time the larger the memory is: it is done for one in 2^failures commands, at least
/// one in so many.
constexpr std::uint32_t kMostFailures = 6;

/// Entries of a thread, by hash; the latest comer stays.
struct Memory {
  std::array<Entry, 64> entries;
};

template <class Look>
bool ask(const Key& key, const void* command, Look&& look) {
  const std::uint64_t hash = (key.first >> 4 ^ key.size) * 0x9e3779b97f4a7c15u;
  Entry& entry = base::per_thread<Memory>().entries[hash >> 58];
  const std::uint64_t generation = key.region->generation();
  if (entry.key != key) {
    entry = {};
    entry.key = key;
  } else if (entry.written) {
    if (entry.generation == generation) return true;
  } else if (command != nullptr) {
    if (entry.command == command) return false;
    entry.command = command;
    if (++entry.skipped < 1u << entry.failures) return false;
  }
  entry.written = look();
  entry.generation = generation;
  entry.command = command;
  entry.failures = entry.written ? 0 : std::min(entry.failures + 1, kMostFailures);
  entry.skipped = 0;
  return entry.written;
}

bool look_at(const ShadowRegion& region, const texel::ImageView& view) {
  for (std::uint32_t level = 0; level < view.level_count; ++level) {
    const texel::Extent& extent = view.level[level].extent;
    const auto blocks = [](std::uint32_t texels, std::uint32_t block) { return (texels + block - 1) / block; };
    const std::uint32_t rows = blocks(extent.height, view.format->block_height);
    const std::uint64_t bytes =
        std::uint64_t{blocks(extent.width, view.format->block_width)} * view.format->block_bytes;
    for (std::uint32_t layer = 0; layer < view.layer_count; ++layer)
      for (std::uint32_t sample = 0; sample < view.samples; ++sample)
        for (std::uint32_t slice = 0; slice < extent.depth; ++slice)
          for (std::uint32_t row = 0; row < rows; ++row)
            if (!region.written(number_of(view.block(level, layer, sample, 0, row, slice)), bytes, Contents::kTexels))
              return false;
  }
  return true;
}

}  // namespace

bool is_all_written(const ShadowRegion& region, const std::byte* first, std::uint64_t bytes, const void* command) {
  return ask({&region, number_of(first), bytes, 0, nullptr}, command,
             [&] { return region.written(number_of(first), bytes, Contents::kBytes); });
}

bool is_all_written(const ShadowRegion& region, const texel::ImageView& view, const void* command) {
  const texel::LevelLayout& level = view.level[0];
  const std::uint64_t size = std::uint64_t{level.extent.width} << 32 ^ std::uint64_t{level.extent.height} << 16 ^
                             level.extent.depth ^ std::uint64_t{view.level_count} << 56 ^
                             std::uint64_t{view.layer_count} << 40;
  const std::uint64_t pitch = level.row_pitch ^ view.layer_stride << 32;
  return ask({&region, number_of(view.base + level.offset), size, pitch, view.format}, command,
             [&] { return look_at(region, view); });
}

}  // namespace vitrine::glass
