// Modules that no compiler writes, each made to trip over one thing that a front end may rely on: cycles, depth,
// counts, forward references, one kind of thing in place of another. Each becomes a shader or an error that says where;
// most of them nothing but the front end refuses. Their twins, which are right, become shaders.
#include <chrono>
#include <functional>

#include <spirv/unified1/spirv.hpp11>

#include "spirv/front/translate.h"
#include "tests/sanitized.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// A compute module: `declarations` in front of the functions, `body` in the entry point, where %x is a number of the
/// invocation and %place its word in a buffer.
Words module_with(const std::string& declarations, const std::string& body, const std::string& functions = "",
                  const std::string& locals = "", const std::string& capabilities = "") {
  ComputeText module;
  module.capabilities = capabilities;
  module.buffers = {"buffer"};
  module.declarations =
      "%u7 = OpConstant %uint 7\n%float = OpTypeFloat 32\n%f1 = OpConstant %float 1\n"
      "%vec2 = OpTypeVector %float 2\n%vec4 = OpTypeVector %float 4\n" +
      declarations;
  module.locals = locals;
  module.body = "%x = OpCopyObject %uint %n\n%place = OpAccessChain %uint_ptr %buffer %u0 %x\n" + body;
  module.functions = functions;
  return assemble(module.text());
}

std::string repeated(std::size_t count, const std::function<std::string(std::size_t)>& text) {
  std::string all;
  for (std::size_t i = 0; i < count; i++) all += text(i);
  return all;
}

std::string number(std::size_t i) { return std::to_string(i); }

/// Why the module is refused; empty: it is not.
std::string refusal(const Words& words, VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT) {
  const auto start = std::chrono::steady_clock::now();
  CompileOptions options = options_for(stage);
  const auto shader = compile(words, options);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(vitrine::test::kSanitized ? 400 : 20));
  if (shader) return {};
  EXPECT_NE(shader.message(), "");
  return shader.message();
}

void expect_refused(const Words& words, const std::string& why,
                    VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT) {
  EXPECT_NE(refusal(words, stage).find(why), std::string::npos) << why << " / " << refusal(words, stage);
}

/// Where an instruction of this opcode stands, behind `skip` others.
std::size_t find_op(const Words& words, spv::Op op, std::size_t skip = 0) {
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
    if ((words[at] & 0xffff) == static_cast<std::uint32_t>(op) && skip-- == 0) return at;
  ADD_FAILURE() << "no such instruction";
  return 5;
}

TEST(MonsterModule, AnIdMeansOneThing) {
  Words words = module_with("%row = OpTypeArray %float %u7\n", "");
  const std::size_t array = find_op(words, spv::Op::OpTypeArray), number = find_op(words, spv::Op::OpTypeFloat);
  words[array + 1] = words[number + 1];  // an array of itself
  expect_refused(words, "is defined already");
  words[array + 1] = 0;
  expect_refused(words, "defines the id 0");
}

TEST(MonsterModule, AnnouncedPointers) {
  const std::string capability = "OpCapability PhysicalStorageBufferAddresses\n";
  const auto with = [&](const std::string& text) { return module_with(text, "", "", "", capability); };
  EXPECT_EQ(refusal(with("OpTypeForwardPointer %p PhysicalStorageBuffer\n%node = OpTypeStruct %p\n"
                         "%p = OpTypePointer PhysicalStorageBuffer %node\n")),
            "");
  expect_refused(with("OpTypeForwardPointer %p PhysicalStorageBuffer\n%node = OpTypeStruct %p\n"
                      "%p = OpTypePointer Function %node\n"),
                 "OpTypeForwardPointer announced");
  expect_refused(with("OpTypeForwardPointer %p PhysicalStorageBuffer\n%node = OpTypeStruct %p\n"
                      "%p = OpTypeVector %float 3\n"),
                 "OpTypeForwardPointer announced");
  Words late = with("%p = OpTypePointer PhysicalStorageBuffer %float\nOpTypeForwardPointer %p PhysicalStorageBuffer\n");
  expect_refused(late, "declared already");
}

