// Valid modules of absurd size or shape: each becomes a shader or an error within reasonable time and memory; the stack
// does not grow with the module.
#include <sys/resource.h>

#include <functional>

#include "spirv/front/translate.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// A compute module whose functions are `functions`, and whose entry point runs `body` with %x, the number of the
/// invocation, and %place, its word in a buffer.
Words module_with(const std::string& declarations, const std::string& functions, const std::string& body,
                  const std::string& locals = "", const std::string& capabilities = "") {
  ComputeText module;
  module.capabilities = capabilities;
  module.buffers = {"buffer"};
  module.declarations = "%u7 = OpConstant %uint 7\n%unary = OpTypeFunction %uint %uint\n" + declarations;
  module.locals = locals;
  module.body = "%x = OpCopyObject %uint %n\n%place = OpAccessChain %uint_ptr %buffer %u0 %x\n" + body;
  module.functions = functions;
  return assemble(module.text());
}

std::string store(const std::string& id) { return "OpStore %place " + id + "\n"; }

/// Whether the module compiles; an error says why.
bool compiles(const Words& words) {
  const CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  const auto shader = compile(words, options);
  if (!shader) {
    EXPECT_NE(shader.message(), "");
  }
  return shader.ok();
}

std::string repeated(std::size_t count, const std::function<std::string(std::size_t)>& text) {
  std::string all;
  for (std::size_t i = 0; i < count; i++) all += text(i);
  return all;
}

std::string number(std::size_t i) { return std::to_string(i); }

TEST(AbsurdModule, RecursionIsRefused) {
  const std::string f =
      "%f = OpFunction %uint None %unary\n%p = OpFunctionParameter %uint\n%fe = OpLabel\n"
      "%again = OpFunctionCall %uint %g %p\nOpReturnValue %again\nOpFunctionEnd\n"
      "%g = OpFunction %uint None %unary\n%q = OpFunctionParameter %uint\n%ge = OpLabel\n"
      "%more = OpFunctionCall %uint %f %q\nOpReturnValue %more\nOpFunctionEnd\n";
  const Words words = module_with("", f, "%r = OpFunctionCall %uint %f %x\n" + store("%r"));
  EXPECT_FALSE(compiles(words));
}

TEST(AbsurdModule, ValueOfTheWayOutThatALoopLoses) {
  // Valid: %sum is made on the only way out, whose condition is never true. Nothing behind the loop runs.
  const std::string loop =
      "OpBranch %head\n%head = OpLabel\n%turn = OpPhi %uint %x %entry %more %next\nOpLoopMerge %end %next None\n"
      "OpBranch %inner\n%inner = OpLabel\n%more = OpGroupNonUniformBroadcastFirst %uint %u3 %turn\n"
      "%never = OpULessThan %bool %more %more\nOpSelectionMerge %stay None\n"
      "OpBranchConditional %never %leave %stay\n%leave = OpLabel\n"
      "%all = OpGroupNonUniformIAdd %uint %u3 Reduce %x\n%sum = OpIAdd %uint %more %all\nOpBranch %end\n"
      "%stay = OpLabel\nOpBranch %next\n%next = OpLabel\nOpBranch %head\n"
      "%end = OpLabel\n%large = OpUGreaterThan %bool %all %u7\n%r = OpSelect %uint %large %sum %u7\n";
  EXPECT_TRUE(compiles(module_with("%u3 = OpConstant %uint 3\n", "", loop + store("%r"), "",
                                   "OpCapability GroupNonUniformArithmetic\nOpCapability GroupNonUniformBallot\n")));
}

/// Peak memory of the process, in KiB.
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(AbsurdModule, ArraysOfAThousandElementsThroughBranches) {
  std::string source =
      "layout(set = 0, binding = 0) buffer B { float v[]; }; void main() { uint n = gl_GlobalInvocationID.x;\n";
  for (std::size_t i = 0; i < 4; i++)
    source += "float a" + number(i) + "[1000]; for (int j = 0; j < 4; j++) a" + number(i) + "[j] = v[j + " + number(i) +
              "];\n";
  source += repeated(10, [](std::size_t i) {
    return "if (v[" + number(i) + "] > 0.5) a" + number(i % 4) + " = a" + number((i + 1) % 4) + ";\n";
  });
  source += "for (int j = 0; j < 4; j++) v[n + j] = a0[j] + a1[j] + a2[j] + a3[j]; }";
  const long before = peak_memory();
  EXPECT_TRUE(compiles(compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, source.c_str())));
  EXPECT_LT(peak_memory() - before, 300000);
}

