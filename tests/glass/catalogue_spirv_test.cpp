// Planted faults in hand-written SPIR-V: what GLSL and HLSL cannot say, and what they seldom say. Each as it is and
// behind spirv-opt -O.
#include "tests/glass/assembly.h"
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

constexpr auto kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr auto kControl = VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;

/// %p: %low bytes behind the address in the push constants.
constexpr char kAddress[] =
    "%pair = OpAccessChain %push_pair %push %u0\n%address = OpLoad %v2uint %pair\n"
    "%base = OpCompositeExtract %uint %address 0\n%sum = OpIAdd %uint %base %low\n"
    "%moved = OpCompositeInsert %v2uint %sum %address 0\n%p = OpBitcast %physical %moved\n";

std::string at_address(const std::string& factor, const std::string& rest) {
  return "%low = OpIMul %uint %x " + factor + "\n" + kAddress + rest;
}

/// `what` in lanes for which `condition` holds.
std::string in_branch(const std::string& condition, const std::string& what) {
  return "%c = " + condition +
         "\nOpSelectionMerge %merge None\nOpBranchConditional %c %then %merge\n%then = OpLabel\n" + what +
         "OpBranch %merge\n%merge = OpLabel\n";
}

Assembly in_stage(VkShaderStageFlagBits stage) {
  Assembly frame;
  frame.stage = stage;
  return frame;
}

Assembly with_four_buffers() {
  Assembly frame;
  frame.capabilities =
      "OpCapability ShaderNonUniform\nOpCapability StorageBufferArrayDynamicIndexing\n"
      "OpCapability StorageBufferArrayNonUniformIndexing\n";
  frame.decorations = "OpDecorate %four DescriptorSet 0\nOpDecorate %four Binding 7\nOpDecorate %marked NonUniform\n";
  frame.declarations =
      "%blocks = OpTypeArray %block %u4\n%blocks_pointer = OpTypePointer StorageBuffer %blocks\n"
      "%four = OpVariable %blocks_pointer StorageBuffer\n";
  frame.interface = "%four";
  return frame;
}

Assembly with_images() {
  Assembly frame;
  frame.capabilities =
      "OpCapability ShaderNonUniform\nOpCapability StorageImageArrayDynamicIndexing\n"
      "OpCapability StorageImageArrayNonUniformIndexing\n";
  frame.decorations = "OpDecorate %many DescriptorSet 0\nOpDecorate %many Binding 6\nOpDecorate %marked NonUniform\n";
  frame.declarations =
      "%image = OpTypeImage %uint 2D 0 0 0 2 R32ui\n%images = OpTypeArray %image %u3\n"
      "%images_pointer = OpTypePointer UniformConstant %images\n%image_pointer = OpTypePointer UniformConstant %image\n"
      "%texel_pointer = OpTypePointer Image %uint\n%many = OpVariable %images_pointer UniformConstant\n"
      "%corner = OpConstantComposite %v2uint %u0 %u0\n";
  frame.interface = "%many";
  return frame;
}

Assembly with_function(const std::string& text) {
  Assembly frame;
  frame.declarations = "%of_word = OpTypeFunction %uint %uint\n";
  frame.functions = text;
  return frame;
}

Assembly with_shared() {
  Assembly frame;
  frame.declarations =
      "%eight = OpTypeArray %uint %u8\n%shared_pointer = OpTypePointer Workgroup %eight\n"
      "%shared_word = OpTypePointer Workgroup %uint\n%s = OpVariable %shared_pointer Workgroup\n";
  frame.interface = "%s";
  return frame;
}

/// A fragment shader with an output.
Assembly with_color() {
  Assembly frame = in_stage(kFragment);
  frame.decorations = "OpDecorate %color Location 0\n";
  frame.declarations =
      "%color_pointer = OpTypePointer Output %v4float\n%color = OpVariable %color_pointer Output\n"
      "%ones = OpConstantComposite %v4float %f1 %f1 %f1 %f1\n";
  frame.interface = "%color";
  return frame;
}

