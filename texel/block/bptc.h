// BC6H and BC7 texels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vitrine::texel {

/// R, G, B, A of texel `texel` (y * 4 + x) of a BC7 block. Reserved blocks are transparent black.
std::array<std::uint8_t, 4> decode_bc7(const std::byte* block, std::uint32_t texel);
/// All 16 texels, as words with R in the low byte.
void decode_bc7(const std::byte* block, std::uint32_t out[16]);

/// R, G, B of texel `texel` of a BC6H block. Reserved modes are black.
std::array<float, 3> decode_bc6h(const std::byte* block, std::uint32_t texel, bool is_signed);

}  // namespace vitrine::texel
