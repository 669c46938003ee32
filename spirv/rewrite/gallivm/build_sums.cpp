// The reference keeps sums of three and four numbers, which dot products become, as one operation to the end of its
// rules. Its code generator adds in the order of the components (lavapipe-shader-math.md 5.1); what it takes out of a
// vector it does not know, unless all of the vector is literal (lavapipe-optimizer.md 6.5).
#include "base/float_mode.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
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
    replace_inst(graph_, id, total.value);
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
    const InstId made = graph_.values[Builder(graph_, position).like(like, Op::kFAdd, {a, b}).value].def;
    graph_.insts[made].opaque = true;
    return folded(made);
  }

  Src folded(InstId id) {
    std::uint32_t words[2] = {};
    std::uint32_t literal[3] = {};
    const Inst& inst = graph_.insts[id];
    for (const std::uint32_t i : {0u, 1u}) {
      const std::optional<std::uint32_t> known = literal_of(graph_, graph_.source(inst, i));
      if (!known) return result_of(graph_, id);
      literal[i] = *known;
    }
    if (inst.kind == Kind::kAlu) {
      evaluate(inst.op, literal, words[0]);
    } else {
      evaluate_sized(graph_, inst, 0, words);
    }
    const Src made = Builder(graph_, id).literal(words[0]);
    graph_.remove(id);
    return made;
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
