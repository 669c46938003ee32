// Modules that no GLSL compiler writes: undefined values, selects of composites, phis, switches, odd but valid forms.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "cases/deviations/deviation.h"
#include "harness/case.h"
#include "harness/graphics.h"
#include "harness/shader.h"
#include "tests/spirv/compute_text.h"

namespace vitrine::cts {
namespace {

/// Runs 64 invocations of a body between buffers `in` (uint[]) and `out` (uint[]); %x is the input, %r must be set.
void run_body(Run& run, const std::string& body, const std::string& types = "", const std::string& capabilities = "",
              const std::string& annotations = "", const std::string& inputs = "",
              const std::string& local_size = "64 1 1") {
  ComputeText module;
  module.uniform = true;
  module.capabilities = capabilities + "%glsl = OpExtInstImport \"GLSL.std.450\"\n";
  module.interface = inputs;
  module.local_size = local_size;
  module.annotations = annotations;
  module.declarations = R"(
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%v2uint = OpTypeVector %uint 2
%v4uint = OpTypeVector %uint 4
%v4float = OpTypeVector %float 4
%u2 = OpConstant %uint 2
%u3 = OpConstant %uint 3
%u5 = OpConstant %uint 5
%i3 = OpConstant %int 3
%f1 = OpConstant %float 1
)" + types;
  module.body = load_word("%x", "in") + body + store_word("%r", "out");
  const std::string text = module.text();
  std::vector<uint32_t> words(64);
  for (uint32_t& word : words) word = run.random.chance(0.5f) ? run.random.bits() : run.random.below(10);
  const Buffer in = run.buffer_of(words), out = run.buffer(256);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
}

CTS_CASE("spirv_assembly", "vector_shuffle_and_insert") {
  run_body(run, R"(
%a = OpCompositeConstruct %v4uint %x %n %u1 %u2
%b = OpVectorShuffle %v4uint %a %a 7 0 5 2
%c = OpCompositeInsert %v4uint %u5 %b 1
%d = OpVectorExtractDynamic %uint %c %u3
%k = OpBitwiseAnd %uint %x %u3
%e = OpVectorExtractDynamic %uint %c %k
%f = OpVectorInsertDynamic %v4uint %c %x %k
%g = OpCompositeExtract %uint %f 2
%h = OpIAdd %uint %d %e
%r = OpBitwiseXor %uint %h %g
)");
}

/// Instructions of unknown non-semantic sets mean nothing, wherever they are.
CTS_CASE("spirv_assembly", "non_semantic_info") {
  run.require(run.gpu.has("VK_KHR_shader_non_semantic_info"), "VK_KHR_shader_non_semantic_info");
  run_body(run, R"(
%note = OpExtInst %void %notes 12 %x %u1
%r = OpIMul %uint %x %u5
%other = OpExtInst %void %notes 7 %r
)",
           "%global = OpExtInst %void %notes 3 %u1\n",
           "OpExtension \"SPV_KHR_non_semantic_info\"\n%notes = OpExtInstImport \"NonSemantic.Nobody.Knows\"\n");
}

CTS_CASE("spirv_assembly", "decorate_string") {
  run.require(run.gpu.has("VK_GOOGLE_decorate_string") && run.gpu.has("VK_GOOGLE_hlsl_functionality1"),
              "VK_GOOGLE_hlsl_functionality1");
  run_body(run, "%r = OpIAdd %uint %x %n\n", "%counter = OpVariable %block_ptr Uniform\n",
           "OpExtension \"SPV_GOOGLE_decorate_string\"\nOpExtension \"SPV_GOOGLE_hlsl_functionality1\"\n",
           "OpDecorate %counter DescriptorSet 0\nOpDecorate %counter Binding 1\n"
           "OpDecorateString %id UserSemantic \"SV_DispatchThreadID\"\n"
           "OpMemberDecorateString %block 0 UserSemantic \"ELEMENT\"\n"
           "OpDecorateId %out HlslCounterBufferGOOGLE %counter\n");
}

