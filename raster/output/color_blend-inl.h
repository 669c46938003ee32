// Blending by SIMD: factors of any number type, and equations in binary32 (lavapipe-texture-blend.md E1-E5). Vector
// twins of blend.h. Include after <hwy/highway.h>, in a file that follows the foreach_target pattern.

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"
#include "raster/output/blend.h"

#if defined(VITRINE_RASTER_COLOR_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_RASTER_COLOR_BLEND_INL_H_
#undef VITRINE_RASTER_COLOR_BLEND_INL_H_
#else
#define VITRINE_RASTER_COLOR_BLEND_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::x86_add;
using base::HWY_NAMESPACE::x86_fma;
using base::HWY_NAMESPACE::x86_mul;
using base::HWY_NAMESPACE::x86_sub;

/// blend_factor() of blend.h over what `in` knows to load and to subtract from one. Dual-source factors only where `in`
/// has a second colour.
template <class Operands>
HWY_INLINE auto blend_factor_lanes(VkBlendFactor factor, const Operands& in) -> decltype(in.one()) {
  switch (factor) {
    case VK_BLEND_FACTOR_ONE:
      return in.one();
    case VK_BLEND_FACTOR_SRC_COLOR:
      return in.src();
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
      return in.complement(in.src());
    case VK_BLEND_FACTOR_DST_COLOR:
      return in.dst();
    case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
      return in.complement(in.dst());
    case VK_BLEND_FACTOR_SRC_ALPHA:
      return in.src_alpha();
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
      return in.complement(in.src_alpha());
    case VK_BLEND_FACTOR_DST_ALPHA:
      return in.dst_alpha();
    case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
      return in.complement(in.dst_alpha());
    case VK_BLEND_FACTOR_CONSTANT_COLOR:
      return in.constant();
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
      return in.complement(in.constant());
    case VK_BLEND_FACTOR_CONSTANT_ALPHA:
      return in.constant_alpha();
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
      return in.complement(in.constant_alpha());
    case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE:
      return in.saturate();
    default:
      break;
  }
  if constexpr (requires { in.second(); }) {
    switch (factor) {
      case VK_BLEND_FACTOR_SRC1_COLOR:
        return in.second();
      case VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR:
        return in.complement(in.second());
      case VK_BLEND_FACTOR_SRC1_ALPHA:
        return in.second_alpha();
      case VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA:
        return in.complement(in.second_alpha());
      default:
        break;
    }
  }
  return in.zero();
}

using F32 = hn::CappedTag<float, base::kWaveWidth>;
using VF = hn::Vec<F32>;

struct alignas(64) Floats {
  float lane[base::kWaveWidth];
};

/// What blending in binary32 needs of a wave. Destination channels that the format lacks are not read.
struct FloatOperands {
  Floats src[4], dst[4], second[4];
  float constants[4];
  bool has_alpha;  ///< the format stores alpha
  float one;       ///< 1, of which the compiler does not know: it would drop products that quiet signalling NaN
};

/// Sets what does not depend on the wave.
HWY_INLINE void set_constants(const ColorWriter& writer, FloatOperands& in) {
  for (std::size_t c = 0; c < 4; ++c) in.constants[c] = writer.constants[c];
  in.has_alpha = writer.format->rgba[3] >= 0;
  in.one = 1.0f;
  asm volatile("" : "+m"(in.one));
}

/// The operands of channel c in lanes i.., as blend_factor_lanes asks for them.
struct FloatFactors {
  const FloatOperands& in;
  std::size_t c, i;

  HWY_INLINE VF load(const Floats& floats) const { return hn::Load(F32(), floats.lane + i); }
  HWY_INLINE VF zero() const { return hn::Zero(F32()); }
  HWY_INLINE VF one() const { return hn::Set(F32(), in.one); }
  HWY_INLINE VF complement(VF v) const { return x86_sub(one(), v); }
  HWY_INLINE VF src() const { return load(in.src[c]); }
  HWY_INLINE VF src_alpha() const { return load(in.src[3]); }
  HWY_INLINE VF dst() const { return load(in.dst[c]); }
  HWY_INLINE VF dst_alpha() const { return in.has_alpha ? load(in.dst[3]) : one(); }
  HWY_INLINE VF second() const { return load(in.second[c]); }
  HWY_INLINE VF second_alpha() const { return load(in.second[3]); }
  HWY_INLINE VF constant() const { return hn::Set(F32(), in.constants[c]); }
  HWY_INLINE VF constant_alpha() const { return hn::Set(F32(), in.constants[3]); }
  HWY_INLINE VF saturate() const {
    if (c == 3) return one();
    return base::HWY_NAMESPACE::lanes_min_second(src_alpha(), in.has_alpha ? complement(dst_alpha()) : zero());
  }
};

HWY_INLINE VF combine_floats(VkBlendOp op, VF a, VF b) {
  return op == VK_BLEND_OP_ADD ? x86_add(a, b) : op == VK_BLEND_OP_SUBTRACT ? x86_sub(a, b) : x86_sub(b, a);
}

/// E5: factors f and 1 - f in a format of one channel.
HWY_INLINE VF blend_complementary(const BlendEquation& equation, bool at_source, VF src, VF dst,
                                  const FloatFactors& in) {
  const VF factor = blend_factor_lanes(at_source ? equation.src : equation.dst, in);
  if (equation.op == VK_BLEND_OP_ADD) {
    const VF from = at_source ? dst : src, to = at_source ? src : dst;
    return x86_fma(factor, x86_sub(to, from), from);
  }
  const VF product = x86_mul(x86_add(src, dst), factor);
  const bool product_first = (equation.op == VK_BLEND_OP_SUBTRACT) == at_source;
  const VF other = at_source ? dst : src;
  return product_first ? x86_sub(product, other) : x86_sub(other, product);
}

/// blend_channel() of blend.h in binary32.
HWY_INLINE VF blend_floats(const BlendEquation& equation, const BlendShape& shape, const FloatOperands& operands,
                           std::size_t c, std::size_t i) {
  const FloatFactors in{operands, c, i};
  const VF src = in.src(), dst = in.dst(), zero = in.zero();
  const VkBlendOp op = equation.op;
  const bool factors = takes_factors(op);
  if (factors && shape.lerp != BlendShape::Lerp::kNone)
    return blend_complementary(equation, shape.lerp == BlendShape::Lerp::kSource, src, dst, in);
  const VF src_factor = blend_factor_lanes(equation.src, in);
  if (factors && shape.common_factor) {
    const VF combined = combine_floats(op, src, dst);
    return shape.src_one ? combined : shape.src_zero ? zero : x86_mul(combined, src_factor);
  }
  const VF src_term = shape.src_one ? src : shape.src_zero ? zero : x86_mul(src, src_factor);
  const VF dst_term = shape.dst_one ? dst : shape.dst_zero ? zero : x86_mul(dst, blend_factor_lanes(equation.dst, in));
  switch (op) {
    case VK_BLEND_OP_MIN:
      return base::HWY_NAMESPACE::lanes_min_second(src_term, dst_term);
    case VK_BLEND_OP_MAX:
      return base::HWY_NAMESPACE::lanes_max_second(src_term, dst_term);
    case VK_BLEND_OP_ADD:
      return shape.src_zero ? dst_term : shape.dst_zero ? src_term : x86_add(src_term, dst_term);
    case VK_BLEND_OP_SUBTRACT:
      return shape.dst_zero ? src_term : x86_sub(src_term, dst_term);
    default:
      return shape.src_zero ? dst_term : x86_sub(dst_term, src_term);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
