// BC1 to BC5 as the reference decodes them: everything in 8 bits (lavapipe-texture-blend.md C1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vitrine::texel {

enum class ColorBlock : std::uint8_t { kRgb, kRgba, kFourColors };  ///< BC1 RGB, BC1 RGBA, BC2 and BC3

/// Weights between the two endpoints of a channel, in 6 fractional bits of 255ths.
inline constexpr std::uint32_t kSevenths = 2331;  ///< 255 * 64 / 7
inline constexpr std::uint32_t kFifths = 3264;    ///< 255 * 64 / 5

/// R, G, B, A of texel `index` (y * 4 + x) of the 8 colour bytes.
std::array<std::uint8_t, 4> decode_color_block(const std::byte* block, std::uint32_t index, ColorBlock kind);

/// The same of all 16 texels, as words with R in the low byte.
void decode_color_block(const std::byte* block, ColorBlock kind, std::uint32_t out[16]);

/// BC2's explicit alpha.
std::uint8_t decode_explicit_alpha(const std::byte* block, std::uint32_t index);

/// One channel of BC3 alpha, BC4, BC5: 8 bits, unsigned or signed.
std::uint8_t decode_channel_unsigned(const std::byte* block, std::uint32_t index);
void decode_channel_unsigned(const std::byte* block, std::uint8_t out[16]);
std::int8_t decode_channel_signed(const std::byte* block, std::uint32_t index);

}  // namespace vitrine::texel