CTS_CASE("spirv_assembly", "local_size_id") {
  run.require(run.gpu.extension_features.maintenance4, "maintenance4");
  run_body(run, "%r = OpIAdd %uint %x %n\n", "%size = OpSpecConstant %uint 64\n", "; target: vulkan1.1\n",
           "OpExecutionModeId %main LocalSizeId %size %u1 %u1\nOpDecorate %size SpecId 9\n", "", "");
}

CTS_CASE("spirv_assembly", "phi_swap") {
  run_body(run, R"(
OpBranch %head
%head = OpLabel
%p = OpPhi %uint %x %entry %q %again
%q = OpPhi %uint %n %entry %p %again
%k = OpPhi %uint %u0 %entry %k1 %again
OpLoopMerge %done %again None
OpBranch %test
%test = OpLabel
%trips = OpBitwiseAnd %uint %x %u3
%more = OpULessThan %bool %k %trips
OpBranchConditional %more %again %done
%again = OpLabel
%k1 = OpIAdd %uint %k %u1
OpBranch %head
%done = OpLabel
%t = OpShiftLeftLogical %uint %p %u1
%r = OpIAdd %uint %t %q
)");
}

CTS_CASE("spirv_assembly", "switch_fallthrough") {
  run_body(run, R"(
%s = OpUMod %uint %x %u5
OpSelectionMerge %done None
OpSwitch %s %default 0 %zero 2 %two 3 %three
%zero = OpLabel
%a = OpIAdd %uint %n %u5
OpBranch %two
%two = OpLabel
%b = OpPhi %uint %u1 %entry %a %zero
OpBranch %done
%three = OpLabel
OpBranch %done
%default = OpLabel
OpBranch %done
%done = OpLabel
%r = OpPhi %uint %b %two %x %three %n %default
)");
}

CTS_CASE("spirv_assembly", "composite_select_and_copy") {
  run_body(run, R"(
%a = OpCompositeConstruct %v2uint %x %n
%b = OpCompositeConstruct %v2uint %n %u5
%c0 = OpULessThan %bool %x %u5
%c1 = OpINotEqual %bool %n %u3
%c = OpCompositeConstruct %v2bool %c0 %c1
%d = OpSelect %v2uint %c %a %b
%e = OpCopyObject %v2uint %d
%s = OpCompositeConstruct %pair %e %f1
%f = OpCompositeExtract %uint %s 0 0
%g = OpCompositeExtract %uint %s 0 1
%r = OpIMul %uint %f %g
)",
           "%v2bool = OpTypeVector %bool 2\n%pair = OpTypeStruct %v2uint %float\n");
}

// Mixes between literals have a shorter form, but not where they are precise.
CTS_CASE("spirv_assembly", "precise_mix_of_literals") {
  run_body(run, R"(
%integer = OpConvertUToF %float %x
%weight = OpFMul %float %integer %third
%precise = OpExtInst %float %glsl FMix %third %seventh %weight
%r = OpBitcast %uint %precise
)",
           "%third = OpConstant %float 0.333\n%seventh = OpConstant %float 1.7\n", "",
           "OpDecorate %precise NoContraction\n");
}

CTS_CASE("spirv_assembly", "unordered_compare") {
  run_body(run, R"(
%f = OpBitcast %float %x
%a = OpFUnordLessThan %bool %f %f1
%b = OpFOrdGreaterThanEqual %bool %f %f1
%c = OpFUnordNotEqual %bool %f %f
%d = OpLogicalEqual %bool %a %b
%e = OpLogicalNotEqual %bool %d %c
%p = OpSelect %uint %a %u1 %u2
%q = OpSelect %uint %e %u5 %u3
%r = OpIMul %uint %p %q
)");
}

