// Blend arithmetic as pure functions over one pixel, in the reference's three number types
// (lavapipe-texture-blend.md E1-E5).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/numeric.h"
#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// The operations of equations; the tests of raster go through them.
inline constexpr std::array kBlendOps = {VK_BLEND_OP_ADD, VK_BLEND_OP_SUBTRACT, VK_BLEND_OP_REVERSE_SUBTRACT,
                                         VK_BLEND_OP_MIN, VK_BLEND_OP_MAX};

/// Whether an operation combines products with factors (E3 and E5 are about those) rather than the colours themselves.
constexpr bool takes_factors(VkBlendOp op) {
  return op == VK_BLEND_OP_ADD || op == VK_BLEND_OP_SUBTRACT || op == VK_BLEND_OP_REVERSE_SUBTRACT;
}

/// uint8 or uint16 as normalised numbers, held in 32-bit integers (E2).
template <int Bits>
struct NormalizedBlend {
  using Value = std::uint32_t;
  static constexpr Value kOne = (1u << Bits) - 1;
  static constexpr bool kFloating = false;

  static Value mul(Value a, Value b) {
    Value t = a * b;
    t += t >> Bits;
    return (t + (1u << (Bits - 1))) >> Bits;
  }
  static Value complement(Value a) { return kOne - a; }
  static Value add(Value a, Value b) { return std::min(a + b, kOne); }
  static Value sub(Value a, Value b) { return a > b ? a - b : 0; }
  static Value min(Value a, Value b) { return std::min(a, b); }
  static Value max(Value a, Value b) { return std::max(a, b); }
  /// E5: v0 + x*(v1 - v0); bytes round, words truncate.
  static Value lerp(Value x, Value v0, Value v1) {
    const auto weight = static_cast<std::int32_t>(x + (x >> (Bits - 1)));
    const auto difference = static_cast<std::int32_t>(v1) - static_cast<std::int32_t>(v0);
    if constexpr (Bits == 8) return (v0 + static_cast<Value>((weight * difference + 128) >> 8)) & kOne;
    // The 32-bit product wraps.
    const auto product = static_cast<std::int32_t>(static_cast<Value>(weight) * static_cast<Value>(difference));
    return (v0 + static_cast<Value>(product >> 16)) & kOne;
  }
};

struct FloatBlend {
  using Value = float;
  static constexpr Value kOne = 1.0f;
  static constexpr bool kFloating = true;

  static Value mul(Value a, Value b) { return a * b; }
  static Value complement(Value a) { return 1.0f - a; }
  static Value add(Value a, Value b) { return a + b; }
  static Value sub(Value a, Value b) { return a - b; }
  static Value min(Value a, Value b) { return base::min_second(a, b); }
  static Value max(Value a, Value b) { return base::max_second(a, b); }
  static Value lerp(Value x, Value v0, Value v1) { return std::fma(x, v1 - v0, v0); }
};

/// A blend constant as a byte: clamped, rounded by an addition (lavapipe-rasterization.md 11.4).
inline std::uint32_t constant_to_byte(float x) {
  if (!(x > 0.0f)) return 0;
  return x >= 1.0f ? 255 : base::bits_of(x * (255.0f / 256.0f) + 32768.0f) & 0xff;
}

/// Operands of one pixel.
template <class T>
struct BlendInput {
  std::array<T, 4> src, second, dst, constants;
  bool has_alpha = true;  ///< the format stores alpha
};

template <class Ops>
typename Ops::Value blend_factor(VkBlendFactor factor, const BlendInput<typename Ops::Value>& in, std::size_t c) {
  using T = typename Ops::Value;
  const T dst_alpha = in.has_alpha ? in.dst[3] : Ops::kOne;
  switch (factor) {
    case VK_BLEND_FACTOR_ZERO:
      return T{0};
    case VK_BLEND_FACTOR_ONE:
      return Ops::kOne;
    case VK_BLEND_FACTOR_SRC_COLOR:
      return in.src[c];
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
      return Ops::complement(in.src[c]);
    case VK_BLEND_FACTOR_DST_COLOR:
      return in.dst[c];
    case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
      return Ops::complement(in.dst[c]);
    case VK_BLEND_FACTOR_SRC_ALPHA:
      return in.src[3];
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
      return Ops::complement(in.src[3]);
    case VK_BLEND_FACTOR_DST_ALPHA:
      return dst_alpha;
    case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
      return Ops::complement(dst_alpha);
    case VK_BLEND_FACTOR_CONSTANT_COLOR:
      return in.constants[c];
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
      return Ops::complement(in.constants[c]);
    case VK_BLEND_FACTOR_CONSTANT_ALPHA:
      return in.constants[3];
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
      return Ops::complement(in.constants[3]);
    case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE:
      if (c == 3) return Ops::kOne;
      return Ops::min(in.src[3], in.has_alpha ? Ops::complement(dst_alpha) : T{0});
    case VK_BLEND_FACTOR_SRC1_COLOR:
      return in.second[c];
    case VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR:
      return Ops::complement(in.second[c]);
    case VK_BLEND_FACTOR_SRC1_ALPHA:
      return in.second[3];
    case VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA:
      return Ops::complement(in.second[3]);
    default:
      return T{0};
  }
}

