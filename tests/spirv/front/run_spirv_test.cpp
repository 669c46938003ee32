// SPIR-V assembly through the whole pipeline, run as compute: what no GLSL compiler writes.
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <limits>

#include "base/numeric.h"
#include "spirv/addresses.h"
#include "spirv/exec/profile.h"
#include "spirv/exec/wave_memory.h"
#include "spirv/program.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kCount = 64;

/// Words of a module whose `body` makes %r (uint) from %x (uint, the invocation's number). `interface`: further
/// variables of the entry point; the module is of SPIR-V 1.4 then.
Words module_of(const std::string& body, const std::string& declarations, const std::string& capabilities,
                const std::string& addressing, const std::string& annotations, const std::string& interface = "") {
  ComputeText module;
  module.capabilities = capabilities;
  module.addressing = addressing;
  module.interface = interface;
  module.annotations = annotations;
  module.buffers = {"buffer"};
  module.declarations = "%u7 = OpConstant %uint 7\n" + declarations;
  module.body = "%x = OpCopyObject %uint %n\n" + body + store_word("%r", "buffer");
  return assemble(module.text(), interface.empty() ? SPV_ENV_VULKAN_1_1 : SPV_ENV_VULKAN_1_1_SPIRV_1_4);
}

std::vector<std::uint32_t> run_spirv(const std::string& body, const std::string& declarations = "",
                                     const std::string& capabilities = "", const std::string& addressing = "Logical",
                                     const std::string& annotations = "", const std::string& interface = "") {
  std::vector<std::uint32_t> values(kCount);
  dispatch_over(values, module_of(body, declarations, capabilities, addressing, annotations, interface),
                options_for(VK_SHADER_STAGE_COMPUTE_BIT), 1);
  return values;
}

constexpr char kPointerCapabilities[] = "OpCapability VariablePointers\n";

TEST(RunSpirv, PointersCompareAndSubtract) {
  // "Pointers must be from the same array": here the fourth element and that of the invocation.
  const std::string chains =
      "%u3 = OpIAdd %uint %u1 %u1\n%four = OpAccessChain %uint_ptr %buffer %u0 %u7\n"
      "%own = OpAccessChain %uint_ptr %buffer %u0 %x\n";
  const auto selected = [&](const std::string& condition) {
    return run_spirv(chains + condition + "%r = OpSelect %uint %c %u7 %u1\n", "", kPointerCapabilities, "Logical",
                     "OpDecorate %uint_ptr ArrayStride 4\n", " %buffer");
  };
  const auto equal = selected("%c = OpPtrEqual %bool %four %own\n");
  const auto different = selected("%c = OpPtrNotEqual %bool %four %own\n");
  const auto distance = run_spirv(chains + "%r = OpPtrDiff %uint %own %four\n", "", kPointerCapabilities, "Logical",
                                  "OpDecorate %uint_ptr ArrayStride 4\n", " %buffer");
  for (std::uint32_t i = 0; i < kCount; i++) {
    EXPECT_EQ(equal[i], i == 7 ? 7u : 1u);
    EXPECT_EQ(different[i], i == 7 ? 1u : 7u);
    EXPECT_EQ(distance[i], i - 7);
  }
}

/// As glslang copies between block layouts: structures of one number are no numbers.
TEST(RunSpirv, StructuresOfOneMemberAreCopiedLogically) {
  const auto copied = run_spirv(
      "%one = OpCompositeConstruct %one_a %x\n%two = OpCopyLogical %one_b %one\n"
      "%three = OpCopyLogical %row_a %row\n%y = OpCompositeExtract %uint %two 0\n"
      "%z = OpCompositeExtract %uint %three 0 0\n%r = OpIAdd %uint %y %z\n",
      "%one_a = OpTypeStruct %uint\n%one_b = OpTypeStruct %uint\n%row_a = OpTypeArray %one_a %u1\n"
      "%row_b = OpTypeArray %one_b %u1\n%seven = OpConstantComposite %one_b %u7\n"
      "%row = OpConstantComposite %row_b %seven\n",
      "", "Logical", "", " %buffer");
  for (std::uint32_t i = 0; i < kCount; i++) EXPECT_EQ(copied[i], i + 7);
}