CTS_CASE("spirv_assembly", "signed_and_unsigned_mixed") {
  run_body(run, R"(
%i = OpBitcast %int %x
%a = OpShiftRightArithmetic %int %i %u3
%b = OpShiftRightLogical %uint %x %u3
%c = OpIAdd %uint %a %b
%d = OpSDiv %int %i %i3
%e = OpIMul %uint %c %d
%f = OpSNegate %int %e
%g = OpNot %uint %f
%h = OpSLessThan %bool %i %f
%k = OpSelect %uint %h %g %e
%m = OpBitReverse %uint %k
%r = OpBitCount %uint %m
)");
}

CTS_CASE("spirv_assembly", "switch_on_64_bits") {
  run.require(run.gpu.features.shaderInt64, "shaderInt64");
  run_body(run, R"(
%wide = OpUConvert %ulong %x
%c = OpConvertUToF %float %wide
%s = OpShiftLeftLogical %ulong %wide %u31
OpSelectionMerge %done None
OpSwitch %s %default 0 %zero 4294967296 %two 6442450944 %three
%zero = OpLabel
OpBranch %done
%two = OpLabel
OpBranch %done
%three = OpLabel
OpBranch %done
%default = OpLabel
OpBranch %done
%done = OpLabel
%r = OpPhi %uint %u1 %zero %u2 %two %u5 %three %n %default
)",
           "%ulong = OpTypeInt 64 0\n%u31 = OpConstant %uint 31\n", "OpCapability Int64\n");
}

CTS_CASE("spirv_assembly", "extended_arithmetic") {
  run_body(run, R"(
%k = OpIMul %uint %x %u5
%a = OpIAddCarry %two %x %k
%b = OpISubBorrow %two %n %x
%c = OpUMulExtended %two %x %k
%a0 = OpCompositeExtract %uint %a 0
%a1 = OpCompositeExtract %uint %a 1
%b1 = OpCompositeExtract %uint %b 1
%c1 = OpCompositeExtract %uint %c 1
%s = OpIAdd %uint %a0 %a1
%t = OpBitwiseXor %uint %b1 %c1
%r = OpIAdd %uint %s %t
)",
           "%two = OpTypeStruct %uint %uint\n");
}

/// Integer dot products of packed bytes and of vectors, with and without saturation.
const bool kDotProducts = [] {
  for (const char* kind : {"SDot", "UDot", "SUDot"})
    AddCase("spirv_assembly", std::string("dot_product.") + kind, [kind](Run& run) {
      run.require(run.gpu.extension_features.shaderIntegerDotProduct && run.gpu.extension_features.shaderInt8,
                  "shaderIntegerDotProduct");
      const std::string name = std::string("Op") + kind + "KHR", saturated = std::string("Op") + kind + "AccSatKHR";
      const std::string type = std::string(kind) == "UDot" ? "u" : "";
      std::string body = R"(
%y = OpIMul %uint %x %big
%z = OpNot %uint %y
%a = DOT %Wint %x %y PackedVectorFormat4x8Bit
%b = SAT %Wint %y %z %Wlimit PackedVectorFormat4x8Bit
%v = OpCompositeConstruct %v3uint %x %y %z
%w = OpCompositeConstruct %v3uint %z %x %x
%c = DOT %Wint %v %w
%p = OpBitcast %v4byte %x
%q = OpBitcast %v4byte %z
%d = SAT %Wint %p %q %Wlimit
%e = DOT %Wshort %p %q
%f = OpBitcast %ushort %e
%g = OpUConvert %uint %f
%h = OpIAdd %uint %a %b
%i = OpIMul %uint %c %u5
%k = OpIAdd %uint %h %i
%l = OpBitwiseXor %uint %k %d
%r = OpIAdd %uint %l %g
)";
      const std::pair<const char*, std::string> kWords[] = {{"DOT", name}, {"SAT", saturated}, {"%W", "%" + type}};
      for (const auto& [from, to] : kWords)
        for (size_t at = body.find(from); at != std::string::npos; at = body.find(from, at + to.size()))
          body.replace(at, std::string(from).size(), to);
      run_body(run, body,
               "%byte = OpTypeInt 8 0\n%v4byte = OpTypeVector %byte 4\n%ushort = OpTypeInt 16 0\n"
               "%short = OpTypeInt 16 1\n%big = OpConstant %uint 2654435761\n%limit = OpConstant %int 2147483600\n"
               "%ulimit = OpConstant %uint 4294967200\n",
               "OpCapability Int8\nOpCapability Int16\nOpCapability DotProductKHR\nOpCapability DotProductInputAllKHR\n"
               "OpCapability DotProductInput4x8BitKHR\nOpCapability DotProductInput4x8BitPackedKHR\n"
               "OpExtension \"SPV_KHR_integer_dot_product\"\n");
    });
  return true;
}();

