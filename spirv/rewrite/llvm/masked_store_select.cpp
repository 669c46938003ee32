// Which branches the reference's optimiser sees as selections: it masks what each branch writes and joins both.
#include "spirv/rewrite/llvm/masked_store_select.h"

#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Operations that the reference computes as floats; it keeps the results of others, and what it loads from buffers,
/// as integers.
bool computes_float(const Inst& inst) {
  if (inst.kind == Kind::kIntrinsic)
    return inst.op == Op::kLoadInput || inst.op == Op::kLoadPush || inst.op == Op::kLoadUniform;
  if (inst.kind != Kind::kAlu || ir::alu_info(inst.op).result != 'F') return false;
  switch (inst.op) {
    case Op::kFSin:
    case Op::kFCos:
    case Op::kFSign:
    case Op::kB2F:
      return false;
    default:
      return true;
  }
}

/// The value is computed as a float, and nothing but one user reads its bits.
bool is_float_for_one(const Graph& graph, Src src) {
  const Inst* inst = graph.def(src.value);
  if (!inst || !computes_float(*inst)) return false;
  if (inst->kind == Kind::kIntrinsic) return true;
  std::uint32_t users = 0;
  for (Slot slot = graph.values[src.value].first_use; slot != kNone; slot = graph.sources[slot].next) {
    const Inst& user = graph.insts[graph.sources[slot].user];
    users += user.kind != Kind::kAlu || ir::alu_info(user.op).operands[slot - user.first] != 'F' ? 1 : 0;
  }
  return users <= 1;
}

/// What contains an instruction.
struct Nest {
  bool in_loop = false;
  bool in_branch = false;
  bool complement = false;  ///< the mask of one of the branches is the complement of a condition
};

/// True when the reference's memory accesses and inner branches need the mask under which the block runs.
bool masks_accesses(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.kind == Kind::kIf || inst.kind == Kind::kLoop) return true;
    if (inst.kind == Kind::kIntrinsic && inst.op != Op::kYield && !computes_float(inst)) return true;
  }
  return false;
}

/// What a branch yields to a component of its results, from one of its sides, in the order of the results.
template <typename Visit>
void for_each_yielded(const Graph& graph, BlockId block, Visit visit) {
  if (!ends_in(graph, block, Op::kYield)) return;
  const Inst& end = graph.insts[graph.blocks[block].tail];
  for (std::uint32_t i = 0; i < end.count; ++i) {
    const Src src = graph.source(end, i);
    const std::uint32_t components = graph.values[src.value].components;
    for (std::uint32_t c = 0; c < components; ++c) visit(component_of(graph, src, static_cast<std::uint8_t>(c)));
  }
}

bool yields_literal(const Graph& graph, BlockId block) {
  bool found = false;
  for_each_yielded(graph, block, [&](Src src) { found |= graph.constant(src.value) != nullptr; });
  return found;
}

/// True when the reference needs the mask under which the block runs: it loads or stores, or writes a literal.
bool needs_mask(const Graph& graph, BlockId block) {
  return masks_accesses(graph, block) || yields_literal(graph, block);
}

/// The complement of a comparison that serves nothing else is the opposite comparison.
bool is_complement(const Graph& graph, const Inst& branch, BlockId block) {
  const Src condition = graph.source(branch, 0);
  const Inst* def = graph.def(condition.value);
  const bool computed = def && def->kind == Kind::kAlu;
  const bool negated = computed && def->op == Op::kNotB, in_then = branch.child[0] == block;
  if (negated != in_then) return false;
  if (in_then) return true;
  const bool compares = computed && ir::alu_info(def->op).result == 'B' && ir::alu_info(def->op).operands[0] != 'B';
  return !compares || graph.values[condition.value].uses > 1 || needs_mask(graph, branch.child[0]);
}

Nest nest_of(const Graph& graph, const Inst& inst) {
  Nest nest;
  for (BlockId block = inst.block; graph.blocks[block].owner != kNone;) {
    const Inst& owner = graph.insts[graph.blocks[block].owner];
    nest.in_loop |= owner.kind == Kind::kLoop;
    nest.in_branch |= owner.kind == Kind::kIf;
    nest.complement |= owner.kind == Kind::kIf && is_complement(graph, owner, block);
    block = owner.block;
  }
  return nest;
}

/// What the masks of a branch serve besides the selection between what its sides write.
struct MaskUses {
  bool then_mask = false;
  bool else_mask = false;
};

void add_mask_uses(const Graph& graph, const Inst& branch, bool negated, MaskUses& uses) {
  uses.then_mask |= masks_accesses(graph, branch.child[negated ? 1 : 0]);
  uses.else_mask |= masks_accesses(graph, branch.child[negated ? 0 : 1]);
}

/// Other branches on the same condition or on its complement share the masks.
void add_other_branches(const Graph& graph, ValueId condition, const Inst& branch, bool negated, MaskUses& uses) {
  for (Slot slot = graph.values[condition].first_use; slot != kNone; slot = graph.sources[slot].next) {
    const Inst& user = graph.insts[graph.sources[slot].user];
    if (user.kind == Kind::kAlu && user.op == Op::kNotB && !negated)
      add_other_branches(graph, user.result, branch, true, uses);
    if (user.kind != Kind::kIf || &user == &branch) continue;
    add_mask_uses(graph, user, negated, uses);
    (negated ? uses.else_mask : uses.then_mask) = true;
  }
}

