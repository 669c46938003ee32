// Decoding of stored bits to values and encoding of values to stored bits, for plain (uncompressed, single-plane)
// formats. Scalar per-texel functions and loops over rows and lanes. Bits: lavapipe-texture-blend.md parts B to D and
// lavapipe-rasterization.md 11.1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "texel/format.h"

namespace vitrine::texel {

/// R, G, B, A as raw bits: binary32 or 32-bit integers, by FormatDesc::kind. Depth and stencil are R.
using Texel = std::array<std::uint32_t, 4>;

/// What is stored: one block of a plain format, at most 16 bytes, little endian.
struct StoredTexel {
  alignas(16) std::array<std::byte, 16> bytes{};
};

/// Who stores decides how values are rounded.
enum class Encoding : std::uint8_t {
  kStore,       ///< imageStore (part B): UNORM to nearest, NaN -> 1, half and 11/11/10 truncate
  kClear,       ///< clears of all kinds (rasterization 11.1): UNORM half away from zero, half truncates
  kAttachment,  ///< colour output (part D): 5/6/10-bit channels truncate; also blit and resolve
};

/// Decodes one block of a plain format: missing colours 0, missing alpha 1 (integer 1 for integer formats).
using TexelDecoder = void (*)(const FormatDesc& format, const std::byte* block, Texel& out);

/// The decoder of a format, chosen once per row or wave. Null if the format is not plain (can_decode).
TexelDecoder texel_decoder(const FormatDesc& format);

/// `count` adjacent texels.
void decode_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out);

/// Encodes one texel; what encode_texel calls. Chosen once per row, wave or draw. Null for formats that can_encode
/// denies.
using TexelEncoder = void (*)(const FormatDesc& format, const Texel& texel, std::byte* block);
TexelEncoder texel_encoder(const FormatDesc& format, Encoding encoding);

/// Encodes one texel into format.block_bytes bytes. Padding bits become 0. Nothing is written for formats that
/// can_encode denies.
void encode_texel(const FormatDesc& format, Encoding encoding, const Texel& texel, std::byte* block);

/// `count` adjacent texels.
void encode_row(const FormatDesc& format, Encoding encoding, const Texel* texels, std::size_t count, std::byte* blocks);

}  // namespace vitrine::texel
