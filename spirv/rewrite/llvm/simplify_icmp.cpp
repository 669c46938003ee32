// Facts about two integers, each of which may decide a comparison: the optimiser does not put facts together.
#include "spirv/rewrite/llvm/simplify_icmp.h"

#include <array>

#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/llvm/constant_range.h"

namespace vitrine::spirv::rewriting {
namespace {

constexpr unsigned kMaxDepth = 3;  ///< of selections that are followed

/// Union of the orders that two integers can have.
using Orders = std::uint8_t;
constexpr Orders kLess = 1, kEqual = 2, kGreater = 4, kAny = 7;

Orders reversed(Orders orders) {
  return static_cast<Orders>((orders & kEqual) | (orders & kLess) << 2 | (orders & kGreater) >> 2);
}

template <class T>
Orders orders_of(T least_a, T largest_a, T least_b, T largest_b) {
  const bool less = least_a<largest_b, greater = largest_a> least_b;
  const bool equal = least_a <= largest_b && least_b <= largest_a;
  return static_cast<Orders>((less ? kLess : 0) | (equal ? kEqual : 0) | (greater ? kGreater : 0));
}

class Analysis {
 public:
  Analysis(const Graph& graph, bool equality) : graph_(graph), equality_(equality) {}

  /// What is known, each for itself: the optimiser does not put facts together.
  std::array<Orders, 3> facts(Src a, Src b, bool is_signed) const {
    if (same(a, b)) return {kEqual, kAny, kAny};
    return {by_range(a, b, is_signed), by_operation(a, b, is_signed, 1), reversed(by_operation(b, a, is_signed, 1))};
  }

 private:
  Orders orders(Src a, Src b, bool is_signed, unsigned depth) const {
    if (same(a, b)) return kEqual;
    Orders result = by_range(a, b, is_signed);
    if (depth == kMaxDepth) return result;
    result &= by_operation(a, b, is_signed, depth + 1);
    return result & reversed(by_operation(b, a, is_signed, depth + 1));
  }

  const Inst* operation(Src src) const { return scalar_operation(graph_, src); }
  bool is_operation(Src src, Op op) const { return scalar_operation(graph_, src, op) != nullptr; }
  Src source(const Inst& inst, std::uint32_t index) const { return graph_.source(inst, index); }
  ConstantRange bits(Src src) const { return range_of_bits(graph_, src); }
  bool is_positive(Src src) const { return bits(src).least_signed >= 0; }
  bool is_nonzero(Src src) const { return bits(src).bits.certain != 0; }
  bool is_divisor(Src src) const { return rewriting::is_nonzero(graph_, src); }

  Orders by_range(Src a, Src b, bool is_signed) const {
    const bool literal = known_literal(graph_, a).has_value() || known_literal(graph_, b).has_value();
    const Asking asking = equality_ ? Asking::kEquality : is_signed ? Asking::kSigned : Asking::kUnsigned;
    const auto range = [&](Src src) { return literal ? constant_range(graph_, src, asking) : bits(src); };
    const ConstantRange x = range(a), y = range(b);
    Orders result = is_signed ? orders_of(x.least_signed, x.largest_signed, y.least_signed, y.largest_signed)
                              : orders_of(x.least, x.largest, y.least, y.largest);
    if (((x.bits.certain & ~y.bits.possible) | (y.bits.certain & ~x.bits.possible)) != 0) result &= kLess | kGreater;
    return result;
  }

  /// What `a` is made of tells about a against b.
  Orders by_operation(Src a, Src b, bool is_signed, unsigned depth) const {
    const Inst* inst = operation(a);
    if (!inst) return kAny;
    const auto operand = [&](std::uint32_t index) { return orders(source(*inst, index), b, is_signed, depth); };
    switch (inst->op) {
      case Op::kMov:
        return operand(0);
      case Op::kSelect:
        return operand(1) | operand(2);
      case Op::kUMin:
      case Op::kUMax:
      case Op::kIMin:
      case Op::kIMax: {
        const bool is_max = inst->op == Op::kUMax || inst->op == Op::kIMax;
        const bool compares_signed = inst->op == Op::kIMin || inst->op == Op::kIMax;
        const Orders inside = orders(source(*inst, 0), source(*inst, 1), compares_signed, depth);
        if ((inside & kLess) == 0) return operand(is_max ? 0 : 1);
        if ((inside & kGreater) == 0) return operand(is_max ? 1 : 0);
        break;
      }
      case Op::kUMod: {
        const std::optional<std::uint32_t> divisor = known_literal(graph_, source(*inst, 1));
        if (divisor && bits(source(*inst, 0)).largest < *divisor) return operand(0);
        break;
      }
      default:
        break;
    }
    // Signed comparisons of what has no sign are unsigned ones.
    const bool as_unsigned = !is_signed || (is_positive(a) && is_positive(b));
    Orders result = kAny;
    for (std::uint32_t index = 0; index < inst->count; ++index)
      if (same(source(*inst, index), b)) result &= against_operand(*inst, index, is_signed, as_unsigned);
    return result;
  }

