// Group operations of scope Subgroup (SPIR-V 3.42.24, Non-Uniform Instructions; Vulkan, Group Operations) and the
// built-ins of subgroups. Built from three instructions: Ballot, Shuffle and Reduce.
#include <bit>

#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

std::uint32_t subgroup_size(const Translator& t) { return t.options.subgroup_size; }
bool is_whole_wave(const Translator& t) { return subgroup_size(t) == base::kWaveWidth; }

/// The invocation's number in its subgroup.
Expr lane(Translator& t) {
  const Expr in_wave{&t, emit(t, ir::Op::kSubgroupInvocation, 1, false, {})};
  return is_whole_wave(t) ? in_wave : in_wave & (subgroup_size(t) - 1);
}

/// Two words: the invocations of the subgroup that are active and for which `holds`.
Expr ballot(Translator& t, ir::ValueId holds) {
  const Expr words{&t, emit(t, ir::Op::kBallot, 2, false, {whole(holds)})};
  last_instr(t).data[0] = subgroup_size(t);
  return words;
}

Expr shuffle(Translator& t, ir::ValueId word, Expr from) {
  const Expr result{&t, emit(t, ir::Op::kShuffle, 1, false, {whole(word), whole(from.id)})};
  last_instr(t).data[0] = subgroup_size(t);
  return result;
}

Expr not_zero(Expr words) { return apply(ir::Op::kINe, {words[0] | words[1], imm_u32(*words.t, 0)}); }

/// Number of the lowest / highest set bit of two words.
Expr lowest_bit(Expr words) {
  Translator& t = *words.t;
  const Expr in_low = apply(ir::Op::kINe, {words[0], imm_u32(t, 0)});
  const Expr low = apply(ir::Op::kFindLsb, {words[0]});
  return select(in_low, low, apply(ir::Op::kIAdd, {apply(ir::Op::kFindLsb, {words[1]}), imm_u32(t, 32)}));
}

Expr highest_bit(Expr words) {
  Translator& t = *words.t;
  const Expr in_high = apply(ir::Op::kINe, {words[1], imm_u32(t, 0)});
  const Expr high = apply(ir::Op::kIAdd, {apply(ir::Op::kUFindMsb, {words[1]}), imm_u32(t, 32)});
  return select(in_high, high, apply(ir::Op::kUFindMsb, {words[0]}));
}

Expr pair(Expr low, Expr high) { return {low.t, vec(*low.t, {whole(low.id), whole(high.id)}, false)}; }

/// Bits of the lanes below `count` (0..64), as two words.
Expr bits_below(Expr count) {
  Translator& t = *count.t;
  const Expr all = imm_u32(t, ~0u), zero = imm_u32(t, 0);
  const Expr mask = apply(ir::Op::kISub, {apply(ir::Op::kShl, {imm_u32(t, 1), count & 31u}), imm_u32(t, 1)});
  const Expr past_low = apply(ir::Op::kUGe, {count, imm_u32(t, 32)});
  const Expr past_high = apply(ir::Op::kUGe, {count, imm_u32(t, 64)});
  return pair(select(past_low, all, mask), select(past_high, all, select(past_low, mask, zero)));
}

Expr both(Expr a, Expr b) { return pair(a[0] & b[0], a[1] & b[1]); }
Expr bits_of_subgroup(Translator& t) { return bits_below(imm_u32(t, subgroup_size(t))); }

Expr inverted(Expr words) {
  return both(pair(apply(ir::Op::kNot, {words[0]}), apply(ir::Op::kNot, {words[1]})), bits_of_subgroup(*words.t));
}

ir::ValueId uvec4(Expr words) {
  const ir::ValueId zero = constant_u32(*words.t, 0);
  return vec(*words.t, {splat(words.id, 0), splat(words.id, 1), whole(zero), whole(zero)}, false);
}

/// f applied to every scalar of a value as a word; booleans travel as 0 / 1.
template <class F>
std::vector<ir::ValueId> map_words(Translator& t, const Value& value, const F& f) {
  std::vector<ir::ValueId> leaves;
  for (const ir::ValueId leaf : value.leaves) {
    std::vector<ir::Src> parts;
    const bool boolean = is_boolean(t, leaf);
    for (std::uint32_t c = 0; c < components(t, leaf); c++) {
      Expr part{&t, extract(t, leaf, c)};
      if (boolean) part = apply(ir::Op::kB2I, {part});
      part = f(part);
      if (boolean) part = apply(ir::Op::kINe, {part, imm_u32(t, 0)});
      parts.push_back(whole(part.id));
    }
    leaves.push_back(vec(t, std::move(parts), boolean));
  }
  return leaves;
}