/// SPV_KHR_expect_assume: values are what they are, whatever is expected of them.
TEST(RunSpirv, ExpectationsAreTheValues) {
  const auto got = run_spirv(
      "%low = OpULessThan %bool %x %u7\n%is = OpExpectKHR %bool %low %no\n%e = OpExpectKHR %uint %x %u7\n"
      "%fits = OpUGreaterThanEqual %bool %e %u0\nOpAssumeTrueKHR %fits\n%more = OpIAdd %uint %e %u7\n"
      "%pair = OpCompositeConstruct %uint2 %more %e\n%both = OpExpectKHR %uint2 %pair %sevens\n"
      "%one = OpCompositeExtract %uint %both 0\n%other = OpCompositeExtract %uint %both 1\n"
      "%r = OpSelect %uint %is %one %other\n",
      "%no = OpConstantFalse %bool\n%uint2 = OpTypeVector %uint 2\n%sevens = OpConstantComposite %uint2 %u7 %u7\n",
      "OpCapability ExpectAssumeKHR\nOpExtension \"SPV_KHR_expect_assume\"\n");
  for (std::uint32_t i = 0; i < kCount; i++) EXPECT_EQ(got[i], i < 7 ? i + 7 : i);
}

TEST(RunSpirv, GroupsRotateAndCombineBooleans) {
  const std::string capabilities =
      "OpCapability GroupNonUniformArithmetic\nOpCapability GroupNonUniformRotateKHR\n"
      "OpExtension \"SPV_KHR_subgroup_rotate\"\n";
  const auto got =
      run_spirv("%r = OpGroupNonUniformRotateKHR %uint %u3 %x %u7\n", "%u3 = OpConstant %uint 3\n", capabilities);
  for (std::uint32_t i = 0; i < kCount; i++) EXPECT_EQ(got[i], (i + 7) % kCount);
  const auto combined = [&](const std::string& opcode) {
    return run_spirv("%low = OpULessThan %bool %x %u7\n%c = " + opcode +
                         " %bool %u3 InclusiveScan %low\n%r = OpSelect %uint %c %u1 %u0\n",
                     "%u3 = OpConstant %uint 3\n", "OpCapability GroupNonUniformArithmetic\n");
  };
  const auto all = combined("OpGroupNonUniformLogicalAnd"), some = combined("OpGroupNonUniformLogicalOr"),
             odd = combined("OpGroupNonUniformLogicalXor");
  for (std::uint32_t i = 0; i < kCount; i++) {
    EXPECT_EQ(all[i], i < 7 ? 1u : 0u);
    EXPECT_EQ(some[i], 1u);
    EXPECT_EQ(odd[i], (std::min(i, 6u) + 1) & 1);
  }
}

/// Not a built-in, and compute shaders have no other inputs: whatever registers hold must not show.
TEST(RunSpirv, InputsThatNothingSuppliesAreZero) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%lost_at = OpAccessChain %lost_ptr %lost
%lost_value = OpLoad %uint %lost_at
%r = OpIAdd %uint %lost_value %x
)",
                                                   R"(
%lost_ptr = OpTypePointer Input %uint
%lost = OpVariable %lost_ptr Input
)",
                                                   "", "Logical", "", " %buffer %lost");
  for (std::uint32_t i = 0; i < kCount; i++) ASSERT_EQ(got[i], i);
}

/// The upper half of an exponent counts: 2^32 has a zero for its lower one.
TEST(RunSpirv, ExponentsOf64BitsAreNotCut) {
  const auto scaled = [](const std::string& exponent) {
    return run_spirv("%scaled = OpExtInst %float %glsl Ldexp %three %far\n%r = OpBitcast %uint %scaled\n",
                     "%float = OpTypeFloat 32\n%three = OpConstant %float 3\n%long = OpTypeInt 64 1\n"
                     "%far = OpConstant %long " +
                         exponent + "\n",
                     "OpCapability Int64\n%glsl = OpExtInstImport \"GLSL.std.450\"\n")[0];
  };
  EXPECT_EQ(scaled("2"), base::bits_of(12.0f));
  EXPECT_EQ(scaled("-2"), base::bits_of(0.75f));
  EXPECT_EQ(scaled("4294967296"), base::bits_of(std::numeric_limits<float>::infinity()));
  EXPECT_EQ(scaled("-4294967296"), base::bits_of(0.0f));
  EXPECT_EQ(scaled("9223372036854775807"), base::bits_of(std::numeric_limits<float>::infinity()));
}

