// GLSL through the whole pipeline, run as compute and compared with the same text compiled as C++.
#include <cstring>

#include "base/numeric.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/front/glsl.h"

// Falling through is what the switch tests are about, and the text is GLSL, which knows no attribute for it.
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"

namespace vitrine::spirv::test {
namespace {

using uint = std::uint32_t;

constexpr uint kCount = 256;

/// Runs `uint f(uint x)` for x = 0 .. kCount - 1.
std::vector<uint> run_glsl(const std::string& function) {
  const std::string source =
      "layout(local_size_x = 64) in;\n"
      "layout(set = 0, binding = 0) buffer B { uint v[]; } b;\n" +
      function + "\nvoid main() { uint i = gl_GlobalInvocationID.x; b.v[i] = f(b.v[i]); }";
  std::vector<uint> values(kCount);
  for (uint i = 0; i < kCount; i++) values[i] = i;
  dispatch_over(values, compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, source), options_for(VK_SHADER_STAGE_COMPUTE_BIT),
                kCount / 64);
  return values;
}

template <class F>
void expect_same(const char* glsl, const F& f) {
  const std::vector<uint> got = run_glsl(glsl);
  for (uint x = 0; x < kCount; x++) ASSERT_EQ(got[x], f(x)) << "x = " << x << "\n" << glsl;
}

/// The same function as GLSL text and as C++.
#define EXPECT_SAME(...)                                           \
  do {                                                             \
    struct Twin {                                                  \
      __VA_ARGS__                                                  \
    };                                                             \
    expect_same(#__VA_ARGS__, [](uint x) { return Twin().f(x); }); \
  } while (false)

TEST(RunGlsl, IfElseChains) {
  EXPECT_SAME(uint f(uint x) {
    uint y = 0u;
    if (x < 10u)
      y = 1u;
    else if (x < 100u) {
      y = x * 3u;
      if ((x & 1u) == 0u) y += 7u;
    } else
      y = x - 50u;
    return y;
  });
}

TEST(RunGlsl, EarlyReturns) {
  EXPECT_SAME(
      uint g(uint x) {
        if (x == 3u) return 33u;
        if (x > 200u) {
          if (x < 220u) return 5u;
          x += 1u;
        }
        return x;
      } uint f(uint x) {
        uint a = g(x);
        if (a == 5u) return 1000u;
        return a + g(x / 2u);
      });
}

TEST(RunGlsl, LoopsWithBreakAndContinue) {
  EXPECT_SAME(uint f(uint x) {
    uint s = 0u;
    for (uint i = 0u; i < x; i++) {
      if (i % 3u == 0u) continue;
      if (s > 5000u) break;
      s += i * i;
    }
    return s;
  });
}

TEST(RunGlsl, DoWhileAndNestedLoops) {
  EXPECT_SAME(uint f(uint x) {
    uint s = 0u, n = x;
    do {
      for (uint j = 0u; j < 4u; j++) {
        if (j == (n & 3u)) break;
        s = s * 5u + j;
      }
      n = n / 2u;
    } while (n != 0u);
    return s;
  });
}

TEST(RunGlsl, ReturnFromNestedLoops) {
  EXPECT_SAME(
      uint g(uint x) {
        for (uint i = 1u; i < 20u; i++)
          for (uint j = i; j < 20u; j++) {
            if (i * j == x) return i * 100u + j;
            if (i * j > x) break;
          }
        return 0u;
      } uint f(uint x) {
        uint total = 0u;
        for (uint k = 0u; k < 3u; k++) {
          uint found = g(x + k);
          if (found == 0u) continue;
          total += found;
        }
        return total;
      });
}

TEST(RunGlsl, SwitchWithFallThrough) {
  EXPECT_SAME(uint f(uint x) {
    uint y = 1u;
    switch (x % 9u) {
      case 0u:
        y += 10u;
        break;
      case 1u:
        y += 20u;
      case 2u:
        y *= 3u;
        if (x > 100u) break;
        y += 1u;
      case 5u:
        y += 7u;
        break;
      case 3u:
      case 4u:
        return y + 1000u;
      default:
        y = x;
      case 7u:
        y ^= 0x55u;
    }
    return y * 2u;
  });
}

TEST(RunGlsl, SwitchInsideLoop) {
  EXPECT_SAME(uint f(uint x) {
    uint state = 0u, n = x;
    for (int i = 0; i < 40; i++) {
      switch (state) {
        case 0u:
          if ((n & 1u) != 0u)
            state = 1u;
          else
            state = 2u;
          break;
        case 1u:
          n = n * 3u + 1u;
          state = 0u;
          continue;
        case 2u:
          n /= 2u;
          if (n <= 1u) return uint(i);
          state = 0u;
          break;
      }
      n += 0u;
    }
    return n;
  });
}

TEST(RunGlsl, ValuesOfLoopsUsedAfterThem) {
  EXPECT_SAME(uint f(uint x) {
    uint a = 1u, b = 1u, i = 0u;
    while (true) {
      uint t = a + b;
      a = b;
      b = t;
      i++;
      if (b > x) break;
    }
    return a * 1000u + i;
  });
}

TEST(RunGlsl, LocalArrays) {
  EXPECT_SAME(uint f(uint x) {
    uint a[8];
    for (uint i = 0u; i < 8u; i++) a[i] = x * (i + 1u);
    a[x % 8u] = 5u;
    uint s = 0u;
    for (uint i = 0u; i < 8u; i++) s = s * 3u + a[7u - i];
    return s;
  });
}

TEST(RunGlsl, TablesOfConstants) {
  EXPECT_SAME(uint f(uint x) {
    const uint few[3] = {7u, 11u, 13u};
    const uint many[20] = {2u,  3u,  5u,  7u,  11u, 13u, 17u, 19u, 23u, 29u,
                           31u, 37u, 41u, 43u, 47u, 53u, 59u, 61u, 67u, 71u};
    uint s = few[x % 3u] * many[x % 20u];
    for (uint i = 0u; i < x % 20u; i++) s = s * 5u + many[19u - i] + few[i % 3u];
    return s;
  });
}

TEST(RunGlsl, SignedArithmeticAndShifts) {
  EXPECT_SAME(uint f(uint x) {
    int a = int(x) - 128;
    int b = (a >> 2) * 7 + (a << 3);
    if (a < -100) b = -b;
    b ^= a;
    return uint(b) + (x >> 3u);
  });
}

TEST(RunGlsl, InoutParametersStructsAndMatrices) {
  const std::vector<uint> got = run_glsl(R"(
    struct S { uint a; mat2x3 m; float t[2]; };
    void touch(inout S s, out uint extra, float k) { s.a += 2u; s.m[1].z = k; s.t[1] += k; extra = s.a * 2u; }
    uint f(uint x) {
      S s = S(x, mat2x3(1.0), float[2](3.0, 4.0)); uint e;
      for (int i = 0; i < 2; i++) touch(s, e, float(x));
      S copy = s; copy.t = float[2](0.0, s.t[1]);
      return s.a + e + uint(copy.t[1]) + uint(s.m[1].z) + uint(s.m[0].x + s.m[1].y + copy.t[0]); })");
  for (uint x = 0; x < kCount; x++) ASSERT_EQ(got[x], (x + 4) + (x + 4) * 2 + (4 + 2 * x) + x + 2) << x;
}

TEST(RunGlsl, DynamicMatrixAndVectorIndices) {
  const std::vector<uint> got = run_glsl(R"(
    uint f(uint x) { mat4 m = mat4(0.0); m[x % 4u][(x / 4u) % 4u] = 7.0; vec4 sum = m[0] + m[1] + m[2] + m[3];
                     uvec3 v = uvec3(1u, 2u, 3u); v[x % 3u] = 9u;
                     return uint(sum[(x / 4u) % 4u]) * 100u + uint(m[x % 4u].x) + v.x + v[(x + 1u) % 3u]; })");
  for (uint x = 0; x < kCount; x++) {
    uint v[3] = {1, 2, 3};
    v[x % 3] = 9;
    ASSERT_EQ(got[x], 700 + (x / 4 % 4 == 0 ? 7 : 0) + v[0] + v[(x + 1) % 3]) << x;
  }
}

TEST(RunGlsl, FloatFunctions) {
  const std::vector<uint> got = run_glsl(R"(
    uint f(uint x) { float v = float(x) / 16.0; float whole; float part = modf(v, whole); int e;
                     float s = frexp(v + 1.0, e);
                     return floatBitsToUint(part + whole * 1024.0 + ldexp(s, e) + float(e)); })");
  for (uint x = 0; x < kCount; x++) {
    const float v = static_cast<float>(x) / 16.0f;
    int e = 0;
    std::frexp(v + 1.0f, &e);
    const float want = (v - std::floor(v)) + std::floor(v) * 1024.0f + (v + 1.0f) + static_cast<float>(e);
    ASSERT_EQ(got[x], base::bits_of(want)) << x;
  }
}

TEST(RunGlsl, BitFieldsPackingAndCarry) {
  const std::vector<uint> got = run_glsl(R"(
    uint f(uint x) { uint carry; uint sum = uaddCarry(x * 0x1000001u, 0xff000000u, carry); uint hi, lo;
                     umulExtended(sum, 0x12345u, hi, lo);
                     return bitfieldInsert(sum, x, 4, 8) + bitfieldExtract(sum, 3, 9) + carry + hi + lo +
                            packUnorm4x8(unpackUnorm4x8(x * 0x01020304u)) + packHalf2x16(unpackHalf2x16(x << 16u)) +
                            uint(findMSB(x) + findLSB(x) + bitCount(x)); })");
  for (uint x = 0; x < kCount; x++) {
    const uint a = x * 0x1000001u, sum = a + 0xff000000u, carry = sum < a;
    const std::uint64_t product = static_cast<std::uint64_t>(sum) * 0x12345u;
    const uint inserted = (sum & ~0xff0u) | (x & 0xff) << 4;
    const int msb = x == 0 ? -1 : 31 - std::countl_zero(x), lsb = x == 0 ? -1 : std::countr_zero(x);
    const uint want = inserted + (sum >> 3 & 0x1ff) + carry + static_cast<uint>(product >> 32) +
                      static_cast<uint>(product) + x * 0x01020304u + (x << 16) +
                      static_cast<uint>(msb + lsb + std::popcount(x));
    ASSERT_EQ(got[x], want) << x;
  }
}

/// SPIR-V whose values dominate their uses without being in an enclosing list, and phis that swap.
TEST(RunSpirv, PhisSwapAndValuesLeaveTheLoop) {
  const Words words = assemble(R"(OpCapability Shader
    OpMemoryModel Logical GLSL450
    OpEntryPoint GLCompute %main "main" %id
    OpExecutionMode %main LocalSize 64 1 1
    OpDecorate %id BuiltIn GlobalInvocationId
    OpDecorate %arr ArrayStride 4
    OpMemberDecorate %blk 0 Offset 0
    OpDecorate %blk BufferBlock
    OpDecorate %b DescriptorSet 0
    OpDecorate %b Binding 0
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %bool = OpTypeBool
    %uint = OpTypeInt 32 0
    %v3 = OpTypeVector %uint 3
    %pin = OpTypePointer Input %v3
    %id = OpVariable %pin Input
    %arr = OpTypeRuntimeArray %uint
    %blk = OpTypeStruct %arr
    %pblk = OpTypePointer Uniform %blk
    %b = OpVariable %pblk Uniform
    %pu = OpTypePointer Uniform %uint
    %c0 = OpConstant %uint 0
    %c1 = OpConstant %uint 1
    %c7 = OpConstant %uint 7
    %main = OpFunction %void None %fn
    %entry = OpLabel
    %gid = OpLoad %v3 %id
    %x = OpCompositeExtract %uint %gid 0
    OpBranch %head
    %head = OpLabel
    %p = OpPhi %uint %c7 %entry %q %cont
    %q = OpPhi %uint %x %entry %p %cont
    %i = OpPhi %uint %c0 %entry %next %cont
    OpLoopMerge %exit %cont None
    OpBranch %test
    %test = OpLabel
    %scaled = OpIMul %uint %i %c7
    %more = OpULessThan %bool %i %x
    OpBranchConditional %more %body %exit
    %body = OpLabel
    OpBranch %cont
    %cont = OpLabel
    %next = OpIAdd %uint %i %c1
    OpBranch %head
    %exit = OpLabel
    %r0 = OpIMul %uint %p %scaled
    %r1 = OpIAdd %uint %r0 %q
    %ptr = OpAccessChain %pu %b %c0 %x
    OpStore %ptr %r1
    OpReturn
    OpFunctionEnd)");
  std::vector<uint> values(kCount, 0);
  ASSERT_TRUE(dispatch_over(values, words, options_for(VK_SHADER_STAGE_COMPUTE_BIT), kCount / 64));
  for (uint x = 0; x < kCount; x++) {
    const uint p = x % 2 == 0 ? 7 : x, q = x % 2 == 0 ? x : 7;
    ASSERT_EQ(values[x], p * (x * 7) + q) << x;
  }
}

}  // namespace
}  // namespace vitrine::spirv::test