Expr read_first(Translator& t, Expr word) {
  if (is_whole_wave(t)) return {&t, emit(t, ir::Op::kReadFirst, 1, false, {whole(word.id)})};
  return shuffle(t, word.id, lowest_bit(ballot(t, constant_bool(t, true))));
}

void shuffle_from(Translator& t, const Inst& inst, const Value& value, Expr from) {
  set_value(t, inst, map_words(t, value, [&](Expr word) { return shuffle(t, word.id, from); }));
}

/// The older instructions of SPV_KHR_shader_ballot and SPV_KHR_subgroup_vote have no scope operand.
std::uint32_t first_operand(const Inst& inst) {
  switch (inst.op) {
    case Op::OpSubgroupBallotKHR:
    case Op::OpSubgroupFirstInvocationKHR:
    case Op::OpSubgroupReadInvocationKHR:
    case Op::OpSubgroupAllKHR:
    case Op::OpSubgroupAnyKHR:
    case Op::OpSubgroupAllEqualKHR:
      return 0;
    default:
      break;
  }
  return 1;
}

const Value& group_value(Translator& t, const Inst& inst) {
  if (first_operand(inst) == 1 &&
      t.module.constant_u32(inst.operand(0), inst) != static_cast<std::uint32_t>(spv::Scope::Subgroup))
    fail(inst, "scope is not supported");
  return value_of(t, inst.operand(first_operand(inst)));
}

Expr number_after(Translator& t, const Inst& inst) { return {&t, number(t, inst.operand(first_operand(inst) + 1))}; }

ir::ValueId group_condition(Translator& t, const Inst& inst) {
  group_value(t, inst);
  return condition(t, inst.operand(first_operand(inst)));
}

Expr ballot_operand(Translator& t, std::uint32_t id) {
  const ir::ValueId value = number(t, id, 4);
  return both({&t, vec(t, {splat(value, 0), splat(value, 1)}, false)}, bits_of_subgroup(t));
}

/// Bit `index` (below 64) of two words as a boolean.
Expr bit_at(Expr words, Expr index) {
  Translator& t = *words.t;
  const Expr word = select(apply(ir::Op::kUGe, {index, imm_u32(t, 32)}), words[1], words[0]);
  return apply(ir::Op::kINe, {apply(ir::Op::kUShr, {word, index & 31u}) & 1u, imm_u32(t, 0)});
}

struct ReduceRow {
  Op opcode;
  ir::GroupOp op;
};

constexpr ReduceRow kReductions[] = {
    {Op::OpGroupNonUniformIAdd, ir::GroupOp::kIAdd},      {Op::OpGroupNonUniformFAdd, ir::GroupOp::kFAdd},
    {Op::OpGroupNonUniformIMul, ir::GroupOp::kIMul},      {Op::OpGroupNonUniformFMul, ir::GroupOp::kFMul},
    {Op::OpGroupNonUniformSMin, ir::GroupOp::kIMin},      {Op::OpGroupNonUniformUMin, ir::GroupOp::kUMin},
    {Op::OpGroupNonUniformFMin, ir::GroupOp::kFMin},      {Op::OpGroupNonUniformSMax, ir::GroupOp::kIMax},
    {Op::OpGroupNonUniformUMax, ir::GroupOp::kUMax},      {Op::OpGroupNonUniformFMax, ir::GroupOp::kFMax},
    {Op::OpGroupNonUniformBitwiseAnd, ir::GroupOp::kAnd}, {Op::OpGroupNonUniformBitwiseOr, ir::GroupOp::kOr},
    {Op::OpGroupNonUniformBitwiseXor, ir::GroupOp::kXor}, {Op::OpGroupNonUniformLogicalAnd, ir::GroupOp::kAnd},
    {Op::OpGroupNonUniformLogicalOr, ir::GroupOp::kOr},   {Op::OpGroupNonUniformLogicalXor, ir::GroupOp::kXor},
};

ir::GroupOp reduction(const Inst& inst) {
  for (const ReduceRow& row : kReductions)
    if (row.opcode == inst.op) return row.op;
  fail(inst, "is not supported");
}

