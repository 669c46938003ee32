// The form the rewrites work on: ir::Function flattened to arrays, with a use list per value, so that a value can be
// replaced in the time of its uses. Blocks are doubly linked lists of instructions; If and Loop are instructions that
// own blocks. Values keep their ids; import and export cost one walk each (lavapipe-optimizer.md 2.1).
#pragma once

#include <cstdint>
#include <vector>

#include "spirv/rewrite/graph/attached.h"

namespace vitrine::spirv::rewriting {

class Graph : public GraphData {
 public:
  /// Takes the function's body; write_back() returns it.
  explicit Graph(ir::Function& function);
  void write_back();

  BlockId root = 0;
  Attachments attached;      ///< what is computed for observers alone
  bool first_round = false;  ///< the first round of a phase of passes.def runs
  ir::Function& function;

  const Inst* def(ValueId value) const {
    const InstId id = values[value].def;
    return id == kNone ? nullptr : &insts[id];
  }
  /// The constant that defines `value`, or null.
  const Inst* constant(ValueId value) const {
    const Inst* inst = def(value);
    return inst && inst->kind == Inst::Kind::kConst ? inst : nullptr;
  }

  /// A new instruction with `count` operands, in no block yet. References to insts and sources become invalid.
  InstId create(Inst::Kind kind, Op op, std::uint8_t components, bool boolean, std::uint32_t count);
  InstId create_const(std::uint8_t components, bool boolean, const std::uint32_t* bits);
  void set_source(InstId inst, std::uint32_t index, Src src);
  /// Gives the instruction another list of operands.
  void set_operands(InstId inst, const std::vector<Src>& src);
  void insert_before(InstId position, InstId inst);
  void insert_after(InstId position, InstId inst);
  void append(BlockId block, InstId inst);

  /// Every use of `from` becomes a use of `to` (same components).
  void replace_uses(ValueId from, ValueId to);
  /// Takes the instruction out of its block and its operands out of the use lists.
  void remove(InstId inst);
  void move_before(InstId position, InstId inst);
  void move_after(InstId position, InstId inst);
  /// Moves all instructions of `block` in front of `position`.
  void splice_before(InstId position, BlockId block);
  /// Moves the instructions [first, last) of one block in front of `position`, with what is attached to them.
  void move_range_before(InstId position, InstId first, InstId last);
  /// Puts what is attached into the blocks, where it is code like all other. `probes`: those of the function. A check
  /// of an operation that lost an operand is dropped.
  void release_attached(const std::vector<Probe>& probes);

 private:
  BlockId import_list(ir::NodeList& list, InstId owner);
  void import_node(std::unique_ptr<ir::Node> node, BlockId block);
  void add_operands(InstId inst, const std::vector<Src>& src);
  ir::NodeList export_block(BlockId block);
  std::unique_ptr<ir::Node> export_inst(InstId id);
  void link_use(Slot slot);
  void unlink_use(Slot slot);
  void unlink(InstId inst);
  void move_range(InstId position, InstId first, InstId last, BlockId block);
  void attach_unused();
  bool is_lost(ir::ValueId value) const;
  bool has_lost_operand(InstId id) const;
  void repair_lost_operands(InstId id, const std::vector<Probe>& probes);
  template <class F>
  void replace_lost_operands(InstId id, F&& word);
  bool becomes_attached(const Inst& inst) const;
};

/// A copy as a tree, with its body and values alone: what to print and verify while the graph is being rewritten.
ir::Function snapshot(const Graph& graph);

/// Calls f(id) for every instruction in program order, an If or Loop before what it contains. f may remove or replace
/// the instruction it gets and insert around it.
template <class F>
void for_each_inst(Graph& graph, BlockId block, F& f) {
  for (InstId id = graph.blocks[block].head; id != kNone;) {
    const InstId next = graph.insts[id].next;
    f(id);
    for (const int side : {0, 1}) {
      const BlockId child = graph.insts[id].child[side];
      if (!graph.insts[id].removed && child != kNone) for_each_inst(graph, child, f);
    }
    id = next;
  }
}

}  // namespace vitrine::spirv::rewriting
