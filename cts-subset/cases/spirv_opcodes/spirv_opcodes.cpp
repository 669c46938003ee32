// One case per opcode that GLSL does not lead to, or only among others: rows of assembly. With those of spirv_numbers
// and the list in tests/spirv/opcode_tests every row of spirv/opcodes.def has a test (tests/structure).
#include "harness/case.h"
#include "harness/graphics.h"
#include "harness/shader.h"
#include "tests/spirv/compute_text.h"

namespace vitrine::cts {
namespace {

/// Workgroups are as large as the reference's subgroups, so that group operations see the same invocations.
constexpr uint32_t kLocal = 8, kGroups = 8, kCount = kLocal * kGroups;

constexpr char kCapabilities[] = R"(OpCapability GroupNonUniform
OpCapability GroupNonUniformVote
OpCapability GroupNonUniformBallot
OpCapability GroupNonUniformArithmetic
OpCapability GroupNonUniformShuffle
OpCapability GroupNonUniformShuffleRelative
OpCapability GroupNonUniformQuad
OpCapability VariablePointers
%glsl = OpExtInstImport "GLSL.std.450"
)";
constexpr char kDeclarations[] = R"(
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%v2bool = OpTypeVector %bool 2
%v2uint = OpTypeVector %uint 2
%v4uint = OpTypeVector %uint 4
%v2float = OpTypeVector %float 2
%v4float = OpTypeVector %float 4
%split = OpTypeStruct %float %int
%float_var = OpTypePointer Function %float
%int_var = OpTypePointer Function %int
%u2 = OpConstant %uint 2
%u3 = OpConstant %uint 3
%u5 = OpConstant %uint 5
%u7 = OpConstant %uint 7
%u15 = OpConstant %uint 15
%u64 = OpConstant %uint 64
%u72 = OpConstant %uint 72
%u128 = OpConstant %uint 128
%u255 = OpConstant %uint 255
%i1 = OpConstant %int 1
%i100 = OpConstant %int 100
%f0 = OpConstant %float 0
%f1 = OpConstant %float 1
%f3 = OpConstant %float 3.25
)";
constexpr char kOperands[] = R"(
%low = OpBitwiseAnd %uint %n %u3
%lane = OpBitwiseAnd %uint %n %u7
%small = OpBitwiseAnd %uint %x %u15
%i = OpBitcast %int %x
%f255 = OpBitwiseAnd %uint %x %u255
%fu = OpConvertUToF %float %f255
%f = OpFDiv %float %fu %f3
%nan = OpBitcast %float %x
%odd_bit = OpBitwiseAnd %uint %x %u1
%odd = OpIEqual %bool %odd_bit %u1
%late = OpUGreaterThan %bool %n %u5
%flags = OpCompositeConstruct %v2bool %odd %late
%v2 = OpCompositeConstruct %v2float %f %f1
%v4 = OpCompositeConstruct %v4float %f %f1 %f0 %f3
%spot_at = OpIAdd %uint %low %u128
%spot = OpAccessChain %uint_ptr %out %u0 %spot_at
%own_at = OpIAdd %uint %n %u64
%own = OpAccessChain %uint_ptr %out %u0 %own_at
)";

/// %r of type uint is stored.
void run_row(Run& run, const std::string& body) {
  run.require(run.gpu.extension_features.variablePointers, "variablePointers");
  ComputeText module;
  module.capabilities = kCapabilities;
  module.local_size = "8 1 1";
  module.annotations = "%file = OpString \"row.comp\"\nOpDecorate %uint_ptr ArrayStride 4\n";
  module.declarations = kDeclarations;
  module.locals = "%part = OpVariable %float_var Function\n%power = OpVariable %int_var Function\n";
  module.body = load_word("%x", "in") + kOperands + body + "\n" + store_word("%r", "out");
  const std::string text = "; target: vulkan1.1\n" + module.text();
  run.note("assembly", text);
  std::vector<uint32_t> words(kCount);
  for (uint32_t& word : words) word = run.random.chance(0.7f) ? run.random.bits() & 0x7f7fffff : run.random.below(40);
  std::vector<uint32_t> outputs(256);
  for (uint32_t& word : outputs) word = run.random.bits();
  const Buffer in = run.buffer_of(words), out = run.buffer_of(outputs);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, kGroups);
  run.out("out", out);
}

struct Row {
  const char* name;
  const char* text;
  char result =
      'u';  ///< type of %q, which becomes %r: u, i, f, b; v: two uints; 4: four; p: {float, int}; 0: %r is set
};

