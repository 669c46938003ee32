// The reference's optimiser negates a product's first operand instead of the product. First is what is ready earlier,
// but conversions between types, as of what is loaded from a buffer, come after everything else.
#include "spirv/rewrite/llvm/operand_rank.h"

#include <algorithm>

#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// What the reference's optimiser does not move.
bool has_place(const Inst& inst) {
  if (inst.kind == Kind::kIntrinsic || inst.kind == Kind::kLoop) return true;
  return is_op(&inst, Op::kFMin) || is_op(&inst, Op::kFMax) || is_op(&inst, Op::kFMinPlain) ||
         is_op(&inst, Op::kFMaxPlain);
}

/// About as many as the reference needs.
std::uint32_t operations_of(const Inst& inst) {
  if (inst.kind == Kind::kConst || inst.kind == Kind::kVec || is_op(&inst, Op::kFNeg)) return 0;
  if (inst.kind == Kind::kIf || is_op(&inst, Op::kSelect)) return 3;
  return inst.kind == Kind::kAlu && ir::alu_info(inst.op).result == 'B' ? 2 : 1;
}

/// A conversion to the reference: what is loaded from a buffer, and what is computed as an integer.
bool is_converted(const Inst* inst) {
  if (!inst || inst->kind == Kind::kConst) return false;
  if (inst->kind == Kind::kIntrinsic)
    return inst->op != Op::kLoadInput && inst->op != Op::kLoadPush && inst->op != Op::kLoadUniform;
  return inst->kind == Kind::kAlu && (ir::alu_info(inst->op).result != 'F' || inst->op == Op::kFNeg);
}

/// Negated by its only user, and not to be added to something: that would be a subtraction.
bool is_negated(const Graph& graph, const Inst& product) {
  const Value& value = graph.values[product.result];
  if (value.uses != 1) return false;
  const Inst& user = graph.insts[graph.sources[value.first_use].user];
  if (!is_op(&user, Op::kFNeg)) return false;
  const Value& negated = graph.values[user.result];
  return negated.uses != 1 || !is_op(&graph.insts[graph.sources[negated.first_use].user], Op::kFAdd);
}

}  // namespace

void OperandRanks::number_places() {
  places_.resize(graph_.insts.size());
  std::uint32_t count = 0;
  auto visit = [&](InstId id) { places_[id] = ++count; };
  for_each_inst(graph_, graph_.root, visit);
}

OperandRanks::Rank OperandRanks::rank(Src read) {
  static constexpr std::uint32_t kMaxDepth = 1000;  // what lies deeper counts as ready: chains of any length end
  const Src src = component_of(graph_, read, read.swizzle[0]);
  const InstId id = graph_.values[src.value].def;
  if (id == kNone) return {};
  const Inst& inst = graph_.insts[id];
  if (has_place(inst)) return {places_[id], 0};
  const auto [known, fresh] = known_.try_emplace(src.value);
  if (!fresh || depth_ == kMaxDepth) return known->second;
  ++depth_;
  Rank result;
  for (std::uint32_t i = 0; i < inst.count; ++i) result = std::max(result, rank(graph_.source(inst, i)));
  if (inst.kind == Kind::kIf) result = std::max(result, rank_of_yields(inst, src.value));
  result.operations += operations_of(inst);
  --depth_;
  return known_[src.value] = result;
}

OperandRanks::Rank OperandRanks::rank_of_yields(const Inst& branch, ValueId value) {
  const std::vector<ValueId>& results = graph_.nodes[branch.node]->results;
  const auto index = static_cast<std::uint32_t>(std::find(results.begin(), results.end(), value) - results.begin());
  Rank result;
  for (const BlockId side : branch.child)
    if (ends_in(graph_, side, Op::kYield))
      result = std::max(result, rank(graph_.source(graph_.insts[graph_.blocks[side].tail], index)));
  return result;
}

bool OperandRanks::negates_selection(InstId product, std::uint32_t index) {
  const Inst& inst = graph_.insts[product];
  if (inst.op != Op::kFMul || !is_negated(graph_, inst)) return false;
  const Src other = graph_.source(inst, 1 - index);
  if (is_converted(graph_.def(other.value))) return true;
  if (places_.empty()) number_places();
  const Rank mine = rank(graph_.source(inst, index)), others = rank(other);
  return mine == others ? index == 0 : mine < others;
}

}  // namespace vitrine::spirv::rewriting