  /// The operation against its operand `index`.
  Orders against_operand(const Inst& inst, std::uint32_t index, bool is_signed, bool as_unsigned) const {
    constexpr Orders kAtLeast = kEqual | kGreater, kAtMost = kEqual | kLess;
    const Src x = source(inst, index);
    if (inst.op == Op::kINeg) return against_negation(x, is_signed);
    if (inst.op == Op::kNot) return kLess | kGreater;
    if (inst.count != 2) return kAny;
    const Src y = source(inst, 1 - index);
    const std::optional<std::uint32_t> by = known_literal(graph_, y);
    const Orders unless_zero = is_nonzero(y) ? kAny & ~kEqual : kAny;
    switch (inst.op) {
      case Op::kIAdd:
        if (is_signed && is_positive(x) && is_operation(y, Op::kINeg) && is_positive(source(*operation(y), 0)))
          return kAtMost;
        return against_sum(x, y, is_signed);
      case Op::kISub:
        if (index == 0 && by && !is_signed && bits(x).least >= *by) return unless_zero & kAtMost;
        if (index == 0 && by && is_signed) return unless_zero & against_signed_sum(x, -signed_of(*by));
        if (index == 0 && is_signed && is_positive(x) && is_positive(y)) return kAtMost;
        return index == 0 ? unless_zero : kAny;
      case Op::kXor:
        if ((as_unsigned || is_positive(y)) && are_disjoint(x, y)) return kAtLeast;
        if (as_unsigned && contains(x, y)) return kAtMost;
        return unless_zero;
      case Op::kOr:
        return as_unsigned || is_positive(y) ? kAtLeast : kAny;
      case Op::kAnd:
        if (contains(y, x)) return kEqual;
        return as_unsigned ? kAtMost : kAny;
      case Op::kUMin:
        return as_unsigned ? kAtMost : kAny;
      case Op::kUMax:
        // A literal below every number but 0 that x can be stands for that alone.
        return as_unsigned || (by && *by < lowest_bit(bits(x).bits.possible)) ? kAtLeast : kAny;
      case Op::kIMin:
      case Op::kIMax:
        return !is_signed ? kAny : inst.op == Op::kIMin ? kAtMost : kAtLeast;
      case Op::kUMod:
        if (index == 1) return is_divisor(x) && as_unsigned ? kLess : kAny;
        return is_divisor(y) && as_unsigned ? kAtMost : kAny;
      case Op::kIRem:
      case Op::kIMod:  // of what has no sign
        if (!is_positive(x) || !is_positive(y) || !is_divisor(source(inst, 1))) return kAny;
        return index == 1 ? kLess : kAtMost;
      case Op::kIDiv:
        return index == 0 && is_positive(x) && is_positive(y) && is_divisor(y) ? kAtMost : kAny;
      case Op::kUDiv:
      case Op::kUShr:
      case Op::kIShr: {
        if (inst.op == Op::kUDiv && index == 0 && !by && is_divisor(y)) return as_unsigned ? kAtMost : kAny;
        if (index != 0 || !by) return kAny;
        // A shift of a positive number is an unsigned one, which goes together with that of its operand.
        if (inst.op == Op::kIShr && (!is_positive(x) || is_operation(x, Op::kUShr))) return kAny;
        const bool divides = inst.op == Op::kUDiv ? *by > 1 : (*by & 31) != 0;
        if (inst.op == Op::kUDiv && *by == 0) return kAny;
        const Orders smaller = divides && is_nonzero(x) ? kAny & ~kEqual : kAny;
        return smaller & (as_unsigned ? kAtMost : kAny);
      }
      default:
        return kAny;
    }
  }

