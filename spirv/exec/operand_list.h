// What an instruction of a program reads and writes, from its notes and side tables: for the trace.
#pragma once

#include <vector>

#include "spirv/program.h"

namespace vitrine::spirv::exec {

struct OperandList {
  std::vector<OperandPlace> results, sources;
};

OperandList operands_of(const Program& program, const Instruction& instruction, const InstructionNote& note);

}  // namespace vitrine::spirv::exec