/// Both labels of a branch are the same, and inside something else leaves the selection.
CTS_CASE("spirv_assembly", "branch_to_one_label") {
  run_body(run, R"(
%odd_bit = OpBitwiseAnd %uint %x %u1
%odd = OpIEqual %bool %odd_bit %u1
OpSelectionMerge %done None
OpBranchConditional %odd %same %same
%same = OpLabel
%a = OpIMul %uint %x %u5
OpSelectionMerge %inner None
OpBranchConditional %odd %left %inner
%left = OpLabel
OpBranch %inner
%inner = OpLabel
%b = OpPhi %uint %a %same %u3 %left
OpBranchConditional %odd %last %done
%last = OpLabel
%c = OpIAdd %uint %b %n
OpBranch %done
%done = OpLabel
%r = OpPhi %uint %b %inner %c %last
)");
}

/// Offset and count of a bit field are integers of any width.
CTS_CASE("spirv_assembly", "bit_fields_of_mixed_widths") {
  run.require(run.gpu.features.shaderInt16 && run.gpu.features.shaderInt64, "16- and 64-bit integers");
  run_body(run, R"(
%few = OpBitwiseAnd %uint %n %u7
%count16 = OpUConvert %ushort %few
%offset64 = OpUConvert %ulong %few
%a = OpBitFieldInsert %uint %x %n %offset64 %count16
%b = OpBitFieldUExtract %uint %a %count16 %offset64
%ix = OpBitcast %int %x
%c = OpBitFieldSExtract %int %ix %offset64 %count16
%uc = OpBitcast %uint %c
%d = OpBitwiseXor %uint %a %uc
%r = OpIAdd %uint %d %b
)",
           "%u7 = OpConstant %uint 7\n%ushort = OpTypeInt 16 0\n%ulong = OpTypeInt 64 0\n",
           "OpCapability Int16\nOpCapability Int64\n");
}

/// Lengths and indices may be constants of other widths; what has no value may be undefined.
CTS_CASE("spirv_assembly", "odd_constants_and_undefined_objects") {
  run.require(run.gpu.features.shaderInt16 && run.gpu.features.shaderInt64, "16- and 64-bit integers");
  run_body(run, R"(
%no_image = OpUndef %image
%no_sampler = OpUndef %sampler
%no_both = OpUndef %both
%from16 = OpAccessChain %uint_ptr %in %s0 %n
%y = OpLoad %uint %from16
%a = OpCompositeConstruct %four %y %x %n %u5
%b = OpCompositeExtract %uint %a 0
%c = OpCompositeExtract %uint %a 3
%r = OpIAdd %uint %b %c
)",
           "%short = OpTypeInt 16 1\n%s0 = OpConstant %short 0\n%ulong = OpTypeInt 64 0\n%l4 = OpConstant %ulong 4\n"
           "%four = OpTypeArray %uint %l4\n%image = OpTypeImage %float 2D 0 0 0 1 Unknown\n%sampler = OpTypeSampler\n"
           "%both = OpTypeSampledImage %image\n",
           "OpCapability Int16\nOpCapability Int64\n");
}

