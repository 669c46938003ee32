// Blocks of compressed formats decoded whole and remembered by their content, per thread: neighbouring lanes and waves
// ask for the same ones. Nothing has to be told when memory changes.
#pragma once

#include <memory>

#include "texel/codec.h"

namespace vitrine::texel {

inline constexpr std::size_t kMaxBlockTexels = 144;  ///< 12x12

class BlockCache {
 public:
  BlockCache();
  ~BlockCache();

  /// Texels of the block at `block`, row by row, as bytes R, G, B, A. Formats that decode_block_bytes knows. Valid
  /// until the next call.
  const std::uint32_t* bytes(const FormatDesc& format, const std::byte* block);

  /// The same as values. All compressed formats.
  const Texel* texels(const FormatDesc& format, const std::byte* block);

 private:
  struct Entries;
  std::unique_ptr<Entries> entries_;  ///< allocated by the first use
};

/// This thread's.
BlockCache& block_cache();

}  // namespace vitrine::texel