TEST(MonsterModule, TypesConsistOfWhatTheyCan) {
  expect_refused(module_with("%s = OpTypeStruct %float\n%bad = OpTypeVector %s 4\n", ""), "cannot consist");
  expect_refused(module_with("%bad = OpTypeMatrix %float 4\n", ""), "cannot consist");
  expect_refused(module_with("%bad = OpTypeSampledImage %float\n", ""), "cannot consist");
  expect_refused(module_with("%bad = OpTypeMatrix %vec4 5\n", ""), "matrix size");
}

TEST(MonsterModule, ArraysOfNothing) {
  const std::string types =
      "%none = OpTypeStruct\n%many = OpConstant %uint 4294967295\n%a0 = OpTypeArray %none %many\n"
      "%a1 = OpTypeArray %a0 %many\n%p = OpTypePointer Private %a1\n%v = OpVariable %p Private\n";
  expect_refused(module_with(types, "%value = OpLoad %a1 %v\nOpStore %v %value\n"), "too large");
  expect_refused(module_with(types + "%null = OpConstantNull %a1\n", ""), "too large");
  const std::string empty =
      "%zero = OpSpecConstant %uint 0\n%a = OpTypeArray %uint %zero\n%p = OpTypePointer Private %a\n"
      "%q = OpTypePointer Private %uint\n%v = OpVariable %p Private\n";
  expect_refused(module_with(empty, "%at = OpAccessChain %q %v %x\n%r = OpLoad %uint %at\nOpStore %place %r\n"),
                 "array without elements");
}

/// Each structure holds the one before twice.
TEST(MonsterModule, StructuresThatDouble) {
  const auto doubled = [](const std::string& start) {
    return "%s0 = OpTypeStruct " + start + "\n" + repeated(60, [](std::size_t i) {
             return "%s" + number(i + 1) + " = OpTypeStruct %s" + number(i) + " %s" + number(i) + "\n";
           });
  };
  for (const std::string start : {"", "%float"})
    for (const std::string storage : {"Private", "Workgroup", "Output"}) {
      const std::string variable = "%p = OpTypePointer " + storage + " %s60\n%v = OpVariable %p " + storage + "\n";
      EXPECT_NE(refusal(module_with(doubled(start) + variable, "%value = OpLoad %s60 %v\nOpStore %v %value\n")), "")
          << start << storage;
    }
}

TEST(MonsterModule, StepsIntoWhatHasNoParts) {
  const std::string declarations =
      "%inner = OpTypePointer Private %vec4\n%outer = OpTypePointer Private %inner\n%v = OpVariable %outer Private\n"
      "%image = OpTypeImage %float 2D 0 0 0 1 Unknown\n%image_ptr = OpTypePointer Private %image\n"
      "%w = OpVariable %image_ptr Private\n%float_ptr = OpTypePointer Private %float\n";
  for (const std::string variable : {"%v", "%w"})
    for (const std::string index : {"%x", "%u1"})
      expect_refused(module_with(declarations, "%at = OpAccessChain %float_ptr " + variable + " " + index +
                                                   "\n%r = OpLoad %float %at\nOpStore %at %r\n"),
                     "index into a scalar");
}

TEST(MonsterModule, ReturnsOfNoValue) {
  Words words = module_with("", "");
  const std::size_t at = find_op(words, spv::Op::OpReturn);
  words[at] = 2u << 16 | static_cast<std::uint32_t>(spv::Op::OpReturnValue);
  words.insert(words.begin() + static_cast<std::ptrdiff_t>(at) + 1, words[find_op(words, spv::Op::OpConstant) + 2]);
  expect_refused(words, "returns no value");
}