/// Converts floats x, and doubles x * ratio, to halves and stores them.
constexpr char kRoundedHalves[] = R"(; target: vulkan1.1
OpCapability Shader
OpCapability Float64
OpCapability StorageBuffer16BitAccess
CAPABILITIES
OpExtension "SPV_KHR_16bit_storage"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %id
OpExecutionMode %main LocalSize 64 1 1
MODES
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %floats ArrayStride 4
OpDecorate %halves ArrayStride 2
OpDecorate %in_block Block
OpDecorate %out_block Block
OpMemberDecorate %in_block 0 Offset 0
OpMemberDecorate %out_block 0 Offset 0
OpDecorate %in DescriptorSet 0
OpDecorate %in Binding 0
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 1
DECORATIONS
%void = OpTypeVoid
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%half = OpTypeFloat 16
%float = OpTypeFloat 32
%double = OpTypeFloat 64
%v3uint = OpTypeVector %uint 3
%v3ptr = OpTypePointer Input %v3uint
%id = OpVariable %v3ptr Input
%floats = OpTypeRuntimeArray %float
%halves = OpTypeRuntimeArray %half
%in_block = OpTypeStruct %floats
%out_block = OpTypeStruct %halves
%in_ptr = OpTypePointer StorageBuffer %in_block
%out_ptr = OpTypePointer StorageBuffer %out_block
%float_ptr = OpTypePointer StorageBuffer %float
%half_ptr = OpTypePointer StorageBuffer %half
%in = OpVariable %in_ptr StorageBuffer
%out = OpVariable %out_ptr StorageBuffer
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%ratio = OpConstant %double RATIO
CONSTANTS
%main = OpFunction %void None %fn
%entry = OpLabel
%gid = OpLoad %v3uint %id
%n = OpCompositeExtract %uint %gid 0
%from = OpAccessChain %float_ptr %in %u0 %n
%x = OpLoad %float %from
%n2 = OpIAdd %uint %n %n
%n3 = OpIAdd %uint %n2 %u1
%to = OpAccessChain %half_ptr %out %u0 %n2
%too = OpAccessChain %half_ptr %out %u0 %n3
%h = OpFConvert %half %x
OpStore %to %h
%d = OpFConvert %double %x
%e = OpFMul %double %d %ratio
%k = HALF
OpStore %too %k
OpReturn
OpFunctionEnd
)";

constexpr double kRatio = 1.0009765;

/// The reference converts to the nearest binary32 on the way, which is a half further from zero than the double.
bool rounds_up_to_half(double number) {
  const float nearest = static_cast<float>(number);
  const int least = std::max(std::ilogb(nearest), -14) - 10;
  const float scaled = std::ldexp(nearest, -least);
  return std::fabs(nearest) > std::fabs(number) && scaled == std::trunc(scaled);
}

/// How the shader asks for its rounding.
struct Rounding {
  const char *capabilities, *modes, *decorations;
  const char* constants = "";
  const char* half = "OpFConvert %half %e";  ///< `constants` have another one
};
constexpr Rounding kTowardZero = {"", "", "OpDecorate %h FPRoundingMode RTZ\nOpDecorate %k FPRoundingMode RTZ"};
constexpr Rounding kNearest = {"", "", "OpDecorate %h FPRoundingMode RTE\nOpDecorate %k FPRoundingMode RTE"};
constexpr char kFloatControls[] =
    "OpCapability Float16\nOpCapability RoundingModeRTE\nOpExtension \"SPV_KHR_float_controls\"";
constexpr Rounding kNearestMode = {kFloatControls, "OpExecutionMode %main RoundingModeRTE 16", ""};
constexpr Rounding kNearestConstant = {kFloatControls, "OpExecutionMode %main RoundingModeRTE 16", "",
                                       "%exact = OpSpecConstant %double RATIO\n"
                                       "%rounded = OpSpecConstantOp %half FConvert %exact",
                                       "OpCopyObject %half %rounded"};

