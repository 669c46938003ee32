// The text of a compute module in SPIR-V assembly, without what every hand-written one would repeat.
#pragma once

#include <string>
#include <vector>

namespace vitrine {

/// What a module adds to this frame: storage buffers of words in set 0, and an entry point %main with %entry, %id
/// (GlobalInvocationId), %gid, %n (its x), and an instruction that leaves it.
/// Declared: %void %fn %bool %uint %v3uint %v3ptr %array (runtime array of %uint) %block %block_ptr %uint_ptr %u0 %u1.
/// Every string is whole lines of assembly, unless said otherwise.
struct ComputeText {
  std::string capabilities;                          ///< besides Shader; also extensions and imports, in this order
  std::string addressing = "Logical";                ///< a word
  std::string interface;                             ///< ids of the entry point besides %id, separated by spaces
  std::string local_size = "64 1 1";                 ///< three numbers; empty when `annotations` say it
  std::string annotations;                           ///< further execution modes, then names, then decorations
  std::vector<std::string> buffers = {"in", "out"};  ///< names; bindings from 0
  bool uniform = false;                              ///< buffers of storage class Uniform, as SPIR-V 1.0 had them
  std::string declarations;                          ///< further types, constants and variables
  std::string locals;                                ///< variables of the entry point
  std::string body;
  std::string functions;

  std::string text() const {
    const std::string storage = uniform ? "Uniform" : "StorageBuffer";
    std::string decorations, variables;
    for (size_t binding = 0; binding < buffers.size(); ++binding) {
      decorations += "OpDecorate %" + buffers[binding] + " DescriptorSet 0\nOpDecorate %" + buffers[binding] +
                     " Binding " + std::to_string(binding) + "\n";
      variables += "%" + buffers[binding] + " = OpVariable %block_ptr " + storage + "\n";
    }
    return "OpCapability Shader\n" + capabilities + "OpMemoryModel " + addressing +
           " GLSL450\nOpEntryPoint GLCompute %main \"main\" %id " + interface + "\n" +
           (local_size.empty() ? "" : "OpExecutionMode %main LocalSize " + local_size + "\n") + annotations +
           "OpDecorate %id BuiltIn GlobalInvocationId\nOpDecorate %array ArrayStride 4\n"
           "OpMemberDecorate %block 0 Offset 0\nOpDecorate %block " +
           (uniform ? "BufferBlock\n" : "Block\n") + decorations + R"(
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%v3uint = OpTypeVector %uint 3
%v3ptr = OpTypePointer Input %v3uint
%id = OpVariable %v3ptr Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%block_ptr = OpTypePointer )" +
           storage + " %block\n%uint_ptr = OpTypePointer " + storage + " %uint\n" + variables +
           "%u0 = OpConstant %uint 0\n%u1 = OpConstant %uint 1\n" + declarations + R"(
%main = OpFunction %void None %fn
%entry = OpLabel
)" + locals +
           "%gid = OpLoad %v3uint %id\n%n = OpCompositeExtract %uint %gid 0\n" + body + "OpReturn\nOpFunctionEnd\n" +
           functions;
  }
};

/// Loads element %n of a buffer into `id`.
inline std::string load_word(const std::string& id, const std::string& buffer) {
  return id + "_at = OpAccessChain %uint_ptr %" + buffer + " %u0 %n\n" + id + " = OpLoad %uint " + id + "_at\n";
}
/// Stores `id` (a %uint) into element %n of a buffer.
inline std::string store_word(const std::string& id, const std::string& buffer) {
  return id + "_to = OpAccessChain %uint_ptr %" + buffer + " %u0 %n\nOpStore " + id + "_to " + id + "\n";
}

}  // namespace vitrine
