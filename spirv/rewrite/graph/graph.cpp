// ir::Function to the flat form of the rewrites and back.
#include "spirv/rewrite/graph/graph.h"

#include "spirv/ir_walk.h"

#include <utility>

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

bool is_plain(const ir::Instr& instr) {
  return instr.op < Op::kAluCount || instr.op == Op::kConst || instr.op == Op::kVec;
}

Kind kind_of(const ir::Instr& instr) {
  const Op op = instr.op;
  if (op < Op::kAluCount) return instr.width == 32 || ir::is_selection(op) ? Kind::kAlu : Kind::kSized;
  if (op == Op::kConst) return Kind::kConst;
  return op == Op::kVec ? Kind::kVec : Kind::kIntrinsic;
}

/// A jump, behind which a list has nothing.
bool ends_list(const Inst& inst) {
  return inst.kind == Kind::kIntrinsic && (inst.op == Op::kYield || inst.op == Op::kBreak || inst.op == Op::kContinue ||
                                           inst.op == Op::kReturn || inst.op == Op::kKill);
}

/// What a step makes without saying where it comes from has the place of the instruction that it is put beside.
void take_place(ir::Origin& made, const ir::Origin& neighbour) {
  if (made.place == 0 && made.spirv_id == 0) made.place = neighbour.place;
}

/// All of an instruction but its operands.
void describe(const Inst& inst, ir::Instr& instr) {
  instr.op = inst.op;
  instr.components = inst.components;
  instr.boolean = inst.boolean;
  instr.exact = inst.exact;
  instr.result = inst.result;
  std::copy(std::begin(inst.imm), std::end(inst.imm), instr.imm.begin());
  instr.origin = inst.origin;
}

}  // namespace

Graph::Graph(ir::Function& from) : function(from) {
  values.resize(from.values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i].components = from.values[i].components;
    values[i].boolean = from.values[i].boolean;
  }
  insts.reserve(values.size() * 2);
  sources.reserve(values.size() * 4);
  root = import_list(from.body, kNone);
  if (!attached.empty()) attach_unused();
}

/// What nothing but probes reads is attached before the first step sees it. Backwards, so that whole chains are.
void Graph::attach_unused() {
  for (InstId id = static_cast<InstId>(insts.size()); id-- > 0;)
    if (!insts[id].removed && insts[id].block != kNone && becomes_attached(insts[id])) remove(id);
}

bool Graph::becomes_attached(const Inst& inst) const {
  return inst.result != ir::kNoValue && inst.kind != Kind::kIf && inst.kind != Kind::kLoop &&
         values[inst.result].uses == 0 && attached.reads(inst.result) &&
         !ir::has_effect(inst.op, inst.op == Op::kImage ? nodes[inst.node]->instr.image.get() : nullptr);
}

BlockId Graph::import_list(ir::NodeList& list, InstId owner) {
  const auto id = static_cast<BlockId>(blocks.size());
  blocks.push_back({kNone, kNone, owner});
  for (auto& node : list) import_node(std::move(node), id);
  list.clear();
  return id;
}

void Graph::add_operands(InstId inst, const std::vector<Src>& src) {
  insts[inst].first = static_cast<Slot>(sources.size());
  insts[inst].count = static_cast<std::uint32_t>(src.size());
  for (const Src& operand : src) {
    sources.push_back({operand, inst, kNone, kNone});
    if (insts[inst].op != Op::kProbe) link_use(static_cast<Slot>(sources.size() - 1));
  }
  if (insts[inst].op == Op::kProbe) attached.link(*this, inst);
}

