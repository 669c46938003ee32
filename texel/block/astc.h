// ASTC blocks, two-dimensional, low dynamic range (Khronos Data Format 1.3, "ASTC Compressed Texture Image Formats").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vitrine::texel {

inline constexpr std::uint32_t kMaxAstcTexels = 144;

/// A decoded block: 16-bit components R, G, B, A of each texel, row by row; for sRGB the byte is the upper half.
using AstcTexels = std::array<std::array<std::uint16_t, 4>, kMaxAstcTexels>;

/// Decodes 16 bytes into width * height texels. Ill-formed blocks, and partitions of high dynamic range, are magenta.
void decode_astc(const std::byte* block, std::uint32_t width, std::uint32_t height, bool srgb, AstcTexels& out);

}  // namespace vitrine::texel