TEST(RunSpirv, NonSemanticInstructionsAreIgnored) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%ignored = OpExtInst %void %strange 1 %x
%r = OpIAdd %uint %x %u7
%more = OpExtInst %void %strange 77 %r %u1
)",
                                                   "", R"(
OpExtension "SPV_KHR_non_semantic_info"
%strange = OpExtInstImport "NonSemantic.Nobody.Knows"
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x + 7);
}

/// The reference refuses such modules, which 2.11 of the SPIR-V specification allows: branches meet before the merge
/// block, and the block where they do defines what follows.
/// Slang writes OpSource Slang (11), which SPIRV-Tools learnt after Debian 12's version.
TEST(RunSpirv, SourceLanguagesMayBeYoungerThanTheValidator) {
  Words words = module_of("%r = OpIAdd %uint %x %u7\n", "", "OpCapability Shader\n", "Logical", "");
  const auto before_annotations = std::find_if(words.begin() + 5, words.end(), [](std::uint32_t word) {
    return (word & 0xffffu) == static_cast<std::uint32_t>(spv::Op::OpDecorate);
  });
  ASSERT_NE(before_annotations, words.end());
  const std::uint32_t source[] = {3u << 16 | static_cast<std::uint32_t>(spv::Op::OpSource), 11, 1};
  words.insert(before_annotations, std::begin(source), std::end(source));
  const auto shader = compile(words, options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  EXPECT_TRUE(shader) << shader.message();
}

TEST(RunSpirv, BranchesMayMeetBeforeTheMergeBlock) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%odd_bit = OpBitwiseAnd %uint %x %u1
%odd = OpIEqual %bool %odd_bit %u1
OpSelectionMerge %joined None
OpBranchConditional %odd %yes %no
%yes = OpLabel
%a = OpIMul %uint %x %u7
OpBranch %early
%no = OpLabel
%b = OpIAdd %uint %x %u1
OpBranch %early
%early = OpLabel
%c = OpPhi %uint %a %yes %b %no
%d = OpIAdd %uint %c %u1
OpBranch %joined
%joined = OpLabel
%e = OpIMul %uint %d %d
%r = OpIAdd %uint %e %c
)");
  for (std::uint32_t x = 0; x < kCount; x++) {
    const std::uint32_t c = x % 2 ? x * 7 : x + 1;
    EXPECT_EQ(got[x], (c + 1) * (c + 1) + c) << x;
  }
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
OpCapability GroupNonUniform
OpCapability GroupNonUniformBallot
OpCapability GroupNonUniformQuad
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], 900 + x / 4 * 4 + 1);
}

/// Where the shader of the following tests finds its pointer: a PhysicalStorageBuffer pointer made of two words.
constexpr char kAddresses[] = R"(
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

/// SPIR-V before 1.6 lets both sides of a conditional branch be one block.
TEST(RunSpirv, BothSidesOfABranchMayBeOneBlock) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%small = OpULessThan %bool %x %u7
OpSelectionMerge %after None
OpBranchConditional %small %side %side
%side = OpLabel
%more = OpIAdd %uint %x %u7
OpBranch %after
%after = OpLabel
%r = OpPhi %uint %more %side
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x + 7);
}

TEST(RunSpirv, OffsetAndCountOfABitFieldHaveAnyWidth) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%high = OpBitFieldInsert %uint %u0 %x %s8 %l6
%low = OpBitFieldUExtract %uint %x %l2 %s2
%r = OpIAdd %uint %high %low
)",
                                                   R"(
%short = OpTypeInt 16 1
%long = OpTypeInt 64 0
%s2 = OpConstant %short 2
%s8 = OpConstant %short 8
%l2 = OpConstant %long 2
%l6 = OpConstant %long 6
)",
                                                   "OpCapability Int16\nOpCapability Int64\n");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], (x << 8) + (x >> 2 & 3)) << x;
}

TEST(RunSpirv, LengthsAndIndicesHaveAnyWidth) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%a = OpAccessChain %local_uint %local %s1
OpStore %a %x
%b = OpInBoundsAccessChain %local_uint %local %l1
%r = OpLoad %uint %b
)",
                                                   R"(
