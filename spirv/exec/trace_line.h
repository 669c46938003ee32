// The line of a trace for one instruction and one lane.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "spirv/exec/operand_list.h"

namespace vitrine::spirv::exec {

/// Columns of a line: name of the instruction, operands.
inline constexpr std::size_t kTraceNameColumn = 7, kTraceOperandColumn = 25;

/// `text` and spaces up to the column, at least one.
std::string padded(std::string text, std::size_t column);

/// "r3 = 3f800000 1".
std::string result_text(const Wave& wave, OperandPlace place, std::size_t lane);

/// One instruction of the code or the preamble as it runs for one lane.
class TraceLine {
 public:
  TraceLine(const Wave& wave, const Instruction& instruction, const InstructionNote& note, std::size_t index);

  /// Before the instruction runs, which may overwrite its operands.
  void read(const Wave& wave, std::size_t lane);

  /// After it. `jump`: the instruction that runs next, if it is not the one behind this.
  std::string text(const Wave& wave, std::size_t lane, std::optional<std::size_t> jump) const;

 private:
  const Instruction& instruction_;
  const InstructionNote& note_;
  OperandList operands_;
  std::string head_, sources_;
};

}  // namespace vitrine::spirv::exec