void Graph::import_node(std::unique_ptr<ir::Node> node, BlockId block) {
  const auto id = static_cast<InstId>(insts.size());
  Inst& inst = insts.emplace_back();
  const ir::Instr& instr = node->instr;
  inst.origin = instr.origin;
  if (node->kind == ir::Node::Kind::kInstr) {
    inst.kind = kind_of(instr);
    inst.op = instr.op == Op::kCopyVar ? Op::kMov : instr.op == Op::kCopyVarB ? Op::kMovB : instr.op;
    inst.components = instr.components;
    inst.boolean = instr.boolean;
    inst.width = instr.width;
    inst.exact = instr.exact;
    inst.result = instr.result;
    std::copy(instr.imm.begin(), instr.imm.end(), inst.imm);
    if (instr.result != ir::kNoValue) values[instr.result].def = id;
    if (instr.op == Op::kProbe) {
      attached.append(*this, block, id);
    } else {
      append(block, id);
    }
    add_operands(id, instr.src);
    if (is_plain(instr)) return;
    insts[id].node = static_cast<std::uint32_t>(nodes.size());
    node->instr.src.clear();
    nodes.push_back(std::move(node));
    return;
  }
  const bool is_if = node->kind == ir::Node::Kind::kIf;
  inst.kind = is_if ? Kind::kIf : Kind::kLoop;
  inst.components = 0;
  inst.node = static_cast<std::uint32_t>(nodes.size());
  for (const ValueId result : node->results) values[result].def = id;
  for (const ValueId param : node->params) values[param].def = id;
  for (const ValueId param : node->continue_params) values[param].def = id;
  append(block, id);
  add_operands(id, is_if ? std::vector<Src>{node->condition} : node->init);
  nodes.push_back(std::move(node));
  ir::Node& kept = *nodes.back();
  const BlockId first = import_list(is_if ? kept.then_list : kept.body, id);
  const BlockId second = import_list(is_if ? kept.else_list : kept.continuing, id);
  insts[id].child[0] = first;
  insts[id].child[1] = second;
}

void Graph::write_back() {
  function.body = export_block(root);
  function.values.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) function.values[i] = {values[i].components, values[i].boolean};
}

ir::NodeList Graph::export_block(BlockId block) {
  ir::NodeList list;
  for (InstId id = blocks[block].head; id != kNone; id = insts[id].next) list.push_back(export_inst(id));
  return list;
}

std::unique_ptr<ir::Node> Graph::export_inst(InstId id) {
  Inst& inst = insts[id];
  std::unique_ptr<ir::Node> node = inst.node == kNone ? std::make_unique<ir::Node>() : std::move(nodes[inst.node]);
  std::vector<Src> operands(inst.count);
  for (std::uint32_t i = 0; i < inst.count; ++i) operands[i] = source(inst, i);
  if (inst.kind == Kind::kIf) {
    node->condition = operands[0];
    node->then_list = export_block(inst.child[0]);
    node->else_list = export_block(inst.child[1]);
    return node;
  }
  if (inst.kind == Kind::kLoop) {
    node->init = std::move(operands);
    node->body = export_block(inst.child[0]);
    node->continuing = export_block(inst.child[1]);
    return node;
  }
  node->instr.src = std::move(operands);
  describe(inst, node->instr);
  return node;
}

InstId Graph::create(Kind kind, Op op, std::uint8_t components, bool boolean, std::uint32_t count) {
  const auto id = static_cast<InstId>(insts.size());
  Inst& inst = insts.emplace_back();
  inst.kind = kind;
  inst.op = op;
  inst.components = components;
  inst.boolean = boolean;
  inst.first = static_cast<Slot>(sources.size());
  inst.count = count;
  for (std::uint32_t i = 0; i < count; ++i) sources.push_back({Src{}, id, kNone, kNone});
  if (components != 0) {
    inst.result = static_cast<ValueId>(values.size());
    values.push_back({id, kNone, kNone, 0, components, boolean});
  }
  return id;
}

InstId Graph::create_const(std::uint8_t components, bool boolean, const std::uint32_t* bits) {
  const InstId id = create(Kind::kConst, Op::kConst, components, boolean, 0);
  std::copy(bits, bits + components, insts[id].imm);
  return id;
}

void Graph::set_source(InstId inst, std::uint32_t index, Src src) {
  const Slot slot = insts[inst].first + index;
  if (sources[slot].src.value != ir::kNoValue) unlink_use(slot);
  sources[slot].src = src;
  link_use(slot);
}

void Graph::set_operands(InstId inst, const std::vector<Src>& src) {
  const Slot first = insts[inst].first;
  for (std::uint32_t i = 0; i < insts[inst].count; ++i) unlink_use(first + i);
  if (src.size() > insts[inst].count) return add_operands(inst, src);
  insts[inst].count = static_cast<std::uint32_t>(src.size());
  for (std::uint32_t i = 0; i < insts[inst].count; ++i) {
    sources[first + i].src = src[i];
    link_use(first + i);
  }
}

