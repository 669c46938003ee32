// Fixed shaders in which the shape of control flow decides what the reference's rules see.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr Type kFloat{Base::kFloat, 1}, kVec4{Base::kFloat, 4};

// What a loop computes in front of its only way out is known behind it.
CTS_CASE("glsl", "control_flow.equal_behind_loop") {
  const char* text =
      "  vec4 s0 = vec4(-1.0, 0.0, 255.0, 2.0), s2 = a, s5 = s0.xxzz;\n  float s1 = dot(b.xw, p.xz);\n"
      "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n"
      "  for (int k = 0, n = int(true); k < n; ++k) {\n    int j = 7;\n"
      "    do s2 = vec4(s5.w, s0.yyy) * s2; while (--j > 0);\n"
      "    s1 = array[((pi.z != i.w ? pi.x : pi.w) & 0x7fffffff) % 7];\n  }\n"
      "  if (!(s1 < 1.7)) s0 = s2.zwwz;\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s0"}}, {}, false});
}

// An array is a set of values once the loop that walks through it is unrolled, even where another loop stores to it.
CTS_CASE("glsl", "control_flow.array_of_values") {
  const char* text =
      "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  int k = pi.y & 7;\n"
      "  do {\n    array[((~7) & 0x7fffffff) % 7] = dot(a.yw * b.zy, normalize(vec2(10.0, -0.1)));\n"
      "  } while (--k > 0);\n"
      "  float sum = 0.0;\n  for (int j = 0; j < 7; ++j) sum += array[j];\n"
      "  float other[3] = float[3](a.x, b.x, a.z);\n"
      "  for (int j = 0; j < (i.x & 3); ++j) {\n    if (j == i.y) other[(~6 & 0x7fffffff) % 3] = other[2] * a.x;\n"
      "    else if (a.x > b.x) break;\n    if (i.z == j) continue;\n    other[1] += other[0];\n  }\n"
      "  float total = 0.0;\n  for (int j = 0; j < 3; ++j) total += other[j];\n";
  evaluate(run, Stage::kCompute, {"", text, {{kFloat, "sum"}, {kFloat, "total"}}, {}, false});
}

// A branch on what is unequal to true: the comparison stays, so that the branch does not know what is equal.
CTS_CASE("glsl", "control_flow.branch_on_unequal") {
  const char* text =
      "  vec4 s = b;\n"
      "  if ((3 != i.x) ^^ true) {\n    for (int k = 0, n = i.x; k < n; ++k) s = (s.yxyw + s) * b;\n  }\n";
  evaluate(run, Stage::kFragment, {"", text, {{kVec4, "s"}}, {}, false});
}

// The literals of a function stay where it is called: the loop's step and the -1 that the function returns are two.
CTS_CASE("glsl", "control_flow.literals_of_function") {
  const char* walk =
      "int walk(int x, int y) {\n  int n = 0;\n  while ((x & 15) != 0) {\n    if (++n > 20) return -1;\n"
      "    x = (x & 1) != 0 ? x + y : x >> 1;\n  }\n  return x ^ n;\n}\n";
  const char* text =
      "  vec4 s1 = a.zwyw - a, s3 = s1 + 0.3;\n  int s2 = int(p.x), k = 1;\n  float s5 = p.y;\n"
      "  while (k-- > 0) {\n    switch (s2) {\n      case 0:\n        s2 = walk(s2, i.w);\n        s5 = s1.y;\n    }\n"
      "    s1 = vec4(0.0);\n  }\n  s1 = s3;\n";
  evaluate(run, Stage::kCompute, {walk, text, {{kVec4, "s1"}, {kFloat, "s5"}}, {}, false});
}

// Nothing joins behind a branch that continues: a value that the loop does not change is known behind the loop.
CTS_CASE("glsl", "control_flow.unchanged_by_dead_branch") {
  const char* text =
      "  vec4 s = fma(b, p.zxyx, a) - 3.0;\n  int k = 2;\n"
      "  while (k-- > 0) {\n    if (0 < pi.w) continue;\n    if (false) {\n      switch (0) {\n"
      "        default:\n          s = i.ywxw;\n      }\n    }\n  }\n  vec4 r = -vec4(s.x);\n";
  evaluate(run, Stage::kFragment, {"", text, {{kVec4, "r"}, {kVec4, "s"}}, {}, false});
}

