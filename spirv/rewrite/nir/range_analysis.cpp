// Range analysis over sign sets: an operation maps every pair of signs its operands may have to the signs its result
// may have; products may always underflow to zero.
#include "spirv/rewrite/nir/range_analysis.h"

#include <cmath>

#include "base/numeric.h"
#include "spirv/rewrite/graph/literals.h"

namespace vitrine::spirv::rewriting {
namespace {

constexpr std::uint8_t kNegative = Range::kNegative, kZero = Range::kZero, kPositive = Range::kPositive,
                       kAny = Range::kAny;

/// Signs of op(x, y) over all signs of x and y.
template <class F>
std::uint8_t combine(std::uint8_t x, std::uint8_t y, F op) {
  std::uint8_t result = 0;
  for (const std::uint8_t a : {kNegative, kZero, kPositive})
    for (const std::uint8_t b : {kNegative, kZero, kPositive})
      if ((x & a) && (y & b)) result = static_cast<std::uint8_t>(result | op(a, b));
  return result;
}

std::uint8_t sum_sign(std::uint8_t a, std::uint8_t b) {
  if (a == kZero) return b;
  if (b == kZero || a == b) return a;
  return kAny;
}

std::uint8_t product_sign(std::uint8_t a, std::uint8_t b) {
  if (a == kZero || b == kZero) return kZero;
  return static_cast<std::uint8_t>(kZero | (a == b ? kPositive : kNegative));
}

std::uint8_t larger_sign(std::uint8_t a, std::uint8_t b) { return a > b ? a : b; }
std::uint8_t smaller_sign(std::uint8_t a, std::uint8_t b) { return a < b ? a : b; }

std::uint8_t negated(std::uint8_t signs) {
  return static_cast<std::uint8_t>((signs & kZero) | (signs & kNegative ? kPositive : 0) |
                                   (signs & kPositive ? kNegative : 0));
}

/// Both operands read the same components of the same value, perhaps one of them `negated`.
bool equal_operands(const Graph& graph, const Inst& inst, bool negated) {
  Src operand[2] = {graph.source(inst, 0), graph.source(inst, 1)};
  bool negative = false;
  for (Src& src : operand) {
    const Inst* def = graph.def(src.value);
    if (!negated || !def || !computes(*def) || def->op != Op::kFNeg) continue;
    const Src inner = graph.source(*def, 0);
    for (unsigned c = 0; c < operand_components(inst, 0); ++c) src.swizzle[c] = inner.swizzle[src.swizzle[c]];
    src.value = inner.value;
    negative = !negative;
  }
  if (operand[0].value != operand[1].value || negative != negated) return false;
  for (unsigned c = 0; c < operand_components(inst, 0); ++c)
    if (operand[0].swizzle[c] != operand[1].swizzle[c]) return false;
  return true;
}

std::uint8_t sign_of(std::uint32_t bits, char type) {
  if (type == 'F') {
    const float v = base::float_of(bits);
    return v == 0.0f ? kZero : v > 0.0f ? kPositive : v < 0.0f ? kNegative : kAny;
  }
  if (bits == 0) return kZero;
  return type == 'I' && static_cast<std::int32_t>(bits) < 0 ? kNegative : kPositive;
}

}  // namespace

Range RangeAnalysis::of_constant(const Inst& user, std::uint32_t index, const Inst& constant, char type) const {
  const bool real = type == 'F';
  Range range{0, real, real, real};
  if (real && user.width != 32) return of_sized_constant(user, index, constant);
  for (unsigned c = 0; c < operand_components(user, index); ++c) {
    const std::uint32_t bits = constant.imm[graph_.source(user, index).swizzle[c]];
    range.signs = static_cast<std::uint8_t>(range.signs | sign_of(bits, type));
    if (!real) continue;
    const float v = base::float_of(bits);
    range.integral &= std::floor(v) == v;
    range.number &= v == v;
    range.finite &= std::isfinite(v);
  }
  return range;
}

Range RangeAnalysis::of_sized_constant(const Inst& user, std::uint32_t index, const Inst& constant) const {
  Range range{0, true, true, true};
  const Src src = graph_.source(user, index);
  for (unsigned c = 0; c < (user.width == 64 ? 1u : operand_components(user, index)); ++c) {
    std::array<std::uint8_t, 4> swizzle = src.swizzle;
    if (user.width != 64) swizzle[0] = src.swizzle[c];
    const double v = literal_number(constant, swizzle, user.width);
    range.signs = static_cast<std::uint8_t>(range.signs | (v == 0.0  ? kZero
                                                           : v > 0.0 ? kPositive
                                                           : v < 0.0 ? kNegative
                                                                     : kAny));
    range.integral &= std::floor(v) == v;
    range.number &= v == v;
    range.finite &= std::isfinite(v);
  }
  return range;
}

Range RangeAnalysis::of_source(const Inst& inst, std::uint32_t index) {
  return of_typed_source(inst, index, ir::alu_info(inst.op).operands[index]);
}

Range RangeAnalysis::of_typed_source(const Inst& inst, std::uint32_t index, char type) {
  const ValueId value = graph_.source(inst, index).value;
  const Inst* def = graph_.def(value);
  if (!def) return {};
  if (def->kind == Inst::Kind::kConst) return of_constant(inst, index, *def, type);
  if (!computes(*def)) return {};
  const bool untyped = def->op == Op::kMov || def->op == Op::kSelect;
  if (!untyped && (ir::alu_info(def->op).result == 'F') != (type == 'F')) return {};
  if (cache_.size() < graph_.values.size()) cache_.resize(graph_.values.size());
  const unsigned slot = type == 'F' ? 0 : type == 'I' ? 1 : 2;
  if (cache_[value].epoch[slot] != epoch_) {
    Range range = of_result(*def, type);
    range.integral |= range.signs == kZero;
    cache_[value].epoch[slot] = epoch_;
    cache_[value].range[slot] = range;
  }
  return cache_[value].range[slot];
}

/// A dot product has a sign where both vectors are the same, or one the negation of the other.
Range RangeAnalysis::of_dot(const Inst& inst) {
  for (const bool negated : {false, true})
    if (equal_operands(graph_, inst, negated))
      return {static_cast<std::uint8_t>(kZero | (negated ? kNegative : kPositive)), false, of_source(inst, 0).number,
              false};
  return {};
}

Range RangeAnalysis::of_converted(const Inst& inst) {
  const Range from = of_source(inst, 0);
  Range range{from.signs, true, true, true};
  if (range.signs == kAny && inst.op == Op::kU2F) range.signs = kZero | kPositive;
  return range;
}

Range RangeAnalysis::of_sum(const Inst& inst) {
  const Range a = of_source(inst, 0), b = of_source(inst, 1);
  return {combine(a.signs, b.signs, sum_sign), a.integral && b.integral, a.number && b.number && (a.finite || b.finite),
          false};
}

Range RangeAnalysis::of_product(const Inst& inst) {
  const Range a = of_source(inst, 0), b = of_source(inst, 1);
  Range range;
  range.integral = a.integral && b.integral;
  if (a.signs != kZero && equal_operands(graph_, inst, false)) {
    range.signs = kZero | kPositive;
  } else if (a.signs != kZero && equal_operands(graph_, inst, true)) {
    range.signs = kZero | kNegative;
  } else {
    range.signs = combine(a.signs, b.signs, product_sign);
  }
  // The reference tests "may be zero" where "cannot be zero" was meant; its answer decides.
  range.number = a.number && b.number &&
                 ((a.finite && b.finite) || ((a.signs & kZero) && b.finite) || (a.finite && (b.signs & kZero)));
  return range;
}

Range RangeAnalysis::of_extremum(const Inst& inst) {
  const Range a = of_source(inst, 0), b = of_source(inst, 1);
  Range range;
  range.integral = a.integral && b.integral;
  range.finite = a.finite && b.finite;
  range.number = a.number || b.number;
  range.signs = combine(a.signs, b.signs, inst.op == Op::kFMax ? larger_sign : smaller_sign);
  // The reference does not combine these: nothing and zero, not zero and zero.
  const auto unknown = [](std::uint8_t signs) { return signs == kAny || signs == (kNegative | kPositive); };
  if ((a.signs == kZero && unknown(b.signs)) || (unknown(a.signs) && b.signs == kZero)) range.signs = kAny;
  if (!a.number) range.signs = static_cast<std::uint8_t>(range.signs | b.signs);
  if (!b.number) range.signs = static_cast<std::uint8_t>(range.signs | a.signs);
  return range;
}

Range RangeAnalysis::of_rounding(const Inst& inst) {
  const Range a = of_source(inst, 0);
  Range range{kAny, true, a.number, a.finite};
  const bool toward_negative = inst.op == Op::kFFloor, toward_positive = inst.op == Op::kFCeil;
  const bool nonpositive = (a.signs & kPositive) == 0, nonnegative = (a.signs & kNegative) == 0;
  if (a.integral) {
    range.signs = a.signs;
  } else if (nonnegative && a.signs != kZero) {
    range.signs = toward_positive ? a.signs : kZero | kPositive;
  } else if (nonpositive && a.signs != kZero) {
    range.signs = toward_negative ? a.signs : kZero | kNegative;
  }
  return range;
}

Range RangeAnalysis::of_power(const Inst& inst) {
  const Range a = of_source(inst, 0), b = of_source(inst, 1);
  const auto not_negative = [](const Range& r) { return (r.signs & kNegative) == 0; };
  Range range{kAny, a.integral && b.integral && not_negative(b), false, false};
  if (b.signs == kZero) {
    range.signs = kPositive;
  } else if (a.signs == kZero && b.signs == kPositive) {
    range.signs = kZero;
  } else if (a.signs == kZero && (b.signs == kNegative || b.signs == (kNegative | kZero))) {
    range.signs = kPositive;
  } else if (not_negative(a)) {
    range.signs = kZero | kPositive;
  }
  return range;
}

Range RangeAnalysis::of_result(const Inst& inst, char type) {
  switch (inst.op) {
    case Op::kMov:
      return of_typed_source(inst, 0, type);
    case Op::kSelect: {
      if (!knows_selections_) return {};
      const Range a = of_typed_source(inst, 1, type), b = of_typed_source(inst, 2, type);
      return {static_cast<std::uint8_t>(a.signs | b.signs), a.integral && b.integral, a.number && b.number,
              a.finite && b.finite};
    }
    case Op::kB2F:
      return {kZero | kPositive, true, true, true};
    case Op::kB2I:
      return {kZero | kPositive, false, true, true};
    case Op::kI2F:
    case Op::kU2F:
      return of_converted(inst);
    case Op::kFAdd:
      return of_sum(inst);
    case Op::kFMul:
      return of_product(inst);
    case Op::kFPow:
      return of_power(inst);
    case Op::kFMin:
    case Op::kFMax:
      return of_extremum(inst);
    case Op::kFFloor:
    case Op::kFCeil:
    case Op::kFTrunc:
      return of_rounding(inst);
    case Op::kFSqrt:
    case Op::kFRsq:
      return {kZero | kPositive, false, false, false};
    case Op::kFDot2:
    case Op::kFDot3:
    case Op::kFDot4:
      return of_dot(inst);
    default:
      return of_float_result(inst);
  }
}

Range RangeAnalysis::of_float_result(const Inst& inst) {
  Range range;
  switch (inst.op) {
    case Op::kFNeg:
      range = of_source(inst, 0);
      range.signs = negated(range.signs);
      return range;
    case Op::kFAbs:
      range = of_source(inst, 0);
      range.signs = static_cast<std::uint8_t>((range.signs & kZero) | (range.signs & ~kZero ? kPositive : 0));
      return range;
    case Op::kFRcp:
      return {of_source(inst, 0).signs, false, false, false};
    case Op::kFSign:
      return {of_source(inst, 0).signs, true, true, true};
    case Op::kFExp2:
      range = of_source(inst, 0);
      return {static_cast<std::uint8_t>(range.signs & kNegative ? kZero | kPositive : kPositive),
              range.integral && (range.signs & kNegative) == 0, false, false};
    default:
      return {};
  }
}

}  // namespace vitrine::spirv::rewriting