%short = OpTypeInt 16 1
%long = OpTypeInt 64 0
%s1 = OpConstant %short 1
%l1 = OpConstant %long 1
%l2 = OpConstant %long 2
%row = OpTypeArray %uint %l2
%pair = OpTypeStruct %uint %uint
%unused = OpTypeStruct %row
%pair_ptr = OpTypePointer Private %pair
%local_uint = OpTypePointer Private %uint
%local = OpVariable %pair_ptr Private
)",
                                                   "OpCapability Int16\nOpCapability Int64\n");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x) << x;
}

TEST(RunSpirv, UndefinedImagesMayStandUnused) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%nothing = OpUndef %image
%none = OpUndef %sampler
%r = OpCopyObject %uint %x
)",
                                                   R"(
%float = OpTypeFloat 32
%image = OpTypeImage %float 2D 0 0 0 1 Unknown
%sampler = OpTypeSampler
)");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], x);
}

TEST(RunSpirv, TruncatesToBinary16) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%given = OpConvertUToF %float %x
%scaled = OpFMul %float %given %f
%wide = OpFConvert %double %scaled
%short = OpFConvert %half %wide
%even = OpIMul %uint %x %u2
%half_at = OpAccessChain %half_ptr %halves %u0 %even
OpStore %half_at %short
%word_at = OpAccessChain %uint_ptr %buffer %u0 %x
%r = OpLoad %uint %word_at
)",
                                                   R"(
%float = OpTypeFloat 32
%double = OpTypeFloat 64
%half = OpTypeFloat 16
%f = OpConstant %float 1.00146484375
%u2 = OpConstant %uint 2
%half_array = OpTypeRuntimeArray %half
%half_block = OpTypeStruct %half_array
%half_block_ptr = OpTypePointer StorageBuffer %half_block
%half_ptr = OpTypePointer StorageBuffer %half
%halves = OpVariable %half_block_ptr StorageBuffer
)",
                                                   R"(
OpCapability Float64
OpCapability StorageBuffer16BitAccess
OpExtension "SPV_KHR_16bit_storage"
OpExtension "SPV_KHR_storage_buffer_storage_class"
)",
                                                   "Logical", R"(
OpDecorate %short FPRoundingMode RTZ
OpDecorate %half_array ArrayStride 2
OpDecorate %half_block Block
OpMemberDecorate %half_block 0 Offset 0
OpDecorate %halves DescriptorSet 0
OpDecorate %halves Binding 0
OpDecorate %halves Aliased
OpDecorate %buffer Aliased
)");
  // 1 + 1.5 / 1024 lies in the middle of 1 + 1 / 1024 and 1 + 2 / 1024, of which the second is even.
  EXPECT_EQ(got[0], 0u);
  EXPECT_EQ(got[1], 0x3c01u);
  EXPECT_EQ(got[2], 0x4001u);
  EXPECT_EQ(got[4], 0x4401u);
}

TEST(RunSpirv, ArraysOfBuffersMayBeSelected) {
  const std::vector<std::uint32_t> got = run_spirv(R"(
%small = OpULessThan %bool %x %u7
%which = OpSelect %array_ptr %small %buffers %buffers
%from = OpAccessChain %uint_ptr %which %u0 %u0 %x
OpStore %from %u7
%back = OpAccessChain %uint_ptr %buffer %u0 %x
%r = OpLoad %uint %back
)",
                                                   R"(
%one = OpTypeArray %block %u1
%array_ptr = OpTypePointer StorageBuffer %one
%buffers = OpVariable %array_ptr StorageBuffer
)",
                                                   R"(
OpCapability VariablePointers
)",
                                                   "Logical",
                                                   "OpDecorate %buffers DescriptorSet 0\n"
                                                   "OpDecorate %buffers Binding 0\n");
  for (std::uint32_t x = 0; x < kCount; x++) EXPECT_EQ(got[x], 7u);
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
  const SourceInfo& sources = *shader.value()->program().sources;
  ASSERT_EQ(sources.files.size(), 2u);
  EXPECT_EQ(sources.files[1].name, "endless.comp");
}

TEST(RunSpirv, ProfilesCountInstructionsByName) {
  auto shader =
      compile(module_of("%r = OpIMul %uint %x %x\n", "", "", "Logical", ""), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
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
