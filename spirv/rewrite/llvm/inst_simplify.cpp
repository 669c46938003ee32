// Literals that only the optimiser of the reference's code generator finds: quotients and comparisons of what is known
// to be smaller than a literal, by the bits that can be set. What follows from them is folded, and operations that such
// a literal leaves nothing to do for are taken away, so that x * 1 keeps a denormal x (lavapipe-optimizer.md 7.3, 7.7).
#include <unordered_set>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/llvm/constant_range.h"
#include "spirv/rewrite/llvm/passes.h"
#include "spirv/rewrite/llvm/simplify_icmp.h"
#include "spirv/rewrite/nir/constant_expressions.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr std::uint32_t kOne = 0x3f800000, kMinusZero = 0x80000000;

class LateFolder {
 public:
  explicit LateFolder(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (inst.kind == Kind::kIf) return take_literals(id);
    if (inst.kind != Kind::kAlu || inst.components != 1 || inst.width != 32 || inst.opaque) return;
    if ((inst.op == Op::kIDiv || inst.op == Op::kUDiv) && is_zero_quotient(inst)) return become(id, 0);
    if (inst.op == Op::kAnd && masks_quotient_by_zero(inst)) return become(id, 0);
    if ((inst.op == Op::kOrB || inst.op == Op::kAndB) && joins_opposites(inst)) return become(id, inst.op == Op::kOrB);
    if (const int known = simplify_icmp(graph_, inst); known >= 0) return become(id, static_cast<std::uint32_t>(known));
    if (inst.op == Op::kFLog2 && log_of_power(id)) return;
    if (folds_alone(inst) && fold(id)) return;
    if (late_.empty() || !reads_late(inst) || fold(id) || keep_literal(id) || take_selected(id)) return;
    take_other(id);
  }

 private:
  std::optional<std::uint32_t> literal(const Inst& inst, std::uint32_t index) const {
    return literal_of(graph_, graph_.source(inst, index));
  }

  bool is(const Inst& inst, std::uint32_t index, std::uint32_t bits) const {
    return is_literal(graph_, graph_.source(inst, index), bits);
  }

  /// A division by zero of signed numbers is 0, too, not that of unsigned ones.
  bool is_zero_quotient(const Inst& inst) const {
    if (inst.op == Op::kIDiv && is(inst, 0, 0)) return true;
    const std::optional<std::uint32_t> divisor = literal(inst, 1);
    if (!divisor) return false;
    const bool negative = inst.op == Op::kIDiv && (*divisor >> 31) != 0;
    const std::uint32_t largest = known_bits(graph_, graph_.source(inst, 0)).possible;
    return largest < (negative ? 0u - *divisor : *divisor) && (inst.op == Op::kUDiv || largest < 0x80000000u);
  }

  /// Bits of a signed quotient by zero, of which at most the sign is set.
  bool masks_quotient_by_zero(const Inst& inst) const {
    for (const std::uint32_t index : {0u, 1u}) {
      const std::optional<std::uint32_t> mask = literal(inst, 1 - index);
      Src dividend;
      if (mask && *mask >> 31 == 0 &&
          match(graph_, graph_.source(inst, index), m_op(Op::kIDiv, m_value(dividend), m_literal(0))))
        return true;
    }
    return false;
  }

  /// x == y beside x != y, of floats; x >= x is x == x.
  bool joins_opposites(const Inst& inst) const {
    const Inst* a = scalar_operation(graph_, graph_.source(inst, 0));
    const Inst* b = scalar_operation(graph_, graph_.source(inst, 1));
    if (!a || !b || a->width != 32 || b->width != 32) return false;
    if (!(is_equality(*a) && b->op == Op::kFNeu) && !(a->op == Op::kFNeu && is_equality(*b))) return false;
    const auto read_same = [&](std::uint32_t i, std::uint32_t j) {
      return same(graph_.source(*a, i), graph_.source(*b, j));
    };
    return (read_same(0, 0) && read_same(1, 1)) || (read_same(0, 1) && read_same(1, 0));
  }

  bool is_equality(const Inst& inst) const {
    return inst.op == Op::kFEq || (inst.op == Op::kFGe && same(graph_.source(inst, 0), graph_.source(inst, 1)));
  }

  /// The results of a branch on such a literal are those of one side; in loops the reference masks them all the same.
  void take_literals(InstId id) {
    const Inst branch = graph_.insts[id];
    const std::optional<std::uint32_t> condition = literal(branch, 0);
    if (!condition || !is_late(branch, 0) || loop_around(graph_, branch.block) != kNone) return;
    const BlockId side = branch.child[*condition != 0 ? 0 : 1];
    if (!ends_in(graph_, side, Op::kYield)) return;
    const std::vector<ValueId> results = graph_.nodes[branch.node]->results;
    for (std::uint32_t i = 0; i < results.size(); ++i) {
      const Src yielded = graph_.source(graph_.insts[graph_.blocks[side].tail], i);
      const Inst* value = graph_.constant(yielded.value);
      if (!value || graph_.values[results[i]].components != 1) continue;
      const std::uint32_t bits = value->imm[yielded.swizzle[0]];
      const Src made = Builder::behind(graph_, id).literal(1, value->boolean, &bits);
      late_.insert(made.value);
      graph_.replace_uses(results[i], made.value);
    }
  }

  bool is_late(const Inst& inst, std::uint32_t index) const {
    return late_.count(graph_.source(inst, index).value) != 0;
  }

