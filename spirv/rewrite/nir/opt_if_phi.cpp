// Arithmetic on parameters of loops in the loop's header: computed in front of the loop and at the end of the body
// instead, and selections between parameters that only the first iteration decides (nir_opt_if.c; lavapipe-optimizer.md
// 5.7, 5.12).
#include "spirv/rewrite/nir/opt_if.h"

#include <algorithm>
#include <array>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

struct Header {
  const Graph& graph;
  InstId loop, latch;
  std::vector<InstId> insts;

  bool contains(InstId id) const { return std::find(insts.begin(), insts.end(), id) != insts.end(); }
  int param(ValueId value) const { return param_index(graph, loop, value); }
  Src init(int index) const { return graph.source(graph.insts[loop], static_cast<std::uint32_t>(index)); }
  Src next(int index) const { return graph.source(graph.insts[latch], static_cast<std::uint32_t>(index)); }
};

bool reads_whole(const Graph& graph, const Inst& inst, std::uint32_t index) {
  const Src src = graph.source(inst, index);
  if (graph.values[src.value].components != inst.components) return false;
  for (unsigned c = 0; c < inst.components; ++c)
    if (src.swizzle[c] != c) return false;
  return true;
}

/// A selection between parameters by one that is constant in front of the loop and behind each iteration; one of the
/// values may be another of the header's instructions.
bool is_trivial_selection(const Header& header, InstId id, bool allow_other) {
  const Graph& graph = header.graph;
  const Inst& inst = graph.insts[id];
  if (inst.kind != Kind::kAlu || !ir::is_selection(inst.op) || !header.contains(id)) return false;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Src src = graph.source(inst, i);
    if (!reads_whole(graph, inst, i)) return false;
    if (header.param(src.value) >= 0) continue;
    if (i == 0 || !allow_other || !header.contains(graph.values[src.value].def)) return false;
    allow_other = false;
  }
  const int chooser = header.param(graph.source(inst, 0).value);
  return graph.constant(header.init(chooser).value) != nullptr && graph.constant(header.next(chooser).value) != nullptr;
}

bool is_conversion(Op op) {
  const ir::AluInfo& info = ir::alu_info(op);
  return info.sources == 1 && info.operands[0] != info.result;
}

bool may_split(const Inst& inst) {
  if (inst.kind != Kind::kAlu || inst.op == Op::kMov || inst.op == Op::kMovB) return false;
  if (inst.op == Op::kNot || inst.op == Op::kNotB || is_conversion(inst.op)) return false;
  return ir::alu_info(inst.op).result != 'B' || ir::alu_info(inst.op).operands[0] == 'B';
}

Src composed(Src inner, Src outer) {
  Src result{inner.value, {}};
  for (unsigned c = 0; c < 4; ++c) result.swizzle[c] = inner.swizzle[outer.swizzle[c]];
  return result;
}

InstId copy_with(Graph& graph, InstId id, const std::vector<Src>& operands) {
  const Inst inst = graph.insts[id];
  const InstId copy = graph.create(Kind::kAlu, inst.op, inst.components, inst.boolean, inst.count);
  graph.insts[copy].exact = inst.exact;
  graph.insts[copy].origin = inst.origin;
  for (std::uint32_t i = 0; i < inst.count; ++i) graph.set_source(copy, i, operands[i]);
  return copy;
}

bool is_undefined(const Graph& graph, ValueId value) {
  const Inst* def = graph.def(value);
  return def && def->kind == Kind::kIntrinsic && def->op == Op::kUndef;
}

bool split(Graph& graph, const Header& header, InstId id) {
  const Inst inst = graph.insts[id];
  bool has_param = false, undefined = true, constant = true;
  std::vector<Src> before, again;
  for (std::uint32_t i = 0; i < inst.count; ++i) {
    const Src src = graph.source(inst, i);
    const int index = header.param(src.value);
    if (index < 0) {
      if (is_inside(graph, src.value, header.loop)) return false;
      before.push_back(src);
      again.push_back(src);
      continue;
    }
    has_param = true;
    before.push_back(composed(header.init(index), src));
    again.push_back(composed(header.next(index), src));
    undefined &= is_undefined(graph, before.back().value);
    constant &= graph.constant(before.back().value) != nullptr;
  }
  if (!has_param) return false;
  if (!undefined && !constant) {
    const Value& value = graph.values[inst.result];
    if (value.uses != 1 || !is_trivial_selection(header, graph.sources[value.first_use].user, true)) return false;
  }
  const InstId first = copy_with(graph, id, before), other = copy_with(graph, id, again);
  graph.insert_before(header.loop, first);
  graph.insert_before(header.latch, other);
  const ValueId param = add_param(graph, header.loop, inst.result, result_of(graph, first), result_of(graph, other));
  graph.replace_uses(inst.result, param);
  graph.remove(id);
  return true;
}

}  // namespace

bool opt_split_alu_of_phi(Graph& graph, InstId loop) {
  const InstId latch = latch_of(graph, loop);
  if (latch == kNone) return false;
  const Header header{graph, loop, latch, header_of(graph, loop)};
  if (header.contains(latch)) return false;
  bool changed = false;
  for (const InstId id : header.insts)
    if (may_split(graph.insts[id])) changed |= split(graph, header, id);
  return changed;
}

bool opt_simplify_bcsel_of_phi(Graph& graph, InstId loop) {
  const InstId latch = latch_of(graph, loop);
  if (latch == kNone) return false;
  const Header header{graph, loop, latch, header_of(graph, loop)};
  bool changed = false;
  for (const InstId id : header.insts) {
    if (!is_trivial_selection(header, id, false)) continue;
    const Inst inst = graph.insts[id];
    const int chooser = header.param(graph.source(inst, 0).value);
    const auto truth = [&](Src src) { return literal_of(graph, src) != 0u; };
    const bool entry = truth(header.init(chooser));
    if (entry == truth(header.next(chooser))) continue;
    const ValueId at_entry = graph.source(inst, entry ? 1 : 2).value, later = graph.source(inst, entry ? 2 : 1).value;
    const Src init = header.init(header.param(at_entry)), next = header.next(header.param(later));
    graph.replace_uses(inst.result, add_param(graph, loop, inst.result, init, next));
    graph.remove(id);
    changed = true;
  }
  return changed;
}

}  // namespace vitrine::spirv::rewriting
