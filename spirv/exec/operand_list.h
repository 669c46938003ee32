// What an instruction of a program reads and writes, from its notes and side tables: for the trace.
#pragma once

#include <vector>

#include "spirv/program.h"

namespace vitrine::spirv::exec {

/// A place in one of the files: 'r' varying, 'u' uniform, 'm' mask.
struct OperandPlace {
  char file = ' ';
  std::uint32_t offset = 0;  ///< bytes
};

struct OperandList {
  std::vector<OperandPlace> results, sources;
};

OperandList operands_of(const Program& program, const Instruction& instruction, const InstructionNote& note);

}  // namespace vitrine::spirv::exec