TEST(MonsterModule, OneKindOfValueForAnother) {
  const std::string types = "%double = OpTypeFloat 64\n%d1 = OpConstant %double 1\n%dvec2 = OpTypeVector %double 2\n";
  const std::string wide = "OpCapability Float64\n";
  for (const std::string& body : std::vector<std::string>{
           "%bits = OpIEqual %bool %d1 %flag\n", "%bits = OpFAdd %double %d1 %f1\n",
           "%bits = OpFAdd %float %flag %f1\n", "%bits = OpDot %double %vd %vf\n",
           "%bits = OpCompositeConstruct %dvec2 %d1 %flag\n", "%bits = OpSelect %double %x %d1 %d1\n",
           "%bits = OpVectorShuffle %dvec2 %vd %vf 0 3\n", "%bits = OpMatrixTimesVector %vec2 %vf %vf\n",
           "%bits = OpOuterProduct %vec2 %flag %f1\n", "%bits = OpTranspose %vec2 %flag\n", "OpStore %place %flag\n",
           "OpStore %place %vf\n", "%bits = OpAtomicIAdd %uint %place %u1 %u0 %flag\n", "%bits = OpLoad %uint %x\n",
           "OpStore %x %u1\n", "%bits = OpBitcast %vec2 %flag\n"}) {
    const std::string defs =
        "%flag = OpIEqual %bool %x %u7\n%vd = OpCompositeConstruct %dvec2 %d1 %d1\n"
        "%vf = OpCompositeConstruct %vec2 %f1 %f1\n";
    EXPECT_NE(refusal(module_with(types, defs + body, "", "", wide)), "") << body;
  }
}

TEST(MonsterModule, ImagesThatAreNone) {
  const std::string declarations =
      "%image = OpTypeImage %float 3D 0 0 0 1 Unknown\n%texels = OpTypeImage %float Buffer 0 0 0 1 Unknown\n"
      "%sampler = OpTypeSampler\n%sampled = OpTypeSampledImage %image\n%ip = OpTypePointer UniformConstant %image\n"
      "%tp = OpTypePointer UniformConstant %texels\n%sp = OpTypePointer UniformConstant %sampler\n"
      "%i = OpVariable %ip UniformConstant\n%b = OpVariable %tp UniformConstant\n%s = OpVariable %sp UniformConstant\n"
      "%vec3 = OpTypeVector %float 3\n%c3 = OpConstantComposite %vec3 %f1 %f1 %f1\n";
  const std::string load =
      "%image_value = OpLoad %image %i\n%texels_value = OpLoad %texels %b\n%sampler_value = OpLoad %sampler %s\n"
      "%both = OpSampledImage %sampled %image_value %sampler_value\n";
  const auto with = [&](const std::string& body) {
    return module_with(declarations, load + body, "", "", "OpCapability SampledBuffer\nOpCapability ImageQuery\n");
  };
  EXPECT_EQ(refusal(with("%r = OpImageSampleExplicitLod %vec4 %both %c3 Lod %f1\n")), "");
  expect_refused(with("%r = OpImageSampleExplicitLod %vec4 %image_value %c3 Lod %f1\n"), "without a sampler");
  expect_refused(with("%r = OpImageSampleExplicitLod %vec4 %sampler_value %c3 Lod %f1\n"), "not an image");
  expect_refused(with("%r = OpImageSampleExplicitLod %vec4 %texels_value %c3 Lod %f1\n"), "");
  expect_refused(with("%r = OpImageSampleDrefExplicitLod %float %both %c3 %f1 Lod %f1\n"), "depth comparison");
  expect_refused(with("%r = OpImageGather %vec4 %both %c3 %u0\n"), "not gathered");
  expect_refused(with("%r = OpImageQueryLevels %uint %texels_value\n"), "neither levels");
  expect_refused(with("%r = OpImageQueryLevels %uint %x\n"), "not an image");
}

