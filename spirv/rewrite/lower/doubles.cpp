// Doubles as the reference sees them, which has one value where the front end has two words: pairs of the same words
// are one value, and selections of both words are one selection. Neither changes a number; how often values are used
// decides whether inexact rules apply to them (lavapipe-optimizer.md 4.8).
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/merge_equal.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/lower/passes.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Both words of a double.
Src double_of(ValueId value) { return {value, {0, 1, 0, 1}}; }

class Joiner {
 public:
  explicit Joiner(Graph& graph) : graph_(graph) {}

  /// Words that are composed to a double.
  void visit_pair(InstId id) {
    const Inst& vec = graph_.insts[id];
    if (vec.removed || vec.kind != Kind::kVec || vec.components != 2 || !is_read_as_double(vec.result)) return;
    const InstId low = selection(graph_.source(vec, 0).value), high = selection(graph_.source(vec, 1).value);
    const ValueId whole = join(low, high);
    if (whole == kNone) return;
    graph_.replace_uses(graph_.insts[id].result, whole);
    graph_.remove(id);
    replace(low, high, whole);
  }

  /// Words of computed doubles, which are only read as words.
  void visit_words(InstId id) {
    const Inst& inst = graph_.insts[id];
    if (inst.removed || selection(inst.result) != id) return;
    if (const InstId high = second_word(id); high != kNone) {
      if (const ValueId whole = join(id, high); whole != kNone) replace(id, high, whole);
    } else {
      widen(id);
    }
  }

  bool changed() const { return changed_; }

 private:
  bool is_read_as_double(ValueId value) const {
    for (Slot use = graph_.values[value].first_use; use != kNone; use = graph_.sources[use].next) {
      const Inst& user = graph_.insts[graph_.sources[use].user];
      if (computes(user) && user.width == 64) return true;
    }
    return false;
  }

  /// One double selected by the conditions of two words; none if these differ.
  ValueId join(InstId low, InstId high) {
    if (low == kNone || high == kNone || low == high || !same_condition(low, high)) return kNone;
    const InstId last = graph_.insts[low].block == graph_.insts[high].block ? later(low, high) : kNone;
    if (last == kNone) return kNone;
    const Src yes = pair(last, low, high, 1), no = pair(last, low, high, 2);
    return select_double(last, low, yes, no);
  }

  /// Selects as `like` does.
  ValueId select_double(InstId position, InstId like, Src yes, Src no) {
    Inst model = graph_.insts[like];
    model.width = 64;
    changed_ = true;
    return Builder(graph_, position).like(model, Op::kSelect, {scalar(graph_.source(model, 0)), yes, no}, 2).value;
  }

  /// One word of two computed doubles, of which the other word is not read.
  void widen(InstId id) {
    const Src yes = moved(scalar(graph_.source(graph_.insts[id], 1)));
    const Src no = moved(scalar(graph_.source(graph_.insts[id], 2)));
    if (yes.swizzle[0] != no.swizzle[0] || !is_computed_double(yes) || !is_computed_double(no)) return;
    const ValueId whole = select_double(id, id, double_of(yes.value), double_of(no.value));
    read_word(graph_.insts[id].result, whole, yes.swizzle[0]);
    remove_selection(id);
  }

  bool is_computed_double(Src word) const {
    const Inst* def = graph_.def(word.value);
    return def && computes(*def) && def->width == 64 && !def->boolean && def->components == 2;
  }

  void replace(InstId low, InstId high, ValueId whole) {
    read_word(graph_.insts[low].result, whole, 0);
    read_word(graph_.insts[high].result, whole, 1);
    remove_selection(low);
    remove_selection(high);
  }

  bool same_condition(InstId a, InstId b) const {
    const Src one = scalar(graph_.source(graph_.insts[a], 0)), other = scalar(graph_.source(graph_.insts[b], 0));
    return one.value == other.value && one.swizzle == other.swizzle;
  }

