// Ranges of integers, followed through operations with literals.
#include "spirv/rewrite/llvm/constant_range.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "spirv/rewrite/graph/match.h"

namespace vitrine::spirv::rewriting {
namespace {

constexpr unsigned kMaxDepth = 6;  ///< of operations that are followed

/// Each reading tells something about the other one where the sign is known.
ConstantRange agreed(ConstantRange range) {
  range.least = std::max(range.least, range.bits.certain);
  range.largest = std::min(range.largest, range.bits.possible);
  range.least_signed = std::max(range.least_signed, range.bits.least_signed());
  range.largest_signed = std::min(range.largest_signed, range.bits.largest_signed());
  const auto as_signed = [](std::uint32_t value) { return static_cast<std::int32_t>(value); };
  const auto as_unsigned = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
  if ((range.least ^ range.largest) >> 31 == 0) {
    range.least_signed = std::max(range.least_signed, as_signed(range.least));
    range.largest_signed = std::min(range.largest_signed, as_signed(range.largest));
  }
  if ((range.least_signed < 0) == (range.largest_signed < 0)) {
    range.least = std::max(range.least, as_unsigned(range.least_signed));
    range.largest = std::min(range.largest, as_unsigned(range.largest_signed));
  }
  return range;
}

void bound(ConstantRange& range, std::uint64_t least, std::uint64_t largest) {
  if (largest >> 32 != 0) return;
  range.least = static_cast<std::uint32_t>(least);
  range.largest = static_cast<std::uint32_t>(largest);
}

void bound_signed(ConstantRange& range, std::int64_t least, std::int64_t largest) {
  if (least < INT32_MIN || largest > INT32_MAX) return;
  range.least_signed = static_cast<std::int32_t>(least);
  range.largest_signed = static_cast<std::int32_t>(largest);
}

class Analysis {
 public:
  Analysis(const Graph& graph, Asking asking) : graph_(graph), asking_(asking) {}

  ConstantRange of(Src src, unsigned depth) const {
    ConstantRange range;
    range.bits = known_bits(graph_, src);
    const Inst* inst = operation(src);
    if (inst && depth < kMaxDepth) of_operation(*inst, depth + 1, range);
    return agreed(range);
  }

  /// Whether the integer can be this literal.
  bool can_be(Src src, std::uint32_t literal, unsigned depth) const {
    const ConstantRange range = of(src, depth);
    const auto number = static_cast<std::int32_t>(literal);
    if (((literal & ~range.bits.possible) | (range.bits.certain & ~literal)) != 0) return false;
    if (literal < range.least || literal > range.largest) return false;
    if (number < range.least_signed || number > range.largest_signed) return false;
    const Inst* inst = operation(src);
    return !inst || depth == kMaxDepth || can_give(*inst, literal, depth + 1);
  }

  /// Whether x + literal is below `limit`, if that is known: as a question about the upper bits of x where the limit is
  /// 2^k, and as one that asks whether x + literal - limit is below -limit.
  std::optional<bool> is_below(Src src, std::uint32_t limit) const {
    const Inst* inst = operation(src);
    if (limit == 0 || !inst || !is_used_once(*inst)) return std::nullopt;
    const std::optional<Sum> sum = sum_with_literal(*inst);
    return sum ? is_below(known_bits(graph_, sum->base), sum->offset, limit) : std::nullopt;
  }

  /// The operand where all of its bits are known.
  std::optional<std::uint32_t> literal(Src src) const {
    const KnownBits bits = known_bits(graph_, src);
    return bits.possible == bits.certain ? std::optional(bits.certain) : std::nullopt;
  }

 private:
  const Inst* operation(Src src) const { return scalar_operation(graph_, src); }

  Src source(const Inst& inst, std::uint32_t index) const { return graph_.source(inst, index); }

  /// Sums that something else reads, too, stay; the comparison is not asked of their operands.
  bool is_used_once(const Inst& inst) const { return graph_.values[inst.result].uses == 1; }

  /// What a quotient divides by, where that is a positive literal: whether it equals another one is asked of the
  /// dividend.
  std::optional<std::int64_t> divisor(const Inst& inst) const {
    if (inst.op != Op::kUDiv && inst.op != Op::kIDiv) return std::nullopt;
    const std::optional<std::uint32_t> by = literal(source(inst, 1));
    if (!by || *by == 0 || (inst.op == Op::kIDiv && *by >> 31 != 0)) return std::nullopt;
    return *by;
  }

  /// Whether no number from `first` to `last` is in the range that sums without overflow, extrema and selections have.
  /// `ends`: they reach to the least or to the largest number.
  bool is_outside(Src src, std::int64_t first, std::int64_t last, bool ends, unsigned depth) const {
    const Inst* inst = operation(src);
    if (!inst) return false;
    switch (inst->op) {
      case Op::kIAdd:
      case Op::kUMin:
      case Op::kIMin:
      case Op::kSelect:
        break;
      case Op::kUMax:
      case Op::kIMax:
        if (!ends) return false;
        break;
      default:
        return false;
    }
    const ConstantRange range = of(src, depth);
    return range.largest < first || range.least > last;
  }

