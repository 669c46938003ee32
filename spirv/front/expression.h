// A small notation for building ALU expressions: values with their width, operators in the order they are written.
// Scalars next to vectors are repeated. Every operator is one IR instruction; nothing is folded or reordered.
#pragma once

#include "spirv/front/context.h"

namespace vitrine::spirv::front {

struct Expr {
  Translator* t = nullptr;
  ir::ValueId id = ir::kNoValue;
  std::uint32_t size() const { return components(*t, id); }
  ir::Src src() const { return size() == 1 ? splat(id) : whole(id); }
  Expr operator[](std::uint32_t component) const { return {t, extract(*t, id, component)}; }
};

inline Expr apply(ir::Op op, std::initializer_list<Expr> operands) {
  Translator& t = *operands.begin()->t;
  std::uint32_t size = 1;
  std::vector<ir::Src> src;
  for (const Expr& operand : operands) {
    size = std::max(size, operand.size());
    src.push_back(operand.src());
  }
  return {&t, emit(t, op, size, ir::alu_info(op).result == 'B', std::move(src))};
}

inline Expr imm(Translator& t, float value) { return {&t, constant_float(t, value)}; }
inline Expr imm_u32(Translator& t, std::uint32_t value) { return {&t, constant_u32(t, value)}; }

// Operators on floats.
inline Expr operator+(Expr a, Expr b) { return apply(ir::Op::kFAdd, {a, b}); }
inline Expr operator-(Expr a, Expr b) { return apply(ir::Op::kFSub, {a, b}); }
inline Expr operator*(Expr a, Expr b) { return apply(ir::Op::kFMul, {a, b}); }
inline Expr operator/(Expr a, Expr b) { return apply(ir::Op::kFDiv, {a, b}); }
inline Expr operator-(Expr a) { return apply(ir::Op::kFNeg, {a}); }
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
inline Expr select(Expr condition, Expr a, Expr b) { return apply(ir::Op::kSelect, {condition, a, b}); }

// Operators on words.
inline Expr operator&(Expr a, Expr b) { return apply(ir::Op::kAnd, {a, b}); }
inline Expr operator|(Expr a, Expr b) { return apply(ir::Op::kOr, {a, b}); }
inline Expr operator&(Expr a, std::uint32_t b) { return a & imm_u32(*a.t, b); }
inline Expr operator|(Expr a, std::uint32_t b) { return a | imm_u32(*a.t, b); }
inline Expr operator<<(Expr a, std::uint32_t b) { return apply(ir::Op::kShl, {a, imm_u32(*a.t, b)}); }
inline Expr operator>>(Expr a, std::uint32_t b) { return apply(ir::Op::kUShr, {a, imm_u32(*a.t, b)}); }

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
