// Planted faults and their correct twins, in compute shaders.
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

/// As texts_of().
std::vector<std::string> found(const std::string& declarations, const std::string& body, std::uint32_t groups = 1,
                               const std::unique_ptr<Tool>& tool = make_sanitize()) {
  std::vector<std::uint32_t> words(64);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  run_observed(tool.get(), R"(#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
)" + declarations + R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n",
               words, groups);
  return texts_of(*tool);
}

using Texts = std::vector<std::string>;

TEST(Sanitize, FindsLoadsOutsideOfBuffers) {
  EXPECT_EQ(found("", "v[0] = v[i + 60u];"),
            Texts{"out-of-bounds-load x4 at 4: load of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "v[0] = v[i + 56u];"), Texts{});
}

TEST(Sanitize, QuickAsksForNothingThatIsWritten) {
  const std::string body = "uint x; if (i > 3u) x = 1u; s[i] = i; v[i + 61u] = x + s[i + 8u];";
  const auto quick = found("shared uint s[16];", body, 1, make_sanitize_quick());
  EXPECT_EQ(quick,
            Texts{"out-of-bounds-store x5 at 3: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("shared uint s[16];", body).size(), 3u);
}

TEST(Sanitize, FindsStoresOutsideOfBuffers) {
  EXPECT_EQ(found("", "v[i + 61u] = 1u;"),
            Texts{"out-of-bounds-store x5 at 3: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "if (i < 3u) v[i + 61u] = 1u;"), Texts{});
}

TEST(Sanitize, TellsOfAnAccessOnceHoweverManyInstructionsItBecomes) {
  EXPECT_EQ(found("", "for (uint k = 0u; k < 4u; ++k) v[i * 4u + k + 40u] = k;"),
            Texts{"out-of-bounds-store x8 at 6: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("layout(set = 0, binding = 0) buffer M { mat4 m[]; };", "v[i] = uint(m[i][0][0] + m[i][3][3]);"),
            (Texts{"out-of-bounds-load x4 at 4: load of 4 bytes at offset 256, outside of a buffer of 256 bytes",
                   "out-of-bounds-load x4 at 4: load of 4 bytes at offset 316, outside of a buffer of 256 bytes"}));
  EXPECT_EQ(
      found("layout(set = 0, binding = 0) buffer M { mat4 m[]; };", "mat4 a = m[i]; v[i] = uint(a[0][0] + a[3][3]);"),
      Texts{"out-of-bounds-load x8 at 4: load of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
}

TEST(Sanitize, FindsAtomicsOutsideOfBuffers) {
  EXPECT_EQ(
      found("", "atomicAdd(v[i * 10u], 1u);"),
      Texts{
          "out-of-bounds-atomic x1 at 7: atomic operation on 4 bytes at offset 280, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "atomicAdd(v[i * 9u], 1u);"), Texts{});
}

TEST(Sanitize, FindsLoadsThatAllInvocationsShare) {
  EXPECT_EQ(found("", "v[i] = v[v[63] + 1u];"),
            Texts{"out-of-bounds-load x8 at 0: load of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
  EXPECT_EQ(found("", "if (i > 100u) v[i] = v[v[63] + 1u];"), Texts{});
}

TEST(Sanitize, FindsWhatWrapsAround) {
  EXPECT_EQ(
      found("", "v[i] = v[i - 1u];"),
      Texts{"out-of-bounds-load x1 at 0: load of 4 bytes at offset 4294967292, outside of a buffer of 256 bytes"});
}

TEST(Sanitize, FindsAccessesOutsideOfSharedMemory) {
  const std::string shared = "shared uint s[12];";
  EXPECT_EQ(found(shared, "s[i] = i; s[i + 8u] = i; barrier(); v[i] = s[i];"),
            Texts{"out-of-bounds-shared x4 at 4: store of 4 bytes at offset 48, outside of shared memory (48 bytes)"});
  EXPECT_EQ(found(shared, "s[i] = i; s[i + 4u] = i; barrier(); v[i] = s[i];"), Texts{});
}

TEST(Sanitize, FindsIndicesPastTheEndOfArrays) {
  const std::string fill = "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; ";
  EXPECT_EQ(found("", fill + "v[i] = a[v[i]];"),
            Texts{"out-of-bounds-array x3 at 5: load of word 5 of an array variable of 5 words"});
  EXPECT_EQ(found("", fill + "v[i] = a[v[i] % 5u];"), Texts{});
}

TEST(Sanitize, FindsIntegersDividedByZero) {
  EXPECT_EQ(found("", "v[i] = 100u / v[i];"), Texts{"division-by-zero x1 at 0: 100 divided by 0"});
  EXPECT_EQ(found("", "v[i] = 100u % (v[i] - 5u);"), Texts{"division-by-zero x1 at 5: 100 divided by 0"});
  EXPECT_EQ(found("", "v[i] = uint((int(v[i]) - 2147483647 - 1) / (int(v[i + 1u]) - 2));"),
            Texts{"division-by-zero x2 at 0: -2147483648 divided by -1"});
  EXPECT_EQ(found("", "if (v[i] != 0u) v[i] = 100u / v[i];"), Texts{});
}

TEST(Sanitize, FindsOperandsOfVectorsOncePerInvocation) {
  EXPECT_EQ(found("", "uvec2 q = uvec2(100u) / uvec2(v[i], v[i] / 2u); v[i] = q.x + q.y;"),
            Texts{"division-by-zero x2 at 0: 100 divided by 0"});
}

TEST(Sanitize, FindsShiftsThatGoTooFar) {
  EXPECT_EQ(found("", "v[i] = 1u << (v[i] + 30u);"),
            Texts{"shift-too-far x6 at 2: shift by 32 of a number of 32 bits"});
  EXPECT_EQ(found("", "v[i] = uint(int(v[i]) >> (v[i] + 20u));"), Texts{});
}

TEST(Sanitize, FindsBitFieldsThatDoNotFit) {
  EXPECT_EQ(found("", "v[i] = bitfieldExtract(v[i], 30, int(v[i]));"),
            Texts{"bit-field-out-of-range x5 at 3: field of 3 bits at offset 30 of a number of 32 bits"});
  EXPECT_EQ(found("", "v[i] = bitfieldInsert(v[i], 7u, 30, int(min(v[i], 2u)));"), Texts{});
}

TEST(Sanitize, FindsConversionsThatDoNotFit) {
  EXPECT_EQ(found("", "v[i] = uint(float(v[i]) - 2.5);"),
            Texts{"conversion-out-of-range x2 at 0: conversion of -2.5 to an unsigned integer of 32 bits"});
  EXPECT_EQ(found("", "v[i] = uint(int(float(v[i]) * 1e9));"),
            Texts{"conversion-out-of-range x5 at 3: conversion of 3e+09 to a signed integer of 32 bits"});
  EXPECT_EQ(found("", "v[i] = uint(float(v[i]) - 0.5);"), Texts{});
}

TEST(Sanitize, FindsArgumentsOfFunctions) {
  EXPECT_EQ(found("", "v[i] = floatBitsToUint(sqrt(float(v[i]) - 1.0));"), Texts{"undefined-math x1 at 0: sqrt(-1)"});
  EXPECT_EQ(found("", "v[i] = floatBitsToUint(pow(float(v[i]) - 2.0, 3.0));"),
            Texts{"undefined-math x2 at 0: pow(-2, 3)"});
  EXPECT_EQ(found("", "v[i] = clamp(3u, v[i], 5u);"), Texts{"undefined-math x2 at 6: clamp(3, 6, 5)"});
  EXPECT_EQ(found("", "v[i] = floatBitsToUint(smoothstep(float(v[i]), 6.0, 1.0));"),
            Texts{"undefined-math x2 at 6: smoothstep(6, 6, 1)"});
  EXPECT_EQ(found("", "v[i] = floatBitsToUint(log(float(v[i]) + 1.0) + asin(float(v[i]) / 7.0));"), Texts{});
}

TEST(Sanitize, FindsOperandsInLoopsThatAreUnrolled) {
  EXPECT_EQ(found("", "uint s = 0u; for (uint k = 0u; k < 4u; ++k) s += v[i] / (3u - k); v[i] = s;"),
            Texts{"division-by-zero x8 at 0: 0 divided by 0"});
  EXPECT_EQ(found("", "uint s = 0u; for (uint k = 0u; k < 4u; ++k) s += v[i] / (4u - k); v[i] = s;"), Texts{});
}

TEST(Sanitize, FindsSharedMemoryThatNobodyHasWritten) {
  const std::string shared = "shared uint s[8];";
  EXPECT_EQ(found(shared, "if (i != 3u) s[i] = i; barrier(); v[i] = s[7u - i];"),
            Texts{"uninitialized-shared x1 at 4: load of 4 bytes at offset 12 of shared memory that no invocation has "
                  "written"});
  EXPECT_EQ(found(shared, "s[i % 8u] = i; barrier(); v[i] = s[7u - i % 8u];", 3), Texts{});
  EXPECT_EQ(found("shared uint n;", "atomicAdd(n, i); barrier(); v[i] = n;"),
            Texts{"uninitialized-shared x1 at 0: atomic operation on 4 bytes at offset 0 of shared memory that no "
                  "invocation has written"});
  EXPECT_EQ(found("shared uint n;", "if (i % 8u == 0u) n = 0u; barrier(); atomicAdd(n, i); barrier(); v[i] = n;", 2),
            Texts{});
}

TEST(Sanitize, FindsVariablesThatWereNotWritten) {
  EXPECT_EQ(
      found("", "uint x; if (i < 5u) x = i; v[i] = x;"),
      Texts{"uninitialized-variable x3 at 5: what is stored depends on variable 'x', which has not been written"});
  EXPECT_EQ(found("", "uint x; if (i < 5u) x = i; else x = 2u; v[i] = x;"), Texts{});
  EXPECT_EQ(
      found("", "uint s; for (uint k = 0u; k < v[4]; ++k) s += k; v[i] = s;"),
      Texts{"uninitialized-variable x8 at 0: what is stored depends on variable 's', which has not been written"});
  EXPECT_EQ(found("", "uint x; if (v[i] > 100u) { if (x == 3u) v[i] = 1u; }"), Texts{});
  EXPECT_EQ(found("", "uint x; if (x + v[i] == 3u) v[i] = 1u;"),
            Texts{"uninitialized-variable x8 at 0: a branch depends on variable 'x', which has not been written"});
}

TEST(Sanitize, KnowsComponentsOfVariables) {
  EXPECT_EQ(found("", "uvec4 x; x.xyz = uvec3(i); uvec4 y = x * 2u; v[i] = y.x + y.y;"), Texts{});
  EXPECT_EQ(
      found("", "uvec4 x; x.xyz = uvec3(i); uvec4 y = x * 2u; v[i] = y.x + y.w;"),
      Texts{"uninitialized-variable x8 at 0: what is stored depends on variable 'x', which has not been written"});
  const std::string parts = "struct P { uint a; uvec2 b; }; void f(inout P p) { p.b.y = p.a; }";
  EXPECT_EQ(found(parts, "P p; p.a = i; f(p); v[i] = p.b.y;"), Texts{});
  EXPECT_EQ(found(parts, "P p; p.b.x = i; f(p); v[i] = p.b.x;"), Texts{});
  EXPECT_EQ(
      found(parts, "P p; p.b.x = i; f(p); v[i] = p.b.y;"),
      Texts{"uninitialized-variable x8 at 0: what is stored depends on variable 'p', which has not been written"});
}

TEST(Sanitize, KnowsElementsOfArrays) {
  const std::string fill = "uint a[8]; for (uint k = 0u; k < v[7]; ++k) a[k] = k;";
  EXPECT_EQ(found("", fill + "v[i] = a[i % 7u];"), Texts{});
  EXPECT_EQ(
      found("", fill + "v[i] = a[i];"),
      Texts{"uninitialized-variable x1 at 7: what is stored depends on variable 'a', which has not been written"});
  EXPECT_EQ(found("", "uint a[8]; for (uint k = 0u; k < 8u; ++k) a[k] = k; v[i] = a[i];"), Texts{});
}

TEST(Sanitize, ForgetsVariablesWhereTheyBegin) {
  EXPECT_EQ(found("uint f(uint k) { uint x; if (k == 0u) x = 7u; return x; }",
                  "for (uint k = 0u; k < v[2]; ++k) if (f(k) == 7u) v[i] = 3u;"),
            Texts{"uninitialized-variable x16 at 0: a branch depends on variable 'x', which has not been written"});
  EXPECT_EQ(
      found("uint f(uint x) { uint r; if (x > 0u) { r = 1u; } return r; }", "v[i] = f(i) + f(v[i] + 1u);"),
      Texts{"uninitialized-variable x1 at 0: what is stored depends on variable 'r', which has not been written"});
}

TEST(Sanitize, ForgetsSharedMemoryWithItsWorkgroup) {
  EXPECT_EQ(found("shared uint s[8];", "if (gl_WorkGroupID.x == 0u) s[i % 8u] = i; barrier(); v[i] = s[i % 8u];", 2),
            Texts{"uninitialized-shared x8 at 8: load of 4 bytes at offset 0 of shared memory that no invocation has "
                  "written"});
}

TEST(Sanitize, FindsBarriersThatNotAllReach) {
  EXPECT_EQ(found("shared uint s;", "if (i < 3u) { s = i; barrier(); } v[i] = i;"),
            Texts{"divergent-barrier x3 at 0: barrier of a workgroup that not all its invocations reach"});
  EXPECT_EQ(found("shared uint s;", "if (v[10] == 10u) { s = i; barrier(); } v[i] = i;"), Texts{});
}

TEST(Sanitize, FindsCasesThatAreMissing) {
  EXPECT_EQ(found("uint f(uint x) { switch (x) { case 0u: return 1u; default: return 2u; } }", "v[i] = f(v[i]);"),
            Texts{});
}

TEST(Numbers, AreFoundWhereTheyBecomeInfiniteOrNone) {
  const auto numbers = [](const std::string& body) { return found("", body, 1, make_numbers()); };
  EXPECT_EQ(numbers("float x = 1.0 / float(v[i]); float y = x * float(v[i]); v[i] = floatBitsToUint(y * 2.0);"),
            (Texts{"infinity x1 at 0: infinity made of 1, 0", "not-a-number x1 at 0: NaN made of inf, 0"}));
  EXPECT_EQ(numbers("float x = float(v[i]); x = x / x; v[i] = floatBitsToUint(x + 1.0);"),
            Texts{"not-a-number x1 at 0: NaN made of 0, 0"});
  EXPECT_EQ(numbers("vec3 n = normalize(vec3(v[i])); v[i] = floatBitsToUint(dot(n, vec3(1.0)));"),
            Texts{"not-a-number x1 at 0: NaN made of (0, 0, 0)"});
  EXPECT_EQ(numbers("vec3 n = normalize(vec3(v[i] + 1u)); v[i] = floatBitsToUint(dot(n, vec3(1.0)));"), Texts{});
}

TEST(Sanitize, CountsAPlaceOnce) {
  EXPECT_EQ(found("", "for (uint k = 0u; k < v[4]; ++k) v[64u + k + i] = k;", 2),
            Texts{"out-of-bounds-store x64 at 0: store of 4 bytes at offset 256, outside of a buffer of 256 bytes"});
}

}  // namespace
}  // namespace vitrine::glass::test
