// Collects the operands of an instruction.
#include "spirv/exec/operand_list.h"

namespace vitrine::spirv::exec {
namespace {

/// `offset` may carry kUniformPlace; nothing lies at an odd byte.
void add(std::vector<OperandPlace>& list, char file, std::uint32_t offset) {
  if (file != ' ' && offset != kNoOperand) list.push_back({file, offset & ~kUniformPlace});
}

void add(std::vector<OperandPlace>& list, const IndexOperand& index) {
  if (index.file != IndexOperand::File::kConstant)
    add(list, index.file == IndexOperand::File::kVarying ? 'r' : 'u', index.value);
}

void add_memory(OperandList& list, const MemoryOp& row, const InstructionNote& note) {
  for (const std::uint32_t offset : row.data) add(note.loads ? list.results : list.sources, note.data, offset);
  add(list.sources, 'r', row.compare);
  add(list.sources, row.index);
}

void add_image(OperandList& list, const ImageOp& row) {
  for (const std::uint32_t offset : row.result) add(list.results, 'r', offset);
  for (const auto& operand : row.operand)
    for (const std::uint32_t offset : operand) add(list.sources, 'r', offset);
  add(list.sources, row.image_index);
  add(list.sources, row.sampler_index);
}

}  // namespace

OperandList operands_of(const Program& program, const Instruction& instruction, const InstructionNote& note) {
  OperandList list;
  add(list.results, note.files[0], instruction.dst);
  add(list.results, note.high, instruction.extra[1]);
  for (std::size_t i = 0; i < 3; ++i) add(list.sources, note.files[i + 1], instruction.src[i]);
  add(list.sources, note.fourth, instruction.extra[0]);
  if (note.extra == InstructionNote::Extra::kMemory) add_memory(list, program.memory_ops[instruction.extra[0]], note);
  if (note.extra == InstructionNote::Extra::kImage) add_image(list, program.image_ops[instruction.extra[0]]);
  return list;
}

}  // namespace vitrine::spirv::exec
