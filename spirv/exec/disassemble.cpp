// Text form of a Program, for logs and tests.
#include <algorithm>

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

std::string list(const std::vector<Instruction>& code, const std::vector<InstructionNote>& notes) {
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
    if (note.jumps)
      text += " -> " + std::to_string(static_cast<std::int64_t>(i) + static_cast<std::int32_t>(code[i].extra[0]));
    if (note.origin.spirv_id != 0) text += "  ; %" + std::to_string(note.origin.spirv_id);
    if (note.origin.line != 0) text += " line " + std::to_string(note.origin.line);
    text += '\n';
  }
  return text;
}

}  // namespace

std::string disassemble(const Program& program) {
  std::string text = "registers " + std::to_string(program.register_count) + ", masks " +
                     std::to_string(program.mask_count) + ", uniform words " + std::to_string(program.uniform_words) +
                     " (" + std::to_string(program.constants.size()) + " constants)\n";
  text += "preamble:\n" + list(program.preamble, program.preamble_notes);
  text += "code:\n" + list(program.code, program.notes);
  return text;
}

}  // namespace vitrine::spirv
