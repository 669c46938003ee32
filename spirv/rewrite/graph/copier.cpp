// See copier.h.
#include "spirv/rewrite/graph/copier.h"

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {

Src Copier::translated(Src src) const {
  const auto entry = map_.find(src.value);
  if (entry == map_.end()) return src;
  Src result{entry->second.value, {}};
  for (unsigned c = 0; c < 4; ++c) result.swizzle[c] = entry->second.swizzle[src.swizzle[c]];
  return result;
}

void Copier::copy(InstId first, InstId last, BlockId to) {
  for (InstId id = first; id != last; id = graph_.insts[id].next) {
    copy_attached(graph_.attached.in_front(id), to);
    const InstId made = copy_inst(id);
    graph_.append(to, made);
  }
  if (last == kNone && first != kNone) copy_attached(graph_.attached.at_end(graph_.insts[first].block), to);
  if (last != kNone) copy_attached(graph_.attached.in_front(last), to);
}

void Copier::copy_attached(const std::vector<InstId>& list, BlockId to) {
  for (const InstId id : std::vector<InstId>(list)) {
    const Inst original = graph_.insts[id];
    const auto made = static_cast<InstId>(graph_.insts.size());
    graph_.insts.push_back(original);
    const std::vector<Src> operands = operands_of(id);
    graph_.attached.set_operands(graph_, made, operands);
    if (original.result != ir::kNoValue) {
      const ValueId result = fresh(original.result);
      graph_.insts[made].result = result;
      graph_.values[result].def = made;
    }
    if (original.node != kNone) copy_node(made, original.node);
    graph_.attached.append(graph_, to, made);
  }
}

std::vector<Src> Copier::copy_branch(BlockId block, BlockId to) {
  const InstId last = graph_.blocks[block].tail;
  copy(graph_.blocks[block].head, last, to);
  return operands_of(last);
}

void Copier::bind_all(const std::vector<ValueId>& values, const std::vector<Src>& sources) {
  for (std::size_t i = 0; i < values.size() && i < sources.size(); ++i) bind(values[i], sources[i]);
}

std::vector<Src> Copier::operands_of(InstId id) const {
  std::vector<Src> result;
  for (std::uint32_t i = 0; i < graph_.insts[id].count; ++i)
    result.push_back(translated(graph_.source(graph_.insts[id], i)));
  return result;
}

void Copier::hand_over_attached() {
  if (graph_.attached.empty()) return;
  for (const auto& [value, copy] : map_) graph_.attached.replace_uses(graph_, value, copy);
}

ValueId Copier::fresh(ValueId value) {
  const Value like = graph_.values[value];
  const auto id = static_cast<ValueId>(graph_.values.size());
  graph_.values.push_back({kNone, kNone, kNone, 0, like.components, like.boolean});
  map_[value] = {id, {0, 1, 2, 3}};
  return id;
}

InstId Copier::copy_inst(InstId id) {
  const Inst original = graph_.insts[id];
  const auto made = static_cast<InstId>(graph_.insts.size());
  graph_.insts.push_back(original);
  const std::vector<Src> operands = operands_of(id);
  graph_.insts[made].count = 0;
  graph_.insts[made].next = graph_.insts[made].previous = kNone;
  graph_.set_operands(made, operands);
  if (original.result != ir::kNoValue) {
    const ValueId result = fresh(original.result);
    graph_.insts[made].result = result;
    graph_.values[result].def = made;
  }
  if (original.node != kNone) copy_node(made, original.node);
  for (const unsigned side : {0u, 1u}) {
    if (original.child[side] == kNone) continue;
    const BlockId block = copy_block(original.child[side], made);
    graph_.insts[made].child[side] = block;
  }
  return made;
}

void Copier::copy_node(InstId made, std::uint32_t from) {
  auto node = std::make_unique<ir::Node>();
  const ir::Node& original = *graph_.nodes[from];
  node->kind = original.kind;
  node->instr = original.instr;
  const auto renew = [&](const std::vector<ValueId>& values, std::vector<ValueId>& copies) {
    for (const ValueId value : values) {
      copies.push_back(fresh(value));
      graph_.values[copies.back()].def = made;
    }
  };
  renew(original.params, node->params);
  renew(original.continue_params, node->continue_params);
  renew(original.results, node->results);
  graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
  graph_.nodes.push_back(std::move(node));
}

BlockId Copier::copy_block(BlockId from, InstId owner) {
  const auto block = static_cast<BlockId>(graph_.blocks.size());
  graph_.blocks.push_back({kNone, kNone, owner});
  for (InstId id = graph_.blocks[from].head; id != kNone; id = graph_.insts[id].next) {
    copy_attached(graph_.attached.in_front(id), block);
    const InstId made = copy_inst(id);
    graph_.append(block, made);
  }
  copy_attached(graph_.attached.at_end(from), block);
  return block;
}

void move_attached_into_sides(Graph& graph, InstId branch, InstId position) {
  if (graph.attached.in_front(position).empty()) return;
  const std::vector<ValueId> results = graph.nodes[graph.insts[branch].node]->results;
  for (const unsigned side : {0u, 1u}) {
    const BlockId block = graph.insts[branch].child[side];
    if (!ends_in(graph, block, Op::kYield)) continue;
    Copier copier(graph);
    copier.bind_all(results, copier.operands_of(graph.blocks[block].tail));
    copier.copy(position, position, block);
  }
  graph.attached.drop(graph, position);
}

}  // namespace vitrine::spirv::rewriting