  /// Whether a division by `by` can give `bits`: it is a range of the dividend, asked for by its distance to the first
  /// of them, or by one of its ends where the other one is the last number.
  bool can_divide(const Inst& inst, std::int64_t by, std::uint32_t bits, unsigned depth) const {
    const KnownBits dividend = known_bits(graph_, source(inst, 0));
    const bool is_signed = inst.op == Op::kIDiv && dividend.possible >> 31 != 0;
    const std::int64_t quotient = is_signed ? std::int64_t{static_cast<std::int32_t>(bits)} : std::int64_t{bits};
    const std::int64_t product = quotient * by;
    const std::int64_t first = is_signed && quotient <= 0 ? product - by + 1 : product;
    const std::int64_t last = is_signed && quotient < 0 ? product : product + by - 1;
    const std::int64_t least = is_signed ? INT32_MIN : 0, largest = is_signed ? INT32_MAX : UINT32_MAX;
    if (product < least || product > largest) return false;
    const bool ends = first <= least || last >= largest;
    if (!is_signed && (dividend.possible < first || is_outside(source(inst, 0), first, last, ends, depth)))
      return false;
    if (last >= largest) return (is_signed ? dividend.largest_signed() : std::int64_t{dividend.possible}) >= first;
    if (first <= least) return (is_signed ? dividend.least_signed() : std::int64_t{dividend.certain}) <= last;
    const auto count = static_cast<std::uint32_t>(last - first + 1);
    const Inst* def = operation(source(inst, 0));
    const std::optional<Sum> moved = def ? sum_with_literal(*def) : std::nullopt;
    const KnownBits base = moved ? known_bits(graph_, moved->base) : dividend;
    const std::uint32_t distance = (moved ? moved->offset : 0) - static_cast<std::uint32_t>(first);
    return sum(base, distance).certain < count && is_below(base, distance, count).value_or(true);
  }

  /// base + offset.
  struct Sum {
    Src base;
    std::uint32_t offset;
  };

  std::optional<Sum> sum_with_literal(const Inst& inst) const {
    if (inst.op != Op::kIAdd && inst.op != Op::kISub) return std::nullopt;
    if (const std::optional<std::uint32_t> by = literal(source(inst, 1)))
      return Sum{source(inst, 0), inst.op == Op::kISub ? 0u - *by : *by};
    const std::optional<std::uint32_t> by = inst.op == Op::kIAdd ? literal(source(inst, 0)) : std::nullopt;
    return by ? std::optional(Sum{source(inst, 1), *by}) : std::nullopt;
  }

  static std::optional<bool> is_below(KnownBits bits, std::uint32_t by, std::uint32_t limit) {
    const KnownBits moved = sum(bits, by - limit);
    if (moved.certain >= 0u - limit) return true;
    if (moved.possible < 0u - limit) return false;
    const std::uint32_t first = 0u - by, lower = limit - 1;
    if (!std::has_single_bit(limit) || (first & lower) != 0) return std::nullopt;
    return (((bits.certain & ~first) | (first & ~bits.possible)) & ~lower) == 0 ? std::nullopt : std::optional(false);
  }

  void of_operation(const Inst& inst, unsigned depth, ConstantRange& range) const {
    const auto operand = [&](std::uint32_t index) { return of(source(inst, index), depth); };
    switch (inst.op) {
      case Op::kBitCount:
        return bound(range, 0, 32);
      case Op::kSelect: {
        const ConstantRange a = operand(1), b = operand(2);
        bound(range, std::min(a.least, b.least), std::max(a.largest, b.largest));
        return bound_signed(range, std::min(a.least_signed, b.least_signed),
                            std::max(a.largest_signed, b.largest_signed));
      }
      default:
        break;
    }
    if (inst.op == Op::kINeg) {
      const ConstantRange a = operand(0);
      return bound_signed(range, -std::int64_t{a.largest_signed}, -std::int64_t{a.least_signed});
    }
    if (inst.count != 2) return;
    for (const std::uint32_t index : {1u, 0u})
      if (const std::optional<std::uint32_t> by = literal(source(inst, index)))
        return with_literal(inst.op, index, operand(1 - index), *by, range);
  }

