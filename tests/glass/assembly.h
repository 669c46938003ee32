// Hand-written modules of the catalogue: a frame for the bodies of main() in three stages. Every line of a body is a
// line of the source.
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include <spirv-tools/libspirv.hpp>

#include <vulkan/vulkan_core.h>

namespace vitrine::glass::test {

/// A module in words, and where its fault is. Bodies know %i, the number of the invocation, %at, a pointer to word %i
/// of the scene's first buffer, and %x, what it holds: that number.
struct Assembly {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
  std::string capabilities;  ///< lines
  std::string decorations;   ///< lines
  std::string declarations;  ///< lines
  std::string interface;     ///< ids of global variables besides those of the frame
  std::string body;          ///< lines; '@' in front of the one with the fault
  std::string functions;     ///< lines, the same

  std::vector<std::uint32_t> words(std::uint32_t& fault_line) const;
};

inline constexpr char kDeclarations[] = R"(%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%v2uint = OpTypeVector %uint 2
%v3uint = OpTypeVector %uint 3
%v4uint = OpTypeVector %uint 4
%v2int = OpTypeVector %int 2
%v4float = OpTypeVector %float 4
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%u2 = OpConstant %uint 2
%u3 = OpConstant %uint 3
%u4 = OpConstant %uint 4
%u5 = OpConstant %uint 5
%u7 = OpConstant %uint 7
%u8 = OpConstant %uint 8
%u9 = OpConstant %uint 9
%u30 = OpConstant %uint 30
%u60 = OpConstant %uint 60
%u56 = OpConstant %uint 56
%u264 = OpConstant %uint 264
%i1 = OpConstant %int 1
%i3 = OpConstant %int 3
%i7 = OpConstant %int 7
%f0 = OpConstant %float 0
%f1 = OpConstant %float 1
%f5 = OpConstant %float 5
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%block_pointer = OpTypePointer StorageBuffer %block
%word_pointer = OpTypePointer StorageBuffer %uint
%v = OpVariable %block_pointer StorageBuffer
%n_array = OpTypeArray %uint %u4
%push_block = OpTypeStruct %v2uint %n_array
%push_pointer = OpTypePointer PushConstant %push_block
%push_word = OpTypePointer PushConstant %uint
%push_pair = OpTypePointer PushConstant %v2uint
%push = OpVariable %push_pointer PushConstant
%physical = OpTypePointer PhysicalStorageBuffer %uint
%local_word = OpTypePointer Function %uint
)";

inline constexpr char kDecorations[] = R"(OpDecorate %words ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %v DescriptorSet 0
OpDecorate %v Binding 0
OpDecorate %n_array ArrayStride 4
OpDecorate %push_block Block
OpMemberDecorate %push_block 0 Offset 0
OpMemberDecorate %push_block 1 Offset 8
)";

/// What differs between stages.
struct StageFrame {
  const char *capabilities, *entry, *modes, *decorations, *declarations, *begin;
};

inline StageFrame frame_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return {"",
              "Fragment",
              "OpExecutionMode %main OriginUpperLeft\n",
              "OpDecorate %in BuiltIn FragCoord\n",
              "%in_pointer = OpTypePointer Input %v4float\n%in = OpVariable %in_pointer Input\n",
              "%position = OpLoad %v4float %in\n%px = OpCompositeExtract %float %position 0\n"
              "%i = OpConvertFToU %uint %px\n"};
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return {"OpCapability Tessellation\n",
              "TessellationControl",
              "OpExecutionMode %main OutputVertices 8\n",
              "OpDecorate %in BuiltIn InvocationId\n",
              "%in_pointer = OpTypePointer Input %uint\n%in = OpVariable %in_pointer Input\n",
              "%i = OpLoad %uint %in\n"};
    default:
      return {"",
              "GLCompute",
              "OpExecutionMode %main LocalSize 8 1 1\n",
              "OpDecorate %in BuiltIn GlobalInvocationId\n",
              "%in_pointer = OpTypePointer Input %v3uint\n%in = OpVariable %in_pointer Input\n",
              "%gid = OpLoad %v3uint %in\n%i = OpCompositeExtract %uint %gid 0\n"};
  }
}

/// Puts an OpLine in front of every line but a merge's branch; `line` goes on.
inline std::string with_lines(const std::string& text, std::uint32_t& line, std::uint32_t& fault_line) {
  std::istringstream lines(text);
  std::string result, one;
  bool merged = false;
  while (std::getline(lines, one)) {
    if (one.empty()) continue;
    ++line;
    if (one[0] == '@') {
      fault_line = line;
      one.erase(0, 1);
    }
    if (!merged) result += "OpLine %file " + std::to_string(line) + " 1\n";
    result += one + "\n";
    merged = one.find("Merge") != std::string::npos;
  }
  return result;
}

inline std::vector<std::uint32_t> Assembly::words(std::uint32_t& fault_line) const {
  const StageFrame frame = frame_of(stage);
  std::uint32_t line = 0;
  fault_line = 0;
  const std::string locals = body.substr(0, body.find('\n') + 1);
  const bool has_local = locals.find("OpVariable") != std::string::npos;
  const std::string lines =
      with_lines(has_local ? locals : "", line, fault_line) +
      with_lines(frame.begin + std::string("%at = OpAccessChain %word_pointer %v %u0 %i\n%x = OpLoad %uint %at\n") +
                     (has_local ? body.substr(locals.size()) : body),
                 line, fault_line);
  const std::string text =
      std::string("OpCapability Shader\nOpCapability PhysicalStorageBufferAddresses\n") + frame.capabilities +
      capabilities + "%glsl = OpExtInstImport \"GLSL.std.450\"\nOpMemoryModel PhysicalStorageBuffer64 GLSL450\n" +
      "OpEntryPoint " + frame.entry + " %main \"main\" %in %v %push " + interface + "\n" + frame.modes +
      "%file = OpString \"shader.spvasm\"\n" + kDecorations + frame.decorations + decorations + kDeclarations +
      frame.declarations + declarations + "%main = OpFunction %void None %fn\n%entry = OpLabel\n" + lines +
      "OpReturn\nOpFunctionEnd\n" + with_lines(functions, line, fault_line);
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
  std::string log;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
    log += std::to_string(at.line) + ": " + message + "\n";
  });
  std::vector<std::uint32_t> words;
  EXPECT_TRUE(tools.Assemble(text, &words)) << log << text;
  EXPECT_TRUE(tools.Validate(words)) << log << text;
  return words;
}

}  // namespace vitrine::glass::test
