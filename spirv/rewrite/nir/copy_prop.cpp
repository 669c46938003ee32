// Copy propagation (nir_opt_copy_propagate.c; lavapipe-optimizer.md 3.4): uses of copies read what was copied.
#include <array>
#include <vector>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/effects.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Looks through one copy. False: the operand's definition is no copy, or the components read come from several values.
bool look_through(const Graph& graph, Src& src, unsigned read) {
  const Inst* copy = graph.def(src.value);
  if (!copy) return false;
  if (is_move(*copy)) {
    const Src from = graph.source(*copy, 0);
    Src result{from.value, {}};
    for (unsigned i = 0; i < 4; ++i) result.swizzle[i] = from.swizzle[src.swizzle[i < read ? i : 0]];
    src = result;
    return true;
  }
  if (copy->kind != Kind::kVec) return false;
  const Src first = graph.source(*copy, src.swizzle[0]);
  Src result = scalar(first);
  for (unsigned i = 1; i < read; ++i) {
    const Src component = graph.source(*copy, src.swizzle[i]);
    if (component.value != first.value) return false;
    result.swizzle[i] = component.swizzle[0];
  }
  src = result;
  return true;
}

/// A whole vector that is another value, component by component.
bool look_through_whole(const Graph& graph, Src& src) {
  const Inst* copy = graph.def(src.value);
  if (!copy || !is_whole(graph, src, src.value)) return false;
  const bool move = is_move(*copy);
  if (!move && copy->kind != Kind::kVec) return false;
  const ValueId from = graph.source(*copy, 0).value;
  if (graph.values[from].components != copy->components) return false;
  for (unsigned i = 0; i < copy->components; ++i) {
    const Src component = graph.source(*copy, move ? 0 : i);
    if (component.value != from || component.swizzle[move ? i : 0] != i) return false;
  }
  src.value = from;
  return true;
}

/// A Mov that gathers components of several values of `vec` gives its uses to a Vec.
bool move_to_vec(Graph& graph, InstId id, const Inst& vec) {
  const Inst inst = graph.insts[id];
  if (!is_move(inst) || inst.components < 2) return false;
  const Src from = graph.source(inst, 0);
  std::array<Src, 4> parts;
  for (unsigned i = 0; i < inst.components; ++i) parts[i] = graph.source(vec, from.swizzle[i]);
  const Src made = Builder::behind(graph, id).vec(std::span(parts).first(inst.components), inst.boolean);
  graph.replace_uses(inst.result, made.value);
  return true;
}

/// The uses of a copy become uses of what it copies, in their order, which is the order in which the rules wake users.
/// A join reads whole values, a component of one by a copy, unless `into_joins`.
bool propagate(Graph& graph, InstId id, bool into_joins) {
  if (!is_move(graph.insts[id]) && graph.insts[id].kind != Kind::kVec) return false;
  std::vector<Slot> uses;
  for (Slot slot = graph.values[graph.insts[id].result].first_use; slot != kNone; slot = graph.sources[slot].next)
    uses.push_back(slot);
  bool changed = false;
  for (const Slot slot : uses) {
    const InstId user = graph.sources[slot].user;
    const std::uint32_t index = slot - graph.insts[user].first;
    Src src = graph.source(graph.insts[user], index);
    unsigned read = components_read(graph, graph.insts[user], index);
    if (read == 0 && into_joins && graph.values[src.value].components == 1) read = 1;
    if (read == 0 ? look_through_whole(graph, src) : look_through(graph, src, read)) {
      graph.set_source(user, index, src);
      changed = true;
    } else if (graph.insts[id].kind == Kind::kVec) {
      changed |= move_to_vec(graph, user, Inst(graph.insts[id]));
    }
  }
  return changed;
}

bool propagate_all(Graph& graph, bool into_joins) {
  bool changed = false;
  auto visit = [&](InstId id) { changed |= propagate(graph, id, into_joins); };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace

bool copy_prop(Graph& graph) { return propagate_all(graph, false); }
bool copy_prop_into_joins(Graph& graph) { return propagate_all(graph, true); }

}  // namespace vitrine::spirv::rewriting