/// A variable of shared memory in a stage that has none.
TEST(MonsterModule, WorkgroupMemoryOfFragments) {
  const Words words = assemble(
      "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\"\n"
      "OpExecutionMode %main OriginUpperLeft\n%void = OpTypeVoid\n%fn = OpTypeFunction %void\n"
      "%float = OpTypeFloat 32\n%one = OpConstant %float 1\n%ptr = OpTypePointer Workgroup %float\n"
      "%v = OpVariable %ptr Workgroup\n%main = OpFunction %void None %fn\n%l = OpLabel\nOpStore %v %one\nOpReturn\n"
      "OpFunctionEnd\n");
  expect_refused(words, "compute shaders only", VK_SHADER_STAGE_FRAGMENT_BIT);
}

TEST(MonsterModule, ManyLargeConstants) {
  EXPECT_NE(refusal(module_with(
                "%length = OpConstant %uint 65536\n%big = OpTypeArray %uint %length\n" +
                    repeated(3000, [](std::size_t i) { return "%c" + number(i) + " = OpConstantNull %big\n"; }),
                "")),
            "");
}

TEST(MonsterModule, ManyCopiesOfALargeValue) {
  EXPECT_NE(refusal(module_with(
                "%length = OpConstant %uint 65536\n%big = OpTypeArray %uint %length\n"
                "%c = OpConstantNull %big\n",
                repeated(3000, [](std::size_t i) { return "%v" + number(i) + " = OpCopyObject %big %c\n"; }))),
            "");
}

/// 2^60 calls of functions that do nothing.
TEST(MonsterModule, CallsOfNothing) {
  const std::string functions = repeated(60, [](std::size_t i) {
    const std::string n = number(i), next = " = OpFunctionCall %void %g" + number(i + 1) + "\n";
    return "%g" + n + " = OpFunction %void None %fn\n%l" + n + " = OpLabel\n" +
           (i < 59 ? "%a" + n + next + "%b" + n + next : std::string()) + "OpReturn\nOpFunctionEnd\n";
  });
  EXPECT_NE(refusal(module_with("", "%r = OpFunctionCall %void %g0\n", functions)), "");
}

TEST(MonsterModule, SwitchOfTenThousandCases) {
  constexpr std::size_t kCases = 10000;
  std::string body = "OpSelectionMerge %done None\nOpSwitch %x %done";
  body += repeated(kCases, [](std::size_t i) { return std::string(" ") + number(i) + " %k" + number(i); }) + "\n";
  body += repeated(kCases, [](std::size_t i) {
    const std::string n = number(i);
    return "%k" + n + " = OpLabel\nOpStore %place %u7\nOpBranch " +
           (i % 2 == 0 ? std::string("%k") + number(i + 1) : std::string("%done")) + "\n";
  });
  refusal(module_with("", body + "%done = OpLabel\n"));
}

TEST(MonsterModule, ManyWorkgroupVariables) {
  const std::string variables =
      repeated(40000, [](std::size_t i) { return "%v" + number(i) + " = OpVariable %shared_ptr Workgroup\n"; });
  const std::string stores = repeated(40000, [](std::size_t i) { return "OpStore %v" + number(i) + " %u7\n"; });
  refusal(module_with("%shared_ptr = OpTypePointer Workgroup %uint\n" + variables, stores));
}

/// Blocks that branch to each other in every way, without a word of structure.
TEST(MonsterModule, ControlFlowWithoutStructure) {
  const std::string flag = "%flag = OpIEqual %bool %x %u7\n";
  expect_refused(module_with("", flag + "OpBranchConditional %flag %a %b\n%a = OpLabel\nOpBranch %b\n%b = OpLabel\n"
                                        "OpBranchConditional %flag %a %c\n%c = OpLabel\n"),
                 "without a merge block");
  expect_refused(module_with("", flag + "OpBranch %a\n%a = OpLabel\nOpBranch %a\n%b = OpLabel\n"), "not structured");
  expect_refused(module_with("", flag + "OpSelectionMerge %m None\nOpBranchConditional %flag %a %m\n%a = OpLabel\n"
                                        "OpSelectionMerge %a None\nOpBranchConditional %flag %a %m\n%m = OpLabel\n"),
                 "");
  expect_refused(module_with("",
                             "OpSwitch %x %a 0 %b\n%a = OpLabel\nOpBranch %c\n%b = OpLabel\nOpBranch %c\n"
                             "%c = OpLabel\n"),
                 "without a merge block");
}

