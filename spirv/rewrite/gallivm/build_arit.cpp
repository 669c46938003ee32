// The shortcuts that the reference's code generator takes when an operand is literally 0 or 1, in program order, for
// every operation, `precise` or not: 0 + x is x (also for x = -0), 0 * x and 0 / x are 0, pow(x, 0) skips NaN. What it
// leaves undefined (a division by literal 0) becomes an undefined value here too. Operations on literals become
// literals at once where the generator's own building blocks fold (not those that are calls of intrinsics), so that the
// next operation takes its shortcut too. A sum with -0 is what its optimiser takes away: x, denormal or not. What a
// branch yields is kept in a register and read from there: no operation knows that it is literal
// (lavapipe-optimizer.md section 6).
#include <algorithm>

#include "base/as_reference.h"
#include "base/float_mode.h"
#include "base/numeric.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/literals.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/nir/constant_expressions.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr std::uint32_t kOne = 0x3f800000, kMinusZero = 0x80000000;

/// Which values the reference keeps in registers: all that a branch yields to an If's result. One that is still needed
/// once the result is there has a register of its own.
class SharedRegisters {
 public:
  explicit SharedRegisters(const Graph& graph) : graph_(graph) {}

  bool holds(ValueId value) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next) {
      const Inst& user = graph_.insts[graph_.sources[slot].user];
      if (user.kind != Kind::kIntrinsic || user.op != Op::kYield) continue;
      const InstId owner = graph_.blocks[user.block].owner;
      if (owner != kNone && graph_.insts[owner].kind == Kind::kIf) return true;
    }
    return false;
  }

 private:
  const Graph& graph_;
};

class ArithmeticBuilder {
 public:
  explicit ArithmeticBuilder(Graph& graph)
      : graph_(graph), registers_(graph), truncates_(base::as_reference(base::Deviation::kSignedModulo)) {}

  void visit(InstId id) {
    id_ = id;
    // (This device alone: deviations.md, signed-modulo.)
    if (truncates_ && graph_.insts[id].op == Op::kIMod) graph_.insts[id].op = Op::kIRem;
    const Inst& inst = graph_.insts[id];
    if (inst.kind == Kind::kSized ? inst.width == 16 && inst.components != 1
                                  : inst.kind != Kind::kAlu || inst.components != 1)
      return;
    if (!poison_.empty() && spread_poison()) return;
    if (inst.opaque && !sums_literals(inst)) return;
    if (shorten(inst.op)) return;
    graph_.insts[id_].kind == Kind::kSized ? fold_sized() : fold();
  }

 private:
  bool is_sum(const Inst* inst) const {
    return inst && inst->kind == Kind::kAlu && inst->op == Op::kFAdd && inst->opaque;
  }

  /// The sum of a dot product takes its products out of a vector, which is literal only as a whole.
  bool sums_literals(const Inst& inst) const {
    if (!is_sum(&inst)) return false;
    for (const std::uint32_t i : {0u, 1u})
      if (!graph_.constant(graph_.source(inst, i).value)) return false;
    const Slot use = graph_.values[inst.result].first_use;
    if (use == kNone || graph_.values[inst.result].uses != 1) return true;
    const Inst* next = &graph_.insts[graph_.sources[use].user];
    while (is_sum(next) && graph_.constant(graph_.source(*next, 1).value)) {
      const Slot more = graph_.values[next->result].first_use;
      next =
          more == kNone || graph_.values[next->result].uses != 1 ? nullptr : &graph_.insts[graph_.sources[more].user];
    }
    return !is_sum(next);
  }

  /// (This device alone: FPFastMathMode without NotNaN, NotInf or NSZ.)
  bool is_strict() const { return (graph_.function.strict_specials & graph_.insts[id_].width) != 0; }