Expr emit_reduce(Expr word, ir::GroupOp op, std::uint32_t cluster, ir::GroupMode mode) {
  Translator& t = *word.t;
  const bool wide = word.high != ir::kNoValue;
  std::vector<ir::Src> sources{whole(word.id)};
  if (wide) sources.push_back(whole(word.high));
  Expr result{&t, emit(t, ir::Op::kReduce, wide ? 2 : 1, false, std::move(sources))};
  ir::Instr& instr = last_instr(t);
  instr.data[0] = cluster;
  instr.data[1] = static_cast<std::uint32_t>(op);
  instr.data[2] = static_cast<std::uint32_t>(mode);
  if (!wide) return result;
  const ir::ValueId both_words = result.id;
  result = {&t, extract(t, both_words, 0)};
  result.high = extract(t, both_words, 1);
  result.width = 64;
  return result;
}

/// One scalar of any type: narrow integers and booleans in 32 bits, narrow floats in binary32, rounded at every step.
Expr reduce_part(const Inst& inst, Expr part, std::uint32_t cluster, ir::GroupMode mode) {
  const ir::GroupOp op = reduction(inst);
  Translator& t = *part.t;
  if (is_boolean(t, part.id))
    return apply(ir::Op::kINe, {emit_reduce(apply(ir::Op::kB2I, {part}), op, cluster, mode), imm_u32(t, 0)});
  const std::uint8_t width = part.width;
  if (width >= 32) return emit_reduce(part, op, cluster, mode);
  switch (op) {
    case ir::GroupOp::kFAdd:
      return convert_float(emit_reduce(convert_float(part, 32), ir::GroupOp::kHAdd, cluster, mode), width);
    case ir::GroupOp::kFMul:
      return convert_float(emit_reduce(convert_float(part, 32), ir::GroupOp::kHMul, cluster, mode), width);
    case ir::GroupOp::kFMin:
    case ir::GroupOp::kFMax:
      return convert_float(emit_reduce(convert_float(part, 32), op, cluster, mode), width);
    case ir::GroupOp::kIMin:
    case ir::GroupOp::kIMax: {
      // In the high bits of a word, so that the result of no invocations is the greatest or least number of `width`
      // bits.
      const Expr shift = imm_u32(t, 32u - width);
      const Expr high = apply(ir::Op::kShl, {convert_unsigned(part, 32), shift});
      return convert_unsigned(apply(ir::Op::kIShr, {emit_reduce(high, op, cluster, mode), shift}), width);
    }
    default:
      return convert_unsigned(emit_reduce(convert_unsigned(part, 32), op, cluster, mode), width);
  }
}

}  // namespace

ir::ValueId subgroup_built_in(Translator& t, spv::BuiltIn built_in) {
  const std::uint32_t* local = t.function.interface.local_size;
  const std::uint32_t size = subgroup_size(t);
  const Expr one = imm_u32(t, 1);
  switch (built_in) {
    case spv::BuiltIn::SubgroupSize:
      return constant_u32(t, size);
    case spv::BuiltIn::NumSubgroups:
      return constant_u32(t, (local[0] * local[1] * local[2] + size - 1) / size);
    case spv::BuiltIn::SubgroupId:
      if (is_whole_wave(t)) return emit(t, ir::Op::kSubgroupId, 1, false, {});
      if (t.function.interface.derivative_group == DerivativeGroup::kQuads) {
        // Invocations do not follow each other by their indices.
        const Expr wave{&t, emit(t, ir::Op::kSubgroupId, 1, false, {})};
        const Expr in_wave{&t, emit(t, ir::Op::kSubgroupInvocation, 1, false, {})};
        const Expr first = apply(ir::Op::kIMul, {wave, imm_u32(t, base::kWaveWidth)});
        return (apply(ir::Op::kIAdd, {first, in_wave}) >> static_cast<std::uint32_t>(std::countr_zero(size))).id;
      }
      return (Expr{&t, emit(t, ir::Op::kLocalInvocationIndex, 1, false, {})} >>
              static_cast<std::uint32_t>(std::countr_zero(size)))
          .id;
    case spv::BuiltIn::SubgroupLocalInvocationId:
      return lane(t).id;
    case spv::BuiltIn::SubgroupEqMask: {
      const Expr below = bits_below(lane(t)), through = bits_below(apply(ir::Op::kIAdd, {lane(t), one}));
      return uvec4(pair(apply(ir::Op::kXor, {below[0], through[0]}), apply(ir::Op::kXor, {below[1], through[1]})));
    }
    case spv::BuiltIn::SubgroupLtMask:
      return uvec4(bits_below(lane(t)));
    case spv::BuiltIn::SubgroupLeMask:
      return uvec4(bits_below(apply(ir::Op::kIAdd, {lane(t), one})));
    case spv::BuiltIn::SubgroupGeMask:
      return uvec4(inverted(bits_below(lane(t))));
    case spv::BuiltIn::SubgroupGtMask:
      return uvec4(inverted(bits_below(apply(ir::Op::kIAdd, {lane(t), one}))));
    default:
      throw Failure("built-in " + std::to_string(static_cast<std::uint32_t>(built_in)) + " is not supported");
  }
}

