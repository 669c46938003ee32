// Sessions by script over a compute shader and its buffer.
#pragma once

#include "tests/glass/debug/scripted.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::debug::test {

using Lines = std::vector<std::string>;
using vitrine::test::DebugInfo;

struct Session {
  std::string text;
  std::vector<std::uint32_t> words;  ///< of the buffer, behind it
};

/// The buffer, set 0, binding 0, begins with 10, 11, 12...
inline Session session(Lines lines, const std::string& shader, DebugInfo info = DebugInfo::kNonSemantic,
                       std::uint32_t groups = 1, Shown shown = Shown::kRehearsal) {
  std::string log;
  const auto module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, shader, vitrine::test::VulkanVersion::k12, log, info);
  EXPECT_FALSE(module.empty()) << log;
  ScriptedDebugger debugger(std::move(lines), shown);
  Session result;
  for (std::uint32_t i = 0; i < 64; ++i) result.words.push_back(10 + i);
  glass::test::run_observed(debugger.tool.get(), module, result.words, groups);
  debugger.tool->commands_done(nullptr);
  result.text = debugger.script.text();
  return result;
}

/// What is said in this order, among other things.
inline void expect_in_order(const std::string& text, const Lines& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << "'" << part << "' is missing behind " << at << " in\n" << text;
    at = found + part.size();
  }
}

}  // namespace vitrine::glass::debug::test
