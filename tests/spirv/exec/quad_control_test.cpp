// SPV_KHR_quad_control: votes of quads, in which helper invocations take part; whole quads where a shader asks for
// them. With MaximallyReconvergesKHR helpers take part in all group operations.
#include <bit>

#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kLanes = 64;

/// OpGroupNonUniformQuadAllKHR and OpGroupNonUniformQuadAnyKHR, which the installed assembler does not know.
constexpr char kVotes[] =
    "%product = OpIMul %uint %x %k\n%shifted = OpShiftRightLogical %uint %product %s\n"
    "%bit = OpBitwiseAnd %uint %shifted %u1\n%holds = OpIEqual %bool %bit %u1\n"
    "!0x000413f6 %bool %all %holds\n!0x000413f7 %bool %any %holds\n"
    "%all_word = OpSelect %uint %all %u2 %u0\n%any_word = OpSelect %uint %any %u1 %u0\n"
    "%vote = OpBitwiseOr %uint %all_word %any_word\n";
constexpr char kNumbers[] = "%u2 = OpConstant %uint 2\n%k = OpConstant %uint 2654435761\n%s = OpConstant %uint 27\n";

bool holds(std::uint32_t x) { return (x * 2654435761u >> 27 & 1) != 0; }

/// Of the quad of `lane`.
std::uint32_t vote(std::uint32_t lane, base::LaneMask active, bool (*holds_of)(std::uint32_t)) {
  bool all = true, any = false;
  for (std::uint32_t other = lane & ~3u; other < (lane | 3u) + 1; other++) {
    if ((active >> other & 1) == 0) continue;
    all &= holds_of(other);
    any |= holds_of(other);
  }
  return (all ? 2u : 0u) | (any ? 1u : 0u);
}

TEST(QuadControl, VotesOfComputeShaders) {
  for (const bool diverges : {false, true})
    for (const std::uint32_t size : {8u, 64u}) {
      ComputeText module;
      module.capabilities = "OpCapability GroupNonUniform\nOpCapability !5087\nOpExtension \"SPV_KHR_quad_control\"\n";
      module.buffers = {"buffer"};
      module.declarations = std::string(kNumbers) + "%u3 = OpConstant %uint 3\n";
      const std::string store = store_word("%vote", "buffer");
      module.body = "%x = OpCopyObject %uint %n\n";
      if (diverges)
        module.body +=
            "%rest = OpUMod %uint %x %u3\n%some = OpIEqual %bool %rest %u1\nOpSelectionMerge %joined None\n"
            "OpBranchConditional %some %joined %inside\n%inside = OpLabel\n" +
            std::string(kVotes) + store + "OpBranch %joined\n%joined = OpLabel\n";
      else
        module.body += kVotes + store;
      CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
      options.subgroup_size = size;
      std::vector<std::uint32_t> words(kLanes, 77);
      ASSERT_TRUE(dispatch_over(words, assemble(module.text()), options, 1));
      base::LaneMask active = 0;
      for (std::uint32_t lane = 0; lane < kLanes; lane++)
        if (!diverges || lane % 3 != 1) active |= base::LaneMask{1} << lane;
      for (std::uint32_t lane = 0; lane < kLanes; lane++)
        ASSERT_EQ(words[lane], (active >> lane & 1) != 0 ? vote(lane, active, holds) : 77) << lane << ", " << size;
    }
}

/// A fragment shader that gives, of each invocation, the number of those that take part in group operations, times
/// four, and the votes of its quad; those of odd numbers end with `leaving` before.
std::string fragment_text(const std::string& modes, const std::string& leaving) {
  const std::string ends =
      "%odd_bit = OpBitwiseAnd %uint %x %u1\n%odd = OpIEqual %bool %odd_bit %u1\n"
      "OpSelectionMerge %after None\nOpBranchConditional %odd %gone %after\n%gone = OpLabel\n" +
      leaving + "\n%after = OpLabel\n";
  return R"(OpCapability Shader
OpCapability GroupNonUniform
OpCapability GroupNonUniformBallot
OpCapability DemoteToHelperInvocationEXT
OpCapability !5087
OpExtension "SPV_EXT_demote_to_helper_invocation"
OpExtension "SPV_KHR_terminate_invocation"
OpExtension "SPV_KHR_maximal_reconvergence"
OpExtension "SPV_KHR_quad_control"
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %lane
OpExecutionMode %main OriginUpperLeft
)" + modes +
         R"(OpDecorate %lane BuiltIn SubgroupLocalInvocationId