/// What of an equation does not depend on the pixel.
struct BlendShape {
  bool src_zero = false, src_one = false, dst_zero = false, dst_one = false;           ///< constant in every channel
  bool common_factor = false;                                                          ///< E3: (src OP dst) * factor
  enum class Lerp : std::uint8_t { kNone, kSource, kDestination } lerp = Lerp::kNone;  ///< E5, one channel
};

/// Whether the factors are f and 1 - f of the same thing; kSource if f stands at the source.
BlendShape::Lerp complementary(VkBlendFactor src, VkBlendFactor dst);
BlendShape blend_shape(const ColorWriter& writer);

/// Whether a blend factor is a dual-source one.
bool reads_second_source(const ColorWriter& writer);

/// One channel of a pixel.
template <class Ops>
typename Ops::Value blend_channel(const BlendEquation& equation, const BlendShape& shape,
                                  const BlendInput<typename Ops::Value>& in, std::size_t c) {
  using T = typename Ops::Value;
  using Lerp = BlendShape::Lerp;
  const T src = in.src[c], dst = in.dst[c];
  const T src_factor = blend_factor<Ops>(equation.src, in, c), dst_factor = blend_factor<Ops>(equation.dst, in, c);
  const VkBlendOp op = equation.op;
  const bool factors = takes_factors(op);
  if (shape.lerp != Lerp::kNone && op == VK_BLEND_OP_ADD) {
    return shape.lerp == Lerp::kSource ? Ops::lerp(src_factor, dst, src) : Ops::lerp(dst_factor, src, dst);
  }
  if (Ops::kFloating && factors && shape.lerp != Lerp::kNone) {
    const bool at_source = shape.lerp == Lerp::kSource;
    const T product = Ops::mul(Ops::add(src, dst), at_source ? src_factor : dst_factor);
    const bool product_first = (op == VK_BLEND_OP_SUBTRACT) == at_source;
    const T other = at_source ? dst : src;
    return product_first ? Ops::sub(product, other) : Ops::sub(other, product);
  }
  if (Ops::kFloating && factors && shape.common_factor) {
    const T combined = op == VK_BLEND_OP_ADD        ? Ops::add(src, dst)
                       : op == VK_BLEND_OP_SUBTRACT ? Ops::sub(src, dst)
                                                    : Ops::sub(dst, src);
    return shape.src_one ? combined : shape.src_zero ? T{0} : Ops::mul(combined, src_factor);
  }
  const T src_term = shape.src_one ? src : shape.src_zero ? T{0} : Ops::mul(src, src_factor);
  const T dst_term = shape.dst_one ? dst : shape.dst_zero ? T{0} : Ops::mul(dst, dst_factor);
  switch (op) {
    case VK_BLEND_OP_ADD:
      return shape.src_zero ? dst_term : shape.dst_zero ? src_term : Ops::add(src_term, dst_term);
    case VK_BLEND_OP_SUBTRACT:
      return shape.dst_zero ? src_term : Ops::sub(src_term, dst_term);
    case VK_BLEND_OP_REVERSE_SUBTRACT:
      return shape.src_zero ? dst_term : Ops::sub(dst_term, src_term);
    case VK_BLEND_OP_MIN:
      return Ops::min(src_term, dst_term);
    default:
      return Ops::max(src_term, dst_term);
  }
}

/// One pixel: rgb by one equation, alpha by the other.
template <class Ops>
std::array<typename Ops::Value, 4> blend_pixel(const ColorWriter& writer, const BlendShape& shape,
                                               const BlendInput<typename Ops::Value>& in) {
  std::array<typename Ops::Value, 4> result;
  for (std::size_t c = 0; c < 4; ++c) result[c] = blend_channel<Ops>(c < 3 ? writer.rgb : writer.alpha, shape, in, c);
  return result;
}

}  // namespace vitrine::raster