/// An image of which the first row alone is written, and a texel of another one.
Assembly with_fresh_image() {
  Assembly frame;
  frame.decorations = "OpDecorate %fresh DescriptorSet 0\nOpDecorate %fresh Binding 10\n";
  frame.declarations =
      "%image = OpTypeImage %uint 2D 0 0 0 2 R32ui\n%image_pointer = OpTypePointer UniformConstant %image\n"
      "%texel_pointer = OpTypePointer Image %uint\n%fresh = OpVariable %image_pointer UniformConstant\n"
      "%third = OpConstantComposite %v2uint %u0 %u2\n";
  frame.interface = "%fresh";
  return frame;
}

Assembly with_undefined(const char* type) {
  Assembly frame;
  frame.declarations = "%undefined = OpUndef " + std::string(type) + "\n";
  return frame;
}

Assembly with_array() {
  Assembly frame;
  frame.declarations =
      "%five = OpTypeArray %uint %u5\n%five_pointer = OpTypePointer Function %five\n"
      "%zeros = OpConstantNull %five\n";
  return frame;
}

const char kNever[] =
    "OpSelectionMerge %merge None\nOpBranchConditional %c %merge %never\n%never = OpLabel\n"
    "@OpUnreachable\n%merge = OpLabel\n";
/// Four rounds of a loop: %k counts them, %again is where the next one comes from.
std::string loop_of(const std::string& round) {
  return "OpBranch %head\n%head = OpLabel\n%k = OpPhi %uint %u0 %entry %next %again\n%more = OpULessThan %bool %k %u4\n"
         "OpLoopMerge %out %again None\nOpBranchConditional %more %round %out\n%round = OpLabel\n" +
         round + "%again = OpLabel\n%next = OpIAdd %uint %k %u1\nOpBranch %head\n%out = OpLabel\n";
}
/// A selection of which both sides continue; `end`: how the second one ends.
std::string continues(const std::string& end) {
  return loop_of(
      "%c = OpULessThan %bool %x %u3\n%d = OpULessThan %bool %x %u7\nOpSelectionMerge %never None\n"
      "OpBranchConditional %c %left %right\n%left = OpLabel\nOpStore %at %k\nOpBranch %again\n%right = OpLabel\n" +
      end + "%never = OpLabel\n@OpUnreachable\n");
}
/// A loop whose only round returns.
const char kReturns[] =
    "OpBranch %head\n%head = OpLabel\nOpLoopMerge %out %again None\nOpBranch %round\n%round = OpLabel\n"
    "OpStore %at %u5\nOpReturn\n%again = OpLabel\nOpBranch %head\n%out = OpLabel\nOpUnreachable\n%end = OpLabel\n";
/// Divides by %k where `condition` does not hold; nobody uses the quotient.
std::string unused_quotient(const std::string& condition) {
  return loop_of("%c = " + condition +
                 "\nOpSelectionMerge %rest None\nOpBranchConditional %c %left %rest\n%left = OpLabel\nOpStore %at %k\n"
                 "OpBranch %again\n%rest = OpLabel\n@%d = OpUDiv %uint %u7 %k\nOpBranch %again\n");
}
const char kSwitch[] =
    "%f = OpFunction %uint None %of_word\n%a = OpFunctionParameter %uint\n%start = OpLabel\n"
    "OpSelectionMerge %end None\nOpSwitch %a %other 0 %zero 1 %one\n%zero = OpLabel\nOpReturnValue %u7\n"
    "%one = OpLabel\nOpReturnValue %u9\n%other = OpLabel\n@OpUnreachable\n%end = OpLabel\nOpReturnValue %u2\n"
    "OpFunctionEnd\n";

/// Returns from two loops, which nothing else leaves.
const char kReturnsFromLoops[] =
    "%g = OpFunction %uint None %of_word\n%b = OpFunctionParameter %uint\n%begin = OpLabel\n"
    "%early = OpULessThan %bool %b %u2\nOpSelectionMerge %rest None\nOpBranchConditional %early %first %rest\n"
    "%first = OpLabel\nOpReturnValue %u7\n%rest = OpLabel\nOpBranch %outer\n"
    "%outer = OpLabel\nOpLoopMerge %behind %outer_on None\nOpBranch %turn\n%turn = OpLabel\nOpBranch %inner\n"
    "%inner = OpLabel\nOpLoopMerge %left %inner_on None\nOpBranch %back\n%back = OpLabel\nOpReturnValue %u7\n"
    "%inner_on = OpLabel\nOpBranch %inner\n%left = OpLabel\nOpBranch %outer_on\n"
    "%outer_on = OpLabel\nOpBranch %outer\n%behind = OpLabel\nOpUnreachable\nOpFunctionEnd\n";

