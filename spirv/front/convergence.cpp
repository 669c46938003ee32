// Where the branches of a selection meet before its merge block. SPIR-V 2.11 lets several blocks of a construct branch
// to the same block; compilers of HLSL and optimizers write that, glslang never.
#include "spirv/front/convergence.h"

#include <algorithm>
#include <unordered_set>

namespace vitrine::spirv::front {
namespace {

/// A function's blocks in reverse postorder and their dominators (Cooper, Harvey, Kennedy: "A Simple, Fast Dominance
/// Algorithm").
struct Graph {
  std::vector<const Block*> order;
  std::unordered_map<std::uint32_t, std::uint32_t> index;  ///< label -> index in order
  std::vector<std::vector<std::uint32_t>> predecessors;
  std::vector<std::uint32_t> dominator;

  bool dominates(std::uint32_t above, std::uint32_t below) const {
    while (below > above) below = dominator[below];
    return below == above;
  }
};

void collect_blocks(const Module& module, std::uint32_t entry, Graph& graph) {
  struct Visit {
    const Block* block;
    std::vector<std::uint32_t> next;
  };
  std::unordered_set<std::uint32_t> seen{entry};
  std::vector<Visit> stack{{&module.block(entry), successors_of(module, module.block(entry))}};
  while (!stack.empty()) {
    if (stack.back().next.empty()) {
      graph.order.push_back(stack.back().block);
      stack.pop_back();
      continue;
    }
    const std::uint32_t label = stack.back().next.back();
    stack.back().next.pop_back();
    if (seen.insert(label).second) stack.push_back({&module.block(label), successors_of(module, module.block(label))});
  }
  std::reverse(graph.order.begin(), graph.order.end());
  for (std::uint32_t i = 0; i < graph.order.size(); i++) graph.index[graph.order[i]->label] = i;
  graph.predecessors.resize(graph.order.size());
  for (std::uint32_t i = 0; i < graph.order.size(); i++)
    for (const std::uint32_t label : successors_of(module, *graph.order[i])) {
      auto& from = graph.predecessors[graph.index[label]];
      if (std::find(from.begin(), from.end(), i) == from.end()) from.push_back(i);
    }
}

void find_dominators(Graph& graph) {
  constexpr std::uint32_t kUnknown = UINT32_MAX;
  graph.dominator.assign(graph.order.size(), kUnknown);
  graph.dominator[0] = 0;
  const auto common = [&](std::uint32_t a, std::uint32_t b) {
    while (a != b) (a > b ? a : b) = graph.dominator[a > b ? a : b];
    return a;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t i = 1; i < graph.order.size(); i++) {
      std::uint32_t best = kUnknown;
      for (const std::uint32_t from : graph.predecessors[i])
        if (graph.dominator[from] != kUnknown) best = best == kUnknown ? from : common(best, from);
      changed |= graph.dominator[i] != best;
      graph.dominator[i] = best;
    }
  }
}

}  // namespace

std::vector<std::uint32_t> successors_of(const Module& module, const Block& block) {
  const Inst& inst = module.code[block.last];
  std::vector<std::uint32_t> labels;
  if (inst.op == spv::Op::OpBranch) labels = {inst.operand(0)};
  if (inst.op == spv::Op::OpBranchConditional) labels = {inst.operand(1), inst.operand(2)};
  if (inst.op == spv::Op::OpSwitch) {
    const std::uint32_t selector_type = module.def(inst.operand(0)).result_type;
    const std::uint32_t words = module.type(selector_type).width == 64 ? 2 : 1;
    labels = {inst.operand(1)};
    for (std::uint32_t i = 2 + words; inst.has(i); i += words + 1) labels.push_back(inst.operand(i));
  }
  return labels;
}

MeetingPoints find_meeting_points(const Module& module, std::uint32_t entry) {
  Graph graph;
  collect_blocks(module, entry, graph);
  std::unordered_set<std::uint32_t> declared;  // ends of constructs, and headers of loops
  for (const Block* block : graph.order) {
    declared.insert({block->merge, block->continue_target});
    if (block->merge_op == spv::Op::OpLoopMerge) declared.insert(block->label);
  }
  MeetingPoints points;
  for (std::uint32_t i = 1; i < graph.order.size(); i++) {
    if (graph.predecessors[i].size() < 2 || declared.count(graph.order[i]->label) != 0) continue;
    if (graph.dominator.empty()) find_dominators(graph);
    const Block& header = *graph.order[graph.dominator[i]];
    if (header.merge_op != spv::Op::OpSelectionMerge) continue;
    const auto merge = graph.index.find(header.merge);
    if (merge == graph.index.end() || graph.dominates(i, merge->second)) points[header.label] = graph.order[i]->label;
  }
  return points;
}

}  // namespace vitrine::spirv::front