  static std::uint32_t lowest_bit(std::uint32_t bits) { return bits & (0u - bits); }
  static std::int64_t signed_of(std::uint32_t bits) { return static_cast<std::int32_t>(bits); }

  bool are_disjoint(Src x, Src y) const { return (bits(x).bits.possible & bits(y).bits.possible) == 0; }

  /// All bits that y can have are set in x.
  bool contains(Src x, Src y) const { return (bits(y).bits.possible & ~bits(x).bits.certain) == 0; }

  /// x + y against x. A sum of disjoint bits is their union, of which less is known.
  Orders against_sum(Src x, Src y, bool is_signed) const {
    const ConstantRange a = bits(x), b = bits(y);
    const std::optional<std::uint32_t> by = known_literal(graph_, y);
    const Orders unless_zero = is_nonzero(y) && !are_disjoint(x, y) ? kAny & ~kEqual : kAny;
    if (!is_signed) {
      if (by && signed_of(*by) < 0 && a.least >= 0u - *by) return kLess;
      return unless_zero & ((std::uint64_t{a.largest} + b.largest) >> 32 == 0 ? kEqual | kGreater : kAny);
    }
    if (by) return unless_zero & against_signed_sum(x, signed_of(*by));
    const bool fits = std::int64_t{a.largest_signed} + b.largest_signed <= INT32_MAX;
    return unless_zero & (fits && b.least_signed >= 0 ? kEqual | kGreater : kAny);
  }

  Orders against_signed_sum(Src x, std::int64_t by) const {
    const ConstantRange a = bits(x);
    if (a.least_signed + by < INT32_MIN || a.largest_signed + by > INT32_MAX) return kAny;
    return by < 0 ? kEqual | kLess : kEqual | kGreater;
  }

  /// -x against x.
  Orders against_negation(Src x, bool is_signed) const {
    const ConstantRange a = bits(x);
    Orders result = (a.bits.certain & ~KnownBits::kSign) != 0 ? kAny & ~kEqual : kAny;
    if (is_signed && a.least_signed >= 0) result &= kEqual | kLess;
    if (!is_signed && a.largest <= KnownBits::kSign) result &= kEqual | kGreater;
    return result;
  }

  const Graph& graph_;
  bool equality_;  ///< a comparison for equality asks
};

}  // namespace

int simplify_icmp(const Graph& graph, const Inst& inst) {
  const bool is_signed = inst.op == Op::kILt || inst.op == Op::kIGe;
  const bool equal = inst.op == Op::kIEq || inst.op == Op::kINe;
  if (!is_signed && !equal && inst.op != Op::kULt && inst.op != Op::kUGe) return -1;
  const Src a = graph.source(inst, 0), b = graph.source(inst, 1);
  const Analysis analysis(graph, equal);
  const bool asks_first = inst.op == Op::kIEq || inst.op == Op::kILt || inst.op == Op::kULt;
  const Orders asked = equal ? kEqual : kLess;
  int known = -1;
  const auto add = [&](Orders orders) {
    if (known < 0 && (orders & asked) == 0) known = !asks_first;
    if (known < 0 && (orders & ~asked) == 0) known = asks_first;
  };
  for (const Orders orders : analysis.facts(a, b, is_signed)) add(orders);
  if (equal)
    for (const Orders orders : analysis.facts(a, b, true)) add(orders);
  if (known >= 0) return known;
  const std::optional<std::uint32_t> left = known_literal(graph, a), right = known_literal(graph, b);
  if (left && right && *left == *right) add(kEqual);
  if (equal && ((right && !can_be(graph, a, *right)) || (left && !can_be(graph, b, *left)))) add(kLess | kGreater);
  if (is_signed || equal) return known;
  const std::optional<bool> less = right ? is_below(graph, a, *right) : std::nullopt;
  const std::optional<bool> at_most = left ? is_below(graph, b, *left + 1) : std::nullopt;
  if (less) add(*less ? kLess : kEqual | kGreater);
  if (at_most) add(*at_most ? kEqual | kGreater : kLess);
  return known;
}

}  // namespace vitrine::spirv::rewriting
