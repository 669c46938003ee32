// The shortcuts that the reference's code generator takes when an operand is literally 0 or 1, in program order, for
// every operation, `precise` or not: 0 + x is x (also for x = -0), 0 * x and 0 / x are 0, pow(x, 0) skips NaN. What it
// leaves undefined (a division by literal 0) becomes an undefined value here too.
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr std::uint32_t kOne = 0x3f800000;

class Builder {
 public:
  explicit Builder(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    id_ = id;
    const Inst& inst = graph_.insts[id];
    if (inst.kind != Kind::kAlu || inst.components != 1 || inst.opaque) return;  // sums add vectors, not literals
    switch (inst.op) {
      case Op::kFAdd:
        if (!undefined_operand() && !take_if(1, 0, 0)) take_if(0, 1, 0);
        break;
      case Op::kFMul:
        if (!take_if(0, 0, 0) && !take_if(1, 0, kOne) && !take_if(1, 1, 0) && !take_if(0, 1, kOne)) undefined_operand();
        break;
      case Op::kFDiv:
        divide();
        break;
      case Op::kFMin:
      case Op::kFMax:
        if (!undefined_operand() && same_operands()) replace(graph_.source(inst, 0));
        break;
      case Op::kFNeg:
      case Op::kFAbs:
        undefined_operand();
        break;
      case Op::kFPow:
        if (is(1, 0)) power_of_zero();
        break;
      default:
        break;
    }
  }

 private:
  bool is(std::uint32_t index, std::uint32_t bits) const {
    const Src& src = graph_.source(graph_.insts[id_], index);
    const Inst* constant = graph_.constant(src.value);
    return constant && constant->imm[src.swizzle[0]] == bits;
  }

  bool same_operands() const {
    const Src& a = graph_.source(graph_.insts[id_], 0);
    const Src& b = graph_.source(graph_.insts[id_], 1);
    return a.value == b.value && a.swizzle[0] == b.swizzle[0];
  }

  InstId add(Op op, bool boolean, std::initializer_list<Src> operands) {
    const InstId made = graph_.create(Kind::kAlu, op, 1, boolean, static_cast<std::uint32_t>(operands.size()));
    std::uint32_t index = 0;
    for (const Src& src : operands) graph_.set_source(made, index++, src);
    graph_.insts[made].origin = graph_.insts[id_].origin;
    graph_.insert_before(id_, made);
    return made;
  }

  Src value_of(InstId inst) const { return {graph_.insts[inst].result, {0, 0, 0, 0}}; }

  void replace(const Src& src) {
    const ValueId value =
        graph_.values[src.value].components == 1 ? src.value : graph_.insts[add(Op::kMov, false, {src})].result;
    graph_.replace_uses(graph_.insts[id_].result, value);
    graph_.remove(id_);
  }

  /// Becomes operand `result` if operand `index` is the constant `bits`.
  bool take_if(std::uint32_t result, std::uint32_t index, std::uint32_t bits) {
    if (!is(index, bits)) return false;
    replace(graph_.source(graph_.insts[id_], result));
    return true;
  }

  void become_undefined() {
    const InstId made = graph_.create(Kind::kIntrinsic, Op::kUndef, 1, false, 0);
    auto node = std::make_unique<ir::Node>();
    graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
    graph_.insts[made].origin = graph_.insts[id_].origin;
    graph_.nodes.push_back(std::move(node));
    graph_.insert_before(id_, made);
    replace(value_of(made));
  }

  bool undefined_operand() {
    const Inst& inst = graph_.insts[id_];
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const Inst* def = graph_.def(graph_.source(inst, i).value);
      if (!def || def->kind != Kind::kIntrinsic || def->op != Op::kUndef) continue;
      become_undefined();
      return true;
    }
    return false;
  }

  void divide() {
    if (take_if(0, 0, 0)) return;
    if (is(0, kOne)) return;
    if (is(1, 0)) {
      become_undefined();
    } else if (!take_if(0, 1, kOne)) {
      undefined_operand();
    }
  }

  /// exp2(0) where the base is neither zero nor NaN, else 0 (6.4).
  void power_of_zero() {
    const Src base = graph_.source(graph_.insts[id_], 0);
    const std::uint32_t zero_bits = 0;
    const InstId zero = graph_.create_const(1, false, &zero_bits);
    graph_.insert_before(id_, zero);
    const InstId below = add(Op::kFLt, true, {base, value_of(zero)});
    const InstId above = add(Op::kFLt, true, {value_of(zero), base});
    const InstId ordered = add(Op::kOrB, true, {value_of(below), value_of(above)});
    replace(value_of(add(Op::kB2F, false, {value_of(ordered)})));
  }

  Graph& graph_;
  InstId id_ = kNone;
};

}  // namespace

void build_identities(Graph& graph) {
  Builder builder(graph);
  auto visit = [&](InstId id) { builder.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
