// Rows of the formats that are met most, converted by SIMD: what decode_row and encode_row use, and rows of bytes.
#pragma once

#include "texel/codec.h"

namespace vitrine::texel {

/// Whether texels are four UNORM bytes in any order.
bool is_four_bytes(const FormatDesc& format);
/// Whether texels are R, G, B as sRGB bytes, in this order or the other, then A.
bool is_srgb_bytes(const FormatDesc& format);
/// Whether texels are R, G, B, A as halves.
bool is_four_halves(const FormatDesc& format);

/// False, with nothing done, for other formats than those.
bool decode_row_simd(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out);
bool encode_row_simd(const FormatDesc& format, Encoding encoding, const Texel* texels, std::size_t count,
                     std::byte* blocks);

/// Stores texels of four bytes, in the order of `from` if is_four_bytes(from), else R, G, B, A, as an attachment would
/// take them.
void put_bytes(const FormatDesc& from, const std::uint32_t* texels, std::size_t count, const FormatDesc& to,
               std::byte* blocks);

}  // namespace vitrine::texel
