// Stage memory: where vertices and patches lie between shader stages. Fixed function writes vertices, patches and
// tables of offsets; tessellation and geometry shaders read and write them as workgroup memory. All units are 32-bit
// words unless said otherwise.
//
//   vertex    position 0..3, point size 4, clip distances 8..15, cull distances 16..23, then 4 words per location
//   patch     outer levels 0..3, inner levels 4..5, then 4 words per location; its vertices follow
//   table     one byte offset per vertex of a primitive
//   emitted   word 0 is kEmit*, then what ShaderInterface::emitted says
#pragma once

#include <cstdint>

#include "spirv/shader.h"

namespace vitrine::spirv {

inline constexpr std::uint32_t kVertexHeaderWords = 24;
inline constexpr std::uint32_t kPatchHeaderWords = 8;
inline constexpr std::uint32_t kNoStageWord = ~std::uint32_t{0};

/// In InterfaceSlot::xfb_offset beside the bytes: what is captured is the component as binary16, or its low half; else
/// its 32 bits.
inline constexpr std::uint32_t kXfbHalf = 1u << 31, kXfbShort = 1u << 30;
inline constexpr std::uint32_t kXfbBytes = kXfbShort - 1;
constexpr std::uint32_t captured_bytes(std::uint32_t xfb_offset) {
  return (xfb_offset & (kXfbHalf | kXfbShort)) != 0 ? 2 : 4;
}

/// Word 0 of an emitted vertex: its stream, and whether it starts a primitive (a strip).
inline constexpr std::uint32_t kEmitStream = 3;
inline constexpr std::uint32_t kEmitStarts = 4;

/// First word of a built-in of a vertex or patch; kNoStageWord if it is none.
constexpr std::uint32_t built_in_word(BuiltIn built_in) {
  switch (built_in) {
    case BuiltIn::kPosition:
    case BuiltIn::kTessLevelOuter:
      return 0;
    case BuiltIn::kPointSize:
    case BuiltIn::kTessLevelInner:
      return 4;
    case BuiltIn::kClipDistance:
      return 8;
    case BuiltIn::kCullDistance:
      return 16;
    default:
      return kNoStageWord;
  }
}

/// Where a vertex shader's output lies in a vertex; kNoStageWord: nowhere.
constexpr std::uint32_t vertex_word(const InterfaceSlot& slot) {
  if (slot.built_in == BuiltIn::kNone) return kVertexHeaderWords + slot.location * 4u + slot.component;
  const std::uint32_t word = built_in_word(slot.built_in);
  return word == kNoStageWord ? word : word + slot.component;
}

}  // namespace vitrine::spirv
