// Tables of what the lowering makes of a few lines (tests/spirv/ir_text.h): the disassembled program. It is lowered as
// for an observer, without chains, so that it is the same for every SIMD target.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>

#include "spirv/exec/observe.h"
#include "spirv/ir_passes.h"
#include "spirv/lower/lower.h"
#include "spirv/program.h"
#include "tests/spirv/ir_text.h"

namespace vitrine::spirv::test {

struct LowerCase {
  const char* why;
  const char* in;
  const char* out;
};

class Nobody : public exec::Observer {
  std::unique_ptr<exec::Watch> watch(const Wave&, const Instruction*) const override { return nullptr; }
};

/// The disassembly without spaces at the ends of lines, and without a preamble that does nothing.
inline std::string tidied(std::string text) {
  for (std::size_t at = text.find(" \n"); at != std::string::npos; at = text.find(" \n", at == 0 ? 0 : at - 1))
    text.erase(at, 1);
  const std::string empty = "preamble:\n    0  end\n";
  if (const std::size_t at = text.find(empty); at != std::string::npos) text.erase(at, empty.size());
  return text;
}

/// The program of a compute shader that consists of these lines.
inline std::string program_of(const char* text) {
  ir::Function function = parse_ir(text);
  function.interface.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  ir::make_joins_whole(function);
  const auto shader = lower(std::move(function), std::make_shared<Nobody>());
  return shader.ok() ? tidied(disassemble(shader.value()->program())) : shader.message();
}

inline void check_lowered(std::span<const LowerCase> cases) {
  for (const LowerCase& row : cases) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ('\n' + program_of(row.in), row.out) << "of" << row.in;
  }
}

}  // namespace vitrine::spirv::test