void Graph::link_use(Slot slot) {
  Operand& operand = sources[slot];
  Value& value = values[operand.src.value];
  operand.next = kNone;
  operand.previous = value.last_use;
  (value.last_use == kNone ? value.first_use : sources[value.last_use].next) = slot;
  value.last_use = slot;
  ++value.uses;
}

void Graph::unlink_use(Slot slot) {
  const Operand& operand = sources[slot];
  Value& value = values[operand.src.value];
  (operand.previous == kNone ? value.first_use : sources[operand.previous].next) = operand.next;
  (operand.next == kNone ? value.last_use : sources[operand.next].previous) = operand.previous;
  --value.uses;
}

void Graph::insert_before(InstId position, InstId inst) {
  take_place(insts[inst].origin, insts[position].origin);
  const BlockId block = insts[position].block;
  const InstId before = insts[position].previous;
  insts[inst].block = block;
  insts[inst].next = position;
  insts[inst].previous = before;
  insts[position].previous = inst;
  (before == kNone ? blocks[block].head : insts[before].next) = inst;
}

void Graph::insert_after(InstId position, InstId inst) {
  take_place(insts[inst].origin, insts[position].origin);
  const InstId after = insts[position].next;
  if (after == kNone) {
    append(insts[position].block, inst);
  } else {
    insert_before(after, inst);
  }
}

void Graph::append(BlockId block, InstId inst) {
  if (!attached.empty()) attached.settle(block, inst);
  insts[inst].block = block;
  insts[inst].next = kNone;
  insts[inst].previous = blocks[block].tail;
  (blocks[block].tail == kNone ? blocks[block].head : insts[blocks[block].tail].next) = inst;
  blocks[block].tail = inst;
}

void Graph::replace_uses(ValueId from, ValueId to) {
  while (values[from].first_use != kNone) {
    const Slot slot = values[from].first_use;
    unlink_use(slot);
    sources[slot].src.value = to;
    link_use(slot);
  }
  if (!attached.empty()) attached.replace_uses(*this, from, to);
}

void Graph::unlink(InstId inst) {
  const Inst& gone = insts[inst];
  (gone.previous == kNone ? blocks[gone.block].head : insts[gone.previous].next) = gone.next;
  (gone.next == kNone ? blocks[gone.block].tail : insts[gone.next].previous) = gone.previous;
}

void Graph::remove(InstId inst) {
  const bool kept = !attached.empty() && becomes_attached(insts[inst]);
  if (!attached.empty()) attached.leave(*this, inst, kept);
  unlink(inst);
  for (std::uint32_t i = 0; i < insts[inst].count; ++i) unlink_use(insts[inst].first + i);
  if (kept) attached.link(*this, inst);
  insts[inst].removed = true;
  if (!attached.empty())
    for (const BlockId child : insts[inst].child)
      if (child != kNone) attached.forget(*this, child);
  for (const BlockId child : insts[inst].child)
    if (child != kNone)
      while (blocks[child].head != kNone) remove(blocks[child].head);
}

void Graph::move_before(InstId position, InstId inst) {
  if (!attached.empty()) attached.leave(*this, inst, false);
  unlink(inst);
  insert_before(position, inst);
}

void Graph::move_after(InstId position, InstId inst) {
  if (!attached.empty()) attached.leave(*this, inst, false);
  unlink(inst);
  insert_after(position, inst);
}

void Graph::splice_before(InstId position, BlockId block) { move_range(position, blocks[block].head, kNone, block); }

void Graph::move_range_before(InstId position, InstId first, InstId last) { move_range(position, first, last, kNone); }

void Graph::move_range(InstId position, InstId first, InstId last, BlockId block) {
  if (!attached.empty()) attached.splice(position, first, last, block);
  for (InstId id = first; id != last;) {
    const InstId next = insts[id].next;
    std::vector<InstId> with = attached.take(id);
    unlink(id);
    insert_before(position, id);
    attached.give(id, std::move(with));
    id = next;
  }
}

