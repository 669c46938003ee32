// ETC2 and EAC blocks, one texel at a time (Khronos Data Format 1.3, "ETC2 Compressed Texture Image Formats"). Indices
// count texels row by row; blocks are big-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vitrine::texel {

/// A colour block of 8 bytes. With `punch_through` texels may be transparent black, else alpha is 255.
std::array<std::uint8_t, 4> decode_etc2_color(const std::byte* block, std::uint32_t index, bool punch_through);

/// The alpha of an RGBA8 block: its first 8 bytes.
std::uint8_t decode_eac_alpha(const std::byte* block, std::uint32_t index);

/// An 11-bit channel of 8 bytes: [0, 2047], or signed [-1023, 1023].
std::int32_t decode_eac_unsigned(const std::byte* block, std::uint32_t index);
std::int32_t decode_eac_signed(const std::byte* block, std::uint32_t index);

}  // namespace vitrine::texel
