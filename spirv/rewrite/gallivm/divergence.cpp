// See divergence.h. Everything starts as shared by all invocations, and only ever becomes different.
#include "spirv/rewrite/gallivm/divergence.h"

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {

using Kind = Inst::Kind;

Divergence::Divergence(const Graph& graph)
    : graph_(graph), varies_(graph.values.size(), false), divides_(graph.insts.size(), false) {
  do {
    changed_ = false;
    visit_block(graph.root);
  } while (changed_);
}

bool Divergence::divides(BlockId block) const {
  if (returns_) return true;
  for (InstId owner = graph_.blocks[block].owner; owner != kNone;
       owner = graph_.blocks[graph_.insts[owner].block].owner)
    if (divides_[owner]) return true;
  return false;
}

void Divergence::vary(ValueId value) {
  if (value == ir::kNoValue || varies_[value]) return;
  varies_[value] = changed_ = true;
}

void Divergence::split(InstId owner) {
  if (divides_[owner]) return;
  divides_[owner] = changed_ = true;
}

bool Divergence::any_operand_varies(const Inst& inst) const {
  for (std::uint32_t i = 0; i < inst.count; ++i)
    if (varies_[graph_.source(inst, i).value]) return true;
  return false;
}

bool Divergence::varies(const Inst& inst) const {
  if (inst.kind != Kind::kIntrinsic) return any_operand_varies(inst);
  switch (inst.op) {
    case Op::kUndef:
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kArrayLength:
      return any_operand_varies(inst);
    default:
      return true;
  }
}

void Divergence::join(const std::vector<ValueId>& values, const Inst& way, bool separate) {
  for (std::uint32_t i = 0; i < values.size() && i < way.count; ++i)
    if (separate || varies_[graph_.source(way, i).value]) vary(values[i]);
}

void Divergence::visit_block(BlockId block) {
  for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) visit(id);
}

void Divergence::visit(InstId id) {
  const Inst& inst = graph_.insts[id];
  if (inst.kind == Kind::kIf) {
    if (varies_[graph_.source(inst, 0).value]) split(id);
    for (const BlockId child : inst.child) {
      visit_block(child);
      if (ends_in(graph_, child, Op::kYield))
        join(graph_.nodes[inst.node]->results, graph_.insts[graph_.blocks[child].tail], divides_[id]);
    }
  } else if (inst.kind == Kind::kLoop) {
    join(graph_.nodes[inst.node]->params, inst, false);
    visit_block(inst.child[0]);
    if (ends_in(graph_, inst.child[0], Op::kYield))
      join(graph_.nodes[inst.node]->params, graph_.insts[graph_.blocks[inst.child[0]].tail], false);
  } else if (is_jump(inst, Op::kReturn) || leaves_loop(inst)) {
    visit_jump(inst);
  } else if (inst.result != ir::kNoValue && varies(inst)) {
    vary(inst.result);
  }
}

/// Lanes that leave one by one divide the loop, those that end one by one all that follows.
void Divergence::visit_jump(const Inst& inst) {
  bool divided = false;
  InstId owner = graph_.blocks[inst.block].owner;
  for (; owner != kNone; owner = graph_.blocks[graph_.insts[owner].block].owner) {
    if (graph_.insts[owner].kind == Kind::kLoop && inst.op != Op::kReturn) break;
    divided = divided || divides_[owner];
  }
  if (inst.op == Op::kReturn) {
    if (divided && !returns_) returns_ = changed_ = true;
    return;
  }
  if (owner == kNone) return;
  if (divided) split(owner);
  const ir::Node& loop = *graph_.nodes[graph_.insts[owner].node];
  const bool leaves = inst.op == Op::kBreak;
  join(leaves ? loop.results : loop.params, inst, leaves && divides_[owner]);
}

}  // namespace vitrine::spirv::rewriting