  bool reads_late(const Inst& inst) const {
    for (std::uint32_t i = 0; i < inst.count; ++i)
      if (is_late(inst, i)) return true;
    return false;
  }

  void become(InstId id, std::uint32_t bits) {
    const Src made = Builder(graph_, id).literal(1, graph_.insts[id].boolean, &bits);
    late_.insert(made.value);
    replace_inst(graph_, id, made.value);
  }

  /// Becomes operand `result` if the other one is the identity `bits`. True: the operation is gone.
  bool take_if(InstId id, std::uint32_t result, std::uint32_t bits) {
    const Inst inst = graph_.insts[id];
    if (!is(inst, 1 - result, bits) || !is_late(inst, 1 - result)) return false;
    become_operand(id, result);
    return true;
  }

  void become_operand(InstId id, std::uint32_t index) {
    const Inst& inst = graph_.insts[id];
    replace_inst(graph_, id, Builder(graph_, id).move(graph_.source(inst, index), inst.result).value);
  }

  /// A selection by a literal is its operand. True: the operation is gone.
  bool take_selected(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (inst.op != Op::kSelect || !is_late(inst, 0) || !literal(inst, 0)) return false;
    const std::uint32_t index = *literal(inst, 0) != 0 ? 1 : 2;
    if (const std::optional<std::uint32_t> taken = literal(inst, index))
      become(id, *taken);
    else
      become_operand(id, index);
    return true;
  }

  /// Zero, or truth, that stays what it is whatever the other operand is. True: the operation is gone.
  bool keep_literal(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (inst.op == Op::kOrB) {
      const auto is_true = [&](std::uint32_t index) {
        return is_late(inst, index) && literal(inst, index).value_or(0) != 0;
      };
      if (!is_true(0) && !is_true(1)) return false;
      become(id, 1);
      return true;
    }
    const bool first = is(inst, 0, 0) && is_late(inst, 0),
               second = inst.count == 2 && is(inst, 1, 0) && is_late(inst, 1);
    switch (inst.op) {
      case Op::kShl:
      case Op::kIShr:
      case Op::kUShr:
        if (!first) return false;
        break;
      case Op::kAnd:
      case Op::kAndB:
      case Op::kIMul:
        if (!first && !second) return false;
        break;
      default:
        return false;
    }
    become(id, 0);
    return true;
  }

  /// Operations that leave one operand as it is for some other one.
  void take_other(InstId id) {
    std::uint32_t identity = 0;
    bool commutes = true;
    switch (graph_.insts[id].op) {
      case Op::kFAdd:
        identity = kMinusZero;
        break;
      case Op::kFDiv:
        commutes = false;
        [[fallthrough]];
      case Op::kFMul:
        identity = kOne;
        break;
      case Op::kAndB:
        identity = 1;
        break;
      case Op::kIAdd:
      case Op::kOr:
      case Op::kOrB:
      case Op::kXor:
        break;
      default:
        return;
    }
    if (!take_if(id, 0, identity) && commutes) take_if(id, 1, identity);
  }

  /// Operations on literals that the generator leaves to the optimiser: of NaN, of the roots of negative numbers and of
  /// numbers that are no integers it leaves them, too.
  bool folds_alone(const Inst& inst) const {
    if (inst.count != 1 || !literal(inst, 0)) return false;
    const float number = base::float_of(*literal(inst, 0));
    switch (inst.op) {
      case Op::kFSqrt:
      case Op::kFRsq:
        return number >= 0;
      case Op::kFFloor:
      case Op::kFCeil:
      case Op::kFTrunc:
      case Op::kFRoundEven:
      case Op::kFFract:
      case Op::kFAbs:
        return number == number;
      case Op::kF2I:
      case Op::kF2U:
        return number >= 0 && number < 0x1p31f;
      default:
        return false;
    }
  }

  /// The logarithm of a literal power of two, of which the polynomial leaves the exponent. True: it is a literal now.
  bool log_of_power(InstId id) {
    const std::optional<std::uint32_t> bits = literal(graph_.insts[id], 0);
    if (!bits) return false;
    const std::uint32_t exponent = *bits >> 23;
    if ((*bits & 0x7fffff) != 0 || exponent == 0 || exponent >= 255) return false;
    become(id, base::bits_of(static_cast<float>(static_cast<int>(exponent) - 127)));
    return true;
  }

  /// Operations that fold to what they compute, whatever the operands.
  static bool folds(const Inst& inst) {
    switch (inst.op) {
      case Op::kFAdd:
      case Op::kFMul:
      case Op::kFDiv:
      case Op::kFNeg:
      case Op::kFAbs:
      case Op::kI2F:
      case Op::kU2F:
      case Op::kB2F:
        return true;
      case Op::kUDiv:
      case Op::kIRem:
      case Op::kIMod:
      case Op::kUMod:
      case Op::kF2I:
      case Op::kF2U:
        return false;
      default:
        return ir::alu_info(inst.op).result != 'F';
    }
  }

  /// True: it is a literal now.
  bool fold(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (!folds(inst) && !folds_alone(inst)) return false;
    std::uint32_t operand[3] = {}, bits = 0;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const std::optional<std::uint32_t> known = literal(inst, i);
      if (!known) return false;
      operand[i] = *known;
    }
    if (!evaluate(inst.op, operand, bits)) return false;
    become(id, bits);
    return true;
  }

  Graph& graph_;
  std::unordered_set<ValueId> late_;
};

}  // namespace

void inst_simplify(Graph& graph) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  LateFolder folder(graph);
  auto visit = [&](InstId id) { folder.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
