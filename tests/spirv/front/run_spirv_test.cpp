// SPIR-V assembly through the whole pipeline, run as compute: what no GLSL compiler writes.
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kCount = 64;

/// Words of a module whose `body` makes %r (uint) from %x (uint, the invocation's number).
Words module_of(const std::string& body, const std::string& declarations, const std::string& imports) {
  return assemble(imports + R"(
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %id
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%v3uint = OpTypeVector %uint 3
%v3ptr = OpTypePointer Input %v3uint
%id = OpVariable %v3ptr Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%block_ptr = OpTypePointer StorageBuffer %block
%uint_ptr = OpTypePointer StorageBuffer %uint
%buffer = OpVariable %block_ptr StorageBuffer
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%u7 = OpConstant %uint 7
)" + declarations +
                  R"(
%main = OpFunction %void None %fn
%entry = OpLabel
%gid = OpLoad %v3uint %id
%x = OpCompositeExtract %uint %gid 0
)" + body + R"(
%to = OpAccessChain %uint_ptr %buffer %u0 %x
OpStore %to %r
OpReturn
OpFunctionEnd
)");
}

std::vector<std::uint32_t> run_spirv(const std::string& body, const std::string& declarations = "",
                                     const std::string& imports = "OpCapability Shader\n") {
  std::vector<std::uint32_t> values(kCount);
  auto shader = compile(module_of(body, declarations, imports), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return values;
  Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(values.data());
  descriptor.size = values.size() * 4;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Fault fault;
  const BoundShader bound(*shader.value(), table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, groups[3] = {1, 1, 1};
  dispatch(bound, base, groups);
  EXPECT_FALSE(fault.raised) << fault.message;
  return values;
}

TEST(RunSpirv, NonSemanticInstructionsAreIgnored) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%ignored = OpExtInst %void %strange 1 %x
%r = OpIAdd %uint %x %u7
%more = OpExtInst %void %strange 77 %r %u1
)",
                                                   "", R"(
OpCapability Shader
OpExtension "SPV_KHR_non_semantic_info"
%strange = OpExtInstImport "NonSemantic.Nobody.Knows"
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x + 7);
}

}  // namespace
}  // namespace vitrine::spirv::test