  /// The selection behind this one that selects the high word where it selects the low word of a computed double.
  InstId second_word(InstId low) const {
    const InstId next = graph_.insts[low].next;
    if (next == kNone || selection(graph_.insts[next].result) != next || !same_condition(low, next)) return kNone;
    for (const std::uint32_t index : {1u, 2u}) {
      const Src first = moved(scalar(graph_.source(graph_.insts[low], index)));
      const Src second = moved(scalar(graph_.source(graph_.insts[next], index)));
      if (is_computed_double(first) && first.value == second.value && first.swizzle[0] == 0 && second.swizzle[0] == 1)
        return next;
    }
    return kNone;
  }

  /// The scalar selection that makes the value.
  InstId selection(ValueId value) const {
    const InstId def = value == ir::kNoValue ? kNone : graph_.values[value].def;
    if (def == kNone) return kNone;
    const Inst& inst = graph_.insts[def];
    const bool selects = inst.kind == Kind::kAlu && inst.op == Op::kSelect && inst.width == 32 && inst.components == 1;
    return selects ? def : kNone;
  }

  /// The second of two instructions of a block.
  InstId later(InstId a, InstId b) const {
    for (InstId at = a; at != kNone; at = graph_.insts[at].next)
      if (at == b) return b;
    return a;
  }

  /// What moves have brought: a branch that has become selections yields words by them.
  Src moved(Src src) const {
    for (const Inst* def = graph_.def(src.value); def && is_move(*def); def = graph_.def(src.value)) {
      const Src from = graph_.source(*def, 0);
      src = scalar({from.value, {from.swizzle[src.swizzle[0]]}});
    }
    return src;
  }

  /// It would count as a use of its operands, and so would moves for it alone.
  void remove_selection(InstId id) {
    const std::vector<Src> operands = operands_of(graph_, id);
    graph_.remove(id);
    for (const Src& operand : operands) {
      const InstId def = graph_.values[operand.value].def;
      if (def != kNone && is_move(graph_.insts[def]) && graph_.values[operand.value].uses == 0) graph_.remove(def);
    }
  }

  /// The double of which the selections take the words as operand `index`.
  Src pair(InstId position, InstId low, InstId high, std::uint32_t index) {
    const Src first = moved(scalar(graph_.source(graph_.insts[low], index)));
    const Src second = moved(scalar(graph_.source(graph_.insts[high], index)));
    if (first.value == second.value && first.swizzle[0] == 0 && second.swizzle[0] == 1 &&
        graph_.values[first.value].components == 2)
      return double_of(first.value);
    const std::optional<std::uint32_t> one = literal_of(graph_, first), two = literal_of(graph_, second);
    Builder build(graph_, position);
    if (!one || !two) return double_of(build.vec({first, second}).value);
    const std::uint32_t words[2] = {*one, *two};
    return double_of(build.literal(2, false, words).value);
  }

  void read_word(ValueId word, ValueId whole, std::uint8_t component) {
    for (const Slot use : uses_of(graph_, word)) {
      const InstId user = graph_.sources[use].user;
      graph_.set_source(user, use - graph_.insts[user].first, {whole, {component, component, component, component}});
    }
  }

  Graph& graph_;
  bool changed_ = false;
};

}  // namespace

void merge_doubles(Graph& graph) {
  for (const Inst& inst : graph.insts) {
    if (inst.width != 64) continue;
    copy_prop(graph);
    merge_equal(graph, {.only_doubles = true});
    return;
  }
}

bool join_doubles(Graph& graph) {
  Joiner joiner(graph);
  auto visit_pair = [&](InstId id) { joiner.visit_pair(id); };
  for_each_inst(graph, graph.root, visit_pair);
  auto visit_words = [&](InstId id) { joiner.visit_words(id); };
  for_each_inst(graph, graph.root, visit_words);
  if (joiner.changed()) merge_doubles(graph);
  return joiner.changed();
}

}  // namespace vitrine::spirv::rewriting
