// Emission of intrinsics: side table rows of memory and image instructions, environment values.
#include "base/shake.h"
#include "spirv/exec/atomics_half.h"
#include "spirv/lower/emitter.h"

namespace vitrine::spirv::lowering {
namespace {

/// Whether an operand is the level 0 of a fetch, which is that without the operand.
bool is_first_level(ir::ImageAccess access, ir::ImageOperand operand, const Scalar& value) {
  return access == ir::ImageAccess::kFetch && operand == ir::ImageOperand::kLod && value.level == Level::kConstant &&
         value.bits == 0;
}

using ir::Op;

/// A slot that lies in no set: the null descriptor.
constexpr std::uint32_t kNullSlot = ~std::uint32_t{0};

Access access_of(Op op) {
  switch (op) {
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kLoadShared:
    case Op::kLoadGlobal:
    case Op::kLoadArray:
      return Access::kLoad;
    case Op::kStoreStorage:
    case Op::kStoreShared:
    case Op::kStoreGlobal:
    case Op::kStoreArray:
      return Access::kStore;
    case Op::kAtomicStorage:
    case Op::kAtomicShared:
    case Op::kAtomicGlobal:
      return Access::kAtomic;
    default:
      return Access::kNone;
  }
}

MemorySpace space_of(Op op) {
  switch (op) {
    case Op::kLoadPush:
      return MemorySpace::kPush;
    case Op::kLoadUniform:
      return MemorySpace::kUniformBuffer;
    case Op::kLoadShared:
    case Op::kStoreShared:
    case Op::kAtomicShared:
      return MemorySpace::kShared;
    case Op::kLoadGlobal:
    case Op::kStoreGlobal:
    case Op::kAtomicGlobal:
      return MemorySpace::kGlobal;
    case Op::kLoadArray:
    case Op::kStoreArray:
      return MemorySpace::kArray;
    default:
      return MemorySpace::kStorageBuffer;
  }
}

}  // namespace

bool Emitter::intrinsic(const ScalarOp& op) {
  if (ir::is_wide(op.op)) {
    wide(op);
    return true;
  }
  switch (op.op) {
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kLoadShared:
    case Op::kArrayLength:
      load(op);
      return true;
    case Op::kLoadGlobal:
    case Op::kStoreGlobal:
    case Op::kAtomicGlobal:
      global(op);
      return true;
    case Op::kStoreStorage:
    case Op::kStoreShared:
      store(op);
      return true;
    case Op::kAtomicStorage:
    case Op::kAtomicShared:
      atomic(op);
      return true;
    case Op::kLoadArray:
    case Op::kStoreArray:
      local_array(op);
      return true;
    case Op::kImage:
      image(op);
      return true;
    case Op::kReadFirst:
      read_first(op);
      return true;
    case Op::kBallot:
    case Op::kShuffle:
    case Op::kReduce:
      group(op);
      return true;
    default:
      environment(op);
      return true;
  }
}

/// An element known now is added to `slot`; elements out of range are the null descriptor.
IndexOperand Emitter::index_operand(ScalarId id, std::uint32_t& slot, std::uint32_t count) {
  if (level(id) == Level::kConstant) {
    const std::uint32_t element = f_.scalars[id].bits;
    slot = element < count ? slot + element : kNullSlot;
    return {};
  }
  const Place at = place(id);
  return {at.file == 'r' ? IndexOperand::File::kVarying : IndexOperand::File::kUniform, at.offset};
}

MemoryOp Emitter::buffer_row(const ScalarOp& op, bool indexed) {
  MemoryOp row;
  if (indexed) {
    row.set = op.instr->data[0];
    row.slot = op.instr->data[1];
    row.count = op.instr->data[2];
    row.index = index_operand(source(op, 0), row.slot, row.count);
  }
  row.added = op.instr->data[3] + op.offset;
  return row;
}

void Emitter::attach(const ScalarOp& op, const MemoryOp& row, char data, bool loads) {
  (in_preamble ? program->preamble : program->code).back().extra[0] =
      static_cast<std::uint32_t>(program->memory_ops.size());
  note().extra = InstructionNote::Extra::kMemory;
  note().data = data;
  note().loads = loads;
  note().access = access_of(op.op);
  note().space = space_of(op.op);
  program->memory_ops.push_back(row);
}

void Emitter::attach(const ImageOp& row) {
  program->code.back().extra[0] = static_cast<std::uint32_t>(program->image_ops.size());
  program->notes.back().extra = InstructionNote::Extra::kImage;
  program->notes.back().access = Access::kImage;
  program->image_ops.push_back(row);
}

void Emitter::memory(const ScalarOp& op, MemoryOp row, std::uint32_t address, Handler wave, Handler uniform,
                     const char* name) {
  const Place at = place(source(op, address));
  append(at.file == 'u' ? uniform : wave, name, op.instr, {}, at);
  const bool loads = op.dst.count != 0;
  attach(op, row, loads && level(result(op, 0)) != Level::kVarying ? 'u' : 'r', loads);
}

void Emitter::load(const ScalarOp& op) {
  const bool buffer = op.op == Op::kLoadUniform || op.op == Op::kLoadStorage || op.op == Op::kArrayLength;
  MemoryOp row = buffer_row(op, buffer);
  const bool varying = level(result(op, 0)) == Level::kVarying;
  if (op.op == Op::kArrayLength) {
    row.length_offset = op.instr->imm[0];
    row.length_stride = op.instr->imm[1];
    append(varying ? exec::array_length : exec::array_length_uniform, "array_length", op.instr, place(result(op, 0)));
    attach(op, row);
    return;
  }
  if (op.op == Op::kLoadPush) row.added = op.instr->data[0] + op.offset;
  row.at = op.at;
  row.components = op.dst.count;
  row.element_bytes = ir::element_bytes(op.instr->imm);
  for (std::uint32_t c = 0; c < op.dst.count && c < 4; ++c) row.data[c] = place(result(op, c)).offset;
  if (row.element_bytes != 4) {
    const auto space = op.op == Op::kLoadPush     ? exec::Space::kPush
                       : op.op == Op::kLoadShared ? exec::Space::kShared
                                                  : exec::Space::kBuffer;
    const bool uniform = place(source(op, buffer ? 1 : 0)).file == 'u';
    const Handler handler = varying ? exec::load_narrow(space, uniform) : exec::load_narrow_uniform(space);
    memory(op, row, buffer ? 1 : 0, handler, handler, "load_narrow");
  } else if (op.op == Op::kLoadPush) {
    memory(op, row, 0, exec::load_push(), exec::load_push_uniform, "load_push");
  } else if (op.op == Op::kLoadShared) {
    memory(op, row, 0, exec::load_shared(), exec::load_shared_uniform, "load_shared");
  } else {
    memory(op, row, 1, exec::load_buffer(false), varying ? exec::load_buffer(true) : exec::load_buffer_uniform,
           op.op == Op::kLoadUniform ? "load_uniform" : "load_storage");
  }
}

void Emitter::store(const ScalarOp& op) {
  const bool buffer = op.op == Op::kStoreStorage;
  MemoryOp row = buffer_row(op, buffer);
  row.write_mask = op.instr->imm[0] & 15;
  std::uint32_t next = buffer ? 2 : 1;
  for (std::uint32_t c = 0; c < 4; ++c)
    if (row.write_mask >> c & 1) row.data[c] = in_register(source(op, next++)).offset;
  row.element_bytes = ir::element_bytes(op.instr->imm);
  if (row.element_bytes != 4) {
    const auto space = buffer ? exec::Space::kBuffer : exec::Space::kShared;
    memory(op, row, buffer ? 1 : 0, exec::store_narrow(space, false), exec::store_narrow(space, true), "store_narrow");
  } else if (buffer) {
    memory(op, row, 1, exec::store_buffer(false), exec::store_buffer(true), "store_storage");
  } else {
    memory(op, row, 0, exec::store_shared(false), exec::store_shared(true), "store_shared");
  }
}

void Emitter::atomic(const ScalarOp& op) {
  const bool buffer = op.op == Op::kAtomicStorage;
  MemoryOp row = buffer_row(op, buffer);
  row.atomic = static_cast<ir::AtomicOp>(op.instr->imm[0]);
  const std::uint32_t address = buffer ? 1 : 0;
  if (op.instr->imm[1] == 8) return atomic_wide(op, row, address);
  if (op.src.count > address + 1) row.data[0] = in_register(source(op, address + 1)).offset;
  if (op.src.count > address + 2) row.compare = in_register(source(op, address + 2)).offset;
  const Place at = place(source(op, address));
  const bool uniform = at.file == 'u', half = op.instr->imm[2] != 0;
  row.element_bytes = ir::element_bytes(op.instr->imm);
  const Handler handler = half     ? exec::atomic_half(buffer ? exec::Space::kBuffer : exec::Space::kShared, uniform)
                          : buffer ? exec::atomic_buffer(uniform)
                                   : exec::atomic_shared(uniform);
  append(handler, buffer ? "atomic" : "atomic_shared", op.instr, op.dst.count != 0 ? place(result(op, 0)) : Place{},
         at);
  attach(op, row);
}

void Emitter::atomic_wide(const ScalarOp& op, MemoryOp row, std::uint32_t address) {
  for (std::uint32_t k = address + 1; k < op.src.count && k < address + 5; ++k)
    row.data[k - address - 1] = in_register(source(op, k)).offset;
  const Place at = place(source(op, address));
  const auto space = address == 1 ? exec::Space::kBuffer : exec::Space::kShared;
  Instruction& instruction = append(exec::atomic_wide(space, at.file == 'u'), "atomic_wide", op.instr,
                                    op.dst.count != 0 ? place(result(op, 0)) : Place{}, at);
  instruction.extra[1] = op.dst.count > 1 ? place(result(op, 1)).offset : kNoOperand;
  note().high = 'r';
  attach(op, row);
}

/// Sources: the address (two words), the offset, then values.
void Emitter::global(const ScalarOp& op) {
  constexpr std::uint32_t kValues = 3;
  MemoryOp row = buffer_row(op, false);
  row.element_bytes = ir::element_bytes(op.instr->imm);
  const bool narrow = row.element_bytes < 4, wide = row.element_bytes == 8;
  Handler handler = nullptr;
  Place to[2];
  if (op.op == Op::kLoadGlobal) {
    handler = narrow ? exec::load_narrow(exec::Space::kGlobal, false) : exec::load_global();
    row.at = op.at;
    row.components = op.dst.count;
    for (std::uint32_t c = 0; c < op.dst.count && c < 4; ++c) row.data[c] = place(result(op, c)).offset;
  } else if (op.op == Op::kStoreGlobal) {
    handler = narrow ? exec::store_narrow(exec::Space::kGlobal, false) : exec::store_global();
    row.write_mask = op.instr->imm[0] & 15;
    std::uint32_t next = kValues;
    for (std::uint32_t c = 0; c < 4; ++c)
      if (row.write_mask >> c & 1) row.data[c] = in_register(source(op, next++)).offset;
  } else {
    handler = wide     ? exec::atomic_wide(exec::Space::kGlobal, false)
              : narrow ? exec::atomic_half(exec::Space::kGlobal, false)
                       : exec::atomic_global;
    row.atomic = static_cast<ir::AtomicOp>(op.instr->imm[0]);
    std::uint32_t* const values[4] = {&row.data[0], wide ? &row.data[1] : &row.compare, &row.data[2], &row.data[3]};
    for (std::uint32_t k = kValues; k < op.src.count && k < kValues + 4; ++k)
      *values[k - kValues] = in_register(source(op, k)).offset;
    for (std::uint32_t c = 0; c < op.dst.count && c < 2; ++c) to[c] = place(result(op, c));
  }
  const Place low = in_register(source(op, 0)), high = in_register(source(op, 1)), offset = in_register(source(op, 2));
  append(handler, ir::op_name(op.op), op.instr, to[0], low, high, offset).extra[1] = to[1].offset;
  note().high = to[1].file;
  attach(op, row, 'r', op.op == Op::kLoadGlobal);
}

void Emitter::local_array(const ScalarOp& op) {
  const std::uint32_t array = op.instr->data[0];
  if (array >= array_base_.size()) return fail("local array that does not exist");
  MemoryOp row;
  row.array_base = array_base_[array];
  row.array_elements = f_.ir->arrays[array].elements;
  const bool table = !f_.ir->arrays[array].table.empty();
  row.added = op.instr->data[1];
  const Place element = place(source(op, 0));
  const bool uniform = element.file == 'u';
  if (op.op == Op::kLoadArray && table) {
    const Place to = place(result(op, 0));
    append(exec::load_table(to.file == 'u'), "load_table", op.instr, to,
           to.file == 'u' ? element : in_register(source(op, 0)));
  } else if (op.op == Op::kLoadArray) {
    append(exec::load_array(uniform), "load_array", op.instr, place(result(op, 0)), element);
  } else {
    const bool whole = op.instr->data[2] != 0;
    append(exec::store_array(uniform, whole), whole ? "store_array.whole" : "store_array", op.instr, {}, element,
           in_register(source(op, 1)));
  }
  attach(op, row);
}

void Emitter::image(const ScalarOp& op) {
  ImageOp row;
  row.info = *op.instr->image;
  for (auto& operand : row.operand) operand.fill(kNoOperand);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(ir::ImageOperand::kCount); ++i) {
    if (!(row.info.operands >> i & 1)) continue;
    const auto operand = static_cast<ir::ImageOperand>(i);
    if (operand == ir::ImageOperand::kImageIndex) {
      row.image_index = index_operand(source(op, next++), row.info.slot, row.info.count);
    } else if (operand == ir::ImageOperand::kSamplerIndex) {
      row.sampler_index = index_operand(source(op, next++), row.info.sampler_slot, row.info.sampler_count);
    } else {
      const std::uint32_t count = image_operand_components(*op.instr, operand);
      for (std::uint32_t c = 0; c < count; ++c, ++next) {
        if (!is_first_level(row.info.access, operand, f_.scalars[source(op, next)]))
          row.operand[i][c] = in_register(source(op, next)).offset;
      }
    }
  }
  for (std::uint32_t c = 0; c < op.dst.count && c < 4; ++c) row.result[c] = place(result(op, c)).offset;
  append(exec::image, "image", op.instr);
  attach(row);
}

