// Single texels of a view, as values or as the bytes of the 8-bit path (lavapipe-texture-blend.md A2, part C).
#include <cstring>

#include "texel/block/block.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {
namespace {

/// Widens an n-bit channel to 8 bits by repeating its bits.
std::uint8_t widen(std::uint32_t value, std::uint32_t bits) {
  if (bits == 8) return static_cast<std::uint8_t>(value);
  if (bits == 1) return value != 0 ? 255 : 0;
  return static_cast<std::uint8_t>(value << (8 - bits) | value >> (2 * bits - 8));
}

}  // namespace

void fetch_texel(const Plan& plan, std::uint32_t level, std::uint32_t layer, std::uint32_t x, std::uint32_t y,
                 std::uint32_t z, Texel& out) {
  const ImageView& view = *plan.view;
  const FormatDesc& format = *view.format;
  if (plan.decode == nullptr) {
    const std::byte* block = view.block(level, layer, 0, x / format.block_width, y / format.block_height, z);
    decode_block_texel(format, block, x % format.block_width, y % format.block_height, out);
    return;
  }
  plan.decode(format, view.block(level, layer, 0, x, y, z), out);
}

void fetch_bytes(const ImageView& view, std::uint32_t level, std::uint32_t layer, std::uint32_t x, std::uint32_t y,
                 std::uint32_t z, ByteTexel& out) {
  const FormatDesc& format = *view.format;
  if (format.is_compressed()) {
    const std::byte* block = view.block(level, layer, 0, x / format.block_width, y / format.block_height, z);
    decode_block_bytes(format, block, x % format.block_width, y % format.block_height, out);
    return;
  }
  std::uint32_t word = 0;
  std::memcpy(&word, view.block(level, layer, 0, x, y, z), format.block_bytes);
  for (std::size_t c = 0; c < 4; ++c) {
    const std::int8_t index = format.rgba[c];
    if (index < 0) {
      out[c] = c == 3 ? 255 : 0;
      continue;
    }
    const Channel& channel = format.channel[index];
    out[c] = widen((word >> channel.offset) & ((1u << channel.bits) - 1), channel.bits);
  }
}

}  // namespace vitrine::texel