// What a loop starts with is joined behind the branch in front of it: its literals are computed with, not folded.
CTS_CASE("glsl", "control_flow.literals_joined_before_loop") {
  const char* text =
      "  vec4 start = vec4(p.y, 1.0, 0.3, p.y);\n  int steps = 0;\n  if (u.x == 2u) {\n    int k = i.z & 7;\n"
      "    while (k-- > 0) ++steps;\n  }\n  int n = pi.y;\n  while (n-- > 0) {\n    if (!false) break;\n"
      "    start = a;\n  }\n  vec4 r = (start - 1.0) * b.ywyx;\n  float turns = float(steps);\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "r"}, {kFloat, "turns"}}, {}, false});
}

// A literal that loops share comes from the first one: once that is unrolled, the second one's counter steps by what is
// in front of it, and the second one stays a loop.
CTS_CASE("glsl", "control_flow.literal_of_unrolled_loop") {
  const char* text =
      "  vec4 s = a, t = b;\n  int k = 1, n = 3;\n  while (k-- > 0) t = t * p;\n"
      "  while (n-- > 0) s = (s + s) * 1.7;\n";
  evaluate(run, Stage::kVertex, {"", text, {{kVec4, "s"}, {kVec4, "t"}}, {}, false});
}

// all() is one operation until the rules come to it; the components' comparisons are theirs to see in the next round.
CTS_CASE("glsl", "control_flow.branch_on_all") {
  const char* text =
      "  vec4 s = vec4(p.z, vec3(-2.5)) * (p * a);\n"
      "  if (all(equal(uvec4(u.y, u.x, u.y, 255u), u.xxzw - u))) {\n    switch (~i.z) {\n      case 0:\n"
      "        s = s.xwwy;\n    }\n  }\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}}, {}, false});
}

// What a branch inside a branch passes on unchanged is known behind both at once: the loop's first iteration goes in
// front of it in the same round.
CTS_CASE("glsl", "control_flow.unchanged_by_inner_branch") {
  const char* text =
      "  vec4 s = a;\n  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  int k = pi.z & 7;\n"
      "  do {\n    if (u.w > u.x) {\n      s = vec4(p.y);\n      if (isinf(a.y)) array[(pi.z & 255) % 7] = a.w;\n    "
      "}\n"
      "    s = (a - s.ywxz) + 1.0;\n  } while (--k > 0);\n  array[0] = s.w;\n"
      "  float sum = 0.0;\n  for (int j = 0; j < 7; ++j) sum += array[j];\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}, {kFloat, "sum"}}, {}, false});
}

// Both sides of the branch copy what the loop ends with: the product behind the loop is known to be zero.
CTS_CASE("glsl", "control_flow.copied_by_both_sides") {
  const char* text =
      "  vec4 s = p;\n  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  int k = pi.x & 7;\n"
      "  do {\n    s = p.zzzz * vec4(a.w, vec3(0.0));\n    if (u.w > u.x) array[(i.x & 255) % 7] = p.y;\n"
      "  } while (--k > 0);\n  if ((i.z & 3) == 0) s = s * a.zzwz;\n"
      "  float sum = 0.0;\n  for (int j = 0; j < 7; ++j) sum += array[j];\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}, {kFloat, "sum"}}, {}, false});
}

// The default of a switch compares again what the case that falls into it has compared: that one of both holds is not
// known.
CTS_CASE("glsl", "control_flow.fall_into_default") {
  const char* text =
      "  vec4 s = a.xwzw, r = s.zzwz;\n  s = s.yyzx;\n  switch (u.y & 3u) {\n    case 0:\n      r = a;\n    default:\n"
      "      s = vec4(0.5);\n  }\n  s = mix(p, vec4(10.0), s) - b.wyxz;\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}}, {}, false});
}