void Emitter::read_first(const ScalarOp& op) {
  const ScalarId from = source(op, 0), to = result(op, 0);
  if (level(from) != Level::kVarying) {
    append(alu_scalar_handler(Op::kMov), "read_first", op.instr, place(to), place(from));
  } else {
    append(f_.scalars[from].boolean ? exec::read_first_mask : exec::read_first, "read_first", op.instr, place(to),
           place(from));
  }
}

void Emitter::wide(const ScalarOp& op) {
  const auto encoded = [](Place at) { return at.file == 'u' ? at.offset | kUniformPlace : at.offset; };
  std::array<Place, 4> sources;
  for (std::uint32_t i = 0; i < op.src.count; ++i) sources[i] = place(source(op, i));
  const Place low = place(result(op, 0));
  const bool scalar = level(result(op, 0)) != Level::kVarying;
  Instruction& instruction =
      append(wide_handler(op.op, scalar), ir::op_name(op.op), op.instr, low, sources[0], sources[1], sources[2]);
  instruction.dst = encoded(low);
  for (std::uint32_t i = 0; i < 3; ++i) instruction.src[i] = encoded(sources[i]);
  instruction.extra[0] = encoded(sources[3]);
  instruction.extra[1] = op.dst.count > 1 ? encoded(place(result(op, 1))) : kNoOperand;
  note().fourth = sources[3].file;
  note().high = op.dst.count > 1 ? place(result(op, 1)).file : ' ';
}

