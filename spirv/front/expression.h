// A small notation for building ALU expressions: values with their width, operators in the order they are written.
// Scalars next to vectors are repeated. Every operator is one IR instruction on 32-bit numbers, a few on others;
// nothing is folded or reordered.
#pragma once

#include <span>
#include <utility>

#include "spirv/front/context.h"

namespace vitrine::spirv::front {

/// A scalar or vector of numbers of any width, or of booleans. Numbers of 64 bits are two IR values, the low and the
/// high words; those of 8 and 16 bits lie zero-extended in 32-bit components.
struct Expr {
  Translator* t = nullptr;
  ir::ValueId id = ir::kNoValue;
  ir::ValueId high = ir::kNoValue;  ///< width 64: the high words
  std::uint8_t width = 32;          ///< bits of a number
  enum class Literal : std::uint8_t { kNone, kFloat, kInt } literal = Literal::kNone;
  double number = 0;  ///< a literal's value: it takes the width of what it meets
  bool view = false;  ///< a scalar: one component of the vector `id`
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};

  std::uint32_t size() const { return view ? 1 : components(*t, id); }
  ir::Src src() const { return source(id); }
  ir::Src source(ir::ValueId part) const { return !view && size() == 1 ? splat(part) : ir::Src{part, swizzle}; }
  /// Component as a value of its own.
  Expr operator[](std::uint32_t component) const {
    Expr result{t, extract(*t, id, component)};
    if (high != ir::kNoValue) result.high = extract(*t, high, component);
    result.width = width;
    return result;
  }
  /// Component as an operand; `id` stays the vector.
  Expr at(std::uint8_t component) const {
    Expr result = *this;
    result.view = true;
    result.swizzle = {component, component, component, component};
    return result;
  }
  Expr swizzled(std::array<std::uint8_t, 4> order) const {
    Expr result = *this;
    result.swizzle = order;
    return result;
  }
};

/// sized.cpp: `op` on operands of which some number is not 32 bits wide; `width` bits.
Expr apply_sized(ir::Op op, std::span<const Expr> operands, std::uint8_t width);
/// An operation of wide_ops.def, component by component.
Expr apply_wide(ir::Op op, std::span<const Expr> operands);
/// A number of another width: zero-extended or truncated; sign-extended or truncated; rounded.
Expr convert_unsigned(Expr value, std::uint8_t width);
Expr convert_signed(Expr value, std::uint8_t width);
Expr convert_float(Expr value, std::uint8_t width);
/// Rounds towards zero (FPRoundingMode RTZ).
Expr truncate_float(Expr value, std::uint8_t width);
/// binary64 to the nearest binary16, rounded once; convert_float rounds to binary32 on the way, as the reference does.
Expr nearest_half(Expr value);
Expr float_to_int(Expr value, std::uint8_t width, bool is_signed);
Expr int_to_float(Expr value, std::uint8_t width, bool is_signed);
/// Constant of `width` bits.
Expr constant_bits(Translator& t, std::uint64_t bits, std::uint8_t width);
/// Vector of scalars of one width.
Expr vector_of(std::span<const Expr> scalars);

/// The second operand is a number of bits or an exponent, of a width of its own.
inline bool is_scaling(ir::Op op) {
  return op == ir::Op::kShl || op == ir::Op::kIShr || op == ir::Op::kUShr || op == ir::Op::kLdExp;
}

/// Width at which `op` computes.
inline std::uint8_t common_width(ir::Op op, std::span<const Expr> operands) {
  if (is_scaling(op)) return operands[0].width;
  std::uint8_t width = 0;
  for (const Expr& operand : operands)
    if (operand.literal == Expr::Literal::kNone && !is_boolean(*operand.t, operand.id))
      width = std::max(width, operand.width);
  return width == 0 ? std::uint8_t{32} : width;
}

inline Expr apply(ir::Op op, std::span<const Expr> operands) {
  Translator& t = *operands[0].t;
  if (const std::uint8_t width = common_width(op, operands); width != 32) return apply_sized(op, operands, width);
  std::uint32_t size = 1;
  std::vector<ir::Src> src;
  for (const Expr& operand : operands) {
    size = std::max(size, operand.size());
    src.push_back(operand.src());
  }
  return {&t, emit(t, op, size, ir::alu_info(op).result == 'B', std::move(src))};
}
inline Expr apply(ir::Op op, std::initializer_list<Expr> operands) {
  return apply(op, std::span(operands.begin(), operands.size()));
}

