// Loops with a constant number of iterations become straight-line code, as in the reference (nir_opt_loop_unroll.c,
// lavapipe-shader-math.md 3.2 and 9; lavapipe-optimizer.md 5.19): unrolled code sees the counter as constants, which
// changes what the algebraic rules do. Covered: exits that are all counted by constants; a counted and another one; a
// body that ends in Break.
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/copier.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/loop_analyze.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/phis_to_regs.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr unsigned kMaxCost = 26 * kMaxIterations;  ///< instructions times iterations

/// Builds the iterations of one loop.
class Unroller {
 public:
  Unroller(Graph& graph, InstId loop, const LoopInfo& info) : graph_(graph), loop_(loop), info_(info), copier_(graph) {}

  void run() {
    copier_.bind_all(node(loop_).params, copier_.operands_of(loop_));
    const BlockId made = new_block(kNone);
    const std::vector<Src> values = iterate(0, made);
    graph_.splice_before(loop_, made);
    replace_results(graph_, loop_, values);
    if (!branches_) copier_.hand_over_attached();
    graph_.remove(loop_);
  }

 private:
  const ir::Node& node(InstId id) const { return *graph_.nodes[graph_.insts[id].node]; }
  BlockId child(InstId id, unsigned side) const { return graph_.insts[id].child[side]; }

  BlockId new_block(InstId owner) {
    graph_.blocks.push_back({kNone, kNone, owner});
    return static_cast<BlockId>(graph_.blocks.size() - 1);
  }

  /// Appends iteration `number` and all that follow; returns the values the loop ends with.
  std::vector<Src> iterate(unsigned number, BlockId to) {
    return go_on(number, 0, graph_.blocks[child(loop_, 0)].head, to);
  }

  /// The same from `first`, before exit `next`.
  std::vector<Src> go_on(unsigned number, std::size_t next, InstId first, BlockId to) {
    if (next == info_.exits.size()) {
      if (info_.once) return leave(first, to);
      finish(first, to);
      return iterate(number + 1, to);
    }
    const Exit& exit = info_.exits[next];
    copier_.copy(first, exit.branch, to);
    if (next == info_.limiting && number == exit.trips)
      return copier_.copy_branch(child(exit.branch, exit.break_side), to);
    if (!exit.counted) return branch(number, next, to);
    stay(exit.branch, exit.break_side, to);
    return go_on(number, next + 1, graph_.insts[exit.branch].next, to);
  }

  /// The other way past a conditional exit.
  void stay(InstId exit, unsigned break_side, BlockId to) {
    const std::vector<ValueId> results = node(exit).results;
    copier_.bind_all(results, copier_.copy_branch(child(exit, 1 - break_side), to));
  }

  /// From `first` to the Break that ends the body.
  std::vector<Src> leave(InstId first, BlockId to) {
    const InstId end = graph_.blocks[child(loop_, 0)].tail;
    copier_.copy(first, end, to);
    return copier_.operands_of(end);
  }

  /// From `first` to the end of the body, then the continue construct.
  void finish(InstId first, BlockId to) {
    const InstId end = graph_.blocks[child(loop_, 0)].tail;
    copier_.copy(first, end, to);
    copier_.bind_all(node(loop_).continue_params, copier_.operands_of(end));
    const std::vector<Src> next = copier_.copy_branch(child(loop_, 1), to);
    copier_.bind_all(node(loop_).params, next);
  }

  /// An If on an exit that is not counted, with the rest of the loop in the branch that stays.
  std::vector<Src> branch(unsigned number, std::size_t next, BlockId to) {
    const Exit& exit = info_.exits[next];
    branches_ = true;
    const auto made = graph_.create(Kind::kIf, Op::kMov, 0, false, 1);
    graph_.set_source(made, 0, copier_.operands_of(exit.branch)[0]);
    auto description = std::make_unique<ir::Node>();
    description->kind = ir::Node::Kind::kIf;
    graph_.insts[made].origin = graph_.insts[exit.branch].origin;
    graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
    graph_.nodes.push_back(std::move(description));
    const std::vector<Src> results = add_results(graph_, made, node(loop_).results);
    graph_.append(to, made);
    const BlockId leaving = new_block(made), staying = new_block(made);
    graph_.insts[made].child[exit.break_side] = leaving;
    graph_.insts[made].child[1 - exit.break_side] = staying;
    yield(leaving, copier_.copy_branch(child(exit.branch, exit.break_side), leaving));
    stay(exit.branch, exit.break_side, staying);
    yield(staying, go_on(number, next + 1, graph_.insts[exit.branch].next, staying));
    return results;
  }

  void yield(BlockId block, const std::vector<Src>& values) {
    const InstId made = make_jump(graph_, Op::kYield, values);
    graph_.append(block, made);
  }

  Graph& graph_;
  InstId loop_;
  LoopInfo info_;
  Copier copier_;
  bool branches_ = false;  ///< no copy is the one that every way comes by
};

bool try_unroll(Graph& graph, InstId loop) {
  LoopInfo info;
  if (!analyze_loop(graph, loop, info)) return false;
  if (!info.once) {
    const LoopCost cost = cost_of_loop(graph, loop, info.trips());
    if (info.trips() > kMaxIterations || (cost.has_loop && info.trips() != 1)) return false;
    if (!cost.wanted && cost.instructions * info.trips() > kMaxCost) return false;
  }
  convert_to_lcssa(graph, loop);
  if (!info.once) {
    const std::vector<BranchJoin> joins = joins_in(graph, loop);
    pass_through_registers(graph, loop);
    join_through_registers(graph, joins);
    leave_through_registers(graph, loop);
  }
  Unroller(graph, loop, info).run();
  return true;
}

/// Innermost first; after one loop of a list the others wait for the next round, as does a loop around an unrolled one.
bool unroll_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    bool inside = false;
    for (const BlockId side : {graph.insts[id].child[0], graph.insts[id].child[1]})
      if (side != kNone) inside |= unroll_in(graph, side);
    changed |= inside;
    if (graph.insts[id].kind == Kind::kLoop && !inside && try_unroll(graph, id)) return true;
  }
  return changed;
}

}  // namespace

bool opt_loop_unroll(Graph& graph) { return unroll_in(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting
