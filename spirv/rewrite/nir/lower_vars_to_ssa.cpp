// Local arrays of which only constant elements are accessed become values: what stays of an array when the loops that
// walked through it are unrolled (lavapipe-shader-math.md 3.2 step 3, splitting of variables, variables to SSA;
// lavapipe-optimizer.md 3.1).
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;
using Element = std::pair<std::uint32_t, std::uint32_t>;  ///< array, index
using State = std::map<Element, ValueId>;                 ///< scalars; none: undefined

/// Larger arrays stay in memory: bounds the work for absurd modules.
constexpr std::uint32_t kMostElements = 1024;

bool is_access(const Inst& inst) {
  return inst.kind == Kind::kIntrinsic && (inst.op == Op::kStoreArray || inst.op == Op::kLoadArray);
}

/// False: its index is not constant. An index behind the array is UINT32_MAX.
bool element_of(const Graph& graph, const Inst& inst, Element& element) {
  const ir::Instr& instr = graph.nodes[inst.node]->instr;
  const Src index = graph.source(inst, 0);
  const Inst* constant = graph.constant(index.value);
  if (constant == nullptr) return false;
  const std::uint64_t number = std::uint64_t{constant->imm[index.swizzle[0]]} + instr.data[1];
  const bool inside = number < graph.function.arrays[instr.data[0]].elements;
  element = {instr.data[0], inside ? static_cast<std::uint32_t>(number) : UINT32_MAX};
  return true;
}

/// The arrays to promote; empty: none.
std::vector<bool> find_promotable(Graph& graph) {
  std::vector<bool> constant(graph.function.arrays.size(), true), used(graph.function.arrays.size(), false);
  bool straight = true;
  auto look = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (inst.kind == Kind::kLoop) {
      const BlockId continuing = inst.child[1];
      const ir::Node& node = *graph.nodes[inst.node];
      straight &= graph.blocks[continuing].head == graph.blocks[continuing].tail &&
                  node.params.size() == node.continue_params.size();
    }
    if (!is_access(inst)) return;
    Element element;
    const std::uint32_t array = graph.nodes[inst.node]->instr.data[0];
    used[array] = true;
    constant[array] = constant[array] && element_of(graph, inst, element);
  };
  for_each_inst(graph, graph.root, look);
  bool any = false;
  for (std::size_t i = 0; i < used.size(); ++i) {
    constant[i] = constant[i] && used[i] && straight && graph.function.arrays[i].elements <= kMostElements;
    any |= constant[i];
  }
  return any ? constant : std::vector<bool>{};
}

class Promoter {
 public:
  Promoter(Graph& graph, std::vector<bool> promoted) : graph_(graph), promoted_(std::move(promoted)) {}

  void run() { visit(graph_.root); }

 private:
  /// A loop that is being visited.
  struct Frame {
    std::vector<std::pair<Element, std::uint32_t>> params;  ///< what it stores, and the parameter's index
    std::vector<std::pair<InstId, State>> breaks;
  };

  bool promotes(const Inst& inst) const { return is_access(inst) && promoted_[graph_.nodes[inst.node]->instr.data[0]]; }

  ValueId undefined_before(InstId position) { return Builder(graph_, position).undefined(1).value; }

  ValueId value_before(InstId position, const State& state, Element element) {
    const auto entry = state.find(element);
    return entry != state.end() ? entry->second : undefined_before(position);
  }

  void append_operands(InstId id, const std::vector<ValueId>& values) {
    std::vector<Src> more;
    for (const ValueId value : values) more.push_back({value, kWhole});
    rewriting::append_operands(graph_, id, more);
  }

  ValueId scalar_before(InstId position, Src src) {
    if (graph_.values[src.value].components == 1) return src.value;
    return Builder(graph_, position).alu(Op::kMov, {src}).value;
  }

  void access(InstId id) {
    Element element;
    element_of(graph_, graph_.insts[id], element);
    if (graph_.insts[id].op == Op::kStoreArray) {
      if (element.second != UINT32_MAX) state_[element] = scalar_before(id, graph_.source(graph_.insts[id], 1));
    } else {
      const ValueId value = value_before(id, state_, element);
      const InstId move = graph_.create(Kind::kAlu, Op::kMov, 1, false, 1);
      graph_.insts[move].origin = graph_.insts[id].origin;
      graph_.replace_uses(graph_.insts[id].result, graph_.insts[move].result);
      graph_.set_source(move, 0, {value, {0, 0, 0, 0}});
      graph_.insert_before(id, move);
    }
    graph_.remove(id);
  }