// One flag says that a case was left for the next: what falls into the default fell into the case before, too.
CTS_CASE("glsl", "control_flow.fall_through_cases") {
  const char* text =
      "  vec4 s = normalize(a.xwzw), r = s.zzwz - a, q = s.yyzx + p.wzyx;\n"
      "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n"
      "  switch (max(int(u.y), pi.y) & 3) {\n    case 0:\n      r = ldexp(a, pi & ivec4(31)) * (b.ywyz * a);\n"
      "    case 2:\n      array[(pi.z & 255) % 7] = degrees(min(a.y, q.w));\n    default:\n"
      "      q = vec4(0.5, -0.1, 1.7, 0.5) * (i.w != i.z ? s.z : 0.5);\n  }\n"
      "  s = mix(p, vec4(10.0, 255.0, 1.0, 4.0), q) - q.zyxx / b.wyxz;\n"
      "  float sum = 0.0;\n  for (int j = 0; j < 7; ++j) sum += array[j];\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}, {kFloat, "sum"}}, {}, false});
}

// A vector that is composed in front of a branch and read inside of it is composed there again: its parts have two
// uses.
CTS_CASE("glsl", "control_flow.composed_twice") {
  const char* text =
      "  vec4 s = vec4(u) * a;\n  s = vec4(i.x > 3 ? b.z : a.z, s.z * 0.3, b.x, p.w);\n"
      "  if (u.w < ~u.w) s = clamp(vec4(4.0, 0.3, -1.0, 1.0) - s, vec4(a.z, p.x, a.z, a.z), vec4(1.0));\n";
  evaluate(run, Stage::kVertex, {"", text, {{kVec4, "s"}}, {}, false});
}

// A product in front of a loop that is left in two places: both hand on copies of it, so that it has one use.
CTS_CASE("glsl", "control_flow.copies_at_two_breaks") {
  const char* text =
      "  vec4 s = p;\n  float f = i.x;\n  int r = i.x;\n  int k = pi.x;\n"
      "  do {\n    s = vec4(f, vec3(-2.5)) * (a.wyyy * f);\n    int n = 0;\n"
      "    while (r != 0) {\n      if (++n > 20) {\n        r = -1;\n        break;\n      }\n    }\n"
      "  } while (--k > 0);\n";
  evaluate(run, Stage::kCompute, {"", text, {{kVec4, "s"}, {kFloat, "float(r)"}}, {}, false});
}

// Bits of a literal that has none there are zero before the loop is looked at; its division by them becomes that of a
// literal in front of the loop, which is zero.
CTS_CASE("glsl", "control_flow.bits_of_literal") {
  const char* text =
      "  uint s = bitfieldExtract(1u, 2, i.x & 15), t = s;\n  int k = pi.w & 7;\n"
      "  do {\n    if (7u / t == t) s = max(3u >> (u.x & 31u), min(7u, u.z));\n"
      "    t = uint(clamp(p.y, 0.0, 4294967040.0));\n  } while (--k > 0);\n";
  evaluate(run, Stage::kCompute, {"", text, {{kFloat, "uintBitsToFloat(s)"}}, {}, false});
}

// A component that a loop hands on is copied as long as it is that of a vector, and a second use of the sum when it is
// not.
CTS_CASE("glsl", "control_flow.component_at_join") {
  const char* text =
      "  float s = a.x;\n  vec4 r = reflect(b, vec4(0.5, 0.5, 10.0, 3.0)) + vec4(-2.5, 3.0, 0.3, 1.0);\n"
      "  for (int k = 0; k < (i.y & 7); ++k) s = r.z;\n";
  evaluate(run, Stage::kFragment, {"", text, {{kFloat, "s"}, {kVec4, "r"}}, {}, false});
}

// Every iteration copies the same literal: it is the loop's own before the rules come a second time, which then know
// the product of two negations behind it.
CTS_CASE("glsl", "control_flow.literal_of_every_iteration") {
  const char* text =
      "  vec4 s = a;\n  float f = a.y, g = a.z;\n  int k = pi.y & 7;\n"
      "  do {\n    s = -vec4(0.3, 1.0, 0.0, 255.0);\n    f = b.x;\n  } while (--k > 0);\n"
      "  if (p.x != distance(vec2(1.0, 255.0), b.yw)) {\n    f = length(-s.zz);\n    g = (-s.z) * (-s.z);\n  }\n";
  evaluate(run, Stage::kVertex, {"", text, {{kFloat, "f"}, {kFloat, "g"}, {kVec4, "s"}}, {}, false});
}

