// Rows of plain formats whose texels are fields of words, converted by SIMD: what decode_row and encode_row use beside
// codec/rows.h. Functions return how many texels they have converted: whole vectors, none of formats that they do not
// know.
#pragma once

#include "texel/codec.h"

namespace vitrine::texel {

std::size_t decode_field_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out);

/// As colour or depth attachments (Encoding::kAttachment).
std::size_t encode_field_row(const FormatDesc& format, const Texel* texels, std::size_t count, std::byte* blocks);

/// Texels as bytes R, G, B, A, of uncompressed formats of the reference's 8-bit path (plan.h).
std::size_t decode_byte_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, std::uint32_t* out);

}  // namespace vitrine::texel
