// Scalars of instructions that are not arithmetic: interface, memory, images, what an invocation knows of itself.
#include <bit>

#include "spirv/lower/scalarizer.h"

namespace vitrine::spirv::lowering {

void Scalarizer::build_instr(const ir::Instr& instr) {
  if (instr.op < Op::kExecutedCount) return build_alu(instr);
  if (instr.op < Op::kAluCount) return fail("operation that the rewrites should have taken apart");
  if (ir::is_wide(instr.op)) return build_wide(instr);
  switch (instr.op) {
    case Op::kConst: {
      std::vector<ScalarId> ids;
      for (std::uint32_t c = 0; c < instr.components; ++c) ids.push_back(constant(instr.imm[c], instr.boolean));
      return define(instr.result, ids);
    }
    case Op::kUndef:
      return define(instr.result, std::vector<ScalarId>(instr.components, constant(0, instr.boolean)));
    case Op::kVec: {
      std::vector<ScalarId> ids;
      for (const ir::Src& src : instr.src) ids.push_back(component(src, 0));
      return define(instr.result, ids);
    }
    case Op::kLoadInput:
      return build_input(instr);
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kArrayLength:
      return build_load(instr);
    case Op::kImage:
      return build_image(instr);
    case Op::kStoreStorage:
    case Op::kStoreShared:
    case Op::kStoreGlobal:
      return build_store(instr);
    case Op::kGlobalInvocationId:
      return build_global_id(instr);
    case Op::kReadFirst:
      if (level(component(instr.src[0], 0)) <= Level::kUniform)
        return define(instr.result, std::vector<ScalarId>{component(instr.src[0], 0)});
      [[fallthrough]];
    case Op::kStoreOutput:
    case Op::kAtomicStorage:
    case Op::kLoadGlobal:
    case Op::kAtomicGlobal:
    case Op::kLoadShared:
    case Op::kAtomicShared:
    case Op::kLoadArray:
    case Op::kStoreArray:
    case Op::kBarrier:
    case Op::kMemoryBarrier:
    case Op::kDemote:
    case Op::kProbe:
    case Op::kHelperInvocation:
    case Op::kElect:
    case Op::kReadClock:
    case Op::kBallot:
    case Op::kShuffle:
    case Op::kReduce: {
      std::vector<ScalarId> sources;
      for (const ir::Src& src : instr.src) append(sources, src, 1);
      return define(instr.result, emit(instr, sources, instr.components, instr.boolean));
    }
    case Op::kWorkgroupId:
    case Op::kNumWorkgroups:
    case Op::kLocalInvocationId:
    case Op::kLocalInvocationIndex:
    case Op::kSubgroupInvocation:
    case Op::kSubgroupId:
      return define(instr.result, environment(instr.op, instr.components, &instr));
    default:
      return fail("instruction that the lowering does not cover");
  }
}

void Scalarizer::build_wide(const ir::Instr& instr) {
  std::vector<ScalarId> sources;
  bool uniform = true;
  for (const ir::Src& src : instr.src) {
    sources.push_back(component(src, 0));
    uniform = uniform && level(sources.back()) <= Level::kUniform;
  }
  if (sources.size() > 4) return fail("wide instruction with too many sources");
  ScalarOp op;
  op.kind = Kind::kIntrinsic;
  op.op = instr.op;
  op.instr = &instr;
  const Key key = key_of(instr.op, sources, nullptr);
  define(instr.result, emit_pure(op, key, sources, instr.components, instr.boolean, uniform));
}

/// The place of an invocation in a workgroup whose quads are two columns in two rows each (SPIR-V, execution mode
/// DerivativeGroupQuads): wave after wave, quad after quad.
std::vector<ScalarId> Scalarizer::quad_environment(Op op, const ir::Instr* instr) {
  const auto& size = ir_.interface.local_size;
  const ScalarId index = out_.groups_per_wave > 1 ? packed_environment(Op::kLocalInvocationIndex, 1, instr)[0]
                                                  : read_environment(Op::kLocalInvocationIndex, 1, instr)[0];
  const auto sum = [&](ScalarId a, ScalarId b) { return alu(Op::kIAdd, std::array<ScalarId, 2>{a, b}, instr); };
  const auto times = [&](ScalarId a, std::uint32_t by) {
    return alu(Op::kIMul, std::array<ScalarId, 2>{a, constant(by, false)}, instr);
  };
  const ScalarId quad = divide(index, 4), lane = remainder(index, 4);
  const ScalarId x = sum(times(remainder(quad, size[0] / 2), 2), remainder(lane, 2));
  const ScalarId row = divide(quad, size[0] / 2);
  const ScalarId y = sum(times(remainder(row, size[1] / 2), 2), divide(lane, 2));
  const ScalarId z = divide(row, size[1] / 2);
  if (op == Op::kLocalInvocationId) return {x, y, z};
  return {sum(sum(x, times(y, size[0])), times(z, size[0] * size[1]))};
}

std::vector<ScalarId> Scalarizer::environment(Op op, std::uint32_t count, const ir::Instr* instr) {
  const bool placed = op == Op::kLocalInvocationId || op == Op::kLocalInvocationIndex;
  if (placed && ir_.interface.derivative_group == DerivativeGroup::kQuads) return quad_environment(op, instr);
  return out_.groups_per_wave > 1 ? packed_environment(op, count, instr) : read_environment(op, count, instr);
}

std::vector<ScalarId> Scalarizer::packed_environment(Op op, std::uint32_t count, const ir::Instr* instr) {
  const auto& size = ir_.interface.local_size;
  const std::uint32_t invocations = size[0] * size[1] * size[2];
  const ScalarId lane = read_environment(Op::kSubgroupInvocation, 1, instr)[0];
  const ScalarId index = remainder(lane, invocations);
  std::vector<ScalarId> result;
  if (op == Op::kLocalInvocationIndex) {
    result = {index};
  } else if (op == Op::kLocalInvocationId) {
    result = {remainder(index, size[0]), remainder(divide(index, size[0]), size[1]), divide(index, size[0] * size[1])};
  } else {
    result = read_environment(op, count, instr);
    if (op == Op::kWorkgroupId) {
      const std::array<ScalarId, 2> sum{result[0], divide(lane, invocations)};
      result[0] = alu(Op::kIAdd, sum, instr);
    }
  }
  return result;
}

ScalarId Scalarizer::divide(ScalarId value, std::uint32_t by) {
  const bool shift = std::has_single_bit(by);
  const std::array<ScalarId, 2> sources{value,
                                        constant(shift ? static_cast<std::uint32_t>(std::countr_zero(by)) : by, false)};
  return by == 1 ? value : alu(shift ? Op::kUShr : Op::kUDiv, sources, nullptr);
}

ScalarId Scalarizer::remainder(ScalarId value, std::uint32_t by) {
  const bool mask = std::has_single_bit(by);
  const std::array<ScalarId, 2> sources{value, constant(mask ? by - 1 : by, false)};
  return by == 1 ? constant(0, false) : alu(mask ? Op::kAnd : Op::kUMod, sources, nullptr);
}

std::vector<ScalarId> Scalarizer::read_environment(Op op, std::uint32_t count, const ir::Instr* instr) {
  ScalarOp out;
  out.kind = Kind::kIntrinsic;
  out.op = op;
  out.instr = instr;
  Key key = key_of(op, {}, nullptr);
  key.words[9] = count;
  return emit_pure(out, key, {}, count, false, false);
}

void Scalarizer::build_global_id(const ir::Instr& instr) {
  const std::vector<ScalarId> group = environment(Op::kWorkgroupId, 3, &instr);
  const std::vector<ScalarId> local = environment(Op::kLocalInvocationId, 3, &instr);
  std::vector<ScalarId> result;
  for (std::uint32_t c = 0; c < instr.components; ++c) {
    const std::array<ScalarId, 2> product{group[c], constant(ir_.interface.local_size[c], false)};
    const std::array<ScalarId, 2> sum{alu(Op::kIMul, product, &instr), local[c]};
    result.push_back(alu(Op::kIAdd, sum, &instr));
  }
  define(instr.result, result);
}

void Scalarizer::build_input(const ir::Instr& instr) {
  if (instr.data[0] >= ir_.interface.inputs.size()) return fail("input index out of range");
  Key key = key_of(Op::kLoadInput, {}, nullptr);
  key.words[5] = instr.data[0];
  const auto [it, added] = global_.try_emplace(key, 0);
  if (added) {
    it->second = out_.add(false, Level::kVarying);
    out_.scalars[it->second].input = instr.data[0];
  }
  define(instr.result, std::vector<ScalarId>{it->second});
}

void Scalarizer::build_load(const ir::Instr& instr) {
  std::vector<ScalarId> sources;
  bool uniform = true;
  for (const ir::Src& src : instr.src) {
    sources.push_back(component(src, 0));
    uniform = uniform && level(sources.back()) <= Level::kUniform;
  }
  if (out_.accesses_stay || (instr.op == Op::kLoadStorage && (out_.writes_memory || instr.imm[2] != 0)))
    return define(instr.result, emit(instr, sources, instr.components, false));
  ScalarOp op;
  op.kind = Kind::kIntrinsic;
  op.op = instr.op;
  op.instr = &instr;
  set_load_offsets(op);
  define(instr.result, emit_pure(op, key_of(instr.op, sources, &instr), sources, instr.components, false, uniform));
}

void Scalarizer::set_load_offsets(ScalarOp& op) {
  if (op.op != Op::kLoadPush && op.op != Op::kLoadUniform && op.op != Op::kLoadStorage && op.op != Op::kLoadShared &&
      op.op != Op::kLoadGlobal)
    return;
  for (std::uint32_t c = 0; c < 4; ++c) op.at[c] = c * ir::element_bytes(op.instr->imm);
}

void Scalarizer::build_store(const ir::Instr& instr) {
  std::vector<ScalarId> sources;
  const std::size_t addresses = instr.src.size() - 1;
  for (std::size_t i = 0; i < addresses; ++i) sources.push_back(component(instr.src[i], 0));
  for (std::uint32_t c = 0; c < 4; ++c)
    if (instr.imm[0] >> c & 1) sources.push_back(component(instr.src[addresses], c));
  emit(instr, sources, 0, false);
}

void Scalarizer::build_image(const ir::Instr& instr) {
  std::vector<ScalarId> sources;
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(ir::ImageOperand::kCount); ++i) {
    if (!(instr.image->operands >> i & 1)) continue;
    if (next >= instr.src.size()) return fail("image instruction with too few sources");
    append(sources, instr.src[next++], image_operand_components(instr, static_cast<ir::ImageOperand>(i)));
  }
  define(instr.result, emit(instr, sources, instr.components, false));
}

std::uint32_t image_operand_components(const ir::Instr& instr, ir::ImageOperand operand) {
  const ir::ImageInfo& info = *instr.image;
  const std::uint32_t dimensions = ir::coordinate_components(info.dim);
  switch (operand) {
    case ir::ImageOperand::kCoord:
      return dimensions + (info.arrayed ? 1 : 0);
    case ir::ImageOperand::kGradX:
    case ir::ImageOperand::kGradY:
    case ir::ImageOperand::kOffset:
      return dimensions;
    case ir::ImageOperand::kCompare:
      return info.wide ? 2 : 1;
    case ir::ImageOperand::kValue:
      if (info.access == ir::ImageAccess::kAtomic) return info.wide ? 2 : 1;
      return instr.data[0] == 0 ? 4 : instr.data[0];
    default:
      return 1;
  }
}

}  // namespace vitrine::spirv::lowering