// What joins in the body of an unrolled loop passes through registers: copies in each of the branches read the sum, so
// that it is not read once and its literal stays where it is.
CTS_CASE("glsl", "control_flow.joins_of_unrolled_body") {
  const char* text =
      "  vec4 s = b.xxww * a.xwzy;\n  float f = a.x * b.x;\n  int k = 1;\n"
      "  while (k-- > 0) {\n    if (u.y != 0u) {\n      s = (a - b) - vec4(-1.0, -1.0, 1.0, 0.0);\n"
      "      if (ldexp(a.z, 31) < step(b.y, p.x)) f = float(1000003 ^ pi.x);\n    }\n  }\n";
  evaluate(run, Stage::kCompute, {"", text, {{kFloat, "f"}, {kVec4, "s"}}, {}, false});
}

// Every turn of the unrolled loop stores the same to one element: only the first does, and as nothing else reads the
// product, its literal goes inward. Not so if a store to another element comes between.
CTS_CASE("glsl", "control_flow.repeated_stores") {
  const std::string store = "  e[(i.x & 0x7fffffff) % 7] = 0.3 * dot(p.xw, a.ww);\n";
  const std::string between = "  e[(i.y & 0x7fffffff) % 7] = 1.5 * dot(p.xw, b.ww);\n";
  for (const std::string& behind : {between + store, std::string()}) {
    const std::string text =
        "  float e[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  int k = 2;\n  while (k-- > 0)\n" + store +
        behind + "  float f = 0.0;\n  for (int n = 0; n < 7; ++n) f += e[n];\n";
    evaluate(run, Stage::kCompute, {"", text, {{kFloat, "f"}}, {}, false});
  }
}

// What is read of an element is what was stored to it or read of it before, whatever its index: infinity less itself is
// then zero. Not so behind a store to what may be the same element.
CTS_CASE("glsl", "control_flow.values_of_dynamic_elements") {
  const std::string x = "e[(i.x & 0x7fffffff) % 7]", y = "e[(i.y & 0x7fffffff) % 7]";
  const std::string stored = "  float f = a.x * 1e30 * 1e30;\n  " + x + " = f;\n";
  const std::string between[] = {"", "  " + y + " = b.x;\n", "  e[2] = b.y;\n",
                                 "  for (int k = 0; k < (i.w & 3); ++k) { " + y + " += 1.0; }\n",
                                 "  if (a.y > b.z) e[(i.z & 0x7fffffff) % 7] = b.w;\n"};
  for (const std::string& other : between)
    for (const std::string& first : {stored, "  float f = " + x + ";\n"}) {
      const std::string text = "  float e[7] = float[7](a.x, a.y, 1e38 * a.z * 1e38, a.w, b.x, b.y, b.z);\n" + first +
                               other + "  float d = " + x + " - f;\n  float g = e[3] - e[3];\n";
      evaluate(run, Stage::kCompute, {"", text, {{kFloat, "d"}, {kFloat, "g"}}, {}, false});
    }
}

// A store of what the element holds goes: the product that it would read keeps one reader.
CTS_CASE("glsl", "control_flow.stores_of_what_is_there") {
  const std::string store = "  e[3] = 0.3 * dot(p.xw, a.ww);\n";
  for (const std::string between : {"", "  e[4] = b.w;\n", "  e[(i.y & 0x7fffffff) % 7] = 1.5;\n"}) {
    const std::string text = "  float e[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n" + store + between + store +
                             "  float f = e[(i.x & 0x7fffffff) % 7];\n";
    evaluate(run, Stage::kCompute, {"", text, {{kFloat, "f"}}, {}, false});
  }
}

}  // namespace
}  // namespace vitrine::cts