constexpr Row kRows[] = {
    {"Nop", "OpNop\n%q = OpIAdd %uint %x %u1"},
    {"NoLine", "OpLine %file 3 4\n%p = OpIAdd %uint %x %u1\nOpNoLine\n%q = OpIMul %uint %p %u5"},
    {"Undef", "%any = OpUndef %uint\n%none = OpBitwiseAnd %uint %any %u0\n%q = OpIAdd %uint %none %x"},
    {"CopyMemory", "OpCopyMemory %own %x_at\n%q = OpIAdd %uint %x %u1"},
    {"ArrayLength", "%q = OpArrayLength %uint %out 0"},
    {"PtrAccessChain", "%next = OpPtrAccessChain %uint_ptr %own %low\n%q = OpLoad %uint %next"},
    {"QuantizeToF16", "%q = OpQuantizeToF16 %float %nan", 'f'},
    {"BitFieldInsert", "%q = OpBitFieldInsert %uint %x %n %small %u7"},
    {"BitFieldUExtract", "%q = OpBitFieldUExtract %uint %x %small %u7"},
    {"BitFieldSExtract", "%q = OpBitFieldSExtract %int %i %small %u7", 'i'},
    {"Any", "%q = OpAny %bool %flags", 'b'},
    {"All", "%q = OpAll %bool %flags", 'b'},
    {"LogicalOr", "%q = OpLogicalOr %bool %odd %late", 'b'},
    {"LogicalAnd", "%q = OpLogicalAnd %bool %odd %late", 'b'},
    {"LogicalNot", "%q = OpLogicalNot %bool %odd", 'b'},
    {"LogicalEqual", "%q = OpLogicalEqual %bool %odd %late", 'b'},
    {"LogicalNotEqual", "%q = OpLogicalNotEqual %bool %odd %late", 'b'},
    {"FUnordGreaterThan", "%q = OpFUnordGreaterThan %bool %nan %f1", 'b'},
    {"FUnordLessThanEqual", "%q = OpFUnordLessThanEqual %bool %nan %f1", 'b'},
    {"AtomicLoad", "%q = OpAtomicLoad %uint %own %u1 %u0"},
    {"AtomicStore", "OpAtomicStore %own %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicExchange", "%q = OpAtomicExchange %uint %own %u1 %u0 %x"},
    {"AtomicCompareExchange",
     "%old = OpLoad %uint %own\n%same = OpSelect %uint %odd %old %x\n"
     "%q = OpAtomicCompareExchange %uint %own %u1 %u0 %u0 %x %same"},
    {"AtomicIIncrement", "%o = OpAtomicIIncrement %uint %spot %u1 %u0\n%q = OpIAdd %uint %x %u1"},
    {"AtomicIDecrement", "%o = OpAtomicIDecrement %uint %spot %u1 %u0\n%q = OpIAdd %uint %x %u1"},
    {"AtomicIAdd", "%o = OpAtomicIAdd %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicISub", "%o = OpAtomicISub %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicSMin", "%o = OpAtomicSMin %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicUMin", "%o = OpAtomicUMin %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicSMax", "%o = OpAtomicSMax %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicUMax", "%o = OpAtomicUMax %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicAnd", "%o = OpAtomicAnd %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicOr", "%o = OpAtomicOr %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"AtomicXor", "%o = OpAtomicXor %uint %spot %u1 %u0 %x\n%q = OpIAdd %uint %x %u1"},
    {"MemoryBarrier", "OpStore %own %x\nOpMemoryBarrier %u1 %u72\n%q = OpLoad %uint %own"},
    {"GroupNonUniformElect", "%q = OpGroupNonUniformElect %bool %u3", 'b'},
    {"GroupNonUniformAll", "%q = OpGroupNonUniformAll %bool %u3 %odd", 'b'},
    {"GroupNonUniformAny", "%q = OpGroupNonUniformAny %bool %u3 %late", 'b'},
    {"GroupNonUniformAllEqual", "%q = OpGroupNonUniformAllEqual %bool %u3 %low", 'b'},
    {"GroupNonUniformBroadcast", "%q = OpGroupNonUniformBroadcast %uint %u3 %x %u5"},
    {"GroupNonUniformBroadcastFirst", "%q = OpGroupNonUniformBroadcastFirst %uint %u3 %x"},
    {"GroupNonUniformBallot", "%q = OpGroupNonUniformBallot %v4uint %u3 %odd", '4'},
    {"GroupNonUniformInverseBallot",
     "%b = OpGroupNonUniformBallot %v4uint %u3 %odd\n%q = OpGroupNonUniformInverseBallot %bool %u3 %b", 'b'},
    {"GroupNonUniformBallotBitExtract",
     "%b = OpGroupNonUniformBallot %v4uint %u3 %odd\n%q = OpGroupNonUniformBallotBitExtract %bool %u3 %b %low", 'b'},
    {"GroupNonUniformBallotBitCount",
     "%b = OpGroupNonUniformBallot %v4uint %u3 %odd\n%q = OpGroupNonUniformBallotBitCount %uint %u3 InclusiveScan %b"},
    {"GroupNonUniformBallotFindLSB",
     "%b = OpCompositeConstruct %v4uint %u7 %u0 %u0 %u0\n%q = OpGroupNonUniformBallotFindLSB %uint %u3 %b"},
    {"GroupNonUniformBallotFindMSB",
     "%b = OpCompositeConstruct %v4uint %u7 %u0 %u0 %u0\n%q = OpGroupNonUniformBallotFindMSB %uint %u3 %b"},
    {"GroupNonUniformShuffle", "%q = OpGroupNonUniformShuffle %uint %u3 %x %low"},
    {"GroupNonUniformShuffleXor", "%q = OpGroupNonUniformShuffleXor %uint %u3 %x %u5"},
    {"GroupNonUniformShuffleUp",
     "%up = OpGroupNonUniformShuffleUp %uint %u3 %x %u1\n%first = OpIEqual %bool %lane %u0\n"
     "%q = OpSelect %uint %first %u0 %up"},
    {"GroupNonUniformShuffleDown",
     "%down = OpGroupNonUniformShuffleDown %uint %u3 %x %u1\n%last = OpIEqual %bool %lane %u7\n"
     "%q = OpSelect %uint %last %u0 %down"},
    {"GroupNonUniformIAdd", "%q = OpGroupNonUniformIAdd %uint %u3 Reduce %x"},
    {"GroupNonUniformFAdd", "%q = OpGroupNonUniformFAdd %float %u3 InclusiveScan %f", 'f'},
    {"GroupNonUniformIMul", "%q = OpGroupNonUniformIMul %uint %u3 ExclusiveScan %x"},
    {"GroupNonUniformFMul", "%q = OpGroupNonUniformFMul %float %u3 Reduce %f", 'f'},
    {"GroupNonUniformSMin", "%q = OpGroupNonUniformSMin %int %u3 Reduce %i", 'i'},
    {"GroupNonUniformUMin", "%q = OpGroupNonUniformUMin %uint %u3 InclusiveScan %x"},
    {"GroupNonUniformFMin", "%q = OpGroupNonUniformFMin %float %u3 Reduce %f", 'f'},
    {"GroupNonUniformSMax", "%q = OpGroupNonUniformSMax %int %u3 Reduce %i", 'i'},
    {"GroupNonUniformUMax", "%q = OpGroupNonUniformUMax %uint %u3 Reduce %x"},
    {"GroupNonUniformFMax", "%q = OpGroupNonUniformFMax %float %u3 InclusiveScan %f", 'f'},
    {"GroupNonUniformBitwiseAnd", "%q = OpGroupNonUniformBitwiseAnd %uint %u3 Reduce %x"},
    {"GroupNonUniformBitwiseOr", "%q = OpGroupNonUniformBitwiseOr %uint %u3 ExclusiveScan %x"},
    {"GroupNonUniformBitwiseXor", "%q = OpGroupNonUniformBitwiseXor %uint %u3 InclusiveScan %x"},
    {"GroupNonUniformQuadBroadcast", "%q = OpGroupNonUniformQuadBroadcast %uint %u3 %x %u2"},
    {"GroupNonUniformQuadSwap", "%q = OpGroupNonUniformQuadSwap %uint %u3 %x %u2"},
    {"Modf", "%h = OpExtInst %float %glsl Modf %f %part\n%w = OpLoad %float %part\n%q = OpFSub %float %h %w", 'f'},
    {"Frexp",
     "%h = OpExtInst %float %glsl Frexp %f %power\n%w = OpLoad %int %power\n%wf = OpConvertSToF %float %w\n"
     "%q = OpFSub %float %h %wf",
     'f'},
    {"FrexpStruct", "%q = OpExtInst %split %glsl FrexpStruct %f", 'p'},
    {"PackSnorm4x8", "%q = OpExtInst %uint %glsl PackSnorm4x8 %v4"},
    {"PackUnorm4x8", "%q = OpExtInst %uint %glsl PackUnorm4x8 %v4"},
    {"PackSnorm2x16", "%q = OpExtInst %uint %glsl PackSnorm2x16 %v2"},
    {"PackUnorm2x16", "%q = OpExtInst %uint %glsl PackUnorm2x16 %v2"},
    {"PackHalf2x16", "%q = OpExtInst %uint %glsl PackHalf2x16 %v2"},
    {"UnpackSnorm2x16", "%h = OpExtInst %v2float %glsl UnpackSnorm2x16 %x\n%q = OpDot %float %h %v2", 'f'},
    {"UnpackUnorm2x16", "%h = OpExtInst %v2float %glsl UnpackUnorm2x16 %x\n%q = OpDot %float %h %v2", 'f'},
    {"UnpackHalf2x16", "%h = OpExtInst %v2float %glsl UnpackHalf2x16 %x\n%q = OpDot %float %h %v2", 'f'},
    {"UnpackSnorm4x8", "%h = OpExtInst %v4float %glsl UnpackSnorm4x8 %x\n%q = OpDot %float %h %v4", 'f'},
    {"UnpackUnorm4x8", "%h = OpExtInst %v4float %glsl UnpackUnorm4x8 %x\n%q = OpDot %float %h %v4", 'f'},
    {"Refract", "%h = OpExtInst %v2float %glsl Refract %v2 %v2 %f3\n%q = OpCompositeExtract %float %h 0", 'f'},
    {"FindILsb", "%q = OpExtInst %int %glsl FindILsb %x", 'i'},
    {"FindSMsb", "%q = OpExtInst %int %glsl FindSMsb %i", 'i'},
    {"FindUMsb", "%q = OpExtInst %int %glsl FindUMsb %x", 'i'},
};

std::string result_of(const Row& row) {
  switch (row.result) {
    case 'i':
    case 'f':
      return "\n%r = OpBitcast %uint %q";
    case 'b':
      return "\n%r = OpSelect %uint %q %u5 %u3";
    case '4':
      return "\n%r = OpCompositeExtract %uint %q 0";
    case 'p':
      return "\n%q0 = OpCompositeExtract %float %q 0\n%q1 = OpCompositeExtract %int %q 1\n"
             "%q2 = OpBitcast %uint %q0\n%q3 = OpBitcast %uint %q1\n%r = OpBitwiseXor %uint %q2 %q3";
    default:
      return "\n%r = OpCopyObject %uint %q";
  }
}

const bool kRegistered = [] {
  for (const Row& row : kRows)
    AddCase("spirv_opcodes", row.name, [&row](Run& run) { run_row(run, row.text + result_of(row)); });
  return true;
}();

/// Functions of images in GLSL, and the opcode that each becomes. t: a mipmapped colour image, d: depth with a
/// comparing sampler, m: four samples; p: framebuffer coordinates over the size.
struct ImageRow {
  const char* opcode;
  const char* code;
};

constexpr ImageRow kImageRows[] = {
    {"OpImageSampleImplicitLod", "texture(t, p * 3.0)"},
    {"OpImageSampleExplicitLod", "textureLod(t, p, p.x * 4.0)"},
    {"OpImageSampleDrefImplicitLod", "vec4(texture(d, vec3(p * 2.0, p.y)))"},
    {"OpImageSampleDrefExplicitLod", "vec4(textureLod(d, vec3(p, p.y), p.x * 3.0))"},
    {"OpImageSampleProjImplicitLod", "textureProj(t, vec3(p, 0.5 + p.x))"},
    {"OpImageSampleProjExplicitLod", "textureProjLod(t, vec3(p, 0.5 + p.x), p.y * 3.0)"},
    {"OpImageSampleProjDrefImplicitLod", "vec4(textureProj(d, vec4(p, p.y, 0.7 + p.x)))"},
    {"OpImageSampleProjDrefExplicitLod", "vec4(textureProjLod(d, vec4(p, p.y, 0.7 + p.x), p.x * 2.0))"},
    {"OpImageGather", "textureGather(t, p, 2)"},
    {"OpImageDrefGather", "textureGather(d, p, p.x)"},
    {"OpImageFetch", "texelFetch(t, ivec2(p * 15.0), 0) + texelFetch(m, ivec2(p * 15.0), int(p.x * 3.9))"},
    {"OpImageQuerySizeLod", "p.xyxy + vec4(textureSize(t, 2), textureSize(t, 0))"},
    {"OpImageQuerySize", "p.xyxy + vec4(textureSize(m), 0.0, 1.0)"},
    {"OpImageQueryLod", "p.xyxy + vec4(textureQueryLod(t, p * p * 9.0), 0.0, 1.0)"},
    {"OpImageQueryLevels", "p.xyxy + vec4(textureQueryLevels(t))"},
    {"OpImageQuerySamples", "p.xyxy + vec4(textureSamples(m))"},
    {"OpImage", "texelFetch(t, ivec2(p * 7.0), 1)"},
    {"OpSampledImage", "texture(sampler2D(i, s), p * 3.0)"},
    {"OpDPdx", "vec4(dFdx(p.x * p.y), dFdx(p), 1.0)"},
    {"OpDPdy", "vec4(dFdy(p.x * p.y), dFdy(p), 1.0)"},
    {"OpFwidth", "vec4(fwidth(p.x * p.y), fwidth(p), 1.0)"},
    {"OpDPdxFine", "vec4(dFdxFine(p.x * p.y), dFdxFine(p), 1.0)"},
    {"OpDPdyFine", "vec4(dFdyFine(p.x * p.y), dFdyFine(p), 1.0)"},
    {"OpFwidthFine", "vec4(fwidthFine(p.x * p.y), fwidthFine(p), 1.0)"},
    {"OpDPdxCoarse", "vec4(dFdxCoarse(p.x * p.y), dFdxCoarse(p), 1.0)"},
    {"OpDPdyCoarse", "vec4(dFdyCoarse(p.x * p.y), dFdyCoarse(p), 1.0)"},
    {"OpFwidthCoarse", "vec4(fwidthCoarse(p.x * p.y), fwidthCoarse(p), 1.0)"},
};

void run_image_row(Run& run, const ImageRow& row) {
  const auto image = [&](VkFormat format, uint32_t levels, VkSampleCountFlagBits samples) {
    ImageSpec spec;
    spec.format = format;
    spec.extent = {16, 16, 1};
    spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    spec.levels = levels;
    spec.samples = samples;
    if (samples != VK_SAMPLE_COUNT_1_BIT) spec.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return run.image(spec);
  };
  const Image color = image(VK_FORMAT_R8G8B8A8_UNORM, 4, VK_SAMPLE_COUNT_1_BIT);
  const Image depth = image(VK_FORMAT_D16_UNORM, 3, VK_SAMPLE_COUNT_1_BIT);
  const Image samples = image(VK_FORMAT_R8G8B8A8_UNORM, 1, VK_SAMPLE_COUNT_4_BIT);
  run.fill_random(color);
  run.fill_random(depth);
  VkSamplerCreateInfo compare{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  compare.compareEnable = VK_TRUE;
  compare.compareOp = VK_COMPARE_OP_LESS;
  compare.maxLod = VK_LOD_CLAMP_NONE;
  VkSamplerCreateInfo mipmapped{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  mipmapped.magFilter = mipmapped.minFilter = VK_FILTER_LINEAR;
  mipmapped.maxLod = VK_LOD_CLAMP_NONE;
  const VkSampler linear = run.sampler(mipmapped);
  const Resources res = run.resources(
      {sampled(0, color, linear), sampled(1, depth, run.sampler(compare)), sampled(2, samples, linear),
       Binding{3, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, {}, {{VK_NULL_HANDLE, color.view, VK_IMAGE_LAYOUT_GENERAL}}, {}},
       Binding{4, VK_DESCRIPTOR_TYPE_SAMPLER, {}, {{linear, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED}}, {}}});
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_SFLOAT}});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = std::string(
                      "#extension GL_ARB_shader_texture_image_samples : enable\n"
                      "layout(binding = 0) uniform sampler2D t;\nlayout(binding = 1) uniform sampler2DShadow d;\n"
                      "layout(binding = 3) uniform texture2D i;\nlayout(binding = 4) uniform sampler s;\n"
                      "layout(binding = 2) uniform sampler2DMS m;\nlayout(location = 0) out vec4 o;\n"
                      "void main() { vec2 p = gl_FragCoord.xy / 64.0; o = ") +
                  row.code + "; }\n";
  spec.layout = res.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearColorValue value{{0.25f, 0.5f, 0.75f, 1.0f}};
    const VkImageSubresourceRange range = samples.range();
    vkCmdClearColorImage(cmd, samples.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
    run.barrier(cmd);
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

const bool kImagesRegistered = [] {
  for (const ImageRow& row : kImageRows)
    AddCase("spirv_opcodes", row.opcode + 2, [&row](Run& run) { run_image_row(run, row); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
