// See attached.h.
#include "spirv/rewrite/graph/attached.h"

namespace vitrine::spirv::rewriting {
namespace {

const std::vector<InstId> kNothing;

/// Conditions that one probe may have: bits of Instr::data[2] and [3].
constexpr std::uint32_t kMaxGuards = 64;

void append_all(std::vector<InstId>& to, const std::vector<InstId>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

const std::vector<InstId>& Attachments::in_front(InstId inst) const {
  const auto found = in_front_.find(inst);
  return found == in_front_.end() ? kNothing : found->second;
}

const std::vector<InstId>& Attachments::at_end(BlockId block) const {
  const auto found = at_end_.find(block);
  return found == at_end_.end() ? kNothing : found->second;
}

void Attachments::append(GraphData& graph, BlockId block, InstId inst) {
  graph.insts[inst].block = block;
  at_end_[block].push_back(inst);
}

void Attachments::settle(BlockId block, InstId next) {
  const auto found = at_end_.find(block);
  if (found == at_end_.end()) return;
  append_all(in_front_[next], found->second);
  at_end_.erase(found);
}

void Attachments::leave(GraphData& graph, InstId inst, bool keep) {
  std::vector<InstId> list = take(inst);
  if (keep) list.push_back(inst);
  if (list.empty()) return;
  const InstId next = graph.insts[inst].next;
  std::vector<InstId>& there = next == kNone ? at_end_[graph.insts[inst].block] : in_front_[next];
  there.insert(there.begin(), list.begin(), list.end());
}

std::vector<InstId> Attachments::take(InstId inst) {
  const auto found = in_front_.find(inst);
  if (found == in_front_.end()) return {};
  std::vector<InstId> list = std::move(found->second);
  in_front_.erase(found);
  return list;
}

void Attachments::give(InstId inst, std::vector<InstId> list) {
  if (!list.empty()) in_front_[inst] = std::move(list);
}

void Attachments::forget_list(GraphData& graph, const std::vector<InstId>& list) {
  for (const InstId id : list) unlink(graph, id);
}

void Attachments::forget(GraphData& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    forget_list(graph, take(id));
    for (const BlockId child : graph.insts[id].child)
      if (child != kNone) forget(graph, child);
  }
  const auto end = at_end_.find(block);
  if (end == at_end_.end()) return;
  forget_list(graph, end->second);
  at_end_.erase(block);
}

void Attachments::splice(InstId position, InstId first, InstId last, BlockId block) {
  std::vector<InstId> before = take(position), behind;
  if (last != kNone) {
    behind = take(last);
  } else if (const auto end = at_end_.find(block); end != at_end_.end()) {
    behind = std::move(end->second);
    at_end_.erase(end);
  }
  if (first == last) {
    append_all(before, behind);
    return give(position, std::move(before));
  }
  append_all(before, take(first));
  give(first, std::move(before));
  give(position, std::move(behind));
}

void Attachments::guard_list(GraphData& graph, const std::vector<InstId>& list, Src condition, bool holds) {
  for (const InstId id : list) {
    if (graph.insts[id].op != Op::kProbe) continue;
    ir::Instr& instr = graph.nodes[graph.insts[id].node]->instr;
    const std::uint32_t number = instr.data[1];
    if (number == kMaxGuards) continue;
    ++instr.data[1];
    if (holds) instr.data[2 + number / 32] |= 1u << number % 32;
    std::vector<Src> operands;
    for (std::uint32_t i = 0; i < graph.insts[id].count; ++i) operands.push_back(graph.source(graph.insts[id], i));
    operands.insert(operands.begin() + number, {condition.value, {condition.swizzle[0]}});
    unlink(graph, id);
    set_operands(graph, id, operands);
  }
}

void Attachments::guard(GraphData& graph, BlockId block, Src condition, bool holds) {
  if (empty()) return;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    guard_list(graph, in_front(id), condition, holds);
    for (const BlockId child : graph.insts[id].child)
      if (child != kNone) guard(graph, child, condition, holds);
  }
  guard_list(graph, at_end(block), condition, holds);
}

void Attachments::keep_branches(GraphData& graph, InstId branch) {
  if (empty()) return;
  const Src condition = graph.source(graph.insts[branch], 0);
  std::vector<InstId> kept = take(branch);
  for (const unsigned side : {0u, 1u}) {
    const BlockId block = graph.insts[branch].child[side];
    guard(graph, block, condition, side == 0);
    for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
      if (graph.insts[id].kind == Inst::Kind::kIf) keep_branches(graph, id);
      append_all(kept, take(id));
    }
    if (const auto end = at_end_.find(block); end != at_end_.end()) {
      append_all(kept, end->second);
      at_end_.erase(end);
    }
  }
  give(branch, std::move(kept));
}

bool Attachments::any_in(const GraphData& graph, BlockId block) const {
  if (empty()) return false;
  if (!at_end(block).empty()) return true;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    if (!in_front(id).empty()) return true;
    for (const BlockId child : graph.insts[id].child)
      if (child != kNone && any_in(graph, child)) return true;
  }
  return false;
}

void Attachments::set_operands(GraphData& graph, InstId inst, const std::vector<Src>& src) {
  graph.insts[inst].first = static_cast<Slot>(graph.sources.size());
  graph.insts[inst].count = static_cast<std::uint32_t>(src.size());
  for (const Src& operand : src) graph.sources.push_back({operand, inst, kNone, kNone});
  link(graph, inst);
}

void Attachments::link(GraphData& graph, InstId user) {
  const Inst& inst = graph.insts[user];
  for (std::uint32_t i = 0; i < inst.count; ++i) uses_.emplace(graph.sources[inst.first + i].src.value, inst.first + i);
}

void Attachments::unlink(GraphData& graph, InstId user) {
  const Inst& inst = graph.insts[user];
  for (std::uint32_t i = 0; i < inst.count; ++i) {
    const auto [first, last] = uses_.equal_range(graph.sources[inst.first + i].src.value);
    for (auto at = first; at != last;) at = at->second == inst.first + i ? uses_.erase(at) : std::next(at);
  }
}

void Attachments::replace_uses(GraphData& graph, ir::ValueId from, Src to) {
  const auto [first, last] = uses_.equal_range(from);
  std::vector<Slot> slots;
  for (auto at = first; at != last; ++at) slots.push_back(at->second);
  uses_.erase(first, last);
  for (const Slot slot : slots) {
    Src& src = graph.sources[slot].src;
    src.value = to.value;
    for (std::uint8_t& component : src.swizzle) component = to.swizzle[component];
    uses_.emplace(to.value, slot);
  }
}

}  // namespace vitrine::spirv::rewriting