inline Expr imm(Translator& t, float value) {
  Expr result{&t, constant_float(t, value)};
  result.literal = Expr::Literal::kFloat;
  result.number = static_cast<double>(value);
  return result;
}
inline Expr imm_u32(Translator& t, std::uint32_t value) {
  Expr result{&t, constant_u32(t, value)};
  result.literal = Expr::Literal::kInt;
  result.number = value;
  return result;
}

// Operators on floats.
inline Expr operator+(Expr a, Expr b) { return apply(ir::Op::kFAdd, {a, b}); }
inline Expr operator-(Expr a, Expr b) { return apply(ir::Op::kFSub, {a, b}); }
inline Expr operator*(Expr a, Expr b) { return apply(ir::Op::kFMul, {a, b}); }
inline Expr operator/(Expr a, Expr b) { return apply(ir::Op::kFDiv, {a, b}); }
inline Expr operator-(Expr a) {
  Expr result = apply(ir::Op::kFNeg, {a});
  result.literal = a.literal;
  result.number = -a.number;
  return result;
}
inline Expr operator<(Expr a, Expr b) { return apply(ir::Op::kFLt, {a, b}); }
inline Expr operator>=(Expr a, Expr b) { return apply(ir::Op::kFGe, {a, b}); }
inline Expr operator+(Expr a, float b) { return a + imm(*a.t, b); }
inline Expr operator*(Expr a, float b) { return a * imm(*a.t, b); }
inline Expr abs(Expr a) { return apply(ir::Op::kFAbs, {a}); }
inline Expr sign(Expr a) { return apply(ir::Op::kFSign, {a}); }
inline Expr sqrt(Expr a) { return apply(ir::Op::kFSqrt, {a}); }
/// a * b + c with two roundings, as the reference's front end writes it: the rewrites split it in their first round.
inline Expr multiply_add(Expr a, Expr b, Expr c) { return apply(ir::Op::kFMulAdd, {a, b, c}); }
inline Expr multiply_add(Expr a, Expr b, float c) { return multiply_add(a, b, imm(*a.t, c)); }
inline Expr multiply_add(Expr a, float b, Expr c) { return multiply_add(a, imm(*a.t, b), c); }
inline Expr multiply_add(Expr a, float b, float c) { return multiply_add(a, imm(*a.t, b), imm(*a.t, c)); }
inline Expr min(Expr a, Expr b) { return apply(ir::Op::kFMin, {a, b}); }
inline Expr max(Expr a, Expr b) { return apply(ir::Op::kFMax, {a, b}); }
inline Expr bool_to_float(Expr a, std::uint8_t width) {
  return width == 32 ? apply(ir::Op::kB2F, {a}) : apply_sized(ir::Op::kB2F, {&a, 1}, width);
}
inline Expr select(Expr condition, Expr a, Expr b) { return apply(ir::Op::kSelect, {condition, a, b}); }

// Operators on words.
inline Expr operator&(Expr a, Expr b) { return apply(ir::Op::kAnd, {a, b}); }
inline Expr operator|(Expr a, Expr b) { return apply(ir::Op::kOr, {a, b}); }
inline Expr operator&(Expr a, std::uint32_t b) { return a & imm_u32(*a.t, b); }
inline Expr operator|(Expr a, std::uint32_t b) { return a | imm_u32(*a.t, b); }
inline Expr operator<<(Expr a, std::uint32_t b) { return apply(ir::Op::kShl, {a, imm_u32(*a.t, b)}); }
inline Expr operator>>(Expr a, std::uint32_t b) { return apply(ir::Op::kUShr, {a, imm_u32(*a.t, b)}); }

/// The row of ops.def for vectors of `size` components, given that for two.
constexpr ir::Op for_size(ir::Op two, std::uint32_t size) {
  return static_cast<ir::Op>(static_cast<std::uint32_t>(two) + size - 2);
}

/// composites.cpp: sum of products, order of section 5.1.
Expr dot(const Expr& a, const Expr& b);

// ---- SPIR-V values as expressions (values.cpp)

/// Value of an id that is one scalar or vector.
Expr number_of(Translator& t, std::uint32_t id);
/// The scalars and vectors that a value consists of.
std::vector<Expr> leaf_numbers(Translator& t, const Value& value);
void set_number(Translator& t, const Inst& inst, const Expr& number);
void set_numbers(Translator& t, const Inst& inst, std::span<const Expr> numbers);

/// Sets the exact flag for the operators in its scope.
class ExactScope {
 public:
  explicit ExactScope(Translator& t) : t_(t), saved_(std::exchange(t.exact, true)) {}
  ~ExactScope() { t_.exact = saved_; }

 private:
  Translator& t_;
  bool saved_;
};

}  // namespace vitrine::spirv::front
