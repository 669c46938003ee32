// Probes for those who observe a shader: where blocks begin, and what NonSemantic.DebugPrintf says.
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

/// Operand numbers of DebugPrintf: the set, the instruction, the format, its arguments.
constexpr std::uint32_t kFormat = 2, kFirstArgument = 3;

std::string string_of(const Translator& t, std::uint32_t id) {
  const Inst& definition = t.module.def(id);
  if (definition.op != spv::Op::OpString) throw Failure("%" + std::to_string(id) + " is not a string");
  return string_at(definition, 0);
}

}  // namespace

ProbeValue probe_value(Translator& t, const Inst& inst, std::uint32_t id, std::vector<ir::Src>& words) {
  ProbeValue result;
  result.first_word = static_cast<std::uint32_t>(words.size());
  const Value value = value_of(t, id);
  const Type* type = &t.module.type(value.type);
  if (type->kind == Type::Kind::kVector) {
    result.components = static_cast<std::uint8_t>(type->count);
    type = &t.module.type(type->element);
  }
  const bool number = type->kind == Type::Kind::kInt || type->kind == Type::Kind::kFloat;
  if (!number && type->kind != Type::Kind::kBool) fail(inst, "argument is not a number, boolean or vector");
  result.width = static_cast<std::uint8_t>(number ? type->width : 32);
  result.type = type->kind == Type::Kind::kBool    ? 'B'
                : type->kind == Type::Kind::kFloat ? 'F'
                : type->is_signed                  ? 'I'
                                                   : 'U';
  for (std::uint8_t c = 0; c < result.components; ++c)
    for (const ir::ValueId leaf : value.leaves) words.push_back(splat(leaf, c));
  return result;
}

void emit_probe(Translator& t, Probe probe, std::vector<ir::Src> words) {
  ir::Instr& instr = emit_effect(t, ir::Op::kProbe, std::move(words));
  instr.data[0] = static_cast<std::uint32_t>(t.function.probes.size());
  probe.place = instr.origin.place;
  t.function.probes.push_back(std::move(probe));
}

void probe_block(Translator& t, const Block& block) {
  t.inst = &t.module.code[block.first];
  Probe probe;
  probe.kind = Probe::Kind::kBlock;
  probe.id = block.label;
  probe.function = t.frames.back().function->id;
  probe.enters = t.frames.back().function->entry == block.label;
  for (std::uint32_t i = block.first; i <= block.last; ++i) {
    const Inst& inst = t.module.code[i];
    if (inst.op == spv::Op::OpVariable || inst.op == spv::Op::OpPhi || inst.origin.place == 0) continue;
    if (probe.places.empty()) t.inst = &inst;
    if (probe.places.empty() || probe.places.back() != inst.origin.place) probe.places.push_back(inst.origin.place);
  }
  probe.end_place = t.module.code[block.last].origin.place;
  count_costs(t.module, block, probe);
  probe.successors = successors_of(t.module, block);
  emit_probe(t, std::move(probe), {});
}

void debug_printf(Translator& t, const Inst& inst) {
  if (!t.interest.printf) return;
  Probe probe;
  probe.kind = Probe::Kind::kPrintf;
  probe.id = inst.result;
  probe.format = string_of(t, inst.operand(kFormat));
  std::vector<ir::Src> words;
  for (std::uint32_t i = kFirstArgument; inst.has(i); ++i)
    probe.values.push_back(probe_value(t, inst, inst.operand(i), words));
  emit_probe(t, std::move(probe), std::move(words));
}

}  // namespace vitrine::spirv::front