  /// Elements of which the states do not all know the same value.
  static std::vector<Element> differing(const std::vector<const State*>& states) {
    std::vector<Element> found;
    for (const State* state : states)
      for (const auto& [element, value] : *state) {
        const auto differs = [&, wanted = value, key = element](const State* other) {
          const auto entry = other->find(key);
          return entry == other->end() || entry->second != wanted;
        };
        if (std::any_of(states.begin(), states.end(), differs)) found.push_back(element);
      }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// A result of the If or Loop `id`, of what the jumps `ends` find in `states`, for all elements that differ.
  void join(InstId id, const std::vector<InstId>& ends, const std::vector<const State*>& states) {
    State joined = *states[0];
    const std::vector<Element> elements = differing(states);
    std::vector<std::vector<ValueId>> values(ends.size());
    for (const Element& element : elements)
      for (std::size_t i = 0; i < ends.size(); ++i) values[i].push_back(value_before(ends[i], *states[i], element));
    const std::vector<Src> results = add_results(graph_, id, values[0]);
    for (std::size_t i = 0; i < elements.size(); ++i) joined[elements[i]] = results[i].value;
    for (std::size_t i = 0; i < ends.size(); ++i) append_operands(ends[i], values[i]);
    state_ = std::move(joined);
  }

  void visit_if(InstId id) {
    const BlockId child[2] = {graph_.insts[id].child[0], graph_.insts[id].child[1]};
    const State before = state_;
    visit(child[0]);
    const State then_state = std::exchange(state_, before);
    visit(child[1]);
    const bool stays[2] = {ends_in(graph_, child[0], Op::kYield), ends_in(graph_, child[1], Op::kYield)};
    if (stays[0] && stays[1]) {
      const State else_state = state_;
      join(id, {graph_.blocks[child[0]].tail, graph_.blocks[child[1]].tail}, {&then_state, &else_state});
    } else if (stays[0]) {
      state_ = then_state;
    }
  }

  void collect_stored(BlockId block, std::vector<Element>& stored) const {
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      Element element;
      if (promotes(inst) && inst.op == Op::kStoreArray && element_of(graph_, inst, element) &&
          element.second != UINT32_MAX)
        stored.push_back(element);
      for (const BlockId child : inst.child)
        if (child != kNone) collect_stored(child, stored);
    }
  }

  /// Every way back passes what the elements are there.
  void pass(InstId way) {
    for (const auto& [element, index] : frames_.back().params)
      graph_.set_source(way, index, {value_before(way, state_, element), {0, 1, 2, 3}});
  }

  void visit_loop(InstId loop) {
    std::vector<Element> stored;
    const BlockId body = graph_.insts[loop].child[0];
    collect_stored(body, stored);
    std::sort(stored.begin(), stored.end());
    stored.erase(std::unique(stored.begin(), stored.end()), stored.end());
    frames_.emplace_back();
    std::vector<ValueId> initial;
    for (const Element& element : stored) initial.push_back(value_before(loop, state_, element));
    auto index = static_cast<std::uint32_t>(graph_.nodes[graph_.insts[loop].node]->params.size());
    const std::vector<ValueId> params = add_params(graph_, loop, initial);
    for (std::size_t i = 0; i < stored.size(); ++i) {
      state_[stored[i]] = params[i];
      frames_.back().params.emplace_back(stored[i], index++);
    }
    visit(body);
    if (ends_in(graph_, body, Op::kYield)) pass(graph_.blocks[body].tail);
    const Frame frame = std::move(frames_.back());
    frames_.pop_back();
    if (frame.breaks.empty()) return;
    std::vector<InstId> ends;
    std::vector<const State*> states;
    for (const auto& [jump, state] : frame.breaks) {
      ends.push_back(jump);
      states.push_back(&state);
    }
    join(loop, ends, states);
  }

  void visit(BlockId block) {
    for (InstId id = graph_.blocks[block].head; id != kNone;) {
      const Inst inst = graph_.insts[id];
      if (promotes(inst)) {
        access(id);
      } else if (inst.kind == Kind::kIf) {
        visit_if(id);
      } else if (inst.kind == Kind::kLoop) {
        visit_loop(id);
      } else if (is_jump(inst, Op::kBreak)) {
        frames_.back().breaks.emplace_back(id, state_);
      } else if (is_jump(inst, Op::kContinue)) {
        pass(id);
      }
      id = inst.next;
    }
  }

  Graph& graph_;
  const std::vector<bool> promoted_;
  State state_;
  std::vector<Frame> frames_;
};

}  // namespace

bool lower_vars_to_ssa(Graph& graph) {
  if (graph.function.arrays.empty()) return false;
  const std::vector<bool> promoted = find_promotable(graph);
  if (promoted.empty()) return false;
  Promoter(graph, promoted).run();
  return true;
}

}  // namespace vitrine::spirv::rewriting
