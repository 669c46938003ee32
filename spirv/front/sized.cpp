// ALU operations on numbers of 8, 16 and 64 bits, out of operations on 32-bit words (lavapipe-shader-math.md 7 and 8).
//
// Narrow integers lie zero-extended in a word: signed operations extend the sign first, and what may leave the width is
// cut off. 64-bit integers are pairs of words for wide_ops.def. Floats keep their operations until the rewrites have
// seen them (ir::Instr::width).
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

/// The operation computes with floats, or selects between what its instruction calls floats.
bool is_float_op(const Translator& t, Op op) {
  if (op == Op::kSelect)
    return t.inst != nullptr && t.inst->result_type != 0 &&
           number_type(t, t.inst->result_type).kind == Type::Kind::kFloat;
  if (op == Op::kB2F) return true;
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

Expr to_half(const Expr& value) { return with_width(words(Op::kF2Half, {value}), 16); }
Expr from_half(const Expr& value) { return words(Op::kHalf2F, {zero_extended(value)}); }

/// Vector of components that are `low`, of 64 bits with their `high` words.
Expr joined(Translator& t, std::vector<ir::Src> low, std::vector<ir::Src> high, bool boolean) {
  const auto together = [&](std::vector<ir::Src> parts) {
    // One word of a pair is a component of it; vec() joins scalars.
    if (parts.size() == 1) return extract(t, parts[0].value, parts[0].swizzle[0]);
    return vec(t, std::move(parts), boolean);
  };
  Expr result{&t, together(std::move(low))};
  if (high.empty()) return result;
  result.high = together(std::move(high));
  result.width = 64;
  return result;
}

// ---- floats: operations that the rewrites expand

bool has_double(Op op) {
  switch (op) {
    case Op::kFSin:
    case Op::kFCos:
    case Op::kFExp2:
    case Op::kFLog2:
    case Op::kFPow:
    case Op::kFDdx:
    case Op::kFDdy:
      return false;
    default:
      return true;
  }
}

Expr apply_half(Op op, std::span<const Expr> in) {
  Translator& t = *in[0].t;
  std::uint32_t size = 1;
  std::vector<ir::Src> sources;
  for (const Expr& operand : in) {
    size = std::max(size, operand.size());
    sources.push_back(operand.src());
  }
  const bool boolean = ir::alu_info(op).result == 'B';
  Expr result{&t, emit(t, op, size, boolean, std::move(sources), 16)};
  return boolean ? result : with_width(result, 16);
}

/// The words of component `c`, or the boolean or exponent.
ir::Src double_source(const Expr& value, std::uint32_t c, char letter) {
  Translator& t = *value.t;
  const ir::Src src = value.src();
  if (src.swizzle[c] >= components(t, src.value)) throw Failure("operands differ in size");
  const ir::Src low = splat(src.value, src.swizzle[c]);
  if (is_boolean(t, src.value) || letter == 'I') return low;
  if (value.high == ir::kNoValue) throw Failure("operand does not fit its type");
  const auto *words = constant_of(t, src.value), *high = constant_of(t, value.high);
  if (words != nullptr && high != nullptr) {
    const std::uint32_t pair[2] = {(*words)[src.swizzle[c]], (*high)[src.swizzle[c]]};
    return whole(literal(t, pair, false));
  }
  return whole(vec(t, {low, splat(value.high, src.swizzle[c])}, false));
}

Expr apply_double(Op op, std::span<const Expr> in) {
  if (!has_double(op)) throw Failure(std::string(ir::op_name(op)) + " is not supported on 64-bit numbers");
  Translator& t = *in[0].t;
  std::uint32_t size = 1;
  for (const Expr& operand : in) size = std::max(size, operand.size());
  const bool boolean = ir::alu_info(op).result == 'B';
  std::vector<ir::Src> low, high;
  for (std::uint32_t c = 0; c < size; c++) {
    std::vector<ir::Src> sources;
    for (std::size_t i = 0; i < in.size(); i++)
      sources.push_back(double_source(in[i], c, ir::alu_info(op).operands[i]));
    const ir::ValueId value = emit(t, op, boolean ? 1 : 2, boolean, std::move(sources), 64);
    low.push_back(splat(value, 0));
    high.push_back(splat(value, 1));
  }
  return joined(t, std::move(low), boolean ? std::vector<ir::Src>{} : std::move(high), boolean);
}

}  // namespace

Expr constant_bits(Translator& t, std::uint64_t bits, std::uint8_t width) {
  Expr result{&t, constant_u32(t, static_cast<std::uint32_t>(bits))};
  if (width == 64) result.high = constant_u32(t, static_cast<std::uint32_t>(bits >> 32));
  result.width = width;
  return result;
}

Expr vector_of(std::span<const Expr> scalars) {
  if (scalars.empty()) throw Failure("operand does not fit its type");
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
  return joined(t, std::move(low), result_words == 1 ? std::vector<ir::Src>{} : std::move(high), info.result == 'B');
}

Expr apply_sized(Op op, std::span<const Expr> operands, std::uint8_t width) {
  Translator& t = *operands[0].t;
  std::vector<Expr> in(operands.begin(), operands.end());
  for (std::size_t i = 0; i < in.size(); i++) {
    if (is_scaling(op) && i == 1) continue;
    if (in[i].literal != Expr::Literal::kNone) in[i] = literal_at(in[i], width);
    if (!is_boolean(t, in[i].id) && in[i].width != width) throw Failure("operands differ in width");
  }
  if (width == 64) return is_float_op(t, op) ? apply_double(op, in) : apply_64(op, in);
  return is_float_op(t, op) ? apply_half(op, in) : apply_narrow_int(op, in, width);
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

Expr nearest_half(Expr value) {
  const ExactScope exact(*value.t);
  const Expr low = truncate_float(value, 32);
  const Expr cut_off = apply(Op::kFNeu, {convert_float(low, 64), value});
  return to_half(low | words(Op::kB2I, {cut_off}));  // round to odd: no tie that is none
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