void Emitter::group(const ScalarOp& op) {
  const Place from = in_register(source(op, 0));
  if (op.op == Op::kReduce && op.src.count > 1) {
    const auto combine = static_cast<ir::GroupOp>(op.instr->data[1]);
    Instruction& instruction = append(exec::reduce_wide(combine, static_cast<ir::GroupMode>(op.instr->data[2])),
                                      "reduce.wide", op.instr, place(result(op, 0)), from, in_register(source(op, 1)));
    instruction.extra[0] = op.instr->data[0];
    instruction.extra[1] = place(result(op, 1)).offset;
    note().high = place(result(op, 1)).file;
    return;
  }
  for (std::uint32_t c = 0; c < op.dst.count; ++c) {
    const Place to = place(result(op, c));
    if (to.file == ' ') continue;
    const bool uniform = to.file == 'u';
    if (op.op == Op::kBallot) {
      append(uniform ? exec::ballot_uniform : exec::ballot, "ballot", op.instr, to, from).extra[1] = c;
    } else if (op.op == Op::kShuffle) {
      append(exec::shuffle, "shuffle", op.instr, to, from, in_register(source(op, 1)));
    } else {
      const auto combine = static_cast<ir::GroupOp>(op.instr->data[1]);
      append(exec::reduce(combine, static_cast<ir::GroupMode>(op.instr->data[2]), uniform), "reduce", op.instr, to,
             from);
    }
    program->code.back().extra[0] = op.instr->data[0];
  }
}

