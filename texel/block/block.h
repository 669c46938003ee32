// Block-compressed texels, one at a time (lavapipe-texture-blend.md C1; Khronos Data Format 1.3, chapters of BC, ETC2
// and ASTC).
#pragma once

#include "texel/codec.h"

namespace vitrine::texel {

/// Texel (x, y) of a block as values; x and y inside the block. BC, ETC2, EAC, ASTC; others give 0.
void decode_block_texel(const FormatDesc& format, const std::byte* block, std::uint32_t x, std::uint32_t y, Texel& out);

/// All texels of a block, row by row.
void decode_block_texels(const FormatDesc& format, const std::byte* block, Texel* out);

/// The same as 8-bit channels, before conversion to float: formats of the reference's byte path (UNORM, not BC6H).
void decode_block_bytes(const FormatDesc& format, const std::byte* block, std::uint32_t x, std::uint32_t y,
                        std::array<std::uint8_t, 4>& out);

/// Those of all texels of a block, row by row, as words with R in the low byte.
void decode_block_bytes(const FormatDesc& format, const std::byte* block, std::uint32_t* out);

}  // namespace vitrine::texel