void Graph::release_attached(const std::vector<Probe>& probes) {
  const Attachments released = std::exchange(attached, {});
  std::vector<InstId> placed;
  const auto place = [&](InstId id, auto&& insert) {
    insts[id].removed = false;
    placed.push_back(id);
    insert();
    for (std::uint32_t i = 0; i < insts[id].count; ++i) link_use(insts[id].first + i);
  };
  const auto visit = [&](const auto& self, BlockId block) -> void {
    for (InstId at = blocks[block].head; at != kNone; at = insts[at].next) {
      for (const InstId id : released.in_front(at)) place(id, [&] { insert_before(at, id); });
      for (const BlockId child : insts[at].child)
        if (child != kNone) self(self, child);
    }
    const InstId tail = blocks[block].tail;
    const bool ends = tail != kNone && ends_list(insts[tail]);
    for (const InstId id : released.at_end(block))
      place(id, [&] { ends ? insert_before(tail, id) : append(block, id); });
  };
  visit(visit, root);
  for (const InstId id : placed) repair_lost_operands(id, probes);
}

bool Graph::is_lost(ir::ValueId value) const {
  const InstId def = values[value].def;
  return def == kNone || insts[def].removed;
}

bool Graph::has_lost_operand(InstId id) const {
  for (std::uint32_t i = 0; i < insts[id].count; ++i)
    if (is_lost(source(insts[id], i).value)) return true;
  return false;
}

/// A probe, or what only probes read, that has lost operands with a loop that is gone: a check of an operation is
/// dropped; an index is ~0; a write acts, whatever its condition, and nothing else does; all else is zero.
void Graph::repair_lost_operands(InstId id, const std::vector<Probe>& probes) {
  if (!has_lost_operand(id)) return;
  if (insts[id].op != Op::kProbe) return replace_lost_operands(id, [](std::uint32_t) { return 0u; });
  const ir::Instr& instr = nodes[insts[id].node]->instr;
  const Probe::Kind kind = probes[instr.data[0]].kind;
  if (kind == Probe::Kind::kOperation || kind == Probe::Kind::kChoose) return remove(id);
  const bool writes = kind == Probe::Kind::kWrite, indexed = writes || kind == Probe::Kind::kRead;
  replace_lost_operands(id, [&](std::uint32_t operand) -> std::uint32_t {
    if (operand >= instr.data[1]) return indexed ? ~0u : 0;
    const bool holds = (instr.data[2 + operand / 32] >> operand % 32 & 1) != 0;
    return holds == writes ? 1 : 0;
  });
}

template <class F>
void Graph::replace_lost_operands(InstId id, F&& word) {
  for (std::uint32_t i = 0; i < insts[id].count; ++i) {
    const Src src = source(insts[id], i);
    if (!is_lost(src.value)) continue;
    const std::uint32_t value = word(i);
    const std::uint32_t words[4] = {value, value, value, value};
    const InstId made = create_const(values[src.value].components, values[src.value].boolean, words);
    insert_before(blocks[root].head, made);
    set_source(id, i, {insts[made].result, src.swizzle});
  }
}

namespace {

ir::NodeList copy_block(const Graph& graph, BlockId block);

std::unique_ptr<ir::Node> copy_inst(const Graph& graph, const Inst& inst) {
  auto node = std::make_unique<ir::Node>();
  if (inst.node != kNone) {
    const ir::Node& details = *graph.nodes[inst.node];
    node->kind = details.kind;
    node->instr = details.instr;
    node->params = details.params;
    node->continue_params = details.continue_params;
    node->results = details.results;
  }
  std::vector<Src> operands;
  for (std::uint32_t i = 0; i < inst.count; ++i) operands.push_back(graph.source(inst, i));
  if (inst.kind == Kind::kIf) {
    node->condition = operands[0];
    node->then_list = copy_block(graph, inst.child[0]);
    node->else_list = copy_block(graph, inst.child[1]);
  } else if (inst.kind == Kind::kLoop) {
    node->init = std::move(operands);
    node->body = copy_block(graph, inst.child[0]);
    node->continuing = copy_block(graph, inst.child[1]);
  } else {
    node->instr.src = std::move(operands);
    describe(inst, node->instr);
    node->instr.width = inst.width;
  }
  return node;
}

ir::NodeList copy_block(const Graph& graph, BlockId block) {
  ir::NodeList list;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next)
    list.push_back(copy_inst(graph, graph.insts[id]));
  return list;
}

}  // namespace

ir::Function snapshot(const Graph& graph) {
  ir::Function function;
  function.body = copy_block(graph, graph.root);
  for (const Value& value : graph.values) function.values.push_back({value.components, value.boolean});
  return function;
}

}  // namespace vitrine::spirv::rewriting
