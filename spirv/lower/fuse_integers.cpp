// Superinstructions of integers: rotations, choices between bits, three-operand sums and exclusive ors, products and
// shifted values added. Their bits are those of the separate operations.
#include <algorithm>
#include <optional>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

using ir::Op;

/// Two operations that are one: `outer` of a value that `inner` computes and of another one.
struct Pair {
  Op outer, inner, fused;
  bool other_first;  ///< the fused operation takes the other value first, else last
};
constexpr Pair kPairs[] = {
    {Op::kXor, Op::kRotR, Op::kXorRotR, true},   {Op::kXor, Op::kUShr, Op::kXorShr, true},
    {Op::kXor, Op::kShl, Op::kXorShl, true},     {Op::kIAdd, Op::kShl, Op::kIAddShl, true},
    {Op::kIAdd, Op::kIMul, Op::kIMulAdd, false}, {Op::kIAdd, Op::kIAdd, Op::kIAdd3, false},
    {Op::kXor, Op::kXor, Op::kXor3, false},
};

/// The last operand of `op` is a number of bits: superinstructions take it from the uniform file only.
bool counts_bits(Op op) { return op == Op::kRotR || op == Op::kUShr || op == Op::kShl; }

bool is_disjunction(Op op) { return op == Op::kOr || op == Op::kXor || op == Op::kIAdd; }

class IntegerFuser {
 public:
  explicit IntegerFuser(ScalarFunction& function)
      : f_(function), uses_(count_uses(function)), definition_(function.scalars.size(), kNoIndex) {}

  void run() {
    for (std::uint32_t i = 0; i < f_.body.size(); ++i) {
      const ScalarOp& op = f_.body[i];
      if (op.dead) continue;
      if (op.kind != Kind::kAlu && op.kind != Kind::kIntrinsic) stretch_start_ = i;
      if (op.kind != Kind::kAlu || f_.scalars[result(i)].level != Level::kVarying) continue;
      definition_[result(i)] = i;
      if (is_disjunction(op.op) && !rotate(i) && !choose(i) && !agree(i)) pair(i);
      if (f_.body[i].op == Op::kRotR) rotate_difference(i);
    }
  }

 private:
  ScalarId result(std::uint32_t i) const { return f_.operands[f_.body[i].dst.begin]; }
  ScalarId source(const ScalarOp& op, std::uint32_t k) const { return f_.operands[op.src.begin + k]; }

  /// The operation of this stretch that gives `id`, if it is an `op`.
  const ScalarOp* defined_by(ScalarId id, Op op) const {
    const std::uint32_t at = definition_[id];
    return at != kNoIndex && at >= stretch_start_ && f_.body[at].op == op ? &f_.body[at] : nullptr;
  }
  /// The same if only one operation reads the value.
  const ScalarOp* only_for_one(ScalarId id, Op op) const { return uses_[id] == 1 ? defined_by(id, op) : nullptr; }

  std::optional<std::uint32_t> literal(ScalarId id) const {
    if (f_.scalars[id].level != Level::kConstant) return std::nullopt;
    return f_.scalars[id].bits;
  }

  void replace(std::uint32_t i, Op op, std::initializer_list<ScalarId> sources) {
    for (const ScalarId id : sources) ++uses_[id];
    const Range old = f_.body[i].src;
    f_.body[i].op = op;
    f_.body[i].src = f_.add_operands(std::span(sources.begin(), sources.size()));
    release(old);
  }

  void release(Range sources) {
    for (std::uint32_t k = 0; k < sources.count; ++k) {
      const ScalarId id = f_.operands[sources.begin + k];
      if (--uses_[id] != 0 || definition_[id] == kNoIndex) continue;
      f_.body[definition_[id]].dead = true;
      release(f_.body[definition_[id]].src);
    }
  }

  /// a << n | a >> 32 - n.
  bool rotate(std::uint32_t i) {
    for (const std::uint32_t k : {0u, 1u}) {
      const ScalarOp* left = only_for_one(source(f_.body[i], k), Op::kShl);
      const ScalarOp* right = only_for_one(source(f_.body[i], 1 - k), Op::kUShr);
      if (left == nullptr || right == nullptr || source(*left, 0) != source(*right, 0)) continue;
      const auto by = literal(source(*left, 1)), rest = literal(source(*right, 1));
      if (!by || !rest || *by == 0 || *rest == 0 || *by > 31 || *rest > 31 || *by + *rest != 32) continue;
      replace(i, Op::kRotR, {source(*right, 0), source(*right, 1)});
      return true;
    }
    return false;
  }

  /// (a ^ b) turned right.
  void rotate_difference(std::uint32_t i) {
    const ScalarOp* difference = only_for_one(source(f_.body[i], 0), Op::kXor);
    if (difference == nullptr) return;
    replace(i, Op::kRotRXor, {source(*difference, 0), source(*difference, 1), source(f_.body[i], 1)});
  }

