// SPIR-V assembly through the whole pipeline, run as compute: what no GLSL compiler writes.
#include "spirv/addresses.h"
#include "spirv/exec/profile.h"
#include "spirv/exec/wave_memory.h"
#include "spirv/program.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kCount = 64;

/// Words of a module whose `body` makes %r (uint) from %x (uint, the invocation's number).
Words module_of(const std::string& body, const std::string& declarations, const std::string& imports,
                const std::string& addressing, const std::string& decorations) {
  return assemble(imports + "\nOpMemoryModel " + addressing + R"( GLSL450
OpEntryPoint GLCompute %main "main" %id
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
)" + decorations + R"(
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
                                     const std::string& imports = "OpCapability Shader\n",
                                     const std::string& addressing = "Logical", const std::string& decorations = "") {
  std::vector<std::uint32_t> values(kCount);
  auto shader = compile(module_of(body, declarations, imports, addressing, decorations),
                        options_for(VK_SHADER_STAGE_COMPUTE_BIT));
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

/// SPIR-V 1.5 lets the invocation that is broadcast from be any value that is the same in the subgroup.
TEST(RunSpirv, BroadcastsFromADynamicInvocation) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%from = OpAccessChain %uint_ptr %buffer %u0 %u7
%zero = OpLoad %uint %from
%which = OpIAdd %uint %zero %u9
%all = OpGroupNonUniformBroadcast %uint %u3 %x %which
%quad = OpGroupNonUniformQuadBroadcast %uint %u3 %x %u1
%sum = OpIMul %uint %all %u100
%r = OpIAdd %uint %sum %quad
)",
                                                   "%u3 = OpConstant %uint 3\n%u9 = OpConstant %uint 9\n"
                                                   "%u100 = OpConstant %uint 100\n",
                                                   R"(
OpCapability Shader
OpCapability GroupNonUniform
OpCapability GroupNonUniformBallot
OpCapability GroupNonUniformQuad
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], 900 + x / 4 * 4 + 1);
}

/// Where the shader of the following tests finds its pointer: a PhysicalStorageBuffer pointer made of two words.
constexpr char kAddresses[] = R"(
OpCapability Shader
OpCapability PhysicalStorageBufferAddresses
OpExtension "SPV_KHR_physical_storage_buffer"
)";

constexpr char kAddressBody[] = R"(
%p0 = OpBitcast %physical %address
%p = OpPtrAccessChain %physical %p0 %x
OpStore %p %u7 Aligned 4
%r = OpLoad %uint %p Aligned 4
)";

std::vector<std::uint32_t> run_address(std::uint64_t address) {
  const std::string declarations = "%v2uint = OpTypeVector %uint 2\n%low = OpConstant %uint " +
                                   std::to_string(static_cast<std::uint32_t>(address)) + "\n%high = OpConstant %uint " +
                                   std::to_string(address >> 32) +
                                   "\n%address = OpConstantComposite %v2uint %low %high\n"
                                   "%physical = OpTypePointer PhysicalStorageBuffer %uint\n";
  return run_spirv(kAddressBody, declarations, kAddresses, "PhysicalStorageBuffer64",
                   "OpDecorate %physical ArrayStride 4\n");
}

TEST(RunSpirv, PointersReachLiveMemoryOnly) {
  std::vector<std::uint32_t> memory(kCount / 2);
  const auto* bytes = reinterpret_cast<const std::byte*>(memory.data());
  const auto address = reinterpret_cast<std::uintptr_t>(bytes);
  add_addresses(bytes, memory.size() * 4);
  std::vector<std::uint32_t> got = run_address(address);
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x < kCount / 2 ? 7u : 0u) << x;
  for (std::uint32_t word : memory) EXPECT_EQ(word, 7u);
  remove_addresses(bytes);
  for (const std::uint64_t wild :
       {std::uint64_t{0}, std::uint64_t{8}, std::uint64_t{address}, ~std::uint64_t{0} - 40}) {
    got = run_address(wild);
    for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], 0u) << x;
  }
}

TEST(RunSpirv, FaultsNameTheSourceFile) {
  CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  auto shader = compile(assemble(R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main"
OpExecutionMode %main LocalSize 1 1 1
%file = OpString "endless.comp"
%void = OpTypeVoid
%fn = OpTypeFunction %void
%main = OpFunction %void None %fn
%entry = OpLabel
OpLine %file 12 1
OpBranch %head
%head = OpLabel
OpLine %file 13 1
OpLoopMerge %done %again None
OpBranch %again
%again = OpLabel
OpLine %file 14 1
OpBranch %head
%done = OpLabel
OpReturn
OpFunctionEnd
)"),
                        options);
  ASSERT_TRUE(shader) << shader.message();
  EXPECT_EQ(shader.value()->program().files.size(), 1u);
  EXPECT_EQ(shader.value()->program().files[0].second, "endless.comp");
}

TEST(RunSpirv, ProfilesCountInstructionsByName) {
  auto shader = compile(module_of("%r = OpIMul %uint %x %x\n", "", "OpCapability Shader\n", "Logical", ""),
                        options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  ASSERT_TRUE(shader) << shader.message();
  const Program& program = shader.value()->program();
  EXPECT_EQ(exec::take_profile(program), "");
  Fault fault;
  const BoundShader bound(*shader.value(), {}, fault);
  exec::WaveMemory memory;
  for (int run = 0; run < 3; run++) {
    Wave wave;
    memory.bind(bound, wave);
    wave.active = wave.live = wave.launched = base::kAllLanes;
    exec::execute_profiled(wave, program.code.data());
  }
  const std::string table = exec::take_profile(program);
  EXPECT_NE(table.find("store_storage"), std::string::npos) << table;
  EXPECT_NE(table.find("         3 "), std::string::npos) << table;
  EXPECT_EQ(exec::take_profile(program), "");
}

}  // namespace
}  // namespace vitrine::spirv::test