  /// `by` is operand `index`, and a is the range of the other one.
  void with_literal(Op op, std::uint32_t index, const ConstantRange& a, std::uint32_t by, ConstantRange& range) const {
    const auto number = std::int64_t{static_cast<std::int32_t>(by)};
    const std::int64_t low = a.least_signed, high = a.largest_signed;
    const std::uint32_t least = std::min(a.least, by), largest = std::max(a.largest, by);
    switch (op) {
      case Op::kUMin:
        return bound(range, asking_ == Asking::kSigned && a.least < by ? 0 : least, std::min(a.largest, by));
      case Op::kUMax:
        return bound(range, std::max(a.least, by), largest);
      case Op::kIMin:
        return bound_signed(range, std::min(low, number), std::min(high, number));
      case Op::kIMax:
        return bound_signed(range, std::max(low, number), std::max(high, number));
      case Op::kIAdd:
        bound(range, std::uint64_t{a.least} + by, std::uint64_t{a.largest} + by);
        return bound_signed(range, low + number, high + number);
      default:
        break;
    }
    if (index == 0) return op == Op::kISub ? bound_signed(range, number - high, number - low) : void();
    switch (op) {
      case Op::kISub:
        return bound_signed(range, low - number, high - number);
      case Op::kIDiv:
        if (number <= 0) return;
        if (asking_ != Asking::kEquality) return bound_signed(range, low / number, high / number);
        if (low < 0) return bound_signed(range, INT32_MIN / number, INT32_MAX / number);
        [[fallthrough]];  // what has no sign is divided as unsigned numbers are
      case Op::kUDiv:
        if (by == 0) return;
        if (asking_ == Asking::kEquality) return bound(range, 0, ~0u / by);
        // What has a sign bit leaves the signed comparison of its quotient a signed one.
        return bound(range, asking_ == Asking::kSigned && a.bits.possible >> 31 != 0 ? 0 : a.least / by,
                     a.largest / by);
      case Op::kUMod:
        return by == 0 ? void() : bound(range, 0, std::min(a.largest, by - 1));
      case Op::kIRem:
      case Op::kIMod: {
        const std::int64_t most = (number < 0 ? -number : number) - 1;
        if (number == 0) return;
        if (op == Op::kIRem) return bound_signed(range, low >= 0 ? 0 : -most, high <= 0 ? 0 : std::min(high, most));
        return bound_signed(range, low >= 0 && number > 0 ? 0 : -most, most);
      }
      case Op::kShl:
        return bound(range, std::uint64_t{a.least} << (by & 31), std::uint64_t{a.largest} << (by & 31));
      case Op::kUShr:
        return bound(range, asking_ == Asking::kEquality ? 0 : a.least >> (by & 31), a.largest >> (by & 31));
      case Op::kIShr:
        return bound_signed(range, low >> (by & 31), high >> (by & 31));
      default:
        return;
    }
  }

  bool can_give(const Inst& inst, std::uint32_t bits, unsigned depth) const {
    const auto one_can = [&](std::uint32_t first, std::uint32_t second) {
      return can_be(source(inst, first), bits, depth) || can_be(source(inst, second), bits, depth);
    };
    switch (inst.op) {
      case Op::kNot:
        return can_be(source(inst, 0), ~bits, depth);
      case Op::kINeg:
        return can_be(source(inst, 0), 0u - bits, depth);
      case Op::kSelect:
        return one_can(1, 2);
      case Op::kUMin:
      case Op::kUMax:
      case Op::kIMin:
      case Op::kIMax:
        return one_can(0, 1);
      default:
        break;
    }
    if (inst.count != 2) return true;
    if (const std::optional<std::int64_t> by = divisor(inst)) return can_divide(inst, *by, bits, depth);
    if (inst.op == Op::kUDiv && bits == 0 && is_nonzero(graph_, source(inst, 1)))
      return known_bits(graph_, source(inst, 0)).certain < known_bits(graph_, source(inst, 1)).possible;
    for (const std::uint32_t index : {0u, 1u}) {
      const std::optional<std::uint32_t> by = literal(source(inst, index));
      if (!by) continue;
      const Src other = source(inst, 1 - index);
      switch (inst.op) {
        case Op::kIAdd:
          return !is_used_once(inst) || can_be(other, bits - *by, depth);
        case Op::kISub:
          return !is_used_once(inst) || can_be(other, index == 1 ? bits + *by : *by - bits, depth);
        case Op::kXor:
          return can_be(other, bits ^ *by, depth);
        case Op::kIMul:
          if (*by == 0 || std::uint64_t{of(other, depth).largest} * *by >> 32 != 0) return true;
          return bits % *by == 0 && can_be(other, bits / *by, depth);
        default:
          return true;
      }
    }
    return true;
  }

  const Graph& graph_;
  Asking asking_;
};

}  // namespace

ConstantRange constant_range(const Graph& graph, Src src, Asking asking) { return Analysis(graph, asking).of(src, 0); }

ConstantRange range_of_bits(const Graph& graph, Src src) { return agreed({known_bits(graph, src)}); }

std::optional<std::uint32_t> known_literal(const Graph& graph, Src src) {
  return Analysis(graph, Asking::kUnsigned).literal(src);
}

bool can_be(const Graph& graph, Src src, std::uint32_t literal) {
  return Analysis(graph, Asking::kEquality).can_be(src, literal, 0);
}

std::optional<bool> is_below(const Graph& graph, Src src, std::uint32_t limit) {
  return Analysis(graph, Asking::kUnsigned).is_below(src, limit);
}

}  // namespace vitrine::spirv::rewriting