TEST(AbsurdModule, PointersAreNoPartsOfVectors) {
  const std::string declarations =
      "%float = OpTypeFloat 32\n%v3float = OpTypeVector %float 3\n%f1 = OpConstant %float 1\n";
  const std::string vector =
      "%v = OpCompositeConstruct %v3float %place %f1 %f1\n%e = OpCompositeExtract %float %v 0\n"
      "%r = OpBitcast %uint %e\n";
  EXPECT_FALSE(compiles(module_with(declarations, "", vector + store("%r"))));
}

TEST(AbsurdModule, StraightLineOfAHundredThousandInstructions) {
  std::string body = "%a0 = OpIAdd %uint %x %u7\n";
  body += repeated(100000, [](std::size_t i) {
    return "%a" + number(i + 1) +
           (i % 3 == 0   ? " = OpIMul"
            : i % 3 == 1 ? " = OpIAdd"
                         : " = OpBitwiseXor") +
           " %uint %a" + number(i) + " %x\n";
  });
  EXPECT_TRUE(compiles(module_with("", "", body + store("%a100000"))));
}

/// A function that calls the next, each from one place.
TEST(AbsurdModule, LongChainOfCalls) {
  const auto chain = [](std::size_t length) {
    const std::string functions = repeated(length, [&](std::size_t i) {
      const std::string n = number(i);
      const std::string result = i + 1 < length ? "%r" + n + " = OpFunctionCall %uint %f" + number(i + 1) + " %p" + n
                                                : "%r" + n + " = OpIAdd %uint %p" + n + " %u7";
      return "%f" + n + " = OpFunction %uint None %unary\n%p" + n + " = OpFunctionParameter %uint\n%e" + n +
             " = OpLabel\n" + result + "\nOpReturnValue %r" + n + "\nOpFunctionEnd\n";
    });
    return module_with("", functions, "%r = OpFunctionCall %uint %f0 %x\n" + store("%r"));
  };
  EXPECT_TRUE(compiles(chain(40)));
  compiles(chain(5000));
}

/// Every function calls the next one twice: 2^40 calls.
TEST(AbsurdModule, CallsThatMultiply) {
  const std::string functions = repeated(40, [&](std::size_t i) {
    const std::string n = number(i), to = i < 39 ? "%f" + number(i + 1) : "%leaf";
    return "%f" + n + " = OpFunction %uint None %unary\n%p" + n + " = OpFunctionParameter %uint\n%e" + n +
           " = OpLabel\n%a" + n + " = OpFunctionCall %uint " + to + " %p" + n + "\n%b" + n +
           " = OpFunctionCall %uint " + to + " %a" + n + "\nOpReturnValue %b" + n + "\nOpFunctionEnd\n";
  });
  const std::string leaf =
      "%leaf = OpFunction %uint None %unary\n%pl = OpFunctionParameter %uint\n%el = OpLabel\n"
      "%rl = OpIMul %uint %pl %u7\nOpReturnValue %rl\nOpFunctionEnd\n";
  EXPECT_FALSE(compiles(module_with("", functions + leaf, "%r = OpFunctionCall %uint %f0 %x\n" + store("%r"))));
}

TEST(AbsurdModule, ThousandsOfFunctions) {
  const std::string functions = repeated(5000, [&](std::size_t i) {
    const std::string n = number(i);
    return "%f" + n + " = OpFunction %uint None %unary\n%p" + n + " = OpFunctionParameter %uint\n%e" + n +
           " = OpLabel\n%r" + n + " = OpIAdd %uint %p" + n + " %u7\nOpReturnValue %r" + n + "\nOpFunctionEnd\n";
  });
  const std::string calls = repeated(5000, [](std::size_t i) {
    return "%s" + number(i) + " = OpFunctionCall %uint %f" + number(i) + " " +
           (i == 0 ? std::string("%x") : "%s" + number(i - 1)) + "\n";
  });
  EXPECT_TRUE(compiles(module_with("", functions, calls + store("%s4999"))));
}

Words nested_ifs(std::size_t depth) {
  const std::string open = repeated(depth, [](std::size_t i) {
    const std::string n = number(i);
    return "%bit" + n + " = OpShiftRightLogical %uint %x %u1\n%c" + n + " = OpIEqual %bool %bit" + n +
           " %u7\nOpSelectionMerge %m" + n + " None\nOpBranchConditional %c" + n + " %t" + n + " %m" + n + "\n%t" + n +
           " = OpLabel\n";
  });
  const std::string close = repeated(depth, [&](std::size_t i) {
    const std::string n = number(depth - 1 - i);
    return store("%x") + "OpBranch %m" + n + "\n%m" + n + " = OpLabel\n";
  });
  return module_with("", "", open + close);
}

TEST(AbsurdModule, DeepNestingOfSelections) {
  EXPECT_TRUE(compiles(nested_ifs(60)));
  compiles(nested_ifs(3000));
}