void convert_to_half(Run& run, const std::string& name, const Rounding& rounding, double ratio,
                     const std::vector<float>& values) {
  const auto& storage = run.gpu.extension_features;
  run.require(storage.storageBuffer16BitAccess && run.gpu.features.shaderFloat64, "16-bit stores and doubles");
  run.require(*rounding.modes == 0 || run.gpu.has("VK_KHR_shader_float_controls"), "VK_KHR_shader_float_controls");
  std::ostringstream written;
  written << std::setprecision(17) << ratio;
  std::string text = kRoundedHalves;
  const auto fill_in = [&](const std::string& name_of_part, const std::string& part) {
    for (std::size_t at = 0; (at = text.find(name_of_part)) != std::string::npos;)
      text.replace(at, name_of_part.size(), part);
  };
  fill_in("CAPABILITIES", rounding.capabilities);
  fill_in("MODES", rounding.modes);
  fill_in("DECORATIONS", rounding.decorations);
  fill_in("CONSTANTS", rounding.constants);
  fill_in("HALF", rounding.half);
  fill_in("RATIO", written.str());
  const Buffer in = run.buffer_of(values), out = run.buffer(values.size() * 4);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, static_cast<uint32_t>(values.size() / 64));
  run.out(name, out);
}

/// Stores of binary16 that round toward zero, of floats around and beyond what binary16 holds.
CTS_CASE("spirv_assembly", "convert_toward_zero") {
  std::vector<float> values(1024);
  for (float& value : values) {
    do {
      const int exponent = static_cast<int>(run.random.below(46)) - 28;
      value = std::ldexp(run.random.real(-2, 2), exponent);
    } while (rounds_up_to_half(value * kRatio));
  }
  values[0] = std::numeric_limits<float>::infinity();
  values[1] = std::numeric_limits<float>::quiet_NaN();
  values[2] = -0.0f;
  convert_to_half(run, "halves", kTowardZero, kRatio, values);
}

/// Powers of two and their negatives, times something whose half the reference gets wrong and something else.
void close_and_clear(Run& run, const Rounding& rounding, double close, double clear) {
  std::vector<float> values(64);
  for (int i = 0; i < 64; ++i) values[i] = std::ldexp(i % 2 ? -1.0f : 1.0f, i % 25 - 12);
  convert_to_half(run, "close", rounding, close, values);
  convert_to_half(run, "clear", rounding, clear, values);
}

/// Just below 1, and what rounds to no half in binary32.
const AddCase kDoubleToHalf("spirv_assembly", "deviation.double_to_half", "double-to-half", case_against_control,
                            [](Run& run) { close_and_clear(run, kTowardZero, 1.0 - 0x1p-30, 1.0 - 0x1p-12); });

/// Just above the middle of two halves, and what binary32 can tell from it.
constexpr double kAboveMiddle = 1.0 + 0x1p-11 + 0x1p-30, kBehindMiddle = 1.0 + 0x1p-11 + 0x1p-12;
const AddCase kNearestHalf("spirv_assembly", "deviation.nearest_half", "nearest-half", case_against_control,
                           [](Run& run) { close_and_clear(run, kNearest, kAboveMiddle, kBehindMiddle); });
const AddCase kNearestHalfMode("spirv_assembly", "deviation.nearest_half_mode", "nearest-half", case_against_control,
                               [](Run& run) { close_and_clear(run, kNearestMode, kAboveMiddle, kBehindMiddle); });
const AddCase kNearestHalfConstant("spirv_assembly", "deviation.nearest_half_constant", "nearest-half",
                                   case_against_control, [](Run& run) {
                                     close_and_clear(run, kNearestConstant, kAboveMiddle, kBehindMiddle);
                                   });

