// A loop whose first branch only the first iteration decides: what the first iteration does there goes in front of the
// loop, what the others do to the end of the body (nir_opt_if.c; lavapipe-optimizer.md 5.15).
#include "spirv/rewrite/nir/opt_if.h"

#include <array>
#include <utility>

#include "spirv/rewrite/graph/copier.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/phis_to_regs.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Peeler {
 public:
  Peeler(Graph& graph, InstId loop) : graph_(graph), loop_(loop), first_(graph), again_(graph) {}

  bool run() {
    latch_ = latch_of(graph_, loop_);
    if (latch_ == kNone || !find_branch()) return false;
    convert_to_lcssa(graph_, loop_);
    joined_ = node(branch_).results.size();
    pass_through_registers(graph_, loop_);
    read_registers();
    peel();
    return true;
  }

 private:
  const ir::Node& node(InstId id) const { return *graph_.nodes[graph_.insts[id].node]; }

  bool find_branch() {
    header_ = header_of(graph_, loop_);
    branch_ = header_.empty() ? graph_.blocks[graph_.insts[loop_].child[0]].head : graph_.insts[header_.back()].next;
    if (branch_ == kNone || graph_.insts[branch_].kind != Kind::kIf) return false;
    const Src condition = graph_.source(graph_.insts[branch_], 0);
    const int index = param_index(graph_, loop_, condition.value);
    if (index < 0) return false;
    const auto i = static_cast<std::uint32_t>(index);
    const std::optional<std::uint32_t> entry = literal_of(graph_, graph_.source(graph_.insts[loop_], i));
    const std::optional<std::uint32_t> later = literal_of(graph_, graph_.source(graph_.insts[latch_], i));
    if (!entry || !later) return false;
    const bool taken = *entry != 0;
    if (taken == (*later != 0)) return false;
    entry_side_ = graph_.insts[branch_].child[taken ? 0 : 1];
    later_side_ = graph_.insts[branch_].child[taken ? 1 : 0];
    return !contains_jump(graph_, entry_side_) && ends_in(graph_, entry_side_, Op::kYield);
  }

  /// What the header, which moves, reads of the registers.
  void read_registers() {
    const std::vector<ValueId> params = node(loop_).params;
    for (const InstId id : {loop_, latch_})
      for (std::uint32_t i = 0; i < params.size(); ++i)
        graph_.set_source(id, i, copied(graph_, id, graph_.source(graph_.insts[id], i), params[i]));
  }

  BlockId new_block() {
    graph_.blocks.push_back({kNone, kNone, kNone});
    return static_cast<BlockId>(graph_.blocks.size() - 1);
  }

  void peel() {
    const std::vector<ValueId> params = node(loop_).params;
    const InstId head = graph_.blocks[graph_.insts[loop_].child[0]].head;
    first_.bind_all(params, operands_of(graph_, loop_));
    again_.bind_all(params, operands_of(graph_, latch_));

    const BlockId before = new_block();
    first_.copy(head, branch_, before);
    const std::vector<Src> at_entry = first_.copy_branch(entry_side_, before);
    graph_.splice_before(loop_, before);

    const BlockId behind = new_block();
    again_.copy(head, branch_, behind);
    const bool goes_on = ends_in(graph_, later_side_, Op::kYield);
    std::vector<Src> later;
    if (goes_on)
      later = again_.copy_branch(later_side_, behind);
    else
      again_.copy(graph_.blocks[later_side_].head, kNone, behind);
    graph_.splice_before(latch_, behind);

    const std::vector<ValueId> results = node(branch_).results;
    graph_.nodes[graph_.insts[branch_].node]->results.clear();
    graph_.attached.drop(graph_, branch_);
    graph_.remove(branch_);
    for (auto id = header_.rbegin(); id != header_.rend(); ++id) {
      graph_.attached.drop(graph_, *id);  // the copies have it
      graph_.remove(*id);
    }
    std::vector<std::pair<ValueId, ValueId>> replaced;
    for (const InstId id : header_) {
      const ValueId value = graph_.insts[id].result;
      if (value == ir::kNoValue) continue;
      const Src whole{value, kWhole};
      replaced.emplace_back(value, stand_in(value, first_.translated(whole), again_.translated(whole), goes_on));
    }
    for (std::size_t i = 0; i < results.size(); ++i)
      replaced.emplace_back(results[i],
                            stand_in(results[i], in_register(i, loop_, at_entry[i], results[i]),
                                     goes_on ? in_register(i, latch_, later[i], results[i]) : Src{}, goes_on));
    // Last, because what is passed to an iteration may be a value of the one before.
    for (const auto& [value, by] : replaced) graph_.replace_uses(value, by);
    if (!goes_on) graph_.remove(latch_);
  }

  /// What the branch hands on as result `index`, in a register; what the loop's parameters take is already.
  Src in_register(std::size_t index, InstId position, Src src, ValueId like) {
    return index < joined_ ? copied(graph_, position, src, like) : src;
  }

  /// The value that the rest of the body reads.
  ValueId stand_in(ValueId value, Src init, Src next, bool goes_on) {
    return goes_on ? add_param(graph_, loop_, value, init, next) : whole_value(graph_, loop_, init, value);
  }

  Graph& graph_;
  InstId loop_, latch_ = kNone, branch_ = kNone;
  BlockId entry_side_ = kNone, later_side_ = kNone;
  std::size_t joined_ = 0;  ///< results of the branch that are not registers of the loop
  std::vector<InstId> header_;
  Copier first_, again_;
};

}  // namespace

bool opt_peel_loop_initial_if(Graph& graph, InstId loop) { return Peeler(graph, loop).run(); }

}  // namespace vitrine::spirv::rewriting