/// Ladders of blocks: dominators are found in time.
TEST(MonsterModule, LongLadders) {
  const std::string flag = "%flag = OpIEqual %bool %x %u7\n";
  refusal(module_with("", flag + repeated(30000, [](std::size_t i) {
                            const std::string n = number(i);
                            return "OpSelectionMerge %m" + n + " None\nOpBranchConditional %flag %a" + n + " %b" + n +
                                   "\n%a" + n + " = OpLabel\nOpBranch %j" + n + "\n%b" + n + " = OpLabel\nOpBranch %j" +
                                   n + "\n%j" + n + " = OpLabel\nOpBranch %m" + n + "\n%m" + n + " = OpLabel\n";
                          })));
}

/// A value used in front of the instruction that makes it.
TEST(MonsterModule, VariablesThatBeginAsPointersToEachOther) {
  const std::string capabilities = "OpCapability VariablePointers\n";
  const Words itself = module_with(
      "%p0 = OpTypePointer Private %uint\n%p1 = OpTypePointer Private %p0\n%v = OpVariable %p1 Private %v\n",
      "%r = OpLoad %p0 %v\n%y = OpLoad %uint %r\nOpStore %place %y\n", "", "", capabilities);
  EXPECT_NE(refusal(itself), "");
  std::string chain = "%p0 = OpTypePointer Private %uint\n%v0 = OpVariable %p0 Private %u7\n";
  for (std::size_t i = 1; i <= 20000; i++)
    chain += "%p" + number(i) + " = OpTypePointer Private %p" + number(i - 1) + "\n%v" + number(i) +
             " = OpVariable %p" + number(i) + " Private %v" + number(i - 1) + "\n";
  EXPECT_NE(refusal(module_with(chain, "%r = OpLoad %p19999 %v20000\n", "", "", capabilities)), "");
}

TEST(MonsterModule, ForwardReferences) {
  expect_refused(module_with("", "%r = OpIAdd %uint %later %x\n%later = OpIAdd %uint %x %x\nOpStore %place %r\n"),
                 "has no value here");
  expect_refused(module_with("", "%r = OpIAdd %uint %r %x\nOpStore %place %r\n"), "has no value here");
  expect_refused(module_with("%a = OpTypeArray %b %u7\n%b = OpTypeStruct %a\n", ""), "is not a type");
}

TEST(MonsterModule, GroupsOfDecorationsThatMultiply) {
  Words words = module_with("", "");
  const std::uint32_t group = words[3]++,
                      at_decoration = static_cast<std::uint32_t>(find_op(words, spv::Op::OpTypeVoid));
  Words more;
  for (std::uint32_t i = 0; i < 20000; i++)
    more.insert(more.end(), {3u << 16 | static_cast<std::uint32_t>(spv::Op::OpDecorate), group,
                             static_cast<std::uint32_t>(spv::Decoration::NoContraction)});
  more.insert(more.end(), {2u << 16 | static_cast<std::uint32_t>(spv::Op::OpDecorationGroup), group});
  more.insert(more.end(), {60002u << 16 | static_cast<std::uint32_t>(spv::Op::OpGroupDecorate), group});
  for (std::uint32_t i = 0; i < 60000; i++) more.push_back(1 + i % 7);
  words.insert(words.begin() + at_decoration, more.begin(), more.end());
  expect_refused(words, "too many decorations");
}

}  // namespace
}  // namespace vitrine::spirv::test