  /// True when the operation is gone.
  bool shorten(Op op) {
    const Inst& inst = graph_.insts[id_];
    switch (op) {
      case Op::kFAdd:
        return (!is_strict() && (take_if(1, 0, 0) || take_if(0, 1, 0))) || take_if(0, 1, kMinusZero) ||
               take_if(1, 0, kMinusZero) || undefined_operand();
      case Op::kFMul:
        if (is_strict()) return take_if(1, 0, kOne) || take_if(0, 1, kOne) || undefined_operand();
        return take_if(0, 0, 0) || take_if(1, 0, kOne) || take_if(1, 1, 0) || take_if(0, 1, kOne) ||
               undefined_operand();
      case Op::kFDiv:
        return is_strict() ? take_if(0, 1, kOne) || undefined_operand() : divide();
      case Op::kFRcp:
        if (is_strict() || !is(0, 0)) return undefined_operand();
        become_undefined();
        return true;
      case Op::kFMin:
      case Op::kFMax:
      case Op::kFMinPlain:
      case Op::kFMaxPlain:
        if (undefined_operand()) return true;
        if (!equal_operands(0, 1)) return false;
        replace(graph_.source(inst, 0));
        return true;
      case Op::kSelect:
      case Op::kSelectB:
        if (!equal_operands(1, 2)) return false;
        replace(graph_.source(inst, 1));
        return true;
      case Op::kFNeg:
      case Op::kFAbs:
        return undefined_operand();
      case Op::kFLt:
      case Op::kFGe:
      case Op::kFEq:
      case Op::kFNeu:
        return compare_undefined(op == Op::kFNeu);
      case Op::kFPow:
        if (inst.width != 32 || is_strict() || !is(1, 0)) return false;
        power_of_zero();
        return true;
      default:
        return false;
    }
  }

  static bool folds(Op op) {
    switch (op) {
      case Op::kFAdd:
      case Op::kFMul:
      case Op::kFDiv:
      case Op::kFRcp:
      case Op::kFNeg:
      case Op::kFSign:
      case Op::kFLt:
      case Op::kFGe:
      case Op::kFEq:
      case Op::kFNeu:
      case Op::kMov:
      case Op::kMovB:
      case Op::kSelect:
      case Op::kSelectB:
      case Op::kB2F:
      case Op::kB2I:
      case Op::kI2F:
      case Op::kU2F:
      case Op::kF2Half:
      case Op::kHalf2F:
        return true;
      default:
        return false;
    }
  }

  void become(std::uint32_t bits) { become_words(&bits); }

  void become_words(const std::uint32_t* words) {
    replace(build().literal(graph_.insts[id_].components, graph_.insts[id_].boolean, words));
  }

  void fold_sized() {
    const Inst& inst = graph_.insts[id_];
    std::uint32_t words[2] = {};
    if (folds(inst.op) && evaluate_sized(graph_, inst, 0, words)) become_words(words);
  }

  static bool is_nan(std::uint32_t bits) { return (bits & 0x7fffffffu) > 0x7f800000u; }

  bool is_poison(std::uint32_t index) const {
    const ValueId value = graph_.source(graph_.insts[id_], index).value;
    return std::find(poison_.begin(), poison_.end(), value) != poison_.end();
  }

  void become_poison() {
    const std::uint32_t zero = 0;
    const Src made = build().literal(1, graph_.insts[id_].boolean, &zero);
    poison_.push_back(made.value);
    replace(made);
  }