/// Unordered comparisons are exact, and what the rules make of a selection by their negation is.
CTS_CASE("spirv_assembly", "unordered_comparisons_are_exact") {
  const char* comparisons[] = {"LessThan", "LessThanEqual", "GreaterThan", "GreaterThanEqual", "Equal", "NotEqual"};
  for (const std::string comparison : comparisons) {
    run_body(run,
             "%low = OpBitwiseAnd %uint %n %u3\n%f = OpConvertUToF %float %x\n%g = OpConvertUToF %float %low\n%c = "
             "OpFUnord" +
                 comparison + R"( %bool %f %g
%tenth_of_f = OpFMul %float %f %tenth
%negative = OpFMul %float %tenth_of_f %minus
%chosen = OpSelect %float %c %negative %f1
%product = OpFMul %float %chosen %tenth
%r = OpBitcast %uint %product
)",
             "%tenth = OpConstant %float 0.1\n%minus = OpConstant %float -1\n");
    run.outputs.back().name = comparison;
  }
}

/// The absolute value of -2 in a vector of literals.
void literal_magnitude(Run& run, const std::string& name, const std::string& neighbour) {
  run_body(run, R"(
%magnitudes = OpExtInst %v4float %glsl FAbs %numbers
%magnitude = OpCompositeExtract %float %magnitudes 1
%bits = OpBitcast %uint %magnitude
%r = OpIAdd %uint %x %bits
)",
           "%f3 = OpConstant %float 3\n%negative = OpConstant %float -2\n%neighbour = OpConstant %float " + neighbour +
               "\n%numbers = OpConstantComposite %v4float %f1 %negative %neighbour %f3\n");
  run.outputs.back().name = name;
}

const AddCase kNanLiterals("spirv_assembly", "deviation.nan_literals", "nan-literals", case_against_control,
                           [](Run& run) {
                             const Random random = run.random;
                             literal_magnitude(run, "beside_nan", "0x1.8p+128");
                             run.random = random;  // the same input
                             literal_magnitude(run, "beside_number", "5");
                           });

/// There is one device in every group.
CTS_CASE("spirv_assembly", "device_index") {
  run_body(run, "%d = OpLoad %uint %device\n%r = OpIAdd %uint %x %d\n",
           "%uint_in = OpTypePointer Input %uint\n%device = OpVariable %uint_in Input\n",
           "; target: vulkan1.1\nOpCapability DeviceGroup\n", "OpDecorate %device BuiltIn DeviceIndex\n", "%device");
}

CTS_CASE("spirv_assembly", "function_variables_and_access_chains") {
  run_body(run, R"(
%k = OpUMod %uint %x %u5
%p0 = OpAccessChain %uint_local %local %u0
OpStore %p0 %x
%p1 = OpAccessChain %uint_local %local %u1
OpStore %p1 %n
%p2 = OpAccessChain %uint_local %local %k
OpStore %p2 %u3
%all = OpLoad %five %local
OpStore %second %all
%p3 = OpInBoundsAccessChain %uint_local %second %k
%a = OpLoad %uint %p3
%b = OpCompositeExtract %uint %all 0
%c = OpCompositeExtract %uint %all 1
%d = OpIAdd %uint %a %b
%r = OpIAdd %uint %d %c
)",
           "%five = OpTypeArray %uint %u5\n%five_private = OpTypePointer Private %five\n%uint_local = OpTypePointer "
           "Private %uint\n"
           "%zeros = OpConstantNull %five\n%local = OpVariable %five_private Private %zeros\n%second = OpVariable "
           "%five_private Private %zeros\n");
}

/// An output that the shader does not name has the value of its initializer.
CTS_CASE("spirv_assembly", "initialized_output") {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment_module = run.module(assemble_spirv(R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %color
OpExecutionMode %main OriginUpperLeft
OpDecorate %color Location 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%float = OpTypeFloat 32
%v4float = OpTypeVector %float 4
%v4ptr = OpTypePointer Output %v4float
%a = OpConstant %float 0.25
%b = OpConstant %float 0.75
%value = OpConstantComposite %v4float %a %b %b %a
%color = OpVariable %v4ptr Output %value
%main = OpFunction %void None %fn
%entry = OpLabel
OpReturn
OpFunctionEnd
)"));
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
