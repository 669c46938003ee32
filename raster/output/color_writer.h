// How the colours of a wave reach an attachment: what is decided once per draw (ColorWriter), and what a call of it
// takes (ColorWave). Bits: lavapipe-texture-blend.md parts D and E. The functions behind it: color_general.h for
// everything, color_bytes.h, color_floats.h and color_block.h for what is frequent; color.h chooses.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/color_registers.h"
#include "raster/draw.h"
#include "raster/pixel_order.h"
#include "texel/codec.h"
#include "texel/view.h"

namespace vitrine::raster {

/// What arithmetic blending uses (E1).
enum class BlendType : std::uint8_t { kNone, kByte, kWord, kFloat, kAdvanced };

/// One side of a blend equation after what E4 says of formats without alpha. Same numbers as VkBlendFactor.
struct BlendEquation {
  VkBlendFactor src = VK_BLEND_FACTOR_ONE, dst = VK_BLEND_FACTOR_ZERO;
  VkBlendOp op = VK_BLEND_OP_ADD;
};

struct ColorWriter;
struct BlockColorFunctions;  // raster/output/color_block.h

/// One attachment of one wave: everything a writer's function needs.
struct ColorWave {
  const texel::ImageView* view;
  std::uint32_t layer;  ///< within the view
  std::uint32_t sample;
  const QuadPositions* quads;
  base::LaneMask mask;  ///< covered lanes that passed all tests
  ColorRegisters color;
  ColorRegisters second;  ///< of dual-source blending, or none
};

using ColorFunction = void (*)(const ColorWriter& writer, const ColorWave& wave);

/// How fragments reach one colour attachment, decided once per draw. Trivially copyable.
struct ColorWriter {
  ColorFunction function = nullptr;            ///< null: nothing is written
  const BlockColorFunctions* block = nullptr;  ///< for whole blocks; null: `function` does them too
  const texel::FormatDesc* format = nullptr;
  BlendType blend = BlendType::kNone;
  BlendEquation rgb, alpha;
  float constants[4] = {};
  BlendAttachment advanced;  ///< of BlendType::kAdvanced: advanced_blend.h
  bool logic = false;
  VkLogicOp logic_op = VK_LOGIC_OP_COPY;
  bool masked = false;            ///< some channel is not written
  texel::StoredTexel write_bits;  ///< bits of a texel that may change
  /// Formats of four bytes: byte shuffles of a quad, from the order BytePacker leaves, and to its alphas.
  alignas(16) std::uint8_t pack_places[16] = {}, alpha_places[16] = {};
  bool reads_destination() const { return blend != BlendType::kNone || logic || masked; }
};

/// Writes the masked lanes; lanes that hit the same pixel take effect in lane order.
inline void write_color(const ColorWriter& writer, const ColorWave& wave) {
  if (writer.function && wave.mask) writer.function(writer, wave);
}

/// Address of a lane's pixel.
inline std::byte* pixel_address(const ColorWave& wave, std::size_t lane) {
  const std::size_t quad = lane / base::kQuadSize;
  return wave.view->block(0, wave.layer, wave.sample, wave.quads->x[quad] + (lane & 1u),
                          wave.quads->y[quad] + (lane >> 1 & 1u), 0);
}

}  // namespace vitrine::raster
