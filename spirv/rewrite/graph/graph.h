// The form the rewrites work on: ir::Function flattened to arrays, with a use list per value, so that a value can be
// replaced in the time of its uses. Blocks are doubly linked lists of instructions; If and Loop are instructions that
// own blocks. Values keep their ids; import and export cost one walk each (lavapipe-optimizer.md 2.1).
#pragma once

#include <cstdint>
#include <vector>

#include "spirv/ir.h"

namespace vitrine::spirv::rewriting {

using ir::Op;
using ir::Src;
using ir::ValueId;

using InstId = std::uint32_t;
using BlockId = std::uint32_t;
using Slot = std::uint32_t;  ///< index of an operand in Graph::sources
inline constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// An operand and its place in the use list of its value.
struct Operand {
  Src src;
  InstId user = kNone;
  Slot next = kNone, previous = kNone;  ///< use list
};

struct Inst {
  enum class Kind : std::uint8_t {
    kAlu,        ///< one of ops.def
    kSized,      ///< one of ops.def on numbers of `width` bits, not 32 (ir::Instr::width)
    kConst,      ///< imm
    kVec,        ///< component i = operand i
    kIntrinsic,  ///< everything else of intrinsics.def, jumps included; details in `node`
    kIf,         ///< operand 0: condition; child[0] then, child[1] else; results in `node`
    kLoop,       ///< operands: initial values; child[0] body, child[1] continuing
  };
  Kind kind = Kind::kAlu;
  Op op = Op::kMov;
  std::uint8_t components = 1;
  std::uint8_t width = 32;  ///< ir::Instr::width; of a kAlu, too, that selects between numbers of another width
  bool boolean = false;
  bool exact = false;
  bool opaque = false;  ///< made behind the rules of NIR: nothing looks into it or takes it away
  bool packs = false;   ///< F2Half, Half2F: an operation of its own in the reference, of packed halves
  bool removed = false;
  ValueId result = ir::kNoValue;
  Slot first = 0;  ///< operands are sources[first, first + count)
  std::uint32_t count = 0;
  BlockId block = kNone;
  InstId next = kNone, previous = kNone;
  BlockId child[2] = {kNone, kNone};
  std::uint32_t imm[4] = {};
  std::uint32_t node = kNone;  ///< index in Graph::nodes: what does not fit here
  ir::Origin origin;
};

/// An operation of ops.def, whatever the width of its numbers.
inline bool computes(const Inst& inst) { return inst.kind == Inst::Kind::kAlu || inst.kind == Inst::Kind::kSized; }

/// Components that an operation of ops.def reads of operand `index`.
inline unsigned operand_components(const Inst& inst, std::uint32_t index) {
  if (inst.width != 64 && inst.op < Op::kExecutedCount) return inst.components;
  return ir::components_read(inst.op, inst.width, inst.components, index);
}

struct Block {
  InstId head = kNone, tail = kNone;
  InstId owner = kNone;  ///< the If or Loop, kNone: the function
};

struct Value {
  InstId def = kNone;
  Slot first_use = kNone, last_use = kNone;
  std::uint32_t uses = 0;
  std::uint8_t components = 1;
  bool boolean = false;
};

class Graph {
 public:
  /// Takes the function's body; write_back() returns it.
  explicit Graph(ir::Function& function);
  void write_back();

  std::vector<Inst> insts;
  std::vector<Operand> sources;
  std::vector<Value> values;
  std::vector<Block> blocks;
  std::vector<std::unique_ptr<ir::Node>> nodes;  ///< If, Loop and intrinsic nodes; their lists and src are empty
  BlockId root = 0;
  bool first_round = false;  ///< the first round of a phase of passes.def runs
  ir::Function& function;

  const Src& source(const Inst& inst, std::uint32_t index) const { return sources[inst.first + index].src; }
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

 private:
  BlockId import_list(ir::NodeList& list, InstId owner);
  void import_node(std::unique_ptr<ir::Node> node, BlockId block);
  void add_operands(InstId inst, const std::vector<Src>& src);
  ir::NodeList export_block(BlockId block);
  std::unique_ptr<ir::Node> export_inst(InstId id);
  void link_use(Slot slot);
  void unlink_use(Slot slot);
  void unlink(InstId inst);
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