/// A loop to %x whose body is a selection without a way to its merge block, but for what `on` may be.
std::string merge_in_a_loop(const std::string& on, const std::string& mark) {
  return "OpBranch %header\n%header = OpLabel\n%k = OpPhi %uint %u0 %entry %next %on\n"
         "OpLoopMerge %done %on None\nOpBranch %choice\n%choice = OpLabel\n"
         "%enough = OpUGreaterThanEqual %bool %k %x\nOpSelectionMerge %never None\n"
         "OpBranchConditional %enough %out %again\n%out = OpLabel\nOpBranch %done\n%again = OpLabel\n" +
         on + "%never = OpLabel\n" + mark +
         "OpUnreachable\n%on = OpLabel\n%next = OpIAdd %uint %k %u1\nOpBranch %header\n%done = OpLabel\n"
         "OpStore %at %k\n";
}

/// A result of %q that goes to word %i.
std::string stored(const std::string& what) { return what + "OpStore %at %q\n"; }

/// The same, made of integers with signs: %sx is %x.
std::string stored_signed(const std::string& what) {
  return "%sx = OpBitcast %int %x\n" + what + "%q = OpBitcast %uint %sq\nOpStore %at %q\n";
}

/// The same, made of floats: %fx is %x.
std::string stored_float(const std::string& what) {
  return "%fx = OpConvertUToF %float %x\n" + what + "%q = OpBitcast %uint %fq\nOpStore %at %q\n";
}

struct Text {
  std::string name, rule;
  Assembly frame;
  std::string fault, twin;
  bool survives = true;
};

