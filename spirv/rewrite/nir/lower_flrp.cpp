// What mixes of halves consist of: x * (1 + -a) + y * a, or x + a * (y + -x) between literals. The reference decides by
// reading halves as doubles, to which all literals but 0 are alike, and none is 1 or -1 (lavapipe-shader-math.md 5.3;
// lavapipe-optimizer.md 3.8).
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

  Src place(InstId made) {
    graph_.insts[made].origin = graph_.insts[id_].origin;
    graph_.insert_before(id_, made);
    return {graph_.insts[made].result, {0, 1, 2, 3}};
  }

  Src one() {
    const std::uint32_t bits = 0x3c00;
    return {place(graph_.create_const(1, false, &bits)).value, {0, 0, 0, 0}};
  }

  Src apply(Op op, std::initializer_list<Src> operands) {
    const InstId made = graph_.create(Kind::kSized, op, graph_.insts[id_].components, false,
                                      static_cast<std::uint32_t>(operands.size()));
    graph_.insts[made].width = 16;
    graph_.insts[made].exact = graph_.insts[id_].exact;
    std::uint32_t index = 0;
    for (const Src& src : operands) graph_.set_source(made, index++, src);
    return place(made);
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