  /// Whatever is computed from an undefined integer is undefined too; a selection takes its other side. True: the
  /// operation is gone.
  bool spread_poison() {
    const Inst& inst = graph_.insts[id_];
    const bool selects = inst.op == Op::kSelect || inst.op == Op::kSelectB;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      if (!is_poison(i)) continue;
      if (selects && i != 0)
        replace(graph_.source(inst, 3 - i));
      else
        become_poison();
      return true;
    }
    return false;
  }

  /// What the generator's optimiser knows of NaN: arithmetic with it is NaN, its conversion to an integer undefined.
  bool fold_nan() {
    const Inst& inst = graph_.insts[id_];
    const bool arithmetic = inst.op == Op::kFAdd || inst.op == Op::kFMul || inst.op == Op::kFDiv;
    if (!arithmetic && inst.op != Op::kF2I && inst.op != Op::kF2U) return false;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const std::optional<std::uint32_t> literal = literal_of(graph_, graph_.source(inst, i));
      if (!literal || !is_nan(*literal)) continue;
      if (arithmetic)
        become(*literal | 0x00400000u);
      else
        become_poison();
      return true;
    }
    return false;
  }

  void fold() {
    const Inst& inst = graph_.insts[id_];
    if (fold_nan() || !folds(inst.op)) return;
    std::uint32_t operand[3] = {}, bits = 0;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const std::optional<std::uint32_t> literal = literal_of(graph_, graph_.source(inst, i));
      if (!literal) return;
      operand[i] = *literal;
    }
    if (inst.op == Op::kFSign && is_nan(operand[0])) return;
    if (!evaluate(inst.op, operand, bits)) return;
    become(inst.op == Op::kFSign && bits == 0x80000000u ? 0 : bits);
  }

  /// `bits` of binary32: 0, -0 or 1.
  bool is(std::uint32_t index, std::uint32_t bits) const {
    const Inst& inst = graph_.insts[id_];
    const Src src = graph_.source(inst, index);
    const Inst* constant = graph_.constant(src.value);
    if (!constant) return false;
    if (inst.width == 32) return constant->imm[src.swizzle[0]] == bits;
    std::uint32_t words[2];
    literal_words(static_cast<double>(base::float_of(bits)), inst.width, words);
    return constant->imm[src.swizzle[0]] == words[0] && (inst.width == 16 || constant->imm[src.swizzle[1]] == words[1]);
  }

  /// One value, or literals of the same bits.
  bool equal_operands(std::uint32_t i, std::uint32_t j) const {
    const Src a = graph_.source(graph_.insts[id_], i);
    const Src b = graph_.source(graph_.insts[id_], j);
    const unsigned words = operand_components(graph_.insts[id_], i);
    const Inst* x = graph_.constant(a.value);
    const Inst* y = graph_.constant(b.value);
    for (unsigned c = 0; c < words; ++c) {
      const bool same = a.value == b.value && a.swizzle[c] == b.swizzle[c];
      if (!same && !(x && y && x->imm[a.swizzle[c]] == y->imm[b.swizzle[c]])) return false;
    }
    return true;
  }

  Builder build() { return {graph_, id_}; }

  /// A value of one number, which is two words of a double.
  ValueId scalar(Src src) {
    const std::uint8_t words = graph_.insts[id_].components;
    if (graph_.values[src.value].components == words && (words == 1 || (src.swizzle[0] == 0 && src.swizzle[1] == 1)))
      return src.value;
    const Inst* constant = graph_.constant(src.value);
    if (!constant) return build().alu(Op::kMov, {src}, words).value;
    const std::uint32_t bits[2] = {constant->imm[src.swizzle[0]], constant->imm[src.swizzle[1]]};
    return build().literal(words, false, bits).value;
  }

  /// A literal that operations do not see.
  ValueId held(ValueId literal) {
    const Inst& inst = graph_.insts[id_];
    const Src whole = result_of(graph_, graph_.values[literal].def);
    const ValueId made = build().alu(inst.boolean ? Op::kMovB : Op::kMov, {whole}, inst.components).value;
    graph_.insts[graph_.values[made].def].opaque = true;
    return made;
  }

  void replace(Src src) {
    ValueId value = scalar(src);
    if (graph_.constant(value) && registers_.holds(graph_.insts[id_].result)) value = held(value);
    graph_.replace_uses(graph_.insts[id_].result, value);
    graph_.remove(id_);
  }

  /// Becomes operand `result` if operand `index` is the constant `bits`.
  bool take_if(std::uint32_t result, std::uint32_t index, std::uint32_t bits) {
    if (!is(index, bits)) return false;
    replace(graph_.source(graph_.insts[id_], result));
    return true;
  }

  void become_undefined() { replace(build().undefined(graph_.insts[id_].components)); }

  bool has_undefined_operand() const {
    const Inst& inst = graph_.insts[id_];
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const Inst* def = graph_.def(graph_.source(inst, i).value);
      if (def && def->kind == Kind::kIntrinsic && def->op == Op::kUndef) return true;
    }
    return false;
  }

  bool undefined_operand() {
    if (!has_undefined_operand()) return false;
    become_undefined();
    return true;
  }

  /// The optimiser takes an undefined operand of a comparison for NaN.
  bool compare_undefined(bool unordered) {
    if (!has_undefined_operand()) return false;
    const std::uint32_t truth = unordered ? 1 : 0;
    become_words(&truth);
    return true;
  }

  bool divide() {
    if (take_if(0, 0, 0)) return true;
    if (is(0, kOne) && !is(1, 0)) return undefined_operand();
    if (!is(1, 0)) return take_if(0, 1, kOne) || undefined_operand();
    become_undefined();
    return true;
  }

  /// exp2(0) where the base is neither zero nor NaN, else 0 (lavapipe-shader-math.md 6.4). The generator computes
  /// exp2(0): it is no literal.
  void power_of_zero() {
    const Src base = graph_.source(graph_.insts[id_], 0);
    const Src zero = build().literal(0);
    const Src below = build().alu(Op::kFLt, {base, zero}), above = build().alu(Op::kFLt, {zero, base});
    const Src ordered = build().alu(Op::kOrB, {below, above});
    const Src one = build().alu(Op::kFExp2, {zero});
    replace(build().alu(Op::kSelect, {ordered, one, zero}));
  }

  Graph& graph_;
  SharedRegisters registers_;
  bool truncates_;               ///< remainders have the dividend's sign
  std::vector<ValueId> poison_;  ///< literals that stand for undefined integers
  InstId id_ = kNone;
};

}  // namespace

void build_arit(Graph& graph) {
  ArithmeticBuilder builder(graph);
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  auto visit = [&](InstId id) { builder.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
