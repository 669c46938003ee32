// What instructions do besides computing, and what they read.
#include "spirv/rewrite/graph/effects.h"

#include "spirv/ir_walk.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

bool is_effect(const Graph& graph, const Inst& inst) {
  if (inst.op == Op::kYield || inst.op == Op::kBreak || inst.op == Op::kContinue) return true;
  return ir::has_effect(inst.op, inst.op == Op::kImage ? graph.nodes[inst.node]->instr.image.get() : nullptr);
}

bool block_is_pure(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.op == Op::kYield && inst.kind == Kind::kIntrinsic) continue;
    if (!is_pure(graph, inst)) return false;
  }
  return true;
}

}  // namespace

unsigned components_read(const Graph& graph, const Inst& user, std::uint32_t index) {
  switch (user.kind) {
    case Kind::kAlu:
    case Kind::kSized:
      return operand_components(user, index);
    case Kind::kVec:
    case Kind::kIf:
      return 1;
    case Kind::kIntrinsic:
      break;
    default:
      return 0;
  }
  switch (user.op) {
    case Op::kStoreOutput:
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kArrayLength:
    case Op::kLoadShared:
    case Op::kLoadArray:
    case Op::kStoreArray:
    case Op::kAtomicStorage:
    case Op::kAtomicShared:
    case Op::kLoadGlobal:
    case Op::kAtomicGlobal:
    case Op::kReadFirst:
    case Op::kBallot:
    case Op::kShuffle:
    case Op::kReduce:
    case Op::kProbe:
      return 1;
    case Op::kStoreStorage:
      return index < 2 ? 1 : 0;
    case Op::kStoreShared:
      return index < 1 ? 1 : 0;
    case Op::kStoreGlobal:
      return index < 3 ? 1 : 0;
    case Op::kYield:
    case Op::kBreak:
    case Op::kContinue:
      return 0;
    default:
      return graph.values[graph.source(user, index).value].components == 1 ? 1 : 0;
  }
}

bool is_pure(const Graph& graph, const Inst& inst) {
  switch (inst.kind) {
    case Kind::kAlu:
    case Kind::kSized:
    case Kind::kConst:
    case Kind::kVec:
      return true;
    case Kind::kIf:
      return block_is_pure(graph, inst.child[0]) && block_is_pure(graph, inst.child[1]);
    case Kind::kLoop:
      return false;
    case Kind::kIntrinsic:
      return !is_effect(graph, inst);
  }
  return false;
}

}  // namespace vitrine::spirv::rewriting