std::vector<Text> flow() {
  const std::string below_7 = "%c = OpULessThan %bool %x %u7\n", below_9 = "%c = OpULessThan %bool %x %u9\n";
  std::vector<Text> all{
      {"unreachable", "unreachable", {}, below_7 + kNever, below_9 + kNever, false},
      {"unreachable_in_a_fragment", "unreachable", in_stage(kFragment), below_7 + kNever, below_9 + kNever, false},
      {"unreachable_in_a_patch", "unreachable", in_stage(kControl), below_7 + kNever, below_9 + kNever, false},
      {"unreachable_case", "unreachable", with_function(kSwitch), stored("%q = OpFunctionCall %uint %f %x\n"),
       stored("%y = OpUMod %uint %x %u2\n%q = OpFunctionCall %uint %f %y\n"), false},
      {"unreachable_behind_continues",
       "unreachable",
       {},
       continues("OpBranchConditional %d %again %never\n"),
       continues("OpBranch %again\n"),
       false},
      {"unused_quotient_behind_a_continue",
       "division-by-zero",
       {},
       unused_quotient("OpULessThan %bool %x %u3"),
       unused_quotient("OpIEqual %bool %k %u0"),
       false},
      {"unreachable_merge_in_a_loop",
       "unreachable",
       {},
       merge_in_a_loop("%seven = OpUGreaterThanEqual %bool %x %u7\nOpBranchConditional %seven %never %on\n", "@"),
       merge_in_a_loop("OpBranch %on\n", ""),
       false},
      {"unreachable_behind_returns", "unreachable", with_function(std::string(kSwitch) + kReturnsFromLoops),
       "%q = OpFunctionCall %uint %f %x\nOpStore %at %x\n", "%q = OpFunctionCall %uint %g %x\nOpStore %at %x\n", false},
      {"barrier_in_a_branch", "divergent-barrier", with_shared(),
       in_branch("OpULessThan %bool %x %u3", "@OpControlBarrier %u2 %u2 %u264\n"),
       in_branch("OpULessThan %bool %x %u8", "OpControlBarrier %u2 %u2 %u264\n")},
      {"barrier_of_half_a_patch", "divergent-barrier", in_stage(kControl),
       in_branch("OpULessThan %bool %i %u4", "@OpControlBarrier %u2 %u4 %u0\n"),
       in_branch("OpULessThan %bool %i %u8", "OpControlBarrier %u2 %u4 %u0\n")},
      {"barrier_behind_a_return_of_a_patch", "divergent-barrier", in_stage(kControl),
       "%c = OpIEqual %bool %i %u3\nOpSelectionMerge %merge None\nOpBranchConditional %c %then %merge\n"
       "%then = OpLabel\nOpReturn\n%merge = OpLabel\n@OpControlBarrier %u2 %u4 %u0\n",
       "OpControlBarrier %u2 %u4 %u0\n"},
      {"derivative_in_a_branch", "divergent-derivative", in_stage(kFragment),
       in_branch("OpULessThan %bool %x %u3",
                 "%g = OpCompositeExtract %float %position 1\n@%d = OpDPdx %float %g\n"
                 "%q = OpBitcast %uint %d\nOpStore %at %q\n"),
       in_branch("OpULessThan %bool %i %u4",
                 "%g = OpCompositeExtract %float %position 1\n%d = OpDPdx %float %g\n"
                 "%q = OpBitcast %uint %d\nOpStore %at %q\n")},
      {"output_added_to", "uninitialized-variable", with_color(),
       "%old = OpLoad %v4float %color\n%sum = OpFAdd %v4float %old %ones\n@OpStore %color %sum\n",
       "%old = OpLoad %v4float %color\n%new = OpVectorShuffle %v4float %old %ones 4 5 6 3\nOpStore %color %new\n",
       false},
      {"component_of_an_output_moved", "uninitialized-variable", with_color(),
       "%old = OpLoad %v4float %color\n%new = OpVectorShuffle %v4float %old %ones 4 0 6 7\n@OpStore %color %new\n",
       "%old = OpLoad %v4float %color\n%one = OpCompositeInsert %v4float %f1 %old 0\n"
       "%new = OpCompositeInsert %v4float %f5 %one 2\nOpStore %color %new\n",
       false},
      {"undefined_value_stored", "uninitialized-variable", with_undefined("%uint"), "@OpStore %at %undefined\n",
       "OpStore %at %u5\n", false},
      {"undefined_branch", "uninitialized-variable", with_undefined("%bool"),
       "@OpSelectionMerge %merge None\nOpBranchConditional %undefined %then %merge\n%then = OpLabel\n"
       "OpStore %at %u5\nOpBranch %merge\n%merge = OpLabel\n",
       in_branch("OpULessThan %bool %x %u3", "OpStore %at %u5\n"), false},
      {"undefined_part", "uninitialized-variable", with_undefined("%v2uint"),
       "%w = OpCompositeInsert %v2uint %x %undefined 0\n%q = OpCompositeExtract %uint %w 1\n@OpStore %at %q\n",
       "%w = OpCompositeInsert %v2uint %x %undefined 0\n%q = OpCompositeExtract %uint %w 0\nOpStore %at %q\n"},
      {"undefined_phi", "uninitialized-variable", with_undefined("%uint"),
       in_branch("OpULessThan %bool %x %u5", "") + "%q = OpPhi %uint %u3 %then %undefined %entry\n@OpStore %at %q\n",
       in_branch("OpULessThan %bool %x %u5", "") + "%q = OpPhi %uint %u3 %then %u4 %entry\nOpStore %at %q\n", false},
      {"variable_of_a_function",
       "uninitialized-variable",
       {},
       "%local = OpVariable %local_word Function\n" + in_branch("OpULessThan %bool %x %u5", "OpStore %local %x\n") +
           "%q = OpLoad %uint %local\n@OpStore %at %q\n",
       "%local = OpVariable %local_word Function %u4\n" + in_branch("OpULessThan %bool %x %u5", "OpStore %local %x\n") +
           "%q = OpLoad %uint %local\nOpStore %at %q\n",
       false},
      {"shared_word", "uninitialized-shared", with_shared(),
       "%own = OpAccessChain %shared_word %s %i\n" + in_branch("OpULessThan %bool %x %u7", "OpStore %own %x\n") +
           "OpControlBarrier %u2 %u2 %u264\n@%q = OpLoad %uint %own\nOpStore %at %q\n",
       "%own = OpAccessChain %shared_word %s %i\nOpStore %own %x\nOpControlBarrier %u2 %u2 %u264\n"
       "%q = OpLoad %uint %own\nOpStore %at %q\n"},
  };
  return all;
}