OpDecorate %lane Flat
OpDecorate %array ArrayStride 4
OpMemberDecorate %block 0 Offset 0
OpDecorate %block Block
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%v4 = OpTypeVector %uint 4
%in = OpTypePointer Input %uint
%lane = OpVariable %in Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%block_ptr = OpTypePointer StorageBuffer %block
%uint_ptr = OpTypePointer StorageBuffer %uint
%buffer = OpVariable %block_ptr StorageBuffer
%yes = OpConstantTrue %bool
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%u3 = OpConstant %uint 3
%u4 = OpConstant %uint 4
)" + kNumbers +
         R"(%main = OpFunction %void None %fn
%entry = OpLabel
%x = OpLoad %uint %lane
)" + (leaving.empty() ? "" : ends) +
         kVotes + R"(%ballot = OpGroupNonUniformBallot %v4 %u3 %yes
%count = OpGroupNonUniformBallotBitCount %uint %u3 Reduce %ballot
%times = OpIMul %uint %count %u4
%r = OpBitwiseOr %uint %times %vote
%to = OpAccessChain %uint_ptr %buffer %u0 %x
OpStore %to %r
OpReturn
OpFunctionEnd
)";
}

/// Where lanes of odd numbers leave they become helpers, or are gone for good.
enum class Odd : std::uint8_t { kStay, kHelp, kGone };

void expect_fragments(const std::string& modes, bool helpers_count, const std::string& leaving = "",
                      Odd odd = Odd::kStay) {
  constexpr base::LaneMask kOdd = 0xaaaa'aaaa'aaaa'aaaa;
  base::LaneMask active = 0x0ff0'ffff'f0f0'ffff, helpers = 0x0030'8421'1080'0e0e;
  std::vector<std::uint32_t> words(kLanes, 77);
  const auto shader = compile(assemble(fragment_text(modes, leaving)), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
  ASSERT_TRUE(shader) << shader.message();
  EXPECT_TRUE(shader.value()->interface().needs_helpers);
  const Buffers buffers{&words};
  Fault fault;
  const BoundShader bound(*shader.value(), buffers.table, fault);
  WaveRunner runner;
  runner.bind(bound);
  runner.run(active, helpers);
  if (odd == Odd::kHelp) helpers |= active & kOdd;
  if (odd == Odd::kGone) active &= ~kOdd;
  helpers &= active;
  const auto count = static_cast<std::uint32_t>(std::popcount(helpers_count ? active : active & ~helpers));
  for (std::uint32_t lane = 0; lane < kLanes; lane++) {
    const bool stores = ((active & ~helpers) >> lane & 1) != 0;
    ASSERT_EQ(words[lane], stores ? count * 4 + vote(lane, active, holds) : 77) << lane;
  }
}

constexpr char kReconverges[] = "OpExecutionMode %main !6023\nOpExecutionMode %main !5088\n";

TEST(QuadControl, HelpersVoteInTheirQuads) { expect_fragments("", false); }

TEST(QuadControl, HelpersTakePartWhereInvocationsReconvergeMaximally) { expect_fragments(kReconverges, true); }

TEST(QuadControl, DemotedInvocationsGoOnAsHelpers) {
  const std::string demotes = "OpDemoteToHelperInvocationEXT\nOpBranch %after\n";
  expect_fragments("", false, demotes, Odd::kHelp);
  expect_fragments(kReconverges, true, demotes, Odd::kHelp);
}

TEST(QuadControl, TerminatedInvocationsTakeNoPart) {
  expect_fragments("", false, "OpTerminateInvocation\n", Odd::kGone);
  expect_fragments(kReconverges, true, "OpTerminateInvocation\n", Odd::kGone);
}

/// Without an operation that needs them.
TEST(QuadControl, QuadsAreWholeOnRequest) {
  const std::string head =
      "OpCapability Shader\nOpCapability !5087\nOpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\"\n"
      "OpExecutionMode %main OriginUpperLeft\n";
  const std::string body =
      "%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%main = OpFunction %void None %fn\n%entry = OpLabel\nOpReturn\n"
      "OpFunctionEnd\n";
  for (const bool asked : {false, true}) {
    const auto shader = compile(assemble(head + (asked ? "OpExecutionMode %main !5089\n" : "") + body),
                                options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
    ASSERT_TRUE(shader) << shader.message();
    EXPECT_EQ(shader.value()->interface().needs_helpers, asked);
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
