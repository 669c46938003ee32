// Operations on constants that the module asks for: what they give is what the instruction gives when it runs.
#include <cstdint>
#include <string>
#include <vector>

#include "base/numeric.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// What one invocation of a module stores: `body` makes %r, a uint, of what is declared and of %n, which is 0.
std::uint32_t run(const std::string& declarations, const std::string& body) {
  ComputeText module;
  module.buffers = {"buffer"};
  module.declarations = declarations;
  module.body = body + store_word("%r", "buffer");
  std::vector<std::uint32_t> values(64);
  dispatch_over(values, assemble(module.text(), SPV_ENV_VULKAN_1_1), options_for(VK_SHADER_STAGE_COMPUTE_BIT), 1);
  return values[0];
}

/// %a and %b, as specialisation constants, and %int.
std::string operands(std::uint32_t a, std::uint32_t b) {
  return "%int = OpTypeInt 32 1\n%a = OpSpecConstant %uint " + std::to_string(a) + "\n%b = OpSpecConstant %uint " +
         std::to_string(b) + "\n";
}

/// The same numbers of which the compiler knows nothing.
constexpr char kLoaded[] = "%xa = OpIAdd %uint %n %a\n%xb = OpIAdd %uint %n %b\n";

constexpr std::uint32_t kNumbers[] = {0, 1, 7, 31, 32, 0x80000000u, 0x7fffffffu, 0xffffffffu, 0xfffffff9u, 0x12345678u};

TEST(SpecConstant, IntegersAreWhatRunsGive) {
  for (const std::string op : {"IAdd", "ISub", "IMul", "UDiv", "SDiv", "UMod", "SRem", "SMod", "ShiftRightLogical",
                               "ShiftRightArithmetic", "ShiftLeftLogical", "BitwiseOr", "BitwiseXor", "BitwiseAnd"}) {
    const bool divides = op.find("Div") != std::string::npos || op.find("Mod") != std::string::npos || op == "SRem";
    const bool shifts = op.starts_with("Shift");
    for (const std::uint32_t a : kNumbers) {
      for (const std::uint32_t b : {1u, 3u, 31u, 0xfffffffbu, 0x40000000u}) {
        if (shifts && b > 31) continue;  // undefined
        if (divides && a == 0x80000000u && b == 0xffffffffu) continue;
        const std::string declared = operands(a, b) + "%k = OpSpecConstantOp %uint " + op + " %a %b\n";
        EXPECT_EQ(run(declared, "%r = OpCopyObject %uint %k\n"),
                  run(declared, kLoaded + ("%r = Op" + op + " %uint %xa %xb\n")))
            << op << ' ' << a << ' ' << b;
      }
    }
  }
}

TEST(SpecConstant, ComparisonsAreWhatRunsGive) {
  for (const std::string op : {"IEqual", "INotEqual", "UGreaterThan", "SGreaterThan", "UGreaterThanEqual",
                               "SGreaterThanEqual", "ULessThan", "SLessThan", "ULessThanEqual", "SLessThanEqual"}) {
    for (const std::uint32_t a : kNumbers) {
      const std::uint32_t b = 31;
      const std::string declared = operands(a, b) + "%k = OpSpecConstantOp %bool " + op +
                                   " %a %b\n%yes = OpConstant %uint 5\n%no = OpConstant %uint 9\n"
                                   "%s = OpSpecConstantOp %uint Select %k %yes %no\n";
      const std::uint32_t expected =
          run(declared, kLoaded + ("%c = Op" + op + " %bool %xa %xb\n%r = OpSelect %uint %c %yes %no\n"));
      EXPECT_EQ(run(declared, "%r = OpCopyObject %uint %s\n"), expected) << op << ' ' << a;
    }
  }
}

TEST(SpecConstant, OperationsOnOneOperand) {
  const auto of = [](const std::string& op, std::uint32_t a) {
    return run(operands(a, 0) + "%k = OpSpecConstantOp %uint " + op + " %a\n", "%r = OpCopyObject %uint %k\n");
  };
  for (const std::uint32_t a : kNumbers) {
    EXPECT_EQ(of("Not", a), ~a);
    EXPECT_EQ(of("SNegate", a), 0 - a);
  }
}

TEST(SpecConstant, BooleansAreFolded) {
  for (const bool a : {false, true}) {
    for (const bool b : {false, true}) {
      const auto of = [&](const std::string& operation) {
        const auto constant = [](const char* name, bool value) {
          return std::string(name) + (value ? " = OpSpecConstantTrue %bool\n" : " = OpSpecConstantFalse %bool\n");
        };
        return run(constant("%a", a) + constant("%b", b) + "%k = OpSpecConstantOp %bool " + operation +
                       "\n%yes = OpConstant %uint 1\n%no = OpConstant %uint 0\n",
                   "%r = OpSelect %uint %k %yes %no\n") != 0;
      };
      EXPECT_EQ(of("LogicalOr %a %b"), a || b);
      EXPECT_EQ(of("LogicalAnd %a %b"), a && b);
      EXPECT_EQ(of("LogicalEqual %a %b"), a == b);
      EXPECT_EQ(of("LogicalNotEqual %a %b"), a != b);
      EXPECT_EQ(of("LogicalNot %a"), !a);
    }
  }
}

/// Binary16 numbers, and zeros of the same sign for what is smaller than the smallest normal one (SPIR-V 1.6,
/// OpQuantizeToF16).
TEST(SpecConstant, FloatsAreQuantized) {
  const auto quantized = [](float value) {
    return base::float_of(run("%float = OpTypeFloat 32\n%a = OpSpecConstant %float " + std::to_string(value) +
                                  "\n%k = OpSpecConstantOp %float QuantizeToF16 %a\n",
                              "%r = OpBitcast %uint %k\n"));
  };
  EXPECT_EQ(quantized(1.0f), 1.0f);
  EXPECT_EQ(quantized(1.00037f), 1.0f);
  EXPECT_EQ(quantized(-2049.0f), -2048.0f);
  EXPECT_EQ(base::bits_of(quantized(-0.000001f)), 0x80000000u);
}

TEST(SpecConstant, PartsOfCompositesAreFolded) {
  const std::string declared =
      operands(5, 6) +
      "%v2 = OpTypeVector %uint 2\n%v3 = OpTypeVector %uint 3\n%ten = OpConstant %uint 10\n"
      "%pair = OpSpecConstantComposite %v2 %a %b\n%twice = OpSpecConstantOp %v2 IAdd %pair %pair\n"
      "%mixed = OpSpecConstantOp %v3 VectorShuffle %twice %pair 3 0 1\n"
      "%put = OpSpecConstantOp %v3 CompositeInsert %ten %mixed 1\n";
  constexpr std::uint32_t kExpected[] = {6, 10, 12};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::string extracted = "%k = OpSpecConstantOp %uint CompositeExtract %put " + std::to_string(i) + "\n";
    EXPECT_EQ(run(declared + extracted, "%r = OpCopyObject %uint %k\n"), kExpected[i]);
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