void group_elect(Translator& t, const Inst& inst, ir::Op) {
  if (is_whole_wave(t)) return set_value(t, inst, emit(t, ir::Op::kElect, 1, true, {}));
  const Expr first = lowest_bit(ballot(t, constant_bool(t, true)));
  set_value(t, inst, apply(ir::Op::kIEq, {lane(t), first}).id);
}

void group_all(Translator& t, const Inst& inst, ir::Op) {
  const Expr holds{&t, group_condition(t, inst)};
  const Expr fails = apply(ir::Op::kNotB, {holds});
  set_value(t, inst, apply(ir::Op::kNotB, {not_zero(ballot(t, fails.id))}).id);
}

void group_any(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, not_zero(ballot(t, group_condition(t, inst))).id);
}

void group_all_equal(Translator& t, const Inst& inst, ir::Op) {
  const Value value = group_value(t, inst);
  std::vector<std::uint32_t> types;
  leaf_types(t, value.type, types);
  const bool is_boolean_type = number_type(t, types.at(0)).kind == Type::Kind::kBool;
  const bool is_float = number_type(t, types.at(0)).kind == Type::Kind::kFloat;
  const ExactScope exact(t);
  Expr equal{&t, constant_bool(t, true)};
  for (const Expr& number : leaf_numbers(t, value))
    for (std::uint32_t c = 0; c < number.size(); c++) {
      Expr part = number[c];
      if (is_boolean_type) part = apply(ir::Op::kB2I, {part});
      Expr first = part;
      first.id = read_first(t, {&t, part.id}).id;
      if (part.high != ir::kNoValue) first.high = read_first(t, {&t, part.high}).id;
      Expr same = apply(is_float ? ir::Op::kFEq : ir::Op::kIEq, {part, first});
      if (is_float) {  // as the reference compares: NaN equals everything
        const Expr unknown = apply(ir::Op::kFNeu, {part, part}), other = apply(ir::Op::kFNeu, {first, first});
        same = apply(ir::Op::kOrB, {same, apply(ir::Op::kOrB, {unknown, other})});
      }
      equal = apply(ir::Op::kAndB, {equal, same});
    }
  const Expr differs = apply(ir::Op::kNotB, {equal});
  set_value(t, inst, apply(ir::Op::kNotB, {not_zero(ballot(t, differs.id))}).id);
}

void group_broadcast(Translator& t, const Inst& inst, ir::Op) {
  shuffle_from(t, inst, group_value(t, inst), number_after(t, inst));
}

void group_broadcast_first(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, map_words(t, group_value(t, inst), [&](Expr word) { return read_first(t, word); }));
}

void group_ballot(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, uvec4(ballot(t, group_condition(t, inst))));
}

void group_inverse_ballot(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, bit_at(ballot_operand(t, inst.operand(1)), lane(t)).id);
}

void group_ballot_bit(Translator& t, const Inst& inst, ir::Op) {
  const Expr index{&t, number(t, inst.operand(2))};
  set_value(t, inst, bit_at(ballot_operand(t, inst.operand(1)), index & 63u).id);
}

void group_ballot_count(Translator& t, const Inst& inst, ir::Op) {
  Expr words = ballot_operand(t, inst.operand(2));
  const auto mode = static_cast<spv::GroupOperation>(inst.operand(1));
  if (mode == spv::GroupOperation::ExclusiveScan) words = both(words, bits_below(lane(t)));
  if (mode == spv::GroupOperation::InclusiveScan)
    words = both(words, bits_below(apply(ir::Op::kIAdd, {lane(t), imm_u32(t, 1)})));
  const Expr low = apply(ir::Op::kBitCount, {words[0]}), high = apply(ir::Op::kBitCount, {words[1]});
  set_value(t, inst, apply(ir::Op::kIAdd, {low, high}).id);
}