std::vector<Text> accesses() {
  const std::string load = "@%q = OpLoad %uint %p Aligned ";
  const auto element = [](const std::string& index, const std::string& rest) {
    return "%half = OpUDiv %uint %x %u2\n%marked = OpCopyObject %uint %half\n"
           "%e = OpAccessChain %word_pointer %four " +
           index + " %u0 %i\n" + rest;
  };
  const auto image = [](const std::string& index, const std::string& rest) {
    return "%half = OpUDiv %uint %x %u4\n%marked = OpCopyObject %uint %half\n"
           "%e = OpAccessChain %image_pointer %many " +
           index + "\n" + rest;
  };
  const std::string read =
      "%whole = OpLoad %image %e\n@%texel = OpImageRead %v4uint %whole %corner\n"
      "%q = OpCompositeExtract %uint %texel 0\nOpStore %at %q\n";
  const std::string write = "%whole = OpLoad %image %e\n@OpImageWrite %whole %corner %four_words\n";
  const std::string swap =
      "%texel = OpImageTexelPointer %texel_pointer %e %corner %u0\n"
      "@%q = OpAtomicIAdd %uint %texel %u1 %u0 %u3\nOpStore %at %q\n";
  Assembly writes = with_images();
  writes.declarations += "%four_words = OpConstantComposite %v4uint %u1 %u1 %u1 %u1\n";
  const auto unmarked = [](std::string text) {
    text.erase(text.find('@'), 1);
    return text;
  };
  return {
      {"load_that_promises_16",
       "misaligned-access",
       {},
       at_address("%u4", stored(load + "16\n")),
       at_address("%u4", stored(unmarked(load) + "4\n"))},
      {"load_that_promises_2",
       "misaligned-access",
       {},
       at_address("%u2", stored(load + "2\n")),
       at_address("%u4", stored(unmarked(load) + "2\n"))},
      {"store_that_promises_8",
       "misaligned-access",
       {},
       at_address("%u4", "@OpStore %p %x Aligned 8\n"),
       at_address("%u8", "OpStore %p %x Aligned 8\n")},
      {"volatile_store_that_promises_8",
       "misaligned-access",
       {},
       at_address("%u4", "@OpStore %p %x Volatile|Aligned 8\n"),
       at_address("%u8", "OpStore %p %x Volatile|Aligned 8\n")},
      {"copy_that_promises_8",
       "misaligned-access",
       {},
       at_address("%u4", "@OpCopyMemory %at %p Aligned 8\n"),
       at_address("%u8", "OpCopyMemory %at %p Aligned 8\n")},
      {"atomic_at_half_a_word",
       "misaligned-access",
       {},
       at_address("%u2", "@%q = OpAtomicIAdd %uint %p %u1 %u0 %u3\nOpStore %at %q\n"),
       at_address("%u4", "%q = OpAtomicIAdd %uint %p %u1 %u0 %u3\nOpStore %at %q\n")},
      {"atomic_on_a_texel_that_is_not_written", "uninitialized-image", with_fresh_image(),
       "%texel = OpImageTexelPointer %texel_pointer %fresh %third %u0\n"
       "@%q = OpAtomicIAdd %uint %texel %u1 %u0 %u3\nOpStore %at %q\n",
       "%texel = OpImageTexelPointer %texel_pointer %fresh %third %u0\nOpAtomicStore %texel %u1 %u0 %u3\n"},
      {"address_past_the_end",
       "bad-device-address",
       {},
       at_address("%u60", stored(load + "4\n")),
       at_address("%u8", stored(unmarked(load) + "4\n"))},
      {"buffer_without_non_uniform", "non-uniform-index", with_four_buffers(),
       element("%half", "@%q = OpLoad %uint %e\nOpStore %at %q\n"),
       element("%marked", "%q = OpLoad %uint %e\nOpStore %at %q\n")},
      {"store_without_non_uniform", "non-uniform-index", with_four_buffers(), element("%half", "@OpStore %e %x\n"),
       element("%marked", "OpStore %e %x\n")},
      {"atomic_without_non_uniform", "non-uniform-index", with_four_buffers(),
       element("%half", "@%q = OpAtomicIAdd %uint %e %u1 %u0 %u3\nOpStore %at %q\n"),
       element("%marked", "%q = OpAtomicIAdd %uint %e %u1 %u0 %u3\nOpStore %at %q\n")},
      {"image_read_without_non_uniform", "non-uniform-index", with_images(), image("%half", read),
       image("%marked", unmarked(read))},
      {"image_write_without_non_uniform", "non-uniform-index", writes, image("%half", write),
       image("%marked", unmarked(write))},
      {"image_atomic_without_non_uniform", "non-uniform-index", with_images(), image("%half", swap),
       image("%marked", unmarked(swap))},
      {"buffer_past_the_end_in_bounds",
       "out-of-bounds-load",
       {},
       "%far = OpIAdd %uint %i %u60\n%e = OpInBoundsAccessChain %word_pointer %v %u0 %far\n@%q = OpLoad %uint %e\n"
       "OpStore %at %q\n",
       "%far = OpIAdd %uint %i %u56\n%e = OpInBoundsAccessChain %word_pointer %v %u0 %far\n%q = OpLoad %uint %e\n"
       "OpStore %at %q\n"},
      {"array_element", "out-of-bounds-array", with_array(),
       "%a = OpVariable %five_pointer Function %zeros\n%e = OpAccessChain %local_word %a %x\n@%q = OpLoad %uint %e\n"
       "OpStore %at %q\n",
       "%a = OpVariable %five_pointer Function %zeros\n%y = OpUMod %uint %x %u5\n"
       "%e = OpAccessChain %local_word %a %y\n%q = OpLoad %uint %e\nOpStore %at %q\n"},
      {"push_constant_behind_the_block",
       "out-of-bounds-push-constant",
       {},
       "%k = OpIMul %uint %x %u5\n%e = OpAccessChain %push_word %push %u1 %k\n@%q = OpLoad %uint %e\nOpStore %at %q\n",
       "%k = OpUDiv %uint %x %u4\n%e = OpAccessChain %push_word %push %u1 %k\n%q = OpLoad %uint %e\nOpStore %at %q\n"},
      {"push_constant_that_was_not_set",
       "uninitialized-push-constant",
       {},
       "%e = OpAccessChain %push_word %push %u1 %u2\n@%q = OpLoad %uint %e\nOpStore %at %q\n",
       "%e = OpAccessChain %push_word %push %u1 %u1\n%q = OpLoad %uint %e\nOpStore %at %q\n"},
  };
}

