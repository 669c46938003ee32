// ALU operations on numbers of 8, 16 and 64 bits, out of operations on 32-bit words (lavapipe-shader-math.md 7 and 8).
//
// Narrow integers lie zero-extended in a word: signed operations extend the sign first, and what may leave the width is
// cut off. binary16 is computed in binary32 and rounded after every operation, which gives the bits of the operation in
// binary16 (24 >= 2 * 11 + 2). 64-bit numbers are pairs of words for wide_ops.def.
#include <bit>
#include <cmath>

#include "base/numeric.h"
#include "spirv/front/expression.h"

namespace vitrine::spirv::front {
namespace {

using ir::Op;

Expr word(const Expr& value, ir::ValueId id) {
  Expr result = value;
  result.id = id;
  result.high = ir::kNoValue;
  result.width = 32;
  return result;
}
Expr low_word(const Expr& value) { return word(value, value.id); }
Expr high_word(const Expr& value) { return word(value, value.high); }

Expr pair(Expr low, Expr high) {
  low.high = high.id;
  low.width = 64;
  return low;
}

Expr with_width(Expr value, std::uint8_t width) {
  value.width = width;
  return value;
}

Expr words(Op op, std::initializer_list<Expr> operands) { return apply(op, operands); }

bool is_float_op(Op op) {
  const ir::AluInfo& info = ir::alu_info(op);
  return info.operands[0] == 'F' && op != Op::kF2I && op != Op::kF2U;
}

/// What the operation takes its literals for.
Expr literal_at(const Expr& literal, std::uint8_t width) {
  Translator& t = *literal.t;
  if (literal.literal == Expr::Literal::kInt)
    return constant_bits(t, static_cast<std::uint64_t>(literal.number), width);
  if (width == 64) return constant_bits(t, std::bit_cast<std::uint64_t>(literal.number), width);
  return constant_bits(t, base::float_to_half_nearest(static_cast<float>(literal.number)), width);
}

// ---- 64 bits

Op wide_op(Op op) {
  switch (op) {
    case Op::kFAdd:
      return Op::kDAdd;
    case Op::kFMul:
      return Op::kDMul;
    case Op::kFDiv:
      return Op::kDDiv;
    case Op::kFSqrt:
      return Op::kDSqrt;
    case Op::kFFloor:
      return Op::kDFloor;
    case Op::kFCeil:
      return Op::kDCeil;
    case Op::kFTrunc:
      return Op::kDTrunc;
    case Op::kFRoundEven:
      return Op::kDRoundEven;
    case Op::kFMin:
      return Op::kDMin;
    case Op::kFMax:
      return Op::kDMax;
    case Op::kFLt:
      return Op::kDLt;
    case Op::kFGe:
      return Op::kDGe;
    case Op::kFEq:
      return Op::kDEq;
    case Op::kFNeu:
      return Op::kDNeu;
    case Op::kIAdd:
      return Op::kQAdd;
    case Op::kISub:
      return Op::kQSub;
    case Op::kIMul:
      return Op::kQMul;
    case Op::kIMulHigh:
      return Op::kLMulHigh;
    case Op::kUMulHigh:
      return Op::kQMulHigh;
    case Op::kIDiv:
      return Op::kLDiv;
    case Op::kUDiv:
      return Op::kQDiv;
    case Op::kIRem:
      return Op::kLRem;
    case Op::kIMod:
      return Op::kLMod;
    case Op::kUMod:
      return Op::kQMod;
    case Op::kShl:
      return Op::kQShl;
    case Op::kIShr:
      return Op::kLShr;
    case Op::kUShr:
      return Op::kQShr;
    case Op::kILt:
      return Op::kLLt;
    case Op::kIGe:
      return Op::kLGe;
    case Op::kULt:
      return Op::kQLt;
    case Op::kUGe:
      return Op::kQGe;
    default:
      return Op::kCount;
  }
}

Expr zero_wide(Translator& t) { return constant_bits(t, 0, 64); }

/// As many zero words as `like` has components.
Expr zero_words(const Expr& like) {
  const std::uint32_t zeros[4] = {};
  return {like.t, constant(*like.t, {zeros, like.size()})};
}

/// NaN and zeros give +0.
Expr sign_wide(Expr a) {
  Translator& t = *a.t;
  const Expr zero = zero_wide(t);
  const Expr below = apply(Op::kFLt, {a, zero}), above = apply(Op::kFLt, {zero, a});
  const Expr magnitude = select(above, imm_u32(t, 0x3ff00000), imm_u32(t, 0));
  const Expr high = select(below, imm_u32(t, 0xbff00000), magnitude);
  return pair(zero_words(high), high);
}

Expr apply_64(Op op, std::span<const Expr> in) {
  Translator& t = *in[0].t;
  const Expr& a = in[0];
  if (const Op wide = wide_op(op); wide != Op::kCount) return apply_wide(wide, in);
  switch (op) {
    case Op::kMov:
    case Op::kNot:
      return pair(words(op, {low_word(a)}), words(op, {high_word(a)}));
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
      return pair(words(op, {low_word(a), low_word(in[1])}), words(op, {high_word(a), high_word(in[1])}));
    case Op::kSelect:
      return pair(words(op, {a, low_word(in[1]), low_word(in[2])}), words(op, {a, high_word(in[1]), high_word(in[2])}));
    case Op::kIEq:
    case Op::kINe:
      return words(op == Op::kIEq ? Op::kAndB : Op::kOrB,
                   {words(op, {low_word(a), low_word(in[1])}), words(op, {high_word(a), high_word(in[1])})});
    case Op::kFNeg:
      return pair(words(Op::kMov, {low_word(a)}), words(Op::kXor, {high_word(a), imm_u32(t, 0x80000000)}));
    case Op::kFAbs:
      return pair(words(Op::kMov, {low_word(a)}), words(Op::kAnd, {high_word(a), imm_u32(t, 0x7fffffff)}));
    case Op::kFSub:
      return a + -in[1];
    case Op::kFRcp:
      return constant_bits(t, std::bit_cast<std::uint64_t>(1.0), 64) / a;
    case Op::kFRsq:
      return constant_bits(t, std::bit_cast<std::uint64_t>(1.0), 64) / sqrt(a);
    case Op::kFFract:
      return a - apply(Op::kFFloor, {a});
    case Op::kFSign:
      return sign_wide(a);
    case Op::kFMulAdd:
      return a * in[1] + in[2];
    case Op::kINeg:
      return apply(Op::kISub, {zero_wide(t), a});
    case Op::kIAbs:
      return select(apply(Op::kILt, {a, zero_wide(t)}), apply(Op::kINeg, {a}), a);
    case Op::kISign: {
      const Expr negative = apply(Op::kIShr, {a, imm_u32(t, 63)});
      const Expr nonzero = apply(Op::kINe, {a, zero_wide(t)});
      return apply(Op::kOr, {negative, convert_unsigned(words(Op::kB2I, {nonzero}), 64)});
    }
    case Op::kIMin:
      return select(apply(Op::kILt, {a, in[1]}), a, in[1]);
    case Op::kIMax:
      return select(apply(Op::kILt, {a, in[1]}), in[1], a);
    case Op::kUMin:
      return select(apply(Op::kULt, {a, in[1]}), a, in[1]);
    case Op::kUMax:
      return select(apply(Op::kULt, {a, in[1]}), in[1], a);
    case Op::kUAddCarry:
      return convert_unsigned(words(Op::kB2I, {apply(Op::kULt, {apply(Op::kIAdd, {a, in[1]}), a})}), 64);
    case Op::kUSubBorrow:
      return convert_unsigned(words(Op::kB2I, {apply(Op::kULt, {a, in[1]})}), 64);
    case Op::kB2F:
    case Op::kB2I:
      break;
    default:
      break;
  }
  throw Failure(std::string(ir::op_name(op)) + " is not supported on 64-bit numbers");
}

// ---- 8 and 16 bits

std::uint32_t mask_of(std::uint8_t width) { return (1u << width) - 1; }

/// The low bits of a word as a narrow number.
Expr cut(const Expr& value, std::uint8_t width) {
  return with_width(words(Op::kAnd, {value, imm_u32(*value.t, mask_of(width))}), width);
}

Expr zero_extended(const Expr& value) { return with_width(value, 32); }

Expr sign_extended(const Expr& value) {
  Translator& t = *value.t;
  const Expr shift = imm_u32(t, 32u - value.width);
  return words(Op::kIShr, {words(Op::kShl, {zero_extended(value), shift}), shift});
}

Expr shift_count(const Expr& count, std::uint8_t width) {
  return words(Op::kAnd, {low_word(count), imm_u32(*count.t, width - 1u)});
}

Expr apply_narrow_int(Op op, std::span<const Expr> in, std::uint8_t width) {
  Translator& t = *in[0].t;
  const auto unsigned_words = [&](Op as) {
    std::vector<Expr> operands;
    for (const Expr& operand : in) operands.push_back(zero_extended(operand));
    return front::apply(as, operands);
  };
  const auto signed_words = [&](Op as) {
    std::vector<Expr> operands;
    for (const Expr& operand : in) operands.push_back(sign_extended(operand));
    return front::apply(as, operands);
  };
  switch (op) {
    case Op::kMov:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kUMin:
    case Op::kUMax:
      return with_width(unsigned_words(op), width);
    case Op::kSelect:
      return with_width(words(op, {in[0], zero_extended(in[1]), zero_extended(in[2])}), width);
    case Op::kIAdd:
    case Op::kISub:
    case Op::kIMul:
    case Op::kINeg:
    case Op::kNot:
    case Op::kUDiv:
    case Op::kUMod:
      return cut(unsigned_words(op), width);
    case Op::kIDiv:
    case Op::kIRem:
    case Op::kIMod:
    case Op::kIMin:
    case Op::kIMax:
    case Op::kIAbs:
    case Op::kISign:
      return cut(signed_words(op), width);
    case Op::kShl:
      return cut(words(op, {zero_extended(in[0]), shift_count(in[1], width)}), width);
    case Op::kUShr:
      return with_width(words(op, {zero_extended(in[0]), shift_count(in[1], width)}), width);
    case Op::kIShr:
      return cut(words(op, {sign_extended(in[0]), shift_count(in[1], width)}), width);
    case Op::kIEq:
    case Op::kINe:
    case Op::kULt:
    case Op::kUGe:
    case Op::kBitCount:
    case Op::kFindLsb:
    case Op::kUFindMsb:
      return unsigned_words(op);
    case Op::kILt:
    case Op::kIGe:
    case Op::kIFindMsb:
      return signed_words(op);
    case Op::kBitReverse:
      return with_width(words(Op::kUShr, {unsigned_words(op), imm_u32(t, 32u - width)}), width);
    case Op::kUMulHigh:
      return with_width(words(Op::kUShr, {unsigned_words(Op::kIMul), imm_u32(t, width)}), width);
    case Op::kIMulHigh:
      return cut(words(Op::kIShr, {signed_words(Op::kIMul), imm_u32(t, width)}), width);
    case Op::kUAddCarry:
      return with_width(words(Op::kUShr, {unsigned_words(Op::kIAdd), imm_u32(t, width)}), width);
    case Op::kUSubBorrow:
      return with_width(unsigned_words(op), width);
    default:
      throw Failure(std::string(ir::op_name(op)) + " is not supported on narrow numbers");
  }
}

Expr is_nan_half(const Expr& a) {
  Translator& t = *a.t;
  return words(Op::kULt, {imm_u32(t, 0x7c00), words(Op::kAnd, {zero_extended(a), imm_u32(t, 0x7fff)})});
}

Expr to_half(const Expr& value) { return with_width(words(Op::kF2Half, {value}), 16); }
Expr from_half(const Expr& value) { return words(Op::kHalf2F, {zero_extended(value)}); }

/// a < b (min) or a > b (max) or only b is NaN: a, else b. The reference has no instruction for binary16, and chooses
/// otherwise than for binary32 when both are NaN.
Expr min_max_half(Op op, const Expr& a, const Expr& b) {
  const Expr wins = op == Op::kFMin ? apply(Op::kFLt, {a, b}) : apply(Op::kFLt, {b, a});
  const Expr only_b = words(Op::kAndB, {is_nan_half(b), words(Op::kNotB, {is_nan_half(a)})});
  return select(words(Op::kOrB, {wins, only_b}), a, b);
}

/// The reference calls the C library for these.
Expr library_half(Op op, const Expr& a) {
  const Expr single = from_half(a);
  return to_half(apply_wide(op, {&single, 1}));
}

Expr apply_half(Op op, std::span<const Expr> in) {
  Translator& t = *in[0].t;
  const Expr& a = in[0];
  const auto bits = [&](Op as, std::uint32_t constant) {
    return with_width(words(as, {zero_extended(a), imm_u32(t, constant)}), 16);
  };
  switch (op) {
    case Op::kFNeg:
      return bits(Op::kXor, 0x8000);
    case Op::kFAbs:
      return bits(Op::kAnd, 0x7fff);
    case Op::kFSign: {
      const Expr magnitude = words(Op::kAnd, {zero_extended(a), imm_u32(t, 0x7fff)});
      const Expr number = words(Op::kULt, {words(Op::kISub, {magnitude, imm_u32(t, 1)}), imm_u32(t, 0x7c00)});
      const Expr one = words(Op::kOr, {words(Op::kAnd, {zero_extended(a), imm_u32(t, 0x8000)}), imm_u32(t, 0x3c00)});
      return with_width(select(number, one, imm_u32(t, 0)), 16);
    }
    case Op::kFMin:
    case Op::kFMax:
      return min_max_half(op, a, in[1]);
    case Op::kFSub:
      return a + -in[1];
    case Op::kFFract:
      return a - apply(Op::kFFloor, {a});
    case Op::kFRsq:
      return apply(Op::kFRcp, {sqrt(a)});
    case Op::kFSin:
      return library_half(Op::kHSin, a);
    case Op::kFCos:
      return library_half(Op::kHCos, a);
    case Op::kFExp2:
      return library_half(Op::kHExp2, a);
    case Op::kFLog2:
      return library_half(Op::kHLog2, a);
    case Op::kFMulAdd:
      return a * in[1] + in[2];
    case Op::kFPow: {
      const Expr zero = constant_bits(t, 0, 16);
      const Expr power = apply(Op::kFExp2, {apply(Op::kFLog2, {a}) * in[1]});
      return select(words(Op::kOrB, {apply(Op::kFEq, {a, zero}), is_nan_half(a)}), zero, power);
    }
    default:
      break;
  }
  std::vector<Expr> operands;
  for (const Expr& operand : in) operands.push_back(from_half(operand));
  const bool saved = std::exchange(t.opaque, true);
  const Expr result = front::apply(op, operands);
  t.opaque = saved;
  return ir::alu_info(op).result == 'B' ? result : to_half(result);
}

}  // namespace

Expr constant_bits(Translator& t, std::uint64_t bits, std::uint8_t width) {
  Expr result{&t, constant_u32(t, static_cast<std::uint32_t>(bits))};
  if (width == 64) result.high = constant_u32(t, static_cast<std::uint32_t>(bits >> 32));
  result.width = width;
  return result;
}

Expr vector_of(std::span<const Expr> scalars) {
  const Expr& first = scalars[0];
  Translator& t = *first.t;
  std::vector<ir::Src> low, high;
  for (const Expr& scalar : scalars) {
    low.push_back(scalar.src());
    if (first.high != ir::kNoValue) high.push_back(scalar.source(scalar.high));
  }
  const bool boolean = is_boolean(t, first.id);
  Expr result{&t, vec(t, std::move(low), boolean)};
  result.width = first.width;
  if (first.high != ir::kNoValue) result.high = vec(t, std::move(high), boolean);
  return result;
}

Expr apply_wide(Op op, std::span<const Expr> operands) {
  Translator& t = *operands[0].t;
  const ir::WideInfo& info = ir::wide_info(op);
  const std::uint32_t result_words = ir::wide_words(info.result);
  std::uint32_t size = 1;
  for (std::size_t i = 0; i < operands.size(); i++) {
    const bool wide = ir::wide_words(info.operands[i]) == 2;
    if (is_boolean(t, operands[i].id) || (wide && operands[i].high == ir::kNoValue))
      throw Failure("operand does not fit its type");
    size = std::max(size, operands[i].size());
  }
  std::vector<ir::Src> low, high;
  for (std::uint32_t c = 0; c < size; c++) {
    std::vector<ir::Src> sources;
    for (std::size_t i = 0; i < operands.size(); i++) {
      const ir::Src src = operands[i].src();
      if (src.swizzle[c] >= components(t, src.value)) throw Failure("operands differ in size");
      sources.push_back(splat(src.value, src.swizzle[c]));
      if (ir::wide_words(info.operands[i]) == 2) sources.push_back(splat(operands[i].high, src.swizzle[c]));
    }
    const ir::ValueId value = emit(t, op, result_words, info.result == 'B', std::move(sources));
    low.push_back(splat(value, 0));
    high.push_back(splat(value, 1));
  }
  Expr result{&t, ir::kNoValue};
  const auto joined = [&](std::vector<ir::Src> parts) {
    // One word of a pair is a component of it; vec() joins scalars.
    if (parts.size() == 1) return extract(t, parts[0].value, parts[0].swizzle[0]);
    return vec(t, std::move(parts), info.result == 'B');
  };
  result.id = joined(std::move(low));
  if (result_words == 1) return result;
  result.high = joined(std::move(high));
  result.width = 64;
  return result;
}

Expr apply_sized(Op op, std::span<const Expr> operands, std::uint8_t width) {
  Translator& t = *operands[0].t;
  const bool is_shift = op == Op::kShl || op == Op::kIShr || op == Op::kUShr;
  std::vector<Expr> in(operands.begin(), operands.end());
  for (std::size_t i = 0; i < in.size(); i++) {
    if (is_shift && i == 1) continue;
    if (in[i].literal != Expr::Literal::kNone) in[i] = literal_at(in[i], width);
    if (!is_boolean(t, in[i].id) && in[i].width != width) throw Failure("operands differ in width");
  }
  if (width == 64) return apply_64(op, in);
  return is_float_op(op) ? apply_half(op, in) : apply_narrow_int(op, in, width);
}

// ---- conversions (lavapipe-shader-math.md 7.1)

Expr convert_unsigned(Expr value, std::uint8_t width) {
  if (width == value.width) return value;
  if (width < value.width && width < 32) return cut(low_word(value), width);
  if (width < 64) return with_width(low_word(value), width);
  return pair(zero_extended(value), zero_words(value));
}

Expr convert_signed(Expr value, std::uint8_t width) {
  Translator& t = *value.t;
  if (width <= value.width) return convert_unsigned(value, width);
  const Expr low = value.width < 32 ? sign_extended(value) : value;
  if (width == 32) return low;
  if (width < 32) return cut(low, width);
  return pair(low, words(Op::kIShr, {low, imm_u32(t, 31)}));
}

Expr convert_float(Expr value, std::uint8_t width) {
  if (width == value.width) return value;
  if (width == 16) return to_half(convert_float(value, 32));
  if (width == 32) return value.width == 16 ? from_half(value) : apply_wide(Op::kFFromD, {&value, 1});
  const Expr single = convert_float(value, 32);
  return apply_wide(Op::kDFromF, {&single, 1});
}

Expr truncate_float(Expr value, std::uint8_t width) {
  if (width == 16 && value.width == 64) value = truncate_float(value, 32);
  const Expr rounded = convert_float(value, width);
  if (width >= value.width) return rounded;
  const Expr grown = apply(Op::kFLt, {abs(value), abs(convert_float(rounded, value.width))});
  const Expr step = with_width(words(Op::kB2I, {grown}), width);  // one less in the last place is nearer to zero
  return apply(Op::kISub, {rounded, step});
}

Expr float_to_int(Expr value, std::uint8_t width, bool is_signed) {
  if (value.width == 16) value = from_half(value);
  const bool is_double = value.width == 64;
  if (width == 64) {
    const Op op = is_double ? (is_signed ? Op::kLFromD : Op::kQFromD) : (is_signed ? Op::kLFromF : Op::kQFromF);
    return apply_wide(op, {&value, 1});
  }
  // Narrow integers come from 32-bit signed ones, of either signedness.
  const bool as_signed = is_signed || width < 32;
  const Expr whole = is_double ? apply_wide(as_signed ? Op::kIFromD : Op::kUFromD, {&value, 1})
                               : words(as_signed ? Op::kF2I : Op::kF2U, {value});
  return width < 32 ? cut(whole, width) : whole;
}

Expr int_to_float(Expr value, std::uint8_t width, bool is_signed) {
  if (value.width < 32) value = is_signed ? sign_extended(value) : zero_extended(value);
  const bool from_wide = value.width == 64;
  if (width == 64) {
    const Op op = from_wide ? (is_signed ? Op::kDFromL : Op::kDFromQ) : (is_signed ? Op::kDFromI : Op::kDFromU);
    return apply_wide(op, {&value, 1});
  }
  const Expr single = from_wide ? apply_wide(is_signed ? Op::kFFromL : Op::kFFromQ, {&value, 1})
                                : words(is_signed ? Op::kI2F : Op::kU2F, {value});
  return width == 16 ? to_half(single) : single;
}

}  // namespace vitrine::spirv::front
