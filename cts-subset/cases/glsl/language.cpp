// Hand-written shaders for what the random ones leave out: block layouts, built-in variables, derivatives, packing,
// modf and frexp, matrices, structs, arrays of resources, helper invocations.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"
#include "harness/execute.h"

namespace vitrine::cts {
namespace {

/// Statements that set r0.. from a, b, i, u, in all three stages.
void add_body(const char* name, const std::string& statements, std::vector<Variable> results, bool specials = true,
              const std::string& declarations = "") {
  constexpr std::pair<const char*, Stage> kStages[] = {
      {"compute", Stage::kCompute}, {"vertex", Stage::kVertex}, {"fragment", Stage::kFragment}};
  for (const auto& [stage_name, stage] : kStages)
    AddCase("glsl", std::string(name) + "." + stage_name, [=, stage = stage](Run& run) {
      ShaderBody body;
      body.declarations = declarations;
      body.statements = statements;
      body.results = results;
      body.specials = specials;
      evaluate(run, stage, body);
    });
}

constexpr Type kFloat{Base::kFloat, 1}, kVec2{Base::kFloat, 2}, kVec3{Base::kFloat, 3}, kVec4{Base::kFloat, 4};
constexpr Type kInt4{Base::kInt, 4}, kUint1{Base::kUint, 1}, kUint4{Base::kUint, 4};

/// One GLSL function over ordinary and special values: small enough to read.
void add_function(const char* name, const std::string& expression, Type type = kVec4) {
  add_body((std::string("function.") + name).c_str(), type_name(type) + " r0 = " + expression + ";\n", {{type, "r0"}});
}

const bool kFunctions = [] {
  for (const char* f :
       {"abs",  "sign",  "floor", "ceil",  "trunc",   "round",   "roundEven", "fract", "sqrt",  "inversesqrt", "exp",
        "exp2", "log",   "log2",  "sin",   "cos",     "tan",     "asin",      "acos",  "atan",  "sinh",        "cosh",
        "tanh", "asinh", "acosh", "atanh", "radians", "degrees", "normalize", "-",     "1.0 / "})
    add_function(f[0] == '-' ? "negate" : f[0] == '1' ? "reciprocal" : f, std::string(f) + "(a)");
  for (const char* f : {"min", "max", "mod", "pow", "step", "atan", "reflect"})
    add_function((std::string(f) + "2").c_str(), std::string(f) + "(a, b)");
  for (const char* f : {"clamp", "mix", "smoothstep", "fma", "faceforward"}) {
    add_function((std::string(f) + "3").c_str(), std::string(f) + "(a, b, p)");
    add_function((std::string(f) + "3_swapped").c_str(), std::string(f) + "(p, a, b)");
  }
  add_function("pow_abs", "pow(abs(a), b)");
  add_function("refract", "refract(a, b, p.x)");
  add_function("cross", "cross(a.xyz, b.xyz)", kVec3);
  add_function("length", "vec4(length(a), length(a.xyz), length(a.xy), length(a.x))");
  add_function("distance", "vec4(distance(a, b), distance(a.xyz, b.xyz), distance(a.xy, b.xy), distance(a.x, b.x))");
  add_function("dot", "vec4(dot(a, b), dot(a.xyz, b.xyz), dot(a.xy, b.xy), 1.0)");
  add_function("ldexp", "ldexp(a, i & 255)");
  add_function(
      "determinant",
      "vec4(determinant(mat2(a)), determinant(mat3(a.xyz, b.xyz, p.xyz)), determinant(mat4(a, b, p, a.wzyx)), 1.0)");
  add_function("inverse2", "vec4(inverse(mat2(a))[0], inverse(mat2(a))[1])");
  add_function("inverse3", "vec4(inverse(mat3(a.xyz, b.xyz, p.xyz))[0], inverse(mat3(a.xyz, b.xyz, p.xyz))[2].x)");
  add_function("inverse4", "inverse(mat4(a, b, p, a.wzyx))[1]");
  add_function("matrix_vector", "mat4(a, b, p, a.yxwz) * b");
  add_function("vector_matrix", "a * mat4(a, b, p, a.yxwz)");
  add_function("matrix_matrix", "(mat4(a, b, p, a.yxwz) * mat4(b, a, b.zwxy, p))[2]");
  add_function("outer_product", "outerProduct(a, b)[1] + matrixCompMult(mat4(a, b, p, a), mat4(b, b, a, p))[0]");
  add_function("to_int", "vec4(ivec4(a))");
  add_function("to_uint", "vec4(uvec4(a))");
  add_function("from_int", "vec4(i)");
  add_function("from_uint", "vec4(u)");
  add_function("divide", "a / b");
  return true;
}();

// What a selected operation with 1 or 0 keeps (denormals) in the reference's code for CPUs whose registers have masks.
CTS_CASE("glsl", "selected_ones") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  ShaderBody body;
  body.statements = "  vec4 r0 = a * (b.y < 1.0 ? vec4(1.0) : p), r1 = a / (b.x < 1.0 ? b : vec4(1.0));\n";
  body.statements +=
      "  vec4 r2 = a * step(b, p), r3 = a / vec4(greaterThan(b, p)), r4 = a - vec4(equal(b, p));\n"
      "  vec4 r5 = b - (a.x < p.x ? b.wzyx : vec4(0.0)), r6 = b * (1.0 - step(p, a));\n"
      "  precise vec4 weight = vec4(lessThan(b, p)), r7 = (1.0 - weight) * a;\n"
      "  vec4 r8 = a * vec4(lessThan(i, pi)), r9 = a / (u.x < 7u ? 1.0 : 3.0), r10 = a - (i.x > 5 ? vec4(0.0) : "
      "vec4(3.0));\n"
      "  vec4 r11 = b * (1.0 - vec4(greaterThan(i, ivec4(5, -7, 0, 1))));\n";
  for (int k = 0; k < 12; ++k) body.results.push_back({kVec4, "r" + std::to_string(k)});
  body.specials = true;
  evaluate(run, Stage::kFragment, body);
}

// Push constants that are loaded in a branch which is always taken meet those behind it only in the next round, in
// which differences of equal ones are zero before their negation becomes a precise one.
CTS_CASE("glsl", "differences_of_push_constants") {
  const char* text =
      "  precise float x = true ? -p.x : 2.0, y = true ? -p.y : 2.0, z = true ? -p.z : 2.0, w = true ? -p.w : 2.0;\n"
      "  vec4 r = vec4(x * (p.x - p.x), y * (p.y - p.y), z * (p.z - p.z), w * (p.w - p.w));\n";
  for (const Stage stage : {Stage::kCompute, Stage::kVertex, Stage::kFragment})
    evaluate(run, stage, {"", text, {{kVec4, "r"}}, {}, false});
}

// Both sides of a selection are the same literal, which is one value only where equal instructions have been merged.
CTS_CASE("glsl", "selection_of_one_literal") {
  const char* text = "  vec4 r = p * a.wzyx - (p * a.wzyx) * (a.x < b.x ? -2.5 : -2.5);\n";
  for (const Stage stage : {Stage::kCompute, Stage::kVertex, Stage::kFragment})
    evaluate(run, stage, {"", text, {{kVec4, "r"}}, {}, false});
}

// Components that are read of a variable are not constants before the vector that it is composed of is split.
CTS_CASE("glsl", "gathered_components") {
  const char* text =
      "  vec4 t = vec4(a.x, vec3(0.3, -2.5, -1.0)), c = vec4(a.x, 0.3, b.y, -1.0);\n  vec2 two = vec2(2.0, 0.0);\n"
      "  vec2 r0 = fract(two) * t.wz;\n"
      "  vec3 r1 = vec3(4.0, -1.0, 1.7) * ((c.ywy + a.xyz) + (c.xww + b.xyz));\n";
  for (const Stage stage : {Stage::kCompute, Stage::kVertex, Stage::kFragment})
    evaluate(run, stage, {"", text, {{kVec2, "r0"}, {kVec3, "r1"}}, {}, false});
}

// Integers of sines of NaN and infinities.
CTS_CASE("glsl", "integers_of_sines") {
  ShaderBody body;
  body.statements = "  uvec4 r0 = uvec4(abs(i)) + uvec4(sin(a));\n  ivec4 r1 = ivec4(cos(b) * 3.0 + 2.0);\n";
  body.results = {{kUint4, "r0"}, {kInt4, "r1"}};
  body.specials = true;
  evaluate(run, Stage::kFragment, body);
}

const bool kBodies = [] {
  add_body("modf_frexp", "  vec4 whole; vec4 r0 = modf(a, whole);\n  ivec4 e; vec4 r2 = frexp(a, e);\n",
           {{kVec4, "r0"}, {kVec4, "whole"}, {kVec4, "r2"}, {kInt4, "e"}});
  add_body("packing",
           "  uvec4 r0 = uvec4(packUnorm4x8(a), packSnorm4x8(a), packUnorm2x16(a.xy), packSnorm2x16(a.xy));\n"
           "  uint r1 = packHalf2x16(clamp(a.xy, -70000.0, 70000.0));\n"
           "  vec4 r2 = unpackUnorm4x8(u.x), r3 = unpackSnorm4x8(u.y);\n"
           "  vec4 r4 = vec4(unpackUnorm2x16(u.x), unpackSnorm2x16(u.y));\n  vec2 r5 = unpackHalf2x16(u.z);\n",
           {{kUint4, "r0"}, {kUint1, "r1"}, {kVec4, "r2"}, {kVec4, "r3"}, {kVec4, "r4"}, {kVec2, "r5"}});
  add_body("integer_functions",
           "  ivec4 r0 = bitCount(i), r1 = findLSB(i), r2 = findMSB(i), r3 = bitfieldExtract(i, 3, 9);\n"
           "  uvec4 r4 = bitfieldReverse(u), r5 = bitfieldInsert(u, uvec4(i), 5, 11), carry, r7 = uaddCarry(u, "
           "uvec4(i), carry);\n"
           "  uvec4 borrow, r9 = usubBorrow(u, uvec4(i), borrow), high, low; umulExtended(u, uvec4(i), high, low);\n"
           "  ivec4 ihigh, ilow; imulExtended(i, ivec4(u), ihigh, ilow);\n",
           {{kInt4, "r0"},
            {kInt4, "r1"},
            {kInt4, "r2"},
            {kInt4, "r3"},
            {kUint4, "r4"},
            {kUint4, "r5"},
            {kUint4, "carry"},
            {kUint4, "r7"},
            {kUint4, "borrow"},
            {kUint4, "r9"},
            {kUint4, "high"},
            {kUint4, "low"},
            {kInt4, "ihigh"},
            {kInt4, "ilow"}});
  add_body("integer_division",
           "  ivec4 r0 = i / ivec4(i.y, 7, -3, 8), r1 = (i & 0x7fffffff) % ivec4(5, 8, 1000, 1);\n"
           "  uvec4 r2 = u / uvec4(u.y, 7u, 8u, 0x80000001u), r3 = u % uvec4(u.y, 7u, 8u, 0x80000001u);\n",
           {{kInt4, "r0"}, {kInt4, "r1"}, {kUint4, "r2"}, {kUint4, "r3"}});
  add_body(
      "structs_and_arrays",
      "  Thing t = Thing(a, Inner(i.x & 3, b.xy), float[3](a.x, b.y, a.z));\n"
      "  Thing list[3];\n  list[0] = t; list[1] = grow(t); list[2] = grow(list[1]);\n"
      "  list[(i.y & 0x7fffffff) % 3].v.x += 1.0;\n"
      "  vec4 r0 = list[0].v + list[1].v * list[2].inner.w.xyxy;\n"
      "  float r1 = list[(i.z & 0x7fffffff) % 3].f[(i.w & 0x7fffffff) % 3] + kTable[t.inner.n];\n"
      "  bool r2 = list[0] == list[1];\n",
      {{kVec4, "r0"}, {kFloat, "r1"}, {{Base::kBool, 1}, "r2"}}, false,
      "struct Inner { int n; vec2 w; };\nstruct Thing { vec4 v; Inner inner; float f[3]; };\n"
      "const float kTable[4] = float[4](0.5, 1.5, -2.0, 8.0);\n"
      "Thing grow(Thing t) { t.v *= 1.5; t.inner.w = t.inner.w.yx + 0.25; t.f[t.inner.n % 3] -= 1.0; return t; }\n");
  // Elements of arrays that are known once the loops are unrolled; r2: and some that are not.
  add_body("arrays_of_unrolled_loops",
           "  const float weights[] = float[](0.013, 0.11, 0.37, 0.11, 0.013);\n  float made[4];\n"
           "  vec4 r0 = vec4(0.0), r1 = vec4(0.0);\n"
           "  for (int k = 0; k < weights.length(); k++) r0 += (a + b * float(k)) * weights[k] * 0.6;\n"
           "  for (int k = 0; k < 4; k++) {\n    made[k] = a[k] * 0.7;\n    if (i[k] > 3) made[k] *= b[k];\n  }\n"
           "  for (int k = 0; k < 4; k++) r1[k] = made[3 - k] * 1.3 + weights[k];\n"
           "  made[u.x & 3u] = b.z * 3.0;\n  made[1] += 0.5;\n"
           "  float r2 = made[1] * 2.0 + made[u.y & 3u] * made[2];\n",
           {{kVec4, "r0"}, {kVec4, "r1"}, {kFloat, "r2"}}, false);
  // What a sum with -0 keeps (denormals), and which zero the maximum takes while 0 / a is not yet simplified.
  add_body("literal_zeros",
           "  precise vec4 r0 = a - vec4(0.0), r1 = vec4(-0.0) + a;\n"
           "  vec4 r2 = max(0.0 / a, -floor(0.5 * fract(b))), r3 = min(-floor(0.5 * fract(a)), 0.0 / b);\n",
           {{kVec4, "r0"}, {kVec4, "r1"}, {kVec4, "r2"}, {kVec4, "r3"}});
  add_body("swizzles",
           "  vec4 r0 = a.wzyx; r0.yw += b.xz; r0.xz = r0.zx;\n  mat3 m = mat3(a.xyz, b.xyz, a.zxy); m[1].yz = "
           "m[0].xy; m[2][0] = 4.0;\n"
           "  vec3 r1 = m * b.xyz;\n  mat2x4 n = mat2x4(a, b); vec4 r2 = n * a.xy;\n  vec2 r3 = a * n;\n",
           {{kVec4, "r0"}, {kVec3, "r1"}, {kVec4, "r2"}, {kVec2, "r3"}}, false);
  return true;
}();

/// Uniform blocks with every layout rule, nested structs and arrays, a dynamic index; std430 beside std140.
CTS_CASE("glsl", "block_layouts") {
  std::vector<float> floats(1024);
  for (float& value : floats) value = run.random.real(-4, 4);
  const Buffer uniform = run.buffer_of(floats), storage = run.buffer_of(floats), result = run.buffer(64 * 16 * 8);
  const Resources res =
      run.resources({uniform_buffer(0, uniform), storage_buffer(1, storage), storage_buffer(2, result)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
struct S { float f; vec3 v; mat2 m; float list[3]; };
layout(std140, binding = 0) uniform U {
  float a; vec2 b; vec3 c; float d; mat3 m; layout(row_major) mat4x3 rows; S s[2]; float tail[7]; mat2x3 many[2]; ivec2 n;
} u;
layout(std430, binding = 1) buffer B {
  float a; vec2 b; vec3 c; float d; mat3 m; layout(row_major) mat4x3 rows; S s[2]; float tail[7]; mat2x3 many[2]; ivec2 n; vec3 rest[];
} b;
layout(std430, binding = 2) buffer R { vec4 r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x, k = id % 2u, j = id % 7u;
  r[id * 8u] = vec4(u.a, u.b, u.d);
  r[id * 8u + 1u] = vec4(u.m * u.c, u.s[k].f);
  r[id * 8u + 2u] = vec4(u.rows * vec4(u.c, 1.0), u.tail[j]);
  r[id * 8u + 3u] = vec4(u.s[k].m[1], u.s[1].list[id % 3u], u.many[k][1].z);
  r[id * 8u + 4u] = vec4(b.a, b.b, b.d);
  r[id * 8u + 5u] = vec4(b.m * b.c, b.s[k].f);
  r[id * 8u + 6u] = vec4(b.rows * vec4(b.c, 1.0), b.tail[j]);
  r[id * 8u + 7u] = vec4(b.s[k].m[1], b.rest[id % 20u].y, float(b.rest.length()));
})"));
  run.dispatch(res, pipeline, 1);
  run.out("result", result, VK_FORMAT_R32G32B32A32_SFLOAT);
}

/// Draws a few triangles whose fragments show one expression.
void fragment_expression(Run& run, const std::string& expression, const std::string& before = "") {
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\nvoid main() {\n" +
                  before + "  result = " + expression + ";\n}\n";
  spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (int i = 0; i < 3 * 6; ++i) {
    const float w = run.random.real(0.5f, 3.0f);
    for (const float v : {run.random.real(-1, 1) * w, run.random.real(-1, 1) * w, run.random.unit() * w, w})
      values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.real(-2, 2));
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 18, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

const bool kFragments = [] {
  constexpr std::pair<const char*, const char*> kExpressions[] = {
      {"derivative.dFdx", "dFdx(passed)"},
      {"derivative.dFdy", "dFdy(passed)"},
      {"derivative.fwidth", "fwidth(passed)"},
      {"derivative.coarse", "dFdxCoarse(passed) + dFdyCoarse(passed) * 2.0 + fwidthCoarse(passed)"},
      {"derivative.fine", "dFdxFine(passed) + dFdyFine(passed) * 2.0 + fwidthFine(passed)"},
      {"derivative.of_expression", "dFdx(sin(passed * 3.0)) + dFdy(passed * passed)"},
      {"derivative.of_fragcoord", "dFdx(gl_FragCoord * gl_FragCoord) + dFdy(gl_FragCoord)"},
      {"builtin.FragCoord", "gl_FragCoord"},
      {"builtin.FrontFacing", "vec4(gl_FrontFacing ? 1.0 : 0.25)"},
      {"builtin.PrimitiveID", "vec4(float(gl_PrimitiveID))"},
      {"builtin.SampleMaskIn", "vec4(float(gl_SampleMaskIn[0]))"},
      {"builtin.HelperInvocation", "vec4(gl_HelperInvocation ? 1.0 : passed.x)"},
  };
  for (const auto& [name, expression] : kExpressions)
    AddCase("glsl", name, [expression = std::string(expression)](Run& run) {
      if (expression.find("PrimitiveID") != std::string::npos)
        run.require(run.gpu.features.geometryShader, "geometryShader");
      fragment_expression(run, expression);
    });
  // What the reference's rules see depends on which case comes first and on values that leave a loop.
  AddCase("glsl", "rewrite.switch_order", [](Run& run) {
    const char* text =
        "  vec4 r = a, s = a + b;\n"
        "  switch (i.w & 3) {\n    case 0:\n      if ((i.x & 3) == 0) r = s - a;\n      break;\n"
        "    default:\n      int k = 7;\n      do s = a; while (--k > 0);\n  }\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 4}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.loop_value", [](Run& run) {
    const char* text =
        "  vec4 s = a;\n  int k = pi.x & 7;\n  do s = sqrt(abs(a)); while (--k > 0);\n"
        "  float r = length(s.xz);\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 1}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.loop_in_loop", [](Run& run) {
    const char* text =
        "  vec4 s3 = a, s4 = b;\n  int s1 = i.x, k2 = pi.x & 7;\n  while (k2-- > 0) {\n"
        "    switch (~~s1 & 3) {\n      case 0:\n        s4 = s3.zwwx;\n    }\n    int k3 = 5;\n"
        "    do s3 = (b.ywww + s3.wzzw) - 0.25; while (--k3 > 0);\n  }\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 4}, "s4"}}, {}, false});
  });
  AddCase("glsl", "rewrite.unchanged_by_continue", [](Run& run) {
    const char* text =
        "  float s = -distance(b.zz, p.ww);\n  vec4 r = vec4(0.0);\n"
        "  for (int k = 0; k < (i.x & 7); ++k) {\n    if (true ^^ (!true)) continue;\n"
        "    if ((i.y & 3) == 2) s = a.w + a.z;\n  }\n"
        "  if (!(!false)) {\n  } else {\n    r = radians(a) * (p.zyxw * s);\n  }\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 4}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.joined_before_loop", [](Run& run) {
    const char* text =
        "  vec4 s = -0.1 - a;\n  int steps = 0, k0 = pi.z & 7;\n"
        "  do {\n    ++steps;\n    if (u.x != u.z) break;\n  } while (--k0 > 0);\n"
        "  switch ((u.w <= u.w ? 16 : i.y) & 3) {\n    case 0:\n      int k2 = 1;\n"
        "      while (k2-- > 0) s = s + a.z;\n  }\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 4}, "s"}, {{Base::kInt, 1}, "steps"}}, {}, false});
  });
  // What the second loop starts with passes through registers in every branch that the first one unrolls to.
  AddCase("glsl", "rewrite.continue_behind_ladder", [](Run& run) {
    const char* walk =
        "int walk(int x, int y) {\n  int n = 0;\n  while (x != 0) {\n    if (++n > 20) return -1;\n"
        "    x = x != 0 ? x + y : x >> 1;\n  }\n  return x ^ n;\n}\n";
    const char* text =
        "  vec4 s = p, d = p.wywz - p;\n  int w = walk(i.w, i.w), k = 5;\n"
        "  while (k-- > 0) {\n    if (-1 < w) continue;\n"
        "    if ((s.y - s.y) > 0.0) {\n      d = a.xyyz;\n    } else {\n"
        "      switch (i.w & 3) {\n        case 0:\n          s = d * b;\n      }\n    }\n  }\n";
    evaluate(run, Stage::kCompute, {walk, text, {{{Base::kFloat, 4}, "s"}}, {}, false});
  });
  AddCase("glsl", "rewrite.choice_of_zeros", [](Run& run) {
    const char* text = "  float s = 0.0 / a.z;\n  float r = (pi.w == 0 ? s * a.z : s) * a.z;\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 1}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.dot_of_negation", [](Run& run) {
    const char* text =
        "  vec2 r = (b.y != 4.0 ? p.wz : vec2(0.3, -2.5)) * mat2(a.xy, vec2(255.0, 0.0) * -(0.0 * p.x));\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 2}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.constant_beside_products", [](Run& run) {
    const char* text = "  vec2 r = b.wy * mat2(vec2(1.7, 1.0), a.xz) + vec2(10.0, 0.0);\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 2}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.literal_in_register", [](Run& run) {
    const char* text =
        "  float r = a.z, s = 0.0 / r;\n  if (float(i.x) < p.z) {\n"
        "    switch (pi.w) {\n      case 0:\n        s = s * r;\n    }\n    r = s * r;\n  }\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 1}, "r"}, {{Base::kFloat, 1}, "s"}}, {}, false});
  });
  // A value in a register of its own: it is still needed beside what is chosen from it.
  AddCase("glsl", "rewrite.literal_in_own_register", [](Run& run) {
    const char* text =
        "  precise float s = (0.0 / b.z) * a.z, t = a.x * s;\n  precise float r = 4.0 < b.y ? s : p.y;\n";
    const Base number = Base::kFloat;
    evaluate(run, Stage::kVertex, {"", text, {{{number, 1}, "r"}, {{number, 1}, "s"}, {{number, 1}, "t"}}, {}, false});
  });
  AddCase("glsl", "rewrite.sum_of_ldexp", [](Run& run) {
    const char* text = "  vec4 r = ldexp(vec4(-1.0), pi & 31) + mix(a, b, p);\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 4}, "r"}}, {}, false});
  });
  AddCase("glsl", "rewrite.zero_times_vector", [](Run& run) {
    const char* text =
        "  vec2 t = -p.zw, m = mod(b.yw, p.xz);\n  vec2 r = (t - t) * mat2(vec2(-p.x, p.z), p.yw);\n"
        "  vec3 s = vec3(a.x, vec2(-1.0)) * (m - m).xyy;\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 2}, "r"}, {{Base::kFloat, 3}, "s"}}, {}, false});
  });
  // 1 / sqrt as drivers for Direct3D 9 spell it: a minimum, which is no NaN where the operand is one.
  AddCase("glsl", "rewrite.limited_inverse_root", [](Run& run) {
    const char* text =
        "  float x = abs(uintBitsToFloat(pi.x == 0x7fffffff ? 0x3f800000u : 0x7fc00000u)), y = abs(a.y);\n"
        "  float r = sqrt(x) == 0.0 ? 3.4028234663852886e+38 : inversesqrt(x);\n"
        "  float s = sqrt(y) == 0.0 ? 3.4028234663852886e+38 : inversesqrt(y);\n";
    evaluate(run, Stage::kCompute, {"", text, {{{Base::kFloat, 1}, "r"}, {{Base::kFloat, 1}, "s"}}, {}, false});
  });
  AddCase("glsl", "discard.then_derivative", [](Run& run) {
    fragment_expression(run, "vec4(dFdx(passed.x), dFdy(passed.y), passed.zw)", "  if (passed.x > 0.3) discard;\n");
  });
  AddCase("glsl", "discard.in_loop", [](Run& run) {
    fragment_expression(run, "passed", "  for (int k = 0; k < 8; ++k) if (passed.x * float(k) > 3.0) discard;\n");
  });
  AddCase("glsl", "return.early", [](Run& run) {
    fragment_expression(run, "passed * 0.5",
                        "  result = vec4(1.0);\n  if (passed.y > 0.0) { result = passed.wzyx; return; }\n");
  });
  return true;
}();

CTS_CASE("glsl", "builtin.VertexIndex_InstanceIndex") {
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) out vec4 passed;
void main() {
  passed = vec4(gl_VertexIndex, gl_InstanceIndex, 0.0, 1.0);
  gl_Position = vec4(float(gl_VertexIndex % 7) / 4.0 - 0.9, float(gl_InstanceIndex) / 3.0 - 0.9 + float(gl_VertexIndex & 1) * 0.2, 0.5, 1.0);
  gl_PointSize = 5.0;
})";
  spec.fragment =
      "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\n"
      "void main() { result = vec4(passed.xy, gl_PointCoord); }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 9, 4, 3, 1);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("glsl", "clip_and_cull_distance") {
  run.require(run.gpu.features.shaderClipDistance, "shaderClipDistance");
  run.require(run.gpu.features.shaderCullDistance, "shaderCullDistance");
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[2]; float gl_CullDistance[1]; };
void main() {
  passed = color;
  gl_Position = position;
  gl_ClipDistance[0] = color.x - 0.3;
  gl_ClipDistance[1] = 0.8 - color.y;
  gl_CullDistance[0] = color.z - 0.5;
})";
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values;
  for (int i = 0; i < 3 * 10; ++i) {
    for (const float v : {run.random.real(-1, 1), run.random.real(-1, 1), 0.5f, 1.0f}) values.push_back(v);
    for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
  }
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 30, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
