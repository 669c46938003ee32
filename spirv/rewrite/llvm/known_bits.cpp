// Known bits of integers, followed through the operations that make them.
#include "spirv/rewrite/llvm/known_bits.h"

#include <algorithm>
#include <bit>

#include "spirv/rewrite/graph/match.h"

namespace vitrine::spirv::rewriting {
namespace {

constexpr unsigned kMaxDepth = 6;  ///< of operations that are followed

/// All bits up to the highest of these.
std::uint32_t filled(std::uint32_t bits) { return bits == 0 ? 0 : ~0u >> std::countl_zero(bits); }

KnownBits complement(KnownBits a) { return {~a.certain, ~a.possible}; }

/// What holds for either of two values.
KnownBits either(KnownBits a, KnownBits b) { return {a.possible | b.possible, a.certain & b.certain}; }

/// a + b + carry: a bit is known where those of both operands are, and the carry into it is the same in the largest and
/// in the least sum.
KnownBits sum(KnownBits a, KnownBits b, std::uint32_t carry) {
  const std::uint32_t largest = a.possible + b.possible + carry, least = a.certain + b.certain + carry;
  const std::uint32_t may_carry = largest ^ a.possible ^ b.possible, must_carry = least ^ a.certain ^ b.certain;
  const std::uint32_t known = a.known() & b.known() & (~may_carry | must_carry);
  return {largest | ~known, least & known};
}

KnownBits difference(KnownBits a, KnownBits b) { return sum(a, complement(b), 1); }

/// The leading zeros of the largest product, and the trailing bits that follow from trailing bits.
KnownBits product(KnownBits a, KnownBits b) {
  const std::uint64_t largest = std::uint64_t{a.possible} * b.possible;
  const auto shape = [](KnownBits of) {
    const int zeros = std::countr_zero(of.possible), known = std::countr_one(of.known());
    return std::pair(zeros, known - zeros);
  };
  const auto [zeros_a, behind_a] = shape(a);
  const auto [zeros_b, behind_b] = shape(b);
  const int known = std::min(32, zeros_a + zeros_b + std::min(behind_a, behind_b));
  const std::uint32_t below = known == 32 ? ~0u : (1u << known) - 1, bits = a.certain * b.certain & below;
  const std::uint32_t upper = largest >> 32 != 0 ? ~0u : filled(static_cast<std::uint32_t>(largest));
  return {(upper & ~below) | bits, bits};
}

/// `a` where it is known to be at least `least`.
KnownBits at_least(KnownBits a, std::uint32_t least) {
  const int leading = std::countl_one(~a.possible | least);
  return {a.possible, a.certain | (leading == 0 ? 0 : least & ~0u << (32 - leading))};
}

KnownBits larger(KnownBits a, KnownBits b) {
  if (a.certain >= b.possible) return a;
  if (b.certain >= a.possible) return b;
  return either(at_least(a, b.certain), at_least(b, a.certain));
}

KnownBits smaller(KnownBits a, KnownBits b) { return complement(larger(complement(a), complement(b))); }

/// Maps the order of signed numbers to that of unsigned ones, and back.
KnownBits turned(KnownBits a) {
  const std::uint32_t sign = KnownBits::kSign;
  return {(a.possible & ~sign) | (~a.certain & sign), (a.certain & ~sign) | (~a.possible & sign)};
}

class Analysis {
 public:
  explicit Analysis(const Graph& graph) : graph_(graph) {}

  KnownBits of(Src src, unsigned depth) const {
    if (const Inst* constant = graph_.constant(src.value)) {
      const std::uint32_t bits = constant->imm[src.swizzle[0]];
      return constant->boolean ? KnownBits{} : KnownBits{bits, bits};
    }
    const Inst* inst = scalar_operation(graph_, src);
    return inst && depth != kMaxDepth ? of_result(*inst, depth + 1) : KnownBits{};
  }

  bool is_nonzero(Src src, unsigned depth) const {
    if (of(src, depth).certain != 0) return true;
    const Inst* inst = scalar_operation(graph_, src);
    return inst && depth < kMaxDepth && is_nonzero(*inst, depth + 1);
  }

 private:
  /// The operand of an absolute value or a sign has none and is not zero: a bit is set, or it is the sum or the maximum
  /// of a literal and what has no sign.
  bool is_above_zero(const Inst& inst, unsigned depth) const {
    const Src src = graph_.source(inst, 0);
    const KnownBits bits = of(src, depth);
    if (bits.possible >> 31 != 0) return false;
    if (bits.certain != 0) return true;
    const Inst* operand = scalar_operation(graph_, src);
    return operand && (operand->op == Op::kIAdd || operand->op == Op::kUMax) && is_nonzero(*operand, depth + 1);
  }

