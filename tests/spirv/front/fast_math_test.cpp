// SPV_KHR_float_controls2: what FPFastMathMode and FPFastMathDefault do not allow is not done to numbers.
#include <cmath>
#include <limits>

#include "base/numeric.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Of each lane: what the body makes of %a.
const std::vector<float> kGiven = {0.0f,       -0.0f,  1.5f,      -2.25f,     3e38f,      -3e38f,   kInfinity,
                                   -kInfinity, 1e-30f, -7.75e20f, 0.3333333f, -123456.7f, 65504.0f, std::nanf("")};

/// What a module says: of all numbers, and of the instructions %f1 to %f3. A negative mode is not said.
struct Saying {
  int default_mode = -1;
  const char* default_type = "%float";
  int decorated = -1;
};

/// The module's answer, as floats. `body` makes %f3 from %a by %f1 and %f2.
std::vector<float> run_saying(const Saying& saying, const std::string& body) {
  ComputeText module;
  module.capabilities =
      "OpCapability Float16\nOpCapability Float64\nOpCapability Int64\nOpCapability !6029\n"
      "OpExtension \"SPV_KHR_float_controls2\"\n%glsl = OpExtInstImport \"GLSL.std.450\"\n";
  if (saying.default_mode >= 0)
    module.annotations = std::string("OpExecutionModeId %main !6028 ") + saying.default_type + " %mode\n";
  if (saying.decorated >= 0)
    for (const char* id : {"%f1", "%f2", "%f3"})
      module.annotations +=
          std::string("OpDecorate ") + id + " FPFastMathMode !" + std::to_string(saying.decorated) + "\n";
  module.buffers = {"buffer"};
  module.declarations =
      "%float = OpTypeFloat 32\n%half = OpTypeFloat 16\n%double = OpTypeFloat 64\n%int = OpTypeInt 32 1\n"
      "%float2 = OpTypeVector %float 2\n%parts = OpTypeStruct %float %float\n%zero = OpConstant %float 0\n%two = "
      "OpConstant %float 2\n"
      "%tenth = OpConstant %float 0.1\n%large = OpConstant %float 1e10\n%zero16 = OpConstant %half 0\n"
      "%zero64 = OpConstant %double 0\n%long = OpTypeInt 64 1\n%mode = OpConstant %uint " +
      std::to_string(std::max(0, saying.default_mode)) + "\n";
  module.body = load_word("%word", "buffer") + "%a = OpBitcast %float %word\n" + body + "%r = OpBitcast %uint %f3\n" +
                store_word("%r", "buffer");
  std::vector<std::uint32_t> words(64);
  for (std::size_t i = 0; i < kGiven.size(); i++) words[i] = base::bits_of(kGiven[i]);
  dispatch_over(words, assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT), 1);
  std::vector<float> got;
  for (std::size_t i = 0; i < kGiven.size(); i++) got.push_back(base::float_of(words[i]));
  return got;
}

constexpr int kOrdinaryNumbers = 7, kContract = 0x10000, kReassoc = 0x20000, kTransform = 0x40000;
constexpr int kAnything = kOrdinaryNumbers | 8 | kContract | kReassoc | kTransform;

/// Equal, zeros by their sign, NaN as one.
bool same(float a, float b) { return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b); }

template <class F>
std::size_t count_different(const std::vector<float>& got, const F& f) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < kGiven.size(); i++) different += !same(got[i], f(kGiven[i]));
  return different;
}

struct Row {
  const char* body;
  float (*f)(float);
};