std::vector<Text> numbers() {
  return {
      {"signed_division",
       "division-by-zero",
       {},
       stored_signed("@%sq = OpSDiv %int %i7 %sx\n"),
       stored_signed("%sy = OpIAdd %int %sx %i1\n%sq = OpSDiv %int %i7 %sy\n")},
      {"signed_modulo",
       "division-by-zero",
       {},
       stored_signed("@%sq = OpSMod %int %i7 %sx\n"),
       stored_signed("%sy = OpIAdd %int %sx %i1\n%sq = OpSMod %int %i7 %sy\n")},
      {"remainder_of_a_vector",
       "division-by-zero",
       {},
       stored_signed("%sv = OpCompositeConstruct %v2int %i7 %sx\n@%sr = OpSRem %v2int %sv %sv\n"
                     "%sq = OpCompositeExtract %int %sr 1\n"),
       stored_signed("%sy = OpIAdd %int %sx %i1\n%sv = OpCompositeConstruct %v2int %i7 %sy\n"
                     "%sr = OpSRem %v2int %sv %sv\n%sq = OpCompositeExtract %int %sr 1\n")},
      {"unsigned_modulo_in_a_fragment", "division-by-zero", in_stage(kFragment), stored("@%q = OpUMod %uint %u7 %x\n"),
       stored("%y = OpIAdd %uint %x %u1\n%q = OpUMod %uint %u7 %y\n")},
      {"unsigned_division_in_a_patch", "division-by-zero", in_stage(kControl), stored("@%q = OpUDiv %uint %u7 %x\n"),
       stored("%y = OpIAdd %uint %x %u1\n%q = OpUDiv %uint %u7 %y\n")},
      {"arithmetic_shift",
       "shift-too-far",
       {},
       stored_signed("%far = OpIAdd %uint %x %u30\n@%sq = OpShiftRightArithmetic %int %sx %far\n"),
       stored_signed("%far = OpIAdd %uint %x %u9\n%sq = OpShiftRightArithmetic %int %sx %far\n")},
      {"bit_field_with_sign",
       "bit-field-out-of-range",
       {},
       stored_signed("@%sq = OpBitFieldSExtract %int %sx %u30 %x\n"),
       stored_signed("%sq = OpBitFieldSExtract %int %sx %u9 %x\n")},
      {"conversion_of_infinity",
       "conversion-out-of-range",
       {},
       stored_float("%fi = OpFDiv %float %f1 %fx\n@%fs = OpConvertFToS %int %fi\n%fq = OpBitcast %float %fs\n"),
       stored_float("%fy = OpFAdd %float %fx %f1\n%fi = OpFDiv %float %f1 %fy\n%fs = OpConvertFToS %int %fi\n"
                    "%fq = OpBitcast %float %fs\n")},
      {"remainder_of_numbers",
       "undefined-math",
       {},
       stored_float("@%fq = OpFRem %float %f5 %fx\n"),
       stored_float("%fy = OpFAdd %float %fx %f1\n%fq = OpFRem %float %f5 %fy\n")},
      {"bounds_exchanged",
       "undefined-math",
       {},
       stored_float("@%fq = OpExtInst %float %glsl FClamp %f1 %fx %f5\n"),
       stored_float("%fy = OpFNegate %float %fx\n%fq = OpExtInst %float %glsl FClamp %f1 %fy %f5\n")},
      {"bounds_of_integers_exchanged",
       "undefined-math",
       {},
       stored("@%q = OpExtInst %uint %glsl UClamp %u3 %x %u5\n"),
       stored("%q = OpExtInst %uint %glsl UClamp %u3 %x %u8\n")},
      {"arc_cosine_of_more_than_a_turn",
       "undefined-math",
       {},
       stored_float("@%fq = OpExtInst %float %glsl Acosh %fx\n"),
       stored_float("%fy = OpFAdd %float %fx %f1\n%fq = OpExtInst %float %glsl Acosh %fy\n")},
  };
}