void group_ballot_find(Translator& t, const Inst& inst, ir::Op) {
  const Expr words = ballot_operand(t, inst.operand(1));
  set_value(t, inst, (inst.op == Op::OpGroupNonUniformBallotFindLSB ? lowest_bit(words) : highest_bit(words)).id);
}

void group_shuffle(Translator& t, const Inst& inst, ir::Op op) {
  const Value value = group_value(t, inst);
  const Expr operand = number_after(t, inst);
  // Rotation by clusters: the lanes of a cluster are those that agree in the bits above its size.
  if (inst.op == Op::OpGroupNonUniformRotateKHR) {
    const std::uint32_t cluster = inst.has(3) ? t.module.constant_u32(inst.operand(3), inst) : subgroup_size(t);
    if (!std::has_single_bit(cluster)) fail(inst, "cluster size is not a power of two");
    const std::uint32_t inside = std::min(cluster, subgroup_size(t)) - 1;
    const Expr turned = apply(ir::Op::kIAdd, {lane(t), operand}) & inside;
    return shuffle_from(t, inst, value, (lane(t) & ~inside) | turned);
  }
  shuffle_from(t, inst, value, op == ir::Op::kMov ? operand : apply(op, {lane(t), operand}));
}

void group_reduce(Translator& t, const Inst& inst, ir::Op) {
  const auto mode = static_cast<spv::GroupOperation>(inst.operand(1));
  std::uint32_t cluster = subgroup_size(t);
  if (mode == spv::GroupOperation::ClusteredReduce)
    cluster = std::min(cluster, t.module.constant_u32(inst.operand(3), inst));
  else if (mode != spv::GroupOperation::Reduce && mode != spv::GroupOperation::InclusiveScan &&
           mode != spv::GroupOperation::ExclusiveScan)
    fail(inst, "group operation is not supported");
  if (!std::has_single_bit(cluster)) fail(inst, "cluster size is not a power of two");
  const ir::GroupMode result_mode = mode == spv::GroupOperation::InclusiveScan   ? ir::GroupMode::kInclusive
                                    : mode == spv::GroupOperation::ExclusiveScan ? ir::GroupMode::kExclusive
                                                                                 : ir::GroupMode::kReduce;
  std::vector<Expr> results;
  for (const Expr& number : leaf_numbers(t, value_of(t, inst.operand(2)))) {
    std::vector<Expr> parts;
    for (std::uint32_t c = 0; c < number.size(); c++)
      parts.push_back(reduce_part(inst, number[c], cluster, result_mode));
    results.push_back(vector_of(parts));
  }
  set_numbers(t, inst, results);
}

void quad_broadcast(Translator& t, const Inst& inst, ir::Op) {
  t.function.interface.needs_helpers = true;
  const Value value = group_value(t, inst);
  shuffle_from(t, inst, value, (lane(t) & ~3u) | (number_after(t, inst) & 3u));
}

void quad_swap(Translator& t, const Inst& inst, ir::Op) {
  t.function.interface.needs_helpers = true;
  const Value value = group_value(t, inst);
  const std::uint32_t direction = t.module.constant_u32(inst.operand(2), inst);  // 0: x, 1: y, 2: both
  shuffle_from(t, inst, value, apply(ir::Op::kXor, {lane(t), imm_u32(t, (direction + 1) & 3)}));
}

/// Of the active invocations of the quad, helpers among them.
void quad_vote(Translator& t, const Inst& inst, ir::Op op) {
  t.function.interface.needs_helpers = true;
  const bool all = op == ir::Op::kAndB;
  Expr holds{&t, condition(t, inst.operand(0))};
  if (all) holds = apply(ir::Op::kNotB, {holds});
  const Expr own = apply(ir::Op::kB2I, {holds});
  Expr any = own;
  for (const std::uint32_t other : {1u, 2u, 3u})  // inactive ones give 0
    any = any | shuffle(t, own.id, apply(ir::Op::kXor, {lane(t), imm_u32(t, other)}));
  set_value(t, inst, apply(all ? ir::Op::kIEq : ir::Op::kINe, {any, imm_u32(t, 0)}).id);
}

}  // namespace vitrine::spirv::front