Words nested_loops(std::size_t depth) {
  const std::string open = repeated(depth, [](std::size_t i) {
    const std::string n = number(i), from = i == 0 ? "%entry" : "%b" + number(i - 1);
    return "OpBranch %h" + n + "\n%h" + n + " = OpLabel\n%i" + n + " = OpPhi %uint %u0 " + from + " %n" + n + " %k" +
           n + "\nOpLoopMerge %m" + n + " %k" + n + " None\nOpBranch %t" + n + "\n%t" + n + " = OpLabel\n%c" + n +
           " = OpULessThan %bool %i" + n + " %x\nOpBranchConditional %c" + n + " %b" + n + " %m" + n + "\n%b" + n +
           " = OpLabel\n";
  });
  const std::string close = repeated(depth, [&](std::size_t i) {
    const std::string n = number(depth - 1 - i);
    return store("%x") + "OpBranch %k" + n + "\n%k" + n + " = OpLabel\n%n" + n + " = OpIAdd %uint %i" + n +
           " %u1\nOpBranch %h" + n + "\n%m" + n + " = OpLabel\n";
  });
  return module_with("", "", open + close);
}

TEST(AbsurdModule, DeepNestingOfLoops) {
  EXPECT_TRUE(compiles(nested_loops(20)));
  compiles(nested_loops(1000));
}

/// Constant trip counts that nobody should unroll.
TEST(AbsurdModule, LoopsWithHugeConstantTripCounts) {
  for (const char* bound : {"100", "100000", "0xffffffffu", "2000000000"})
    EXPECT_TRUE(compiles(compile_glsl(
        VK_SHADER_STAGE_COMPUTE_BIT,
        std::string("layout(local_size_x = 64) in;\nlayout(set = 0, binding = 0) buffer B { uint v[]; };\nvoid main() "
                    "{\n  uint s = v[0];\n  for (uint i = 0u; i < uint(") +
            bound + "); i++) for (uint j = 0u; j < uint(" + bound + "); j++) s = s * 3u + i * j;\n  v[1] = s;\n}")));
}

TEST(AbsurdModule, SwitchOfManyCases) {
  constexpr std::size_t kCases = 2000;
  std::string body = "OpSelectionMerge %done None\nOpSwitch %x %done";
  body += repeated(kCases, [](std::size_t i) { return std::string(" ") + number(i) + " %k" + number(i); }) + "\n";
  body += repeated(kCases, [](std::size_t i) {
    const std::string n = number(i);
    return "%k" + n + " = OpLabel\n%w" + n + " = OpIMul %uint %x %u7\n" + store("%w" + n) + "OpBranch %done\n";
  });
  compiles(module_with("", "", body + "%done = OpLabel\n"));
}

TEST(AbsurdModule, HugeVariables) {
  for (const char* storage : {"Private", "Workgroup", "Function"})
    for (const char* length : {"4194304", "1073741824", "4294967295"}) {
      const std::string declarations = std::string("%length = OpConstant %uint ") + length +
                                       "\n%big = OpTypeArray %uint %length\n%big_ptr = OpTypePointer " + storage +
                                       " %big\n%part_ptr = OpTypePointer " + storage + " %uint\n";
      const std::string variable = std::string("%v = OpVariable %big_ptr ") + storage + "\n";
      const bool local = std::string(storage) == "Function";
      const std::string body =
          "%at = OpAccessChain %part_ptr %v %x\nOpStore %at %x\n%r = OpLoad %uint %at\n" + store("%r");
      EXPECT_FALSE(compiles(module_with(declarations + (local ? "" : variable), "", body, local ? variable : "")))
          << storage << length;
    }
}

TEST(AbsurdModule, HugeConstants) {
  for (const char* length : {"1048576", "4294967295"})
    EXPECT_FALSE(compiles(module_with(std::string("%length = OpConstant %uint ") + length +
                                          "\n%big = OpTypeArray %uint %length\n%outer = OpTypeArray %big %length\n"
                                          "%null = OpConstantNull %outer\n",
                                      "", store("%x"))));
}

TEST(AbsurdModule, DeepNestingOfTypes) {
  const std::string types = "%s0 = OpTypeStruct %uint\n" + repeated(1000, [](std::size_t i) {
                              return "%s" + number(i + 1) + " = OpTypeStruct %s" + number(i) + "\n";
                            });
  EXPECT_FALSE(compiles(module_with(types, "", store("%x"))));
}

/// Arrays of arrays whose elements are few but whose copies are many.
TEST(AbsurdModule, CopiesOfLargeArrays) {
  const std::string declarations =
      "%length = OpConstant %uint 4096\n%big = OpTypeArray %uint %length\n%big_ptr = OpTypePointer Function %big\n"
      "%part_ptr = OpTypePointer Function %uint\n";
  const std::string copies = repeated(
      200, [](std::size_t i) { return "%l" + number(i) + " = OpLoad %big %v\nOpStore %w %l" + number(i) + "\n"; });
  compiles(module_with(declarations, "",
                       copies + "%at = OpAccessChain %part_ptr %w %x\n%r = OpLoad %uint %at\n" + store("%r"),
                       "%v = OpVariable %big_ptr Function\n%w = OpVariable %big_ptr Function\n"));
}