/// The other components that an else branch writes: a value or a later other literal needs its mask, the same literal
/// the mask of the other branch. Where the condition is negated, so does every literal.
void add_writes(const Graph& graph, BlockId block, std::uint32_t identity, bool negated, MaskUses& uses) {
  std::uint32_t same = 0;
  for_each_yielded(graph, block, [&](Src src) {
    const bool literal = graph.constant(src.value) != nullptr;
    if (is_literal(graph, src, identity) || (negated && literal))
      ++same;
    else
      uses.else_mask |= !literal || same > 0;
  });
  uses.then_mask |= same > 1;
}

/// The value is loaded from push constants or uniforms, without a mask and as integers.
bool is_unmasked_load(const Graph& graph, Src src) {
  const Inst* from = graph.def(src.value);
  return from && from->kind == Kind::kIntrinsic && (from->op == Op::kLoadPush || from->op == Op::kLoadUniform);
}

/// A conjunction or disjunction.
const Inst* joint_of(const Graph& graph, Src condition) {
  const Inst* def = graph.def(condition.value);
  return def && def->kind == Kind::kAlu && (def->op == Op::kAndB || def->op == Op::kOrB) ? def : nullptr;
}

/// A conjunction or disjunction whose complement the reference computes from the mask instead of from the opposite
/// comparisons: it selects something else, too, or joins more than two.
bool keeps_joint(const Graph& graph, Src condition) {
  const Inst* joint = joint_of(graph, condition);
  if (!joint) return false;
  if (joint_of(graph, graph.source(*joint, 0)) || joint_of(graph, graph.source(*joint, 1))) return true;
  for (Slot slot = graph.values[condition.value].first_use; slot != kNone; slot = graph.sources[slot].next) {
    const Inst& user = graph.insts[graph.sources[slot].user];
    if (user.kind == Kind::kAlu && ir::is_selection(user.op) && slot == user.first) return true;
  }
  return false;
}

}  // namespace

/// A comparison of 32-bit integers: their type is that of the masks which select between two literals, and the
/// reference's code generator does not move the conversion to float into such a selection, which hides it.
bool compares_integers(const Graph& graph, Src condition) {
  const Inst* inst = graph.def(condition.value);
  if (!inst || inst->kind != Kind::kAlu) return false;
  switch (inst->op) {
    case Op::kILt:
    case Op::kIGe:
    case Op::kULt:
    case Op::kUGe:
    case Op::kIEq:
    case Op::kINe:
      return true;
    default:
      return false;
  }
}

/// A comparison of floats: what selects between floats by it converts to integers as a whole.
bool compares_floats(const Graph& graph, Src condition) {
  const Inst* inst = graph.def(condition.value);
  return inst && inst->kind == Kind::kAlu && ir::alu_info(inst->op).result == 'B' &&
         ir::alu_info(inst->op).operands[0] == 'F';
}

/// True when the conversion to float moves into a selection of a literal and `operand`.
bool converts_sides(const Graph& graph, Src condition, Src operand) {
  return !compares_integers(graph, condition) || is_float_for_one(graph, operand);
}

/// True when the reference's optimiser sees what the two branches write to a register as one selection, the literal
/// `side` (1: then, 2: else) of which is `identity`. It masks what each branch writes and joins both: if the mask of
/// the else branch serves something else, as a whole by its being the complement of the mask of the then branch;
/// otherwise it moves the literal into a selection by the condition first, and the other value, too, if that is all
/// that its mask still serves. A negated condition is the complement of a mask itself: it becomes a condition of its
/// own where the one that is negated serves nothing else. In a branch the mask of the else branch is the conjunction of
/// the masks around it, which it recognises unless one of them is a complement itself.
bool writes_selection(const Graph& graph, const Inst& branch, unsigned side, Src written, std::uint32_t identity) {
  const Nest nest = nest_of(graph, branch);
  if (nest.in_loop) return false;
  const bool loads = is_unmasked_load(graph, written);
  if (nest.in_branch) return side == 2 && !loads && !nest.complement;
  const Src condition = graph.source(branch, 0);
  const Inst* def = graph.def(condition.value);
  if (!def) return false;
  const bool negated = def->kind == Kind::kAlu && def->op == Op::kNotB;
  const Src compared = negated ? graph.source(*def, 0) : condition;
  MaskUses uses;
  add_mask_uses(graph, branch, negated, uses);
  add_other_branches(graph, compared.value, branch, false, uses);
  if (side == 1) {
    const Inst* from = graph.def(written.value);
    const bool accesses = from && from->kind == Kind::kIntrinsic && !computes_float(*from);
    if (uses.then_mask || !(negated || accesses)) return false;
    return compares_floats(graph, compared) || (accesses && keeps_joint(graph, condition));
  }
  if (compares_integers(graph, condition) && loads) return false;
  const bool masks_else = uses.else_mask;
  add_writes(graph, branch.child[1], identity, negated, uses);
  const bool joins = negated ? !uses.then_mask && !masks_else : uses.else_mask || !uses.then_mask;
  return joins && converts_sides(graph, compared, written);
}

}  // namespace vitrine::spirv::rewriting
