// What mixes of halves consist of: x * (1 + -a) + y * a, or x + a * (y + -x) between literals. The reference decides by
// reading halves as doubles, to which all literals but 0 are alike, and none is 1 or -1 (lavapipe-shader-math.md 5.3;
// lavapipe-optimizer.md 3.8).
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Mixer {
 public:
  explicit Mixer(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    const Inst& mix = graph_.insts[id];
    if (mix.kind != Kind::kSized || mix.op != Op::kFLrp) return;
    id_ = id;
    const Src x = graph_.source(mix, 0), y = graph_.source(mix, 1), weight = graph_.source(mix, 2);
    const bool open = !mix.exact && similar_literals(x, y);
    const Src sum = open ? add(x, multiply(weight, add(y, negate(x))))
                         : add(multiply(x, add(one(), negate(weight))), multiply(y, weight));
    graph_.replace_uses(graph_.insts[id].result, sum.value);
    graph_.remove(id);
  }

 private:
  bool similar_literals(const Src& x, const Src& y) const {
    const Inst *left = graph_.constant(x.value), *right = graph_.constant(y.value);
    if (!left || !right) return false;
    for (unsigned c = 0; c < graph_.insts[id_].components; ++c)
      if ((left->imm[x.swizzle[c]] == 0) != (right->imm[y.swizzle[c]] == 0)) return false;
    return true;
  }

  Builder build() { return {graph_, id_}; }
  Src one() { return build().literal(0x3c00); }
  Src apply(Op op, std::initializer_list<Src> operands) {
    const Inst& mix = graph_.insts[id_];
    return build().like(mix, op, operands, mix.components);
  }

  Src negate(Src a) { return apply(Op::kFNeg, {a}); }
  Src add(Src a, Src b) { return apply(Op::kFAdd, {a, b}); }
  Src multiply(Src a, Src b) { return apply(Op::kFMul, {a, b}); }

  Graph& graph_;
  InstId id_ = kNone;
};

}  // namespace

void lower_flrp(Graph& graph) {
  Mixer mixer(graph);
  auto visit = [&](InstId id) { mixer.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
