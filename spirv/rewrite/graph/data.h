// What a graph of the rewrites consists of.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "spirv/ir.h"

namespace vitrine::spirv::rewriting {

using ir::Op;
using ir::Src;
using ir::ValueId;

using InstId = std::uint32_t;
using BlockId = std::uint32_t;
using Slot = std::uint32_t;  ///< index of an operand in GraphData::sources
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
  /// Made behind the rules of NIR: nothing looks into it or takes it away. Needed, as steps behind it do just that with
  /// other operations of its kind; ops to tell them apart would be FAdd, FMul, FDiv and both moves once more.
  bool opaque = false;
  bool packs = false;  ///< F2Half, Half2F: an operation of its own in the reference, of packed halves
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

/// The tables of a graph.
struct GraphData {
  std::vector<Inst> insts;
  std::vector<Operand> sources;
  std::vector<Value> values;
  std::vector<Block> blocks;
  std::vector<std::unique_ptr<ir::Node>> nodes;  ///< If, Loop and intrinsic nodes; their lists and src are empty

  const Src& source(const Inst& inst, std::uint32_t index) const { return sources[inst.first + index].src; }
};

}  // namespace vitrine::spirv::rewriting
