// Texels that were copied to buffers, and from there to others: chains lead through them as long as the buffers hold
// the same bytes.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "glass/pixel/history.h"

namespace vitrine::glass::pixel {

/// Where bytes of a buffer come from.
struct StagedTexel {
  TexelId texel;
  const texel::FormatDesc* format = nullptr;
  std::uint64_t submission = 0;  ///< of the command that read the image
  std::uint32_t command = 0;
  std::string_view name;  ///< "vkCmdCopyImageToBuffer"
};

/// What the thread that replays tells; not for several.
class Staged {
 public:
  /// Texel blocks side by side, from this one on, lie at `at` now. `block`: texels of one from left to right.
  void add(const std::byte* at, std::uint64_t bytes, const StagedTexel& first, std::uint32_t block);
  /// The same of what a buffer has got from another one.
  void copied(const std::byte* from, const std::byte* to, std::uint64_t bytes);
  /// The texel whose bytes these still are.
  std::optional<StagedTexel> find(const std::byte* at, std::uint32_t bytes) const;

 private:
  struct Row {
    const std::byte* at = nullptr;
    StagedTexel first;
    std::uint32_t block = 1;
    std::vector<std::byte> bytes;  ///< as they were
  };
  void keep(Row row);

  std::deque<Row> rows_;  ///< the newest last
  std::uint64_t bytes_ = 0;
};

}  // namespace vitrine::glass::pixel