TEST(AbsurdModule, ManyVariablesAndPhis) {
  std::string body =
      "%flag = OpINotEqual %bool %u0 %u1\n"
      "%odd = OpIEqual %bool %x %u7\nOpSelectionMerge %m None\nOpBranchConditional %odd %t %m\n"
      "%t = OpLabel\nOpBranch %m\n%m = OpLabel\n";
  body += repeated(20000, [](std::size_t i) { return "%p" + number(i) + " = OpPhi %uint %u7 %entry %x %t\n"; });
  body += "%q0 = OpIAdd %uint %p0 %x\n";
  body += repeated(19999, [](std::size_t i) {
    return "%q" + number(i + 1) + " = OpIAdd %uint %q" + number(i) + " %p" + number(i + 1) + "\n";
  });
  EXPECT_TRUE(compiles(module_with("", "", body + store("%q19999"))));
}

/// Locations are counted where somebody asks for them.
TEST(AbsurdModule, HugeInterface) {
  const auto module = [](const std::string& storage, const std::string& length, const std::string& decorations,
                         const std::string& body = "") {
    return assemble(
        "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\" %v\n"
        "OpExecutionMode %main OriginUpperLeft\nOpDecorate %v Location 0\n" +
        decorations +
        "%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%float = OpTypeFloat 32\n%vec2 = OpTypeVector %float 2\n"
        "%uint = OpTypeInt 32 0\n%length = OpConstant %uint " +
        length + "\n%array = OpTypeArray %vec2 %length\n%outer = OpTypeArray %array %length\n%ptr = OpTypePointer " +
        storage + " %outer\n%v = OpVariable %ptr " + storage + "\n%main = OpFunction %void None %fn\n%l = OpLabel\n" +
        body + "OpReturn\nOpFunctionEnd\n");
  };
  CompileOptions options = options_for(VK_SHADER_STAGE_FRAGMENT_BIT);
  for (const char* length : {"20000", "4294967295"}) {
    const long before = peak_memory();
    EXPECT_TRUE(compile(module("Input", length, "OpDecorate %v Flat\n"), options).ok());
    EXPECT_FALSE(compile(module("Input", length, "OpDecorate %v Flat\n", "%all = OpLoad %outer %v\n"), options).ok());
    EXPECT_FALSE(compile(module("Output", length, "", "%all = OpLoad %outer %v\n"), options).ok());
    EXPECT_LT(peak_memory() - before, 100 << 10) << length;
  }
  const auto small = compile(module("Output", "2", ""), options);
  EXPECT_TRUE(small.ok()) << small.message();
}

/// What a negated product reads is followed as far as it goes, but not down any chain.
TEST(AbsurdModule, LongChainInANegatedProduct) {
  const std::string declarations = "%float = OpTypeFloat 32\n%one = OpConstant %float 1\n";
  std::string body = "%f = OpConvertUToF %float %x\n%q0 = OpFDiv %float %one %f\n";
  body += repeated(200000,
                   [](std::size_t i) { return "%q" + number(i + 1) + " = OpFDiv %float %f %q" + number(i) + "\n"; });
  body +=
      "%less = OpFOrdLessThan %bool %f %one\n%either = OpSelect %float %less %one %f\n"
      "%product = OpFMul %float %either %q200000\n%negative = OpFNegate %float %product\n"
      "%bits = OpBitcast %uint %negative\n";
  EXPECT_TRUE(compiles(module_with(declarations, "", body + store("%bits"))));
}

/// Each asks when its operands are ready; none walks the whole shader for that.
TEST(AbsurdModule, ManyNegatedProducts) {
  const std::string declarations = "%float = OpTypeFloat 32\n%one = OpConstant %float 1\n";
  std::string body =
      "%f = OpConvertUToF %float %x\n%less = OpFOrdLessThan %bool %one %f\n%g = OpFDiv %float %one %f\n"
      "%q0 = OpFDiv %float %g %f\n";
  body += repeated(30000, [](std::size_t i) {
    return "%e" + number(i) + " = OpSelect %float %less %one %q" + number(i) + "\n%p" + number(i) +
           " = OpFMul %float %e" + number(i) + " %g\n%n" + number(i) + " = OpFNegate %float %p" + number(i) + "\n%q" +
           number(i + 1) + " = OpFDiv %float %n" + number(i) + " %g\n";
  });
  body += "%bits = OpBitcast %uint %q30000\n";
  EXPECT_TRUE(compiles(module_with(declarations, "", body + store("%bits"))));
}

}  // namespace
}  // namespace vitrine::spirv::test