  /// What is not zero though no bit is known to be set.
  bool is_nonzero(const Inst& inst, unsigned depth) const {
    const auto one = [&](std::uint32_t index) { return is_nonzero(graph_.source(inst, index), depth); };
    const auto has_sign = [&](std::uint32_t index) {
      return of(graph_.source(inst, index), depth).possible >> 31 != 0;
    };
    switch (inst.op) {
      case Op::kUMin:
        return one(0) && one(1);
      case Op::kSelect:
        return one(1) && one(2);
      case Op::kUMax:
      case Op::kOr:
        return one(0) || one(1);
      case Op::kIAdd:
        return !has_sign(0) && !has_sign(1) && (one(0) || one(1));
      case Op::kShl: {
        const std::optional<std::uint32_t> shifted = literal_of(graph_, graph_.source(inst, 0));
        const std::uint32_t furthest = of(graph_.source(inst, 1), depth).possible & 31;
        return shifted && (*shifted & ~0u >> furthest) != 0;
      }
      default:
        return false;
    }
  }

  KnownBits of_result(const Inst& inst, unsigned depth) const {
    const auto source = [&](std::uint32_t index) { return of(graph_.source(inst, index), depth); };
    switch (inst.op) {
      case Op::kMov:
        return source(0);
      case Op::kB2I:
      case Op::kUAddCarry:
      case Op::kUSubBorrow:
        return {1, 0};
      case Op::kNot:
        return complement(source(0));
      case Op::kAnd: {
        const KnownBits a = source(0), b = source(1);
        return {a.possible & b.possible, a.certain & b.certain};
      }
      case Op::kOr: {
        const KnownBits a = source(0), b = source(1);
        return {a.possible | b.possible, a.certain | b.certain};
      }
      case Op::kXor: {
        const KnownBits a = source(0), b = source(1);
        const std::uint32_t known = a.known() & b.known(), bits = (a.certain ^ b.certain) & known;
        return {bits | ~known, bits};
      }
      case Op::kSelect:
        return either(source(1), source(2));
      case Op::kIAbs:
        return is_above_zero(inst, depth) ? source(0) : KnownBits{};
      case Op::kISign:
        return is_above_zero(inst, depth) ? KnownBits{1, 1} : KnownBits{};
      case Op::kIAdd:
        for (const std::uint32_t index : {0u, 1u})  // the optimiser subtracts
          if (const Inst* operand = scalar_operation(graph_, graph_.source(inst, index), Op::kINeg))
            return difference(source(1 - index), of(graph_.source(*operand, 0), depth + 1));
        return sum(source(0), source(1), 0);
      case Op::kISub:
        return difference(source(0), source(1));
      case Op::kINeg:
        return difference({0, 0}, source(0));
      case Op::kIMul:
        return product(source(0), source(1));
      case Op::kUMin:
        return smaller(source(0), source(1));
      case Op::kUMax:
        return larger(source(0), source(1));
      case Op::kIMin:
        return turned(smaller(turned(source(0)), turned(source(1))));
      case Op::kIMax:
        return turned(larger(turned(source(0)), turned(source(1))));
      case Op::kBitCount:
        return {filled(static_cast<std::uint32_t>(std::popcount(source(0).possible))), 0};
      case Op::kUDiv:
      case Op::kIDiv: {
        const KnownBits dividend = source(0), divisor = source(1);
        if (!is_nonzero(graph_.source(inst, 1), depth)) return {};  // a division by zero is ~0
        if (inst.op == Op::kIDiv && (dividend.possible | divisor.possible) >> 31 != 0) return {};
        return {filled(dividend.possible) >> (31 - std::countl_zero(divisor.certain | 1)), 0};
      }
      case Op::kUMod:
      case Op::kIRem:
      case Op::kIMod: {
        if (!is_nonzero(graph_.source(inst, 1), depth)) return {};  // the remainder of a division by zero is ~0
        const std::uint32_t left = filled(source(0).possible), right = filled(source(1).possible);
        if (inst.op != Op::kUMod && (left | right) >> 31 != 0) return {};
        return {std::min(left, right), 0};
      }
      default:
        return of_shift(inst, depth);
    }
  }

  /// What holds for every distance that the other operand can be.
  KnownBits of_shift(const Inst& inst, unsigned depth) const {
    if (inst.op != Op::kShl && inst.op != Op::kUShr && inst.op != Op::kIShr) return {};
    const KnownBits a = of(graph_.source(inst, 0), depth), by = of(graph_.source(inst, 1), depth);
    const auto shifted = [&](std::uint32_t bits, std::uint32_t distance) {
      if (inst.op == Op::kShl) return bits << distance;
      if (inst.op == Op::kUShr) return bits >> distance;
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> distance);
    };
    KnownBits result{0, ~0u};
    const std::uint32_t least = by.certain & 31, largest = by.possible & 31;
    for (std::uint32_t distance = least; distance <= largest; ++distance)
      if (((distance & ~largest) | (least & ~distance)) == 0)
        result = either(result, {shifted(a.possible, distance), shifted(a.certain, distance)});
    return result;
  }

  const Graph& graph_;
};

}  // namespace

KnownBits sum(KnownBits a, std::uint32_t literal) { return sum(a, {literal, literal}, 0); }

KnownBits known_bits(const Graph& graph, Src src) { return Analysis(graph).of(src, 0); }

bool is_nonzero(const Graph& graph, Src src) { return Analysis(graph).is_nonzero(src, 0); }

}  // namespace vitrine::spirv::rewriting