void Emitter::probe(const ScalarOp& op) {
  if (op.dead) return;  // another one tells of it
  ProbeOp row;
  row.probe = op.instr->data[0];
  const std::uint32_t guards = op.instr->data[1];
  for (std::uint32_t k = 0; k < op.src.count; ++k) {
    if (k < guards && guard_outcome(f_, op, k)) continue;  // holds, or no probe were here
    const Place from = place(source(op, k));
    if (k < guards) {
      row.guards.push_back({{from.file, from.offset}, guard_holds(*op.instr, k)});
    } else {
      row.operands.push_back({from.file, from.offset});
    }
  }
  if (op.joined != kNoIndex) row.also = f_.joined_probes[op.joined];
  const bool of_block = f_.ir->probes[row.probe].kind == Probe::Kind::kBlock;
  Instruction& instruction = append(of_block ? exec::block_probe(row) : exec::probe, "probe", op.instr);
  if (!row.guards.empty()) instruction.src[0] = row.guards[0].first.offset;
  instruction.extra[0] = static_cast<std::uint32_t>(program->probe_ops.size());
  program->probe_ops.push_back(std::move(row));
}

void Emitter::environment(const ScalarOp& op) {
  Handler handler = nullptr;
  switch (op.op) {
    case Op::kBarrier:
      if (f_.ir->interface.local_size[0] * f_.ir->interface.local_size[1] * f_.ir->interface.local_size[2] <=
              base::kWaveWidth &&
          !base::shakes(base::ShakeKind::kOrder))
        return;  // a single wave is always at the same place, unless it runs in parts
      program->has_barrier = true;
      append(exec::barrier, "barrier", op.instr);
      return;
    case Op::kMemoryBarrier:
      return;
    case Op::kProbe:
      return probe(op);
    case Op::kHelperInvocation:
      handler = exec::helper_invocation;
      break;
    case Op::kElect:
      handler = exec::elect;
      break;
    case Op::kReadClock:
      handler = exec::read_clock;
      break;
    case Op::kWorkgroupId:
      handler = exec::workgroup_id;
      break;
    case Op::kNumWorkgroups:
      handler = exec::num_workgroups;
      break;
    case Op::kSubgroupId:
      handler = exec::subgroup_id;
      break;
    case Op::kLocalInvocationId:
      handler = exec::local_invocation_id;
      break;
    case Op::kLocalInvocationIndex:
      handler = exec::local_invocation_index;
      break;
    case Op::kSubgroupInvocation:
      handler = exec::subgroup_invocation;
      break;
    default:
      return fail("intrinsic that the lowering does not cover");
  }
  for (std::uint32_t c = 0; c < op.dst.count; ++c) {
    const Place to = place(result(op, c));
    if (to.file == ' ') continue;
    append(handler, ir::op_name(op.op), op.instr, to).extra[0] = c;
  }
}

}  // namespace vitrine::spirv::lowering
