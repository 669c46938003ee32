// An If that yields x on one side and x op y on the other is x op (c ? identity : y) to the reference's optimiser. Its
// masked instructions turn that back, unless several operations share the selection: then all of them are computed, and
// denormals of x are flushed where those are (lavapipe-optimizer.md 7.8).
#include <map>
#include <tuple>

#include "base/reference_cpu.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/llvm/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr std::uint32_t kZero = 0, kOne = 0x3f800000, kMinusZero = 0x80000000;

/// What one side of an If keeps of what the other side operates on.
struct Choice {
  InstId end = kNone;          ///< the Yield of what is kept
  std::uint32_t index = 0;     ///< of its operand
  std::uint8_t component = 0;  ///< of that
  Op op = Op::kFMul;
  Src kept, operand;
  std::uint32_t identity = 0;
};

/// The side that keeps, the operand and the identity: the selection that operations of one If share.
using Key = std::tuple<std::uint32_t, ValueId, unsigned, std::uint32_t>;

/// The operation on scalars that makes what is read, which steps may look through.
const Inst* open_operation(const Graph& graph, Src src) {
  const Inst* inst = scalar_operation(graph, src);
  return inst && !inst->opaque ? inst : nullptr;
}

class Sharer {
 public:
  explicit Sharer(Graph& graph) : graph_(graph) {}

  void run() {
    for (InstId id = graph_.blocks[graph_.root].head; id != kNone; id = graph_.insts[id].next) {
      choices_.clear();
      collect(id);
      for (const auto& [key, choices] : choices_)
        if (choices.size() > 1 || base::reference_lacks_avx512())
          for (const Choice& choice : choices) compute(choice);
    }
  }

 private:
  /// What both branches of an If yield, component by component.
  void collect(InstId id) {
    const Inst inst = graph_.insts[id];
    if (inst.kind != Kind::kIf || !ends_in(graph_, inst.child[0], Op::kYield) ||
        !ends_in(graph_, inst.child[1], Op::kYield))
      return;
    const InstId ends[2] = {graph_.blocks[inst.child[0]].tail, graph_.blocks[inst.child[1]].tail};
    const std::vector<ValueId> results = graph_.nodes[inst.node]->results;
    for (std::uint32_t index = 0; index < results.size(); ++index)
      for (std::uint8_t c = 0; c < graph_.values[results[index]].components; ++c) {
        const auto yielded = [&](unsigned side) {
          return component_of(graph_, graph_.source(graph_.insts[ends[side]], index), c);
        };
        for (const std::uint32_t side : {0u, 1u}) {
          Choice choice{ends[side], index, c, Op::kFMul, yielded(side), {}, 0};
          if (!find_operation(yielded(1 - side), choice)) continue;
          choices_[{side, choice.operand.value, choice.operand.swizzle[0], choice.identity}].push_back(choice);
          break;
        }
      }
  }

  bool find_operation(Src result, Choice& choice) const {
    const Inst* inst = open_operation(graph_, result);
    if (!inst || !is_used_once(graph_, result) || graph_.constant(choice.kept.value)) return false;
    if (inst->op != Op::kFMul && inst->op != Op::kFAdd && inst->op != Op::kFDiv) return false;
    choice.op = inst->op;
    choice.identity = inst->op == Op::kFAdd ? kMinusZero : kOne;
    for (const std::uint32_t index : {0u, 1u}) {
      if (index == 1 && inst->op == Op::kFDiv) break;
      if (!same(graph_.source(*inst, index), choice.kept)) continue;
      choice.operand = graph_.source(*inst, 1 - index);
      const Inst* negation = inst->op == Op::kFAdd ? open_operation(graph_, choice.operand) : nullptr;
      if (negation && negation->op == Op::kFNeg) {
        choice.operand = graph_.source(*negation, 0);
        choice.identity = kZero;
      }
      return graph_.constant(choice.operand.value) == nullptr;
    }
    return false;
  }

  /// The operation with its identity, in place of what is kept. It is opaque: nothing takes it away.
  void compute(const Choice& choice) {
    const std::uint32_t bits = choice.identity == kZero ? kMinusZero : choice.identity;
    Builder build(graph_, choice.end);
    const Src computed = build.alu(choice.op, {choice.kept, build.literal(bits)});
    graph_.insts[graph_.values[computed.value].def].opaque = true;
    replace_component(choice.end, choice.index, choice.component, computed);
  }

  /// Component `c` of operand `index` of a Yield.
  void replace_component(InstId yield, std::uint32_t index, std::uint8_t c, Src by) {
    const Src src = graph_.source(graph_.insts[yield], index);
    const std::uint8_t components = graph_.values[src.value].components;
    if (components == 1) return graph_.set_source(yield, index, by);
    std::vector<Src> parts;
    for (std::uint8_t i = 0; i < components; ++i) parts.push_back(i == c ? by : component_of(graph_, src, i));
    graph_.set_source(yield, index, Builder(graph_, yield).vec(parts));
  }

  Graph& graph_;
  std::map<Key, std::vector<Choice>> choices_;  ///< of one If
};

}  // namespace

void fold_select_into_op(Graph& graph) { Sharer(graph).run(); }

}  // namespace vitrine::spirv::rewriting