std::vector<Text> all_texts() {
  std::vector<Text> all = flow();
  for (const auto& more : {accesses(), numbers()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

const std::vector<Text>& texts() {
  static const std::vector<Text> all = all_texts();
  return all;
}

/// Which text, and whether it is optimised.
using Choice = std::tuple<std::size_t, bool>;

std::vector<Choice> choices() {
  std::vector<Choice> result;
  for (std::size_t i = 0; i < texts().size(); ++i) {
    result.emplace_back(i, false);
    if (texts()[i].survives) result.emplace_back(i, true);
  }
  return result;
}

Texts found_in(const Text& text, const std::string& body, bool optimized, std::uint32_t& line) {
  Assembly assembly = text.frame;
  assembly.body = body;
  std::vector<std::uint32_t> module = assembly.words(line);
  if (optimized) module = vitrine::test::optimize(module);
  const auto tool = make_sanitize();
  return found_by(*tool, assembly.stage, module);
}

class CatalogueSpirv : public testing::TestWithParam<Choice> {};

TEST_P(CatalogueSpirv, FaultIsFoundAloneOnItsLine) {
  const auto [number, optimized] = GetParam();
  const Text& text = texts()[number];
  std::uint32_t line = 0;
  const Texts found = found_in(text, text.fault, optimized, line);
  EXPECT_EQ(found, Texts{text.rule + ", line " + std::to_string(line)}) << text.fault;
}

TEST_P(CatalogueSpirv, TwinIsSilent) {
  const auto [number, optimized] = GetParam();
  const Text& text = texts()[number];
  std::uint32_t line = 0;
  EXPECT_EQ(found_in(text, text.twin, optimized, line), Texts{}) << text.twin;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueSpirv, testing::ValuesIn(choices()), [](const auto& info) {
  return texts()[std::get<0>(info.param)].name + (std::get<1>(info.param) ? "_optimized" : "");
});

/// Has no fault beside it: the loop takes the condition along with which the check could be made.
TEST(CatalogueSpirvTwins, UnreachableBehindALoopThatReturnsIsSilent) {
  std::uint32_t line = 0;
  EXPECT_EQ(found_in({}, kReturns, false, line), Texts{});
}

TEST(CatalogueSpirvCount, IsNotLess) { EXPECT_GE(texts().size(), 40u); }

}  // namespace
}  // namespace vitrine::glass::test
