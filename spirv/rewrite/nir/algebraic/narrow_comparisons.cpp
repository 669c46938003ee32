// Comparisons of floats that were converted from narrower ones are those of the narrower ones: rules on conversions,
// which rows on one width cannot say (lavapipe-optimizer.md 4.8).
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Narrower {
 public:
  explicit Narrower(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (!computes(inst) || !compares_floats(inst.op)) return;
    if (inst.kind == Kind::kSized && inst.width == 64) from_double(id);
    if (graph_.insts[id].kind == Kind::kAlu) from_single(id);
  }

  bool changed() const { return changed_; }

 private:
  static bool compares_floats(Op op) { return op == Op::kFLt || op == Op::kFGe || op == Op::kFEq || op == Op::kFNeu; }

  void from_double(InstId id) {
    Src narrow[2];
    for (const std::uint32_t i : {0u, 1u}) {
      const Inst* def = graph_.def(graph_.source(graph_.insts[id], i).value);
      if (!def || def->kind != Kind::kIntrinsic || def->op != Op::kDFromF) return;
      narrow[i] = scalar(graph_.source(*def, 0));
    }
    graph_.insts[id].kind = Kind::kAlu;
    graph_.insts[id].width = 32;
    for (const std::uint32_t i : {0u, 1u}) graph_.set_source(id, i, narrow[i]);
    changed_ = true;
  }

  void from_single(InstId id) {
    Src narrow[2];
    for (const std::uint32_t i : {0u, 1u}) {
      const Src src = graph_.source(graph_.insts[id], i);
      const Inst* def = graph_.def(src.value);
      if (!is_op(def, Op::kHalf2F)) return;
      narrow[i] = graph_.source(*def, 0);
      const auto inner = narrow[i].swizzle;
      for (std::size_t c = 0; c < 4; ++c) narrow[i].swizzle[c] = inner[src.swizzle[c]];
    }
    graph_.insts[id].kind = Kind::kSized;
    graph_.insts[id].width = 16;
    for (const std::uint32_t i : {0u, 1u}) graph_.set_source(id, i, narrow[i]);
    changed_ = true;
  }

  Graph& graph_;
  bool changed_ = false;
};

}  // namespace

bool narrow_comparisons(Graph& graph) {
  Narrower narrower(graph);
  auto visit = [&](InstId id) { narrower.visit(id); };
  for_each_inst(graph, graph.root, visit);
  return narrower.changed();
}

}  // namespace vitrine::spirv::rewriting
