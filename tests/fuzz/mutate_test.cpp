// What mutations of values leave alone, so that what they make can be compared with the reference.
#include "tests/fuzz/mutate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <spirv-tools/libspirv.hpp>
#include <string>
#include <vector>

namespace vitrine::fuzz {
namespace {

constexpr char kModule[] = R"(OpCapability Shader
%glsl = OpExtInstImport "GLSL.std.450"
OpMemoryModel Logical GLSL450
OpEntryPoint Vertex %main "main" %in %in2 %out
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%float = OpTypeFloat 32
%uint = OpTypeInt 32 0
%u1 = OpConstant %uint 1
%u2 = OpConstant %uint 2
%f0 = OpConstant %float 0
%f9 = OpConstant %float 9
%in_ptr = OpTypePointer Input %float
%out_ptr = OpTypePointer Output %uint
%in = OpVariable %in_ptr Input
%in2 = OpVariable %in_ptr Input
%out = OpVariable %out_ptr Output
%main = OpFunction %void None %fn
%entry = OpLabel
%a = OpLoad %float %in
%b = OpLoad %float %in2
%sum = OpFAdd %float %a %b
%less = OpFOrdLessThan %bool %a %b
%nan = OpIsNan %bool %sum
%either = OpLogicalOr %bool %less %nan
%bits = OpBitcast %uint %sum
%more = OpIAdd %uint %u1 %u2
%clamped = OpExtInst %float %glsl FClamp %sum %f0 %f9
%small = OpConvertFToU %uint %clamped
%plain = OpSelect %uint %less %more %small
%r = OpSelect %uint %either %plain %bits
OpStore %out %r
OpReturn
OpFunctionEnd
)";

Words assembled() {
  Words words;
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_UNIVERSAL_1_0).Assemble(kModule, &words, 0));
  return words;
}

/// The lines of a module's text; ids are numbers, as the assembler counts them.
std::vector<std::string> lines_of(const Words& words) {
  std::string text;
  EXPECT_TRUE(
      spvtools::SpirvTools(SPV_ENV_UNIVERSAL_1_0).Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER));
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

TEST(Mutate, LeavesWhatKeepsResultsDefined) {
  const Words words = assembled();
  const std::vector<std::string> before = lines_of(words);
  // Of the lines that compute: how often each was changed.
  std::vector<int> changed(before.size());
  for (std::uint64_t seed = 0; seed < 500; seed++) {
    Words mutant = words;
    Random random(seed);
    mutate_values(mutant, random);
    const std::vector<std::string> after = lines_of(mutant);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); i++) changed[i] += after[i] != before[i];
  }
  const auto changes_of = [&](const std::string& part, std::size_t skip = 0) {
    for (std::size_t i = 0; i < before.size(); i++)
      if (before[i].find(part) != std::string::npos && skip-- == 0) return changed[i];
    ADD_FAILURE() << part;
    return 0;
  };
  EXPECT_EQ(changes_of("OpIsNan"), 0);
  EXPECT_EQ(changes_of("OpLogicalOr"), 0);
  EXPECT_EQ(changes_of("OpBitcast"), 0);
  EXPECT_EQ(changes_of("OpSelect", 1), 0);
  EXPECT_EQ(changes_of("OpExtInst %"), 0);
  EXPECT_EQ(changes_of("OpConvertFToU"), 0);
  for (const char* open : {"OpFAdd", "OpFOrdLessThan", "OpIAdd", "OpSelect"}) EXPECT_GT(changes_of(open), 0) << open;
}

}  // namespace
}  // namespace vitrine::fuzz
