// Text form of a Program, for logs and tests.
#include <algorithm>
#include <string_view>

#include "spirv/program.h"

namespace vitrine::spirv {
namespace {

std::string operand(char file, std::uint32_t offset) {
  switch (file) {
    case 'r':
      return " r" + std::to_string(offset / kRegisterStride);
    case 'u':
      return " u" + std::to_string(offset / 4);
    case 'm':
      return " m" + std::to_string(offset / sizeof(base::LaneMask));
    default:
      return "";
  }
}

std::string operands(char file, const std::array<std::uint32_t, 4>& offsets) {
  std::string text;
  for (const std::uint32_t offset : offsets)
    if (offset != kNoOperand) text += operand(file, offset);
  return text;
}

/// Words loaded or stored, and where: descriptor and constant offset.
std::string memory(const MemoryOp& row, const InstructionNote& note) {
  std::string text = " (" + operands(note.data, row.data) + " )";
  text += " set " + std::to_string(row.set) + " slot " + std::to_string(row.slot);
  if (row.added != 0) text += " +" + std::to_string(static_cast<std::int32_t>(row.added));
  return text;
}

std::string image(const ImageOp& row) {
  std::string text = " (" + operands('r', row.result) + " )";
  for (const auto& offsets : row.operand) text += operands('r', offsets);
  return text + " set " + std::to_string(row.info.set) + " slot " + std::to_string(row.info.slot);
}

std::string extra(const Program& program, const Instruction& instruction, const InstructionNote& note, std::size_t i) {
  switch (note.extra) {
    case InstructionNote::Extra::kNone:
      return "";
    case InstructionNote::Extra::kJump:
      return " -> " + std::to_string(static_cast<std::int64_t>(i) + static_cast<std::int32_t>(instruction.extra[0]));
    case InstructionNote::Extra::kMemory:
      return memory(program.memory_ops[instruction.extra[0]], note);
    case InstructionNote::Extra::kImage:
      return image(program.image_ops[instruction.extra[0]]);
  }
  return "";
}

std::string list(const Program& program, const std::vector<Instruction>& code,
                 const std::vector<InstructionNote>& notes) {
  std::string text;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const InstructionNote& note = notes[i];
    std::string head = std::to_string(i);
    head.insert(0, head.size() < 5 ? 5 - head.size() : 0, ' ');
    head += "  ";
    head += note.name;
    head.resize(std::max<std::size_t>(head.size(), 21), ' ');
    text += head;
    text += operand(note.files[0], code[i].dst);
    for (int k = 0; k < 3; ++k) text += operand(note.files[k + 1], code[i].src[k]);
    text += extra(program, code[i], note, i);
    if (note.origin.spirv_id != 0) text += "  ; %" + std::to_string(note.origin.spirv_id);
    if (note.origin.place != 0 && program.sources) text += ' ' + program.sources->text(note.origin.place);
    text += '\n';
  }
  return text;
}

}  // namespace

std::string disassemble(const Program& program) {
  std::string text = "registers " + std::to_string(program.register_count) + ", masks " +
                     std::to_string(program.mask_count) + ", uniform words " + std::to_string(program.uniform_words) +
                     " (" + std::to_string(program.constants.size()) + " constants)\n";
  text += "preamble:\n" + list(program, program.preamble, program.preamble_notes);
  text += "code:\n" + list(program, program.code, program.notes);
  return text;
}

}  // namespace vitrine::spirv
