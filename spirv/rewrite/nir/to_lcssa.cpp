// Values that leave loops. The reference reads a value of a loop behind the loop as it is, so that its rules see how
// the loop computed it; the shader core needs a result of the loop, which keeps what each lane left with. While the
// rewrites run, uses behind a loop read the value itself wherever every way out of the loop yields it.
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "spirv/rewrite/nir/to_lcssa.h"

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

std::vector<InstId> breaks_of(const Graph& graph, InstId loop) {
  std::vector<InstId> breaks;
  for (const BlockId child : graph.insts[loop].child) collect_jumps(graph, child, Op::kBreak, breaks);
  return breaks;
}

void drop_result(Graph& graph, InstId loop, std::size_t index, const std::vector<InstId>& breaks) {
  for (const InstId id : breaks) {
    std::vector<Src> kept = operands_of(graph, id);
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(index));
    graph.set_operands(id, kept);
  }
  auto& results = graph.nodes[graph.insts[loop].node]->results;
  results.erase(results.begin() + static_cast<std::ptrdiff_t>(index));
}

/// The whole value of which `src` is a copy, or kNoValue.
ValueId copied(const Graph& graph, Src src, ValueId like) {
  const Inst* copy = graph.def(src.value);
  if (!copy || !is_move(*copy) || !is_whole(graph, src, like)) return ir::kNoValue;
  const Src source = graph.source(*copy, 0);
  return is_whole(graph, source, like) ? source.value : ir::kNoValue;
}

/// The value that result `index` is at every way out, or kNoValue. Copies of one value are that value.
ValueId value_at_breaks(Graph& graph, ValueId result, std::uint32_t index, const std::vector<InstId>& breaks) {
  if (breaks.empty()) return ir::kNoValue;
  const auto at = [&](InstId id) { return graph.source(graph.insts[id], index); };
  const auto every = [&](auto&& holds) { return std::all_of(breaks.begin(), breaks.end(), holds); };
  const Src first = at(breaks[0]);
  const ValueId origin = copied(graph, first, result);
  if (breaks.size() == 1) return origin != ir::kNoValue ? origin : whole_value(graph, breaks[0], first, result);
  if (every([&](InstId id) { return same_value(graph, at(id), first, result); }))
    return is_whole(graph, first, result) ? first.value : ir::kNoValue;
  return every([&](InstId id) { return copied(graph, at(id), result) == origin; }) ? origin : ir::kNoValue;
}

bool open_loop(Graph& graph, InstId loop) {
  const std::vector<InstId> breaks = breaks_of(graph, loop);
  bool changed = false;
  for (std::size_t i = graph.nodes[graph.insts[loop].node]->results.size(); i-- > 0;) {
    const ValueId result = graph.nodes[graph.insts[loop].node]->results[i];
    if (graph.values[result].uses != 0 || graph.attached.reads(result)) {
      const ValueId value = value_at_breaks(graph, result, static_cast<std::uint32_t>(i), breaks);
      if (value == ir::kNoValue) continue;
      graph.replace_uses(result, value);
    }
    drop_result(graph, loop, i, breaks);
    changed = true;
  }
  return changed;
}

/// The innermost loop in which the value changes.
InstId loop_of(const Graph& graph, ValueId value) {
  const InstId def = graph.values[value].def;
  if (def == kNone) return kNone;
  if (graph.insts[def].kind == Kind::kLoop) {
    const auto& results = graph.nodes[graph.insts[def].node]->results;
    bool result = false;
    for (const ValueId other : results) result |= other == value;
    if (!result) return def;
  }
  return loop_around(graph, graph.insts[def].block);
}

bool encloses(const Graph& graph, InstId loop, BlockId block) {
  for (InstId at = loop_around(graph, block); at != kNone; at = loop_around(graph, graph.insts[at].block))
    if (at == loop) return true;
  return false;
}

class Closer {
 public:
  /// `only`: the loop whose values to close, kNone: all.
  Closer(Graph& graph, InstId only) : graph_(graph), only_(only) {}

  void run() {
    auto visit = [&](InstId id) {
      for (std::uint32_t i = 0; i < graph_.insts[id].count; ++i) close(id, i);
    };
    for_each_inst(graph_, graph_.root, visit);
  }

 private:
  void close(InstId user, std::uint32_t index) {
    Src src = graph_.source(graph_.insts[user], index);
    if (const Inst* def = graph_.def(src.value); def && def->removed) {  // of code that never runs
      const std::uint32_t zero[4] = {};
      return read_literal(user, index, src, zero);
    }
    const BlockId block = graph_.insts[user].block;
    if (only_ != kNone && (!is_inside(graph_, src.value, only_) || encloses(graph_, only_, block))) return;
    const InstId innermost = loop_of(graph_, src.value);
    if (innermost == kNone || encloses(graph_, innermost, block)) return;
    if (const Inst* constant = graph_.constant(src.value); constant && only_ == kNone)
      return read_literal(user, index, src, std::to_array(constant->imm).data());
    for (InstId loop = innermost; loop != kNone && !encloses(graph_, loop, block); loop = loop_of(graph_, src.value))
      src.value = result_for(loop, src.value);
    graph_.set_source(user, index, src);
  }

  /// Operand `index`, which reads `src`, reads these bits instead.
  void read_literal(InstId user, std::uint32_t index, Src src, const std::uint32_t* bits) {
    const Value shape = graph_.values[src.value];
    src.value = Builder(graph_, user).literal(shape.components, shape.boolean, bits).value;
    graph_.set_source(user, index, src);
  }

  /// The result of `loop` that is `value` where the loop ends.
  ValueId result_for(InstId loop, ValueId value) {
    const auto [entry, is_new] = made_.try_emplace({loop, value}, ir::kNoValue);
    if (!is_new) return entry->second;
    entry->second = add_results(graph_, loop, {value})[0].value;
    for (const InstId id : breaks_of(graph_, loop)) {
      append_operands(graph_, id, {{value, kWhole}});
    }
    return entry->second;
  }

  Graph& graph_;
  InstId only_;
  std::map<std::pair<InstId, ValueId>, ValueId> made_;
};

}  // namespace

bool leave_lcssa(Graph& graph) {
  bool changed = false;
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kLoop) changed |= open_loop(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

void convert_to_lcssa(Graph& graph, InstId only) { Closer(graph, only).run(); }

bool is_used_behind(const Graph& graph, InstId loop) {
  for (const Value& value : graph.values) {
    if (value.uses == 0 || value.def == kNone || graph.insts[value.def].removed) continue;
    const auto id = static_cast<ValueId>(&value - graph.values.data());
    if (!is_inside(graph, id, loop)) continue;
    for (Slot use = value.first_use; use != kNone; use = graph.sources[use].next)
      if (!encloses(graph, loop, graph.insts[graph.sources[use].user].block)) return true;
  }
  return false;
}

}  // namespace vitrine::spirv::rewriting
