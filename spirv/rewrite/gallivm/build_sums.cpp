// The reference keeps sums of three and four numbers, which dot products become, as one operation to the end of its
// rules. Its code generator adds in the order of the components (lavapipe-shader-math.md 5.1); what it takes out of a
// vector it does not know, unless all of the vector is literal (lavapipe-optimizer.md 6.5).
#include "base/float_mode.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/nir/constant_expressions.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Adder {
 public:
  explicit Adder(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    const Inst sum = graph_.insts[id];
    if (!computes(sum)) return;
    if (sum.op == Op::kFAddInSum) return add_in_place(id);
    if (sum.op != Op::kFSum2 && sum.op != Op::kFSum3 && sum.op != Op::kFSum4) return;
    Src total = part(sum, 0);
    for (unsigned c = 1; c < operand_components(sum, 0); ++c) total = add(id, sum, total, part(sum, c));
    graph_.replace_uses(sum.result, total.value);
    graph_.remove(id);
  }

 private:
  void add_in_place(InstId id) {
    graph_.insts[id].op = Op::kFAdd;
    graph_.insts[id].opaque = true;
  }

  Src part(const Inst& sum, unsigned c) const {
    const Src src = graph_.source(sum, 0);
    const Inst* vec = graph_.def(src.value);
    Src part = vec && vec->kind == Kind::kVec ? graph_.source(*vec, src.swizzle[c]) : Src{src.value, {src.swizzle[c]}};
    part.swizzle.fill(part.swizzle[0]);
    return part;
  }

  Src add(InstId position, const Inst& like, Src a, Src b) {
    const InstId made = graph_.create(like.kind, Op::kFAdd, 1, false, 2);
    graph_.insts[made].width = like.width;
    graph_.insts[made].exact = like.exact;
    graph_.insts[made].origin = like.origin;
    graph_.insts[made].opaque = true;
    graph_.set_source(made, 0, a);
    graph_.set_source(made, 1, b);
    graph_.insert_before(position, made);
    return folded(made);
  }

  Src folded(InstId id) {
    std::uint32_t words[2] = {};
    std::uint32_t literal[3] = {};
    const Inst& inst = graph_.insts[id];
    for (const std::uint32_t i : {0u, 1u}) {
      const Src src = graph_.source(inst, i);
      const Inst* constant = graph_.constant(src.value);
      if (!constant) return {inst.result, {0, 0, 0, 0}};
      literal[i] = constant->imm[src.swizzle[0]];
    }
    if (inst.kind == Kind::kAlu) {
      evaluate(inst.op, literal, words[0]);
    } else {
      evaluate_sized(graph_, inst, 0, words);
    }
    const InstId made = graph_.create_const(1, false, words);
    graph_.insert_before(id, made);
    graph_.remove(id);
    return {graph_.insts[made].result, {0, 0, 0, 0}};
  }

  Graph& graph_;
};

}  // namespace

void build_sums(Graph& graph) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  Adder adder(graph);
  auto visit = [&](InstId id) { adder.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
