// Known bits of integers, followed through the operations that make them.
#include "spirv/rewrite/known_bits.h"

#include <algorithm>
#include <bit>

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

 private:
  const std::uint32_t* literal(const Inst& inst, std::uint32_t index) const {
    const Src src = graph_.source(inst, index);
    const Inst* constant = graph_.constant(src.value);
    return constant ? &constant->imm[src.swizzle[0]] : nullptr;
  }

  /// The operand of an absolute value or a sign has none and is not zero: a bit is set, or it is the sum or the maximum
  /// of a literal and what has no sign.
  bool is_above_zero(const Inst& inst, unsigned depth) const {
    const Src src = graph_.source(inst, 0);
    const KnownBits bits = of(src, depth);
    if (bits.possible >> 31 != 0) return false;
    if (bits.certain != 0) return true;
    const Inst* operand = scalar_operation(graph_, src);
    if (!operand || (operand->op != Op::kIAdd && operand->op != Op::kUMax)) return false;
    for (const std::uint32_t index : {0u, 1u}) {
      const std::uint32_t* by = literal(*operand, index);
      if (by && *by != 0 && *by >> 31 == 0 && of(graph_.source(*operand, 1 - index), depth).possible >> 31 == 0)
        return true;
    }
    return false;
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
          if (const Inst* operand = scalar_operation(graph_, graph_.source(inst, index));
              operand && operand->op == Op::kINeg)
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
      case Op::kUDiv: {
        const std::uint32_t* divisor = literal(inst, 1);
        return divisor && *divisor != 0 ? KnownBits{filled(source(0).possible) >> (31 - std::countl_zero(*divisor)), 0}
                                        : KnownBits{};
      }
      case Op::kUMod:
      case Op::kIRem:
      case Op::kIMod: {
        const std::uint32_t* divisor = literal(inst, 1);
        if (!divisor || *divisor == 0) return {};  // the remainder of a division by zero is ~0
        const std::uint32_t left = filled(source(0).possible), right = filled(*divisor);
        if (inst.op != Op::kUMod && (left | right) >> 31 != 0) return {};
        return {std::min(left, right), 0};
      }
      default:
        return of_shift(inst, source(0));
    }
  }

  KnownBits of_shift(const Inst& inst, KnownBits a) const {
    const std::uint32_t* by = inst.count == 2 ? literal(inst, 1) : nullptr;
    const std::uint32_t distance = by ? *by & 31 : 0;
    switch (inst.op) {
      case Op::kShl:
        if (by) return {a.possible << distance, a.certain << distance};
        return {a.possible == 0 ? 0 : ~0u << std::countr_zero(a.possible), 0};
      case Op::kUShr:
        if (by) return {a.possible >> distance, a.certain >> distance};
        return {filled(a.possible), 0};
      case Op::kIShr: {
        const auto shifted = [&](std::uint32_t bits) {
          return static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> distance);
        };
        if (by) return {shifted(a.possible), shifted(a.certain)};
        return {filled(a.possible), a.certain >> 31 != 0 ? a.certain & ~0u << (32 - std::countl_one(a.certain)) : 0};
      }
      default:
        return {};
    }
  }

  const Graph& graph_;
};

}  // namespace

KnownBits sum(KnownBits a, std::uint32_t literal) { return sum(a, {literal, literal}, 0); }

KnownBits known_bits(const Graph& graph, Src src) { return Analysis(graph).of(src, 0); }

}  // namespace vitrine::spirv::rewriting