/// What rewrites, or the shortcuts of literal zeros, make something else of.
constexpr Row kSpecials[] = {
    {"%f1 = OpFAdd %float %a %zero\n%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return a + 0.0f; }},
    {"%f1 = OpFMul %float %zero %a\n%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return 0.0f * a; }},
    {"%f1 = OpFSub %float %a %a\n%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return a - a; }},
    {"%f1 = OpFDiv %float %zero %a\n%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return 0.0f / a; }},
    {"%f1 = OpFDiv %float %a %zero\n%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return a / 0.0f; }},
    {"%f1 = OpFSub %float %zero %a\n%f2 = OpFNegate %float %f1\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return -(0.0f - a); }},
};

/// What becomes another number where it is reassociated, contracted or transformed.
constexpr Row kRearranged[] = {
    {"%f1 = OpFMul %float %a %two\n%f2 = OpFMul %float %f1 %tenth\n%f3 = OpCopyObject %float %f2\n",
     [](float a) { return a * 2.0f * 0.1f; }},
    {"%f1 = OpFAdd %float %a %large\n%f2 = OpFNegate %float %large\n%f3 = OpFAdd %float %f1 %f2\n",
     [](float a) { return (a + 1e10f) - 1e10f; }},
    {"%b = OpFAdd %float %a %tenth\n%f1 = OpFMul %float %a %tenth\n%f2 = OpFMul %float %a %b\n"
     "%f3 = OpFAdd %float %f1 %f2\n",
     [](float a) { return a * 0.1f + a * (a + 0.1f); }},
};

TEST(FloatControls2, SpecialNumbersStayWhereTheModuleKeepsThem) {
  const int strict[] = {0, kOrdinaryNumbers & ~1, kOrdinaryNumbers & ~2, kOrdinaryNumbers & ~4, kAnything & ~7};
  for (const Row& row : kSpecials) {
    for (const int mode : strict) {
      EXPECT_EQ(count_different(run_saying({.default_mode = mode}, row.body), row.f), 0u) << mode << "\n" << row.body;
      EXPECT_EQ(count_different(run_saying({.decorated = mode}, row.body), row.f), 0u) << mode << "\n" << row.body;
      EXPECT_EQ(count_different(run_saying({.default_mode = kAnything, .decorated = mode}, row.body), row.f), 0u);
    }
    // Types without a default have no leave for anything.
    EXPECT_EQ(count_different(run_saying({.default_mode = kAnything, .default_type = "%half"}, row.body), row.f), 0u);
    EXPECT_NE(count_different(run_saying({}, row.body), row.f), 0u) << row.body;
    EXPECT_NE(count_different(run_saying({.default_mode = kAnything}, row.body), row.f), 0u) << row.body;
  }
}

TEST(FloatControls2, NothingIsRearrangedWithoutLeave) {
  for (const Row& row : kRearranged) {
    for (const int mode : {kOrdinaryNumbers, kOrdinaryNumbers | kContract, kOrdinaryNumbers | kReassoc, 0}) {
      EXPECT_EQ(count_different(run_saying({.default_mode = mode}, row.body), row.f), 0u) << mode << "\n" << row.body;
      EXPECT_EQ(count_different(run_saying({.decorated = mode}, row.body), row.f), 0u) << mode << "\n" << row.body;
    }
    EXPECT_NE(count_different(run_saying({}, row.body), row.f), 0u) << row.body;
    EXPECT_NE(count_different(run_saying({.default_mode = kOrdinaryNumbers, .decorated = kAnything}, row.body), row.f),
              0u)
        << row.body;
  }
}

TEST(FloatControls2, NumbersOfOtherWidthsKeepTheirZeros) {
  const auto minus_zero = [](const Saying& saying, const char* type, const char* zero) {
    const std::string body = std::string("%given = OpFConvert ") + type + " %a\n%f1 = OpFAdd " + type + " %given " +
                             zero + "\n%f2 = OpCopyObject " + type + " %f1\n%f3 = OpFConvert %float %f2\n";
    return run_saying(saying, body)[1];
  };
  for (const auto& [type, zero] : {std::pair("%half", "%zero16"), std::pair("%double", "%zero64")}) {
    EXPECT_FALSE(std::signbit(minus_zero({.default_mode = 0, .default_type = type}, type, zero))) << type;
    EXPECT_FALSE(std::signbit(minus_zero({.decorated = 0}, type, zero))) << type;
    EXPECT_FALSE(std::signbit(minus_zero({.default_mode = kAnything}, type, zero))) << type;
    EXPECT_TRUE(std::signbit(minus_zero({.default_mode = kAnything, .default_type = type}, type, zero))) << type;
  }
}

/// -0 is less than +0 where the sign of zero counts; both parts of a number have its sign; what is made of a NaN is
/// one.
TEST(FloatControls2, SignsOfZeroAndNansPassThroughFunctions) {
  const std::string copies = "%f2 = OpCopyObject %float %f1\n%f3 = OpCopyObject %float %f2\n";
  const auto of_both = [&](const std::string& function) {
    return "%negated = OpFNegate %float %a\n%f1 = OpExtInst %float %glsl " + function + " %a %negated\n" + copies;
  };
  const auto part = [](const std::string& number) {
    return "%f1 = OpExtInst %parts %glsl ModfStruct %a\n%f2 = OpCompositeExtract %float %f1 " + number +
           "\n%f3 = OpCopyObject %float %f2\n";
  };
  const auto fraction = [](float a) { return std::isinf(a) ? std::copysign(0.0f, a) : a - std::trunc(a); };
  for (const int mode : {0, kOrdinaryNumbers & ~4, kAnything & ~7})
    for (const Saying& saying : {Saying{.default_mode = mode}, Saying{.decorated = mode}}) {
      for (const char* function : {"FMin", "NMin"})
        EXPECT_EQ(count_different(run_saying(saying, of_both(function)), [](float a) { return -std::fabs(a); }), 0u);
      for (const char* function : {"FMax", "NMax"})
        EXPECT_EQ(count_different(run_saying(saying, of_both(function)), [](float a) { return std::fabs(a); }), 0u);
      EXPECT_EQ(count_different(run_saying(saying, part("0")), [&](float a) { return std::copysign(fraction(a), a); }),
                0u);
      EXPECT_EQ(count_different(run_saying(saying, part("1")), [](float a) { return std::trunc(a); }), 0u);
      const std::string power = "%f1 = OpExtInst %float %glsl Pow %a %tenth\n" + copies;
      EXPECT_TRUE(std::isnan(run_saying(saying, power).back())) << mode;
    }
}

/// A conversion there and back is no truncation, which would keep the sign of zero.
TEST(FloatControls2, ConversionsThereAndBackStay) {
  const std::string body =
      "%given = OpFConvert %double %tenth\n%m = OpFNegate %double %given\n%w = OpFConvert %double %a\n"
      "%p = OpFMul %double %w %zero64\n%q = OpFAdd %double %m %p\n%i = OpConvertFToS %long %q\n"
      "%f1 = OpConvertSToF %double %i\n%f2 = OpCopyObject %double %f1\n%f3 = OpFConvert %float %f2\n";
  EXPECT_FALSE(std::signbit(run_saying({.default_mode = 0, .default_type = "%double"}, body)[2]));
  EXPECT_FALSE(std::signbit(run_saying({.decorated = kOrdinaryNumbers}, body)[2]));
}

/// "All core instructions which use any floating-point type for either operands or result", and GLSL's.
TEST(FloatControls2, EveryInstructionMayBeDecorated) {
  const std::string body = R"(
%d1 = OpFOrdLessThan %bool %a %two
%d2 = OpSelect %float %d1 %a %two
%d3 = OpCompositeConstruct %float2 %d2 %a
%d4 = OpDot %float %d3 %d3
%d5 = OpVectorTimesScalar %float2 %d3 %d4
%d6 = OpCompositeExtract %float %d5 1
%d7 = OpExtInst %float %glsl Sqrt %d6
%d8 = OpConvertFToS %int %d7
%d9 = OpConvertSToF %float %d8
OpSelectionMerge %joined None
OpBranchConditional %d1 %other %joined
%other = OpLabel
%d10 = OpExtInst %float %glsl FMix %d9 %a %tenth
OpBranch %joined
%joined = OpLabel
%d11 = OpPhi %float %d9 %entry %d10 %other
%d12 = OpIsNan %bool %d11
%d13 = OpQuantizeToF16 %float %d11
%f1 = OpExtInst %float %glsl FMin %d11 %d13
%f2 = OpFRem %float %f1 %two
%f3 = OpFMod %float %f2 %two
)";
  ComputeText module;
  module.capabilities =
      "OpCapability !6029\nOpExtension \"SPV_KHR_float_controls2\"\n%glsl = OpExtInstImport \"GLSL.std.450\"\n";
  for (int i = 1; i <= 13; i++)
    module.annotations +=
        "OpDecorate %d" + std::to_string(i) + " FPFastMathMode !" + std::to_string(i % 2 * kAnything) + "\n";
  module.buffers = {"buffer"};
  module.declarations =
      "%float = OpTypeFloat 32\n%int = OpTypeInt 32 1\n%float2 = OpTypeVector %float 2\n"
      "%two = OpConstant %float 2\n%tenth = OpConstant %float 0.1\n";
  module.body = load_word("%word", "buffer") + "%a = OpBitcast %float %word\n" + body + "%r = OpBitcast %uint %f3\n" +
                store_word("%r", "buffer");
  std::vector<std::uint32_t> words(64, base::bits_of(1.5f));
  EXPECT_TRUE(dispatch_over(words, assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT), 1));
}

TEST(FloatControls2, ADefaultIsOfAFloatingPointType) {
  ComputeText module;
  module.capabilities = "OpCapability !6029\n";
  module.annotations = "OpExecutionModeId %main !6028 %uint %u0\n";
  module.buffers = {"buffer"};
  const auto shader = compile(assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  EXPECT_FALSE(shader);
  EXPECT_NE(shader.message().find("floating-point"), std::string::npos) << shader.message();
}

}  // namespace
}  // namespace vitrine::spirv::test