  /// a & b | ~a & c, and c ^ a & (b ^ c).
  bool choose(std::uint32_t i) {
    for (const std::uint32_t k : {0u, 1u}) {
      const ScalarId first = source(f_.body[i], k), second = source(f_.body[i], 1 - k);
      const ScalarOp* both = only_for_one(first, Op::kAnd);
      if (both == nullptr) continue;
      const ScalarOp* other = only_for_one(second, Op::kAnd);
      for (const std::uint32_t m : {0u, 1u}) {
        const ScalarId a = source(*both, m), b = source(*both, 1 - m);
        for (const std::uint32_t n : {0u, 1u}) {
          if (other != nullptr && is_inverse(source(*other, n), a)) {
            replace(i, Op::kBitSelect, {a, b, source(*other, 1 - n)});
            return true;
          }
          const ScalarOp* difference = f_.body[i].op == Op::kXor ? only_for_one(b, Op::kXor) : nullptr;
          if (difference != nullptr && source(*difference, n) == second) {
            replace(i, Op::kBitSelect, {a, source(*difference, 1 - n), second});
            return true;
          }
        }
      }
    }
    return false;
  }
  bool is_inverse(ScalarId id, ScalarId of) const {
    const ScalarOp* inversion = defined_by(id, Op::kNot);
    return inversion != nullptr && source(*inversion, 0) == of;
  }

  /// a & b ^ a & c ^ b & c, and a & (b ^ c) ^ b & c; the exclusive ors may be ors.
  bool agree(std::uint32_t i) {
    const Op joined_by = f_.body[i].op;
    if (joined_by == Op::kIAdd) return false;
    for (const std::uint32_t k : {0u, 1u}) {
      const ScalarOp* last = only_for_one(source(f_.body[i], k), Op::kAnd);
      if (last == nullptr) continue;
      const ScalarId b = source(*last, 0), c = source(*last, 1), rest = source(f_.body[i], 1 - k);
      ScalarId a = kNoScalar;
      if (const ScalarOp* common = only_for_one(rest, Op::kAnd)) {
        for (const std::uint32_t m : {0u, 1u})
          if (joins(source(*common, m), joined_by, b, c)) a = source(*common, 1 - m);
      } else if (const ScalarOp* sum = only_for_one(rest, joined_by)) {
        a = common_factor(*sum, b, c);
      }
      if (a == kNoScalar) continue;
      replace(i, Op::kMajority, {a, b, c});
      return true;
    }
    return false;
  }
  /// `id` is b ^ c, or b | c where all is joined by ors.
  bool joins(ScalarId id, Op joined_by, ScalarId b, ScalarId c) const {
    const ScalarOp* join = only_for_one(id, Op::kXor);
    if (join == nullptr && joined_by == Op::kOr) join = only_for_one(id, Op::kOr);
    return join != nullptr && reads_both(*join, b, c);
  }
  bool reads_both(const ScalarOp& op, ScalarId b, ScalarId c) const {
    return (source(op, 0) == b && source(op, 1) == c) || (source(op, 0) == c && source(op, 1) == b);
  }
  /// The a of a & b and a & c, which `sum` joins.
  ScalarId common_factor(const ScalarOp& sum, ScalarId b, ScalarId c) const {
    const ScalarOp* first = only_for_one(source(sum, 0), Op::kAnd);
    const ScalarOp* second = only_for_one(source(sum, 1), Op::kAnd);
    if (first == nullptr || second == nullptr) return kNoScalar;
    for (const std::uint32_t k : {0u, 1u}) {
      const ScalarId a = source(*first, k);
      if (reads_both(*first, a, b) && reads_both(*second, a, c)) return a;
      if (reads_both(*first, a, c) && reads_both(*second, a, b)) return a;
    }
    return kNoScalar;
  }

  void pair(std::uint32_t i) {
    for (const std::uint32_t k : {1u, 0u}) {
      const ScalarId inner = source(f_.body[i], k), other = source(f_.body[i], 1 - k);
      for (const Pair& pair : kPairs) {
        const ScalarOp* op = f_.body[i].op == pair.outer ? only_for_one(inner, pair.inner) : nullptr;
        if (op == nullptr) continue;
        const ScalarId a = source(*op, 0), b = source(*op, 1);
        if (counts_bits(pair.inner) && f_.scalars[b].level == Level::kVarying) continue;
        if (pair.other_first) {
          replace(i, pair.fused, {other, a, b});
        } else {
          replace(i, pair.fused, {a, b, other});
        }
        return;
      }
    }
  }

  ScalarFunction& f_;
  std::vector<std::uint32_t> uses_, definition_;
  std::uint32_t stretch_start_ = 0;
};

}  // namespace

void fuse_integers(ScalarFunction& function) { IntegerFuser(function).run(); }

}  // namespace vitrine::spirv::lowering
