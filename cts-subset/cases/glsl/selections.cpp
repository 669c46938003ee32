// Selections and branches with a literal side, and conversions to integers that are undefined: what the reference's
// optimiser makes of them shows in denormals and in integers.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"
#include "harness/execute.h"

namespace vitrine::cts {
namespace {

constexpr Type kVec4{Base::kFloat, 4}, kUint4{Base::kUint, 4};

/// Fragments over special values: `statements` define r0, r1, ... of `type`.
void evaluate_specials(Run& run, Type type, int results, const std::string& statements) {
  ShaderBody body;
  body.statements = statements;
  for (int k = 0; k < results; ++k) body.results.push_back({type, "r" + std::to_string(k)});
  body.specials = true;
  evaluate(run, Stage::kFragment, body);
}

CTS_CASE("glsl", "selected_values") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  evaluate_specials(run, kVec4, 12,
                    "  vec4 r0 = b * (i.x == 3 ? a : vec4(1.0)), r1 = b * (i.x > 3 ? a * p : vec4(1.0));\n"
                    "  vec4 r2 = b - (i.x > 3 ? a : vec4(0.0)), r3 = b / (a.x > 3.0 ? a : vec4(1.0));\n"
                    "  vec4 product = a * a + p, r4 = b * (i.x > 3 ? product : vec4(1.0)), r5 = product;\n"
                    "  vec4 r6 = b * (i.x > 3 ? sin(a) : vec4(1.0)), r7 = b * (i.x > 3 ? floor(a) : vec4(1.0));\n"
                    "  vec4 r8 = b * (i.x > 3 && a.y > 1.0 ? a : vec4(1.0));\n"
                    "  vec4 r9 = b * (i.x > 3 ? vec4(a.x * a.y) : vec4(1.0));\n"
                    "  vec4 r10 = a - pow(abs(b), p), r11 = a.yxwz - pow(b, b);\n");
}

CTS_CASE("glsl", "branched_values") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  evaluate_specials(run, kVec4, 6,
                    "  vec4 c = vec4(1.0), d = vec4(1.0), e = vec4(1.0), f = vec4(-0.0);\n"
                    "  if (a.x > 3.0) c = in_a[id ^ 1u]; else d = in_a[id ^ 2u];\n"
                    "  if (i.x > 3) e = in_a[id ^ 1u]; else f = in_a[id ^ 2u];\n"
                    "  vec4 r0 = b * c, r1 = b / d, r2 = b * e, r3 = b + f;\n"
                    "  vec4 r4 = b * (isnan(b.w) ? p : vec4(1.0, -10.0, 1.0, 0.5)), r5 = vec4(3.0);\n"
                    "  if (a.y > 0.0) {\n"
                    "    vec4 g;\n"
                    "    if (a.z > 3.0) g = in_a[id ^ 1u]; else g = vec4(1.0);\n"
                    "    r5 = b * g;\n"
                    "  }\n");
}

// Both branches compute something, on conditions of every kind.
CTS_CASE("glsl", "both_branches_values") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  std::string statements;
  const char* const conditions[] = {"a.x > 3.0", "a.y >= 3.0",      "a.z == 3.0", "b.x != 3.0",
                                    "b.y > 2.0", "!(a.w == 255.0)", "i.x > 3",    "b.z <= a.w"};
  for (int k = 0; k < 8; ++k) {
    const std::string n = std::to_string(k), other = k % 2 ? "in_a[id ^ 2u]" : "sqrt(a)";
    statements += "  vec4 g" + n + ", d" + n + "; if (" + conditions[k] + ") { g" + n + " = in_a[id ^ 1u]; d" + n +
                  " = vec4(1.0); } else { g" + n + " = vec4(1.0); d" + n + " = " + other + "; }\n  vec4 r" +
                  std::to_string(2 * k) + " = b * g" + n + ", r" + std::to_string(2 * k + 1) + " = b / d" + n + ";\n";
  }
  evaluate_specials(run, kVec4, 16, statements);
}

// Branches in branches, and conditions of every kind.
CTS_CASE("glsl", "nested_branched_values") {
  const std::string head = "  vec4 r0 = vec4(3.0), r1 = r0, r2 = r0, r3 = r0, r4 = r0, r5 = r0, r6 = r0, r7 = r0;\n";
  const auto inner = [](const std::string& condition, int k) {
    const std::string g = "g" + std::to_string(k);
    return "vec4 " + g + "; if (" + condition + ") " + g + " = in_a[id ^ 1u]; else " + g + " = vec4(1.0); r" +
           std::to_string(k) + " = b * " + g + ";";
  };
  evaluate_specials(run, kVec4, 8,
                    head + "  if (a.y > 0.0) { " + inner("a.z > 3.0", 0) + " } else { " + inner("i.z > 3", 1) + " }\n" +
                        "  if (!(a.y > 0.5)) { " + inner("a.z > 2.0", 2) + " }\n" +
                        "  if (i.y > 2) { r3 = a + p; } else { " + inner("a.z != 3.0", 3) + " }\n" +
                        "  if (!(a.y > 0.25)) { r4 = a + p; } else { " + inner("!(a.z > 1.0)", 4) + " }\n" +
                        "  if (a.y >= 0.0) { " + inner("a.z <= 3.0", 5) + " }\n" +
                        "  if (a.x > 0.5) { r6 = a + p; } else { " + inner("a.w > 1.0", 6) + " }\n" +
                        "  if (a.x > 0.75) { r7 = in_b[id ^ 1u]; } else { " + inner("a.w > 2.0", 7) + " }\n");
}

CTS_CASE("glsl", "compared_branched_values") {
  std::string statements;
  const char* const conditions[] = {"b.y > 1.0",     "!(b.y > 1.0)", "b.y != 1.0",
                                    "!(b.y != 1.0)", "b.y <= 1.0",   "i.x > 3"};
  for (int k = 0; k < 12; ++k) {
    const std::string n = std::to_string(k);
    statements += "  vec4 g" + n + "; if (" + conditions[k / 2] + ") g" + n + " = " + (k % 2 ? "in_a[id ^ 1u]" : "p") +
                  "; else g" + n + " = vec4(1.0);\n  vec4 r" + n + " = a * g" + n + ";\n";
  }
  evaluate_specials(run, kVec4, 12, statements);
}

/// What the two branches of a form do besides writing the factor g; K: a number that tells the blocks apart.
struct MaskedForm {
  const char* name;
  const char* then_block;
  const char* else_block;
};

std::string numbered(std::string text, int k) {
  for (size_t at; (at = text.find('K')) != std::string::npos;) text.replace(at, 1, std::to_string(k));
  return text;
}

/// Denormals multiplied by what two branches write to g: by conditions of every kind, used once or for a selection,
/// too.
void evaluate_masked(Run& run, const MaskedForm& form, bool selects, const char* joined = "b.z > K. || a.z < -K.") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  const char* const conditions[] = {"a.x > K.5",
                                    "b.y >= K.5",
                                    "fract(a.z) == 0.0",
                                    "fract(b.w) != 0.0",
                                    "!(a.y > K.5)",
                                    "!(b.z >= K.5)",
                                    "!(fract(a.w) == 0.0)",
                                    "!(fract(b.x) != 0.0)",
                                    "isnan(a.z * K.)",
                                    "!isnan(b.y * K.)",
                                    "i.x > K",
                                    "i.y == K",
                                    "!(i.z > K)",
                                    "bool(u.x & Ku)",
                                    "b.x < K. && a.x > K.",
                                    joined};
  ShaderBody body;
  body.statements =
      "  vec4 r0, r1, r2, r3 = vec4(0.0), r4 = vec4(0.0), r5 = vec4(0.0), r6 = vec4(0.0), r7 = vec4(0.0);\n";
  for (int k = 0; k < 16; ++k) {
    const std::string n = std::to_string(k / 4), component = std::string(".") + "xyzw"[k % 4];
    body.statements += "  { bool c = " + numbered(conditions[k], k + 1) + "; float g, d = 0.0; if (c) { " +
                       numbered(form.then_block, k) + " } else { " + numbered(form.else_block, k) + " } r" + n +
                       component + " = uintBitsToFloat(id * 3u + 7u) * g; r" + std::to_string(k / 4 + 4) + component +
                       " = " + (selects ? "c ? d : 5.0" : "d") + "; }\n";
  }
  for (int k = 0; k < 8; ++k) body.results.push_back({kVec4, "r" + std::to_string(k)});
  body.specials = true;
  evaluate(run, Stage::kVertex, body);
}

// A literal that one of two branches writes: the reference selects it by the masks of the branches, and whether that is
// a selection by the condition depends on what else the masks serve.
const bool kMaskedForms = [] {
  static const MaskedForm kForms[] = {
      {"loads", "g = in_a[id ^ (Ku & 3u)].y;", "g = 1.0;"},
      {"computes_stores", "g = sqrt(a.y + K.); results[id] = uvec4(K);", "g = 1.0;"},
      {"both_load", "g = in_a[id ^ (Ku & 3u)].y; d = 2.0;", "g = 1.0; d = in_b[id ^ (Ku & 3u)].z;"},
      {"loads_computes", "g = in_a[id ^ (Ku & 3u)].y; d = 2.0;", "g = 1.0; d = sqrt(a.x + K.);"},
      {"computes_else_stores", "g = sqrt(a.y + K.);", "g = 1.0; results[id] = uvec4(K);"},
      {"pushed_stores", "g = p.y;", "g = 1.0; results[id] = uvec4(K);"},
      {"other_literal", "g = sqrt(a.y + K.); d = in_b[id ^ (Ku & 3u)].z;", "g = 1.0; d = 2.0;"},
      {"same_literal", "g = sqrt(a.y + K.); d = in_b[id ^ (Ku & 3u)].z;", "g = 1.0; d = 1.0;"},
      {"then_literal_loads", "g = 1.0;", "g = in_a[id ^ (Ku & 3u)].y;"},
      {"then_literal_stores", "g = 1.0; results[id] = uvec4(K);", "g = sqrt(a.y + K.);"},
      {"then_literal_both", "g = 1.0; results[id] = uvec4(K);", "g = in_a[id ^ (Ku & 3u)].y;"},
      {"then_literal_else_stores", "g = 1.0;", "g = sqrt(a.y + K.); results[id] = uvec4(K);"},
      {"then_literal_other_literal", "g = 1.0; d = in_b[id ^ (Ku & 3u)].z;", "g = sqrt(a.y + K.); d = 2.0;"},
      {"then_literals", "g = 1.0; d = 2.0;", "g = sqrt(a.y + K.); d = in_b[id ^ (Ku & 3u)].z;"}};
  for (const MaskedForm& form : kForms)
    for (const bool selects : {false, true})
      AddCase("glsl", std::string("masked_selections.") + form.name + (selects ? "_used_twice" : ""),
              [&form, selects](Run& run) { evaluate_masked(run, form, selects); });
  return true;
}();

// A condition that joins three: its complement is that of a mask.
CTS_CASE("glsl", "masked_selections.joins_three") {
  evaluate_masked(run, {"", "g = 1.0;", "g = in_a[id ^ (Ku & 3u)].y;"}, false, "b.x < 3.0 && a.x > 3.0 && a.y < K.");
}

// Literals that convert to no integer, selected or as the source of further integers.
CTS_CASE("glsl", "undefined_conversions") {
  run.mutates = false;
  evaluate_specials(run, kUint4, 4,
                    "  uvec4 r0 = uvec4(i.x > 3 ? abs(b) + abs(b) : vec4(-3.0));\n"
                    "  uvec4 r1 = uvec4(a.x > 3.0 ? abs(b) : vec4(-3.0));\n"
                    "  uvec4 r2 = uvec4(a.x > 3.0 && b.x < 1.0 ? abs(a + b) : vec4(5e9));\n"
                    "  vec4 bent = refract(b, vec4(1.7), atanh(abs(3.0)));\n"
                    "  uvec4 r3 = uvec4(ivec4(pow(bent, vec4(4.0))) ^ pi.w);\n");
}

CTS_CASE("glsl", "undefined_comparisons") {
  run.mutates = false;
  evaluate_specials(
      run, kVec4, 4,
      "  float q = a.x / 0.0, s = p.x / 0.0;\n"
      "  vec4 r0 = vec4(q == b.x, q < b.y, q >= b.z, q != b.w);\n"
      "  vec4 r1 = vec4(b.x < s ? a.x : b.x, b.y >= s ? a.y : b.y, s == q ? a.z : b.z, isnan(q) ? a.w : b.w);\n"
      "  vec4 r2 = b, r3 = vec4(a.x / -0.0 == b.x, q > 5.0, q != 5.0, s <= 0.0);\n"
      "  if (q == b.y * 3.0) r2 = a;\n");
}

// A push constant that was loaded before, though the value is not used, makes a branch that loads it small.
CTS_CASE("glsl", "repeated_loads") {
  evaluate_specials(run, kVec4, 1,
                    "  vec4 r0 = p;\n"
                    "  r0 = smoothstep((2654435761u > u.z) ? p : b, (2654435761u > u.z) ? p : b, a);\n");
}

// A vector of words, some of which were loaded before, is another vector in each load of a variable that holds it.
CTS_CASE("glsl", "copies_of_loads") {
  evaluate_specials(run, kVec4, 3,
                    "  float first = p.y;\n  vec4 r2 = vec4(first) * b;\n"
                    "  vec4 q = p;\n  vec4 r0 = mat4(q, p, q, vec4(b.x)) * a.xwwz;\n"
                    "  q = p.yyxx;\n  vec4 r1 = mat4(p, q, q, vec4(b.x)) * a.xwwz;\n");
}

// What is added to a negated value is subtracted from: a selected zero is no identity then.
CTS_CASE("glsl", "subtracted_selections") {
  evaluate_specials(run, kVec4, 3,
                    "  vec4 r0 = (-a.zywx) - (p.w >= b.w ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  vec4 r1 = (b.x >= b.y ? vec4(-0.0, 0.3, 255.0, -0.0) : b.zzxx) - a;\n"
                    "  vec4 r2 = a - (b.z >= b.w ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n");
}

// A number is equal to itself or is not, which the reference finds after its rules.
CTS_CASE("glsl", "selections_by_everything") {
  evaluate_specials(run, kVec4, 8,
                    "  bvec2 x = bvec2(isnan(b.w), b.w == b.w), y = bvec2(b.x == a.y, b.x != a.y);\n"
                    "  vec4 r0 = a - (any(x) ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  vec4 r1 = a - (all(x) ? b.zzxx : vec4(0.0, 0.3, 255.0, -0.0));\n"
                    "  vec4 r2 = a - (any(y) ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  vec4 r3 = a - (any(bvec2(a.y != b.x, y.x)) ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  bool less = a.y < b.x;\n"
                    "  vec4 r4 = a - (any(x) || less ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  vec4 r5 = a - (less && all(x) ? b.zzxx : vec4(0.0, 0.3, 255.0, -0.0));\n"
                    "  vec4 r6 = a - (any(x) && less ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n"
                    "  vec4 r7 = a - (isnan(a.z) || a.z >= a.z ? vec4(0.0, 0.3, 255.0, -0.0) : b.zzxx);\n");
}

// A negated product is that of a negated factor: of the selection, which has no identity then, or of the other.
CTS_CASE("glsl", "negated_selections") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  evaluate_specials(
      run, kVec4, 8,
      "  vec4 r0 = -(b * step(a, vec4(0.25))), r1 = -(abs(b) * (a.x < a.w ? vec4(1.0) : a.zzzz));\n"
      "  vec4 r2 = -((b.x < a.x ? vec4(1.0) : a) * abs(b)), r3 = -(min(b, a.y) * (a.y < b.y ? 1.0 : a.z));\n"
      "  vec4 r4 = -(max(b, b.y) * (a.z < b.x ? 1.0 : a.z)), r5 = b.x - b * (a.y < 0.5 ? 1.0 : a.x);\n"
      "  vec4 r6 = -((a.x < a.w ? p : b) * (a.x < a.y ? 1.0 : a.z));\n"
      "  vec4 r7 = -((i.x < i.y ? p : b) * (i.z < i.y ? 1.0 : a.z * b.x));\n");
}

// The minimum and maximum of two zeros that the compiler folds is the second.
CTS_CASE("glsl", "folded_extrema") {
  evaluate_specials(
      run, kVec4, 4,
      "  vec4 z = vec4(0.0, -0.0, 0.0, -0.0);\n"
      "  vec4 r0 = max(z.wzyx, z), r1 = min(z.wzyx, z);\n"
      "  vec4 r2 = clamp(z.wzyx, vec4(0.0), b), r3 = max(-roundEven(vec4(-0.1, 255.0, 0.0, -1.0)), z);\n");
}

// What is limited to zero is of any sign to the rules: a comparison with it is computed.
CTS_CASE("glsl", "extrema_with_zero") {
  evaluate_specials(run, kVec4, 2,
                    "  vec4 zero = b - b, r0 = -step(0.3, clamp(a, vec4(0.0), zero)) * b;\n"
                    "  vec4 r1 = -step(min(max(a, zero), 0.0), vec4(-0.3)) * b;\n");
}

// A selection may be NaN to the code generator, whatever it selects: the minimum and maximum of two zeros is the
// second.
CTS_CASE("glsl", "extrema_of_selections") {
  evaluate_specials(run, kVec4, 2,
                    "  vec4 r0 = max(b.x == a.z ? vec4(-1.0) : min(a, 1.7), -abs(b) * p.x);\n"
                    "  vec4 r1 = min(b.x == a.z ? vec4(-1.0) : max(a, -1.7), abs(b) * -p.x);\n");
}

// Loops that the compiler unrolls around an exit that is not counted, and branches that it finds to be constant one by
// one: which sums the rules see as one expression, round by round, decides the last bits.
CTS_CASE("glsl", "unrolled_exits") {
  evaluate_specials(
      run, kVec4, 3,
      "  vec4 r0 = a, r1 = vec4(a.y), r2 = a;\n"
      "  for (int k = 0; k < 7; ++k) { if (pi.x == i.z) break; r0 = (r0.xzww + 1.0) - p; }\n"
      "  if ((u.y & 3u) == 0u) for (int k = 0; k < 7; ++k) { if (pi.x == i.z) break; r1 = (r1.xzww - (-1.0)) - p; }\n"
      "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n"
      "  r2 = (-1.0) * b.wwwx;\n"
      "  if (false) { int k = 1; while (k-- > 0) r2 = vec4(b.w); }\n"
      "  array[(i.y & 0x7fffffff) % 7] = r2.y;\n"
      "  r2 = vec4(0.0);\n"
      "  for (int k = 0; k < 7; ++k) r2 += array[k];\n");
}

// Elements of local arrays are what was stored to them last, and the rules see it.
CTS_CASE("glsl", "forwarded_elements") {
  evaluate_specials(
      run, kVec4, 3,
      "  float array[7] = float[7](a.x, a.y, a.z, a.w, b.x, b.y, b.z);\n  vec4 pairs[2] = vec4[2](a, p);\n"
      "  array[2] = 1.0;\n  pairs[1].yz = vec2(2.0, 0.5);\n"
      "  vec4 r0 = vec4(0.0), r2 = vec4(array[i.x & 3]);\n"
      "  for (int k = 0; k < 7; ++k) r0 += array[k];\n"
      "  vec4 r1 = (pairs[0] * b) * pairs[1];\n"
      "  if (i.y > 0) { pairs[0].x = p.z; array[1] = b.y; }\n"
      "  for (int k = 0; k < (i.z & 3); ++k) { r2 += array[1] * pairs[0]; array[k] = p.x; }\n"
      "  r2 += array[2] + array[0];\n");
}

// Branches that keep several x or multiply them by one y: the multiplication is computed where x is kept, too.
CTS_CASE("glsl", "shared_selections") {
  evaluate_specials(run, kVec4, 1, "  vec4 r0 = isinf(a.y * 0.3) ? b : b * p.wxzz;\n");
}

// Booleans that become floats before they are selected are no literals; nor is the power of zero, which is computed.
CTS_CASE("glsl", "selected_numbers") {
  evaluate_specials(run, kVec4, 2,
                    "  vec4 r0 = b * (a.x > a.y ? float(b.x > a.z) : float(b.y > a.w));\n"
                    "  vec4 base = a.wzxy + vec4(3.0, 255.0, 0.5, 1.0) - b.yyww * vec4(0.0, 3.0, 3.0, 1.0);\n"
                    "  vec4 r1 = -b * pow(base.yxzw, vec4(0.0, 3.0, 0.0, 0.0));\n");
}

// The sign of zero is selected; what subtracts it keeps denormals.
CTS_CASE("glsl", "subtracted_signs") {
  run.require(reference_cpu().uint_comparable, "what the reference does on this CPU");
  evaluate_specials(
      run, kVec4, 5,
      "  vec4 r0 = a - sign(b), r1 = a - sign(floor(b * 0.25)), r2 = a + sign(b.wzyx), r3 = sign(a * b) - a;\n"
      "  vec4 shared_sign = sign(b.yxwz), r4 = (a - shared_sign) + (a.wzyx - shared_sign);\n");
}

/// Branches whose condition `conditions[k]` is decided without running the shader: to a root where `ones[k]` is '0', to
/// 1 otherwise. The literal 1 is then a factor, which leaves denormals alone. Mutants would ask for other comparisons
/// that the reference may decide: a class of its own (known-differences.txt), which would hide what else they find.
void compare_decided(Run& run, std::span<const char* const> conditions, std::string_view ones) {
  run.mutates = false;
  std::string statements;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const std::string n = std::to_string(k), root = "sqrt(a.y + " + n + ".)";
    const bool then = ones[k] == '1';
    if (k % 4 == 0) statements += "  vec4 r" + std::to_string(k / 4) + ";\n";
    statements += "  float g" + n + "; if (" + conditions[k] + ") g" + n + " = " + (then ? "1.0" : root) + "; else g" +
                  n + " = " + (then ? root : "1.0") + ";\n  r" + std::to_string(k / 4) + "[" + std::to_string(k % 4) +
                  "] = uintBitsToFloat(id * 3u + 7u) * g" + n + ";\n";
  }
  evaluate_specials(run, kVec4, static_cast<int>(conditions.size() / 4), statements);
}

// Comparisons with literals that known bits decide.
CTS_CASE("glsl", "late_comparisons") {
  constexpr const char* kConditions[] = {"int(u.x & 14u) < 0",
                                         "int(u.y & 7u) >= 0",
                                         "(u.z & 14u) < 100u",
                                         "(u.w >> 4u) >= 0x20000000u",
                                         "(u.x & 3u) == 5u",
                                         "(u.y & 3u) != 9u",
                                         "int(u.z >> 1u) < -3",
                                         "int(u.x & 14u) < 3",
                                         "(u.x & 14u) == 3u",
                                         "(u.y & 10u) != 5u",
                                         "(u.z | 4u) == 3u",
                                         "(u.w | 8u) < 8u",
                                         "(u.x & 14u) < 15u",
                                         "(u.x ^ 14u) == 3u",
                                         "int(u.y | 0x80000000u) >= 0",
                                         "(u.w | 6u) >= 4u"};
  compare_decided(run, kConditions, "0110010001001001");
}

// The literal in front, bits of both operands, and bits of what integers are made of.
CTS_CASE("glsl", "known_bits") {
  constexpr const char* kConditions[] = {"(u.x & 14u) <= 15u",
                                         "15u < (u.y & 14u)",
                                         "(u.z & 3u) < (u.w | 4u)",
                                         "(u.x & 3u) == (u.y | 4u)",
                                         "int(u.z & 0x8000000fu) < 16",
                                         "(u.w & 3u) << 2u == 2u",
                                         "int(u.x | 0x80000000u) >> 4 >= 0",
                                         "~(u.y | 1u) == 1u",
                                         "(u.z & 6u) * 4u == 4u",
                                         "(u.w & 7u) * 3u > 21u",
                                         "((u.x & 3u) - 8u) < 4294967288u",
                                         "bitCount(u.y) > 32",
                                         "(u.z & 7u) % 5u == 5u",
                                         "(u.w >> 28u) / 3u > 5u",
                                         "max(u.x, 9u) < 9u",
                                         "min(u.y & 12u, u.z & 3u) >= 4u",
                                         "-int(u.w | 1u) == 4",
                                         "((u.x | 1u) ^ 5u) == 5u",
                                         "(u.y > u.z ? u.w & 7u : 9u) > 9u",
                                         "(u.x | 3u) - (u.y & 29u) == 4096u"};
  compare_decided(run, kConditions, "10101000001000000000");
}

// Ranges of operations that do not overflow, and equalities that say something about the operand behind such ones.
CTS_CASE("glsl", "known_ranges") {
  constexpr const char* kConditions[] = {"(u.x >> 17u) + 17u >= 10u",
                                         "int((u.y & 14u) - 4u) > 32",
                                         "(u.z & 1u) + 5u == 4u",
                                         "(u.w | 8192u) - 14u == 1u",
                                         "(u.x >> 15u) * 45u == 32u",
                                         "(u.y | 372u) / 40u >= 7u",
                                         "(u.z & 65536u) / 21u == 7u",
                                         "int(u.w | 32768u) >> 8 == 589049585",
                                         "(u.x > u.y ? u.z | 6u : u.w | 9u) == 4u",
                                         "min(u.x & 16777216u, u.y | 31u) == 39u",
                                         "(u.z > u.w ? u.x | 23u : 33u) >= 21u",
                                         "int(max(u.y & 268435456u, 31u)) <= 4",
                                         "(u.z | 16u) % 13u != (u.w | 16u)",
                                         "((u.x & 33u) >> 9u & 10u) == ((u.y & 3u) >> 8u)",
                                         "(u.z | 28118852u) / 10u != 33554432u",
                                         "int(u.w) / 7 > 306783378",
                                         "(u.x | 8192u) - 14u < 1u",
                                         "(u.y | 256u) - 8u >= 8u",
                                         "7u < (u.z | 256u) - 8u",
                                         "3u >= (u.w & 12u) + 4294967264u"};
  compare_decided(run, kConditions, "10000100001011100110");
}

// Whether a quotient equals a literal is asked of the dividend: its bits tell, and the range of what is no overflow.
CTS_CASE("glsl", "known_quotients") {
  constexpr const char* kConditions[] = {"(u.x | 8192u) / 14u == 1u",
                                         "(u.y & 27u) / 14u == 2u",
                                         "((u.z & 255u) | 64u) / 14u == 1u",
                                         "int((u.w & 255u) | 64u) / 14 == 1",
                                         "int((u.x & 255u) | 64u) / 14 == 30",
                                         "int(u.y & 255u) / 14 == -1",
                                         "int(u.z | 2147483648u) / 14 == 3",
                                         "int(u.w | 2147483648u) / 14 == 0",
                                         "(u.x & 2147483647u) / 1000u == 4294967u",
                                         "(u.y | 8192u) / 4096u == 1u",
                                         "((u.z | 8192u) - 14u) / 14u == 1u",
                                         "min(u.w & 255u, 77u) / 14u == 9u",
                                         "((u.x >> 17u) + 17u) / 5u == 2u",
                                         "((u.y & 255u) | 64u) / 14u + 3u == 4u",
                                         "(u.z | 8192u) / 14u * 3u == 3u",
                                         "u.w / 1000u == 4294968u",
                                         "int(u.x & 2147483647u) / 14 == -1",
                                         "int(u.y & 2147483647u) / 14 == 153391690",
                                         "int(min(u.z | 1024u, 15u)) / 10 >= 214748364",
                                         "int((u.w | 27u) - 14u) / 5 == -4",
                                         "int((u.x >> 18u) + 6u) / 4096 < -53030",
                                         "((u.y >> 10u) + 2115u) / 16u == 3u",
                                         "max(u.z & 13134703u, 769u) / 7u == 14u",
                                         "int(u.w >> 25u) / 4096 <= -3338530"};
  compare_decided(run, kConditions, "000000000000000000000000");
}

// Extrema of unsigned numbers, asked as signed ones.
CTS_CASE("glsl", "known_extrema") {
  constexpr const char* kConditions[] = {"int(min(u.x | 18u, 28773u)) < 12", "int(min(u.y | 18u, 28773u)) > 28773",
                                         "int(max(u.z << 14u, 75476063u)) < int(u.z << 14u)",
                                         "int(max(u.w << 9u, 511u)) < int(u.w << 9u)"};
  compare_decided(run, kConditions, "0000");
}

// Quotients and remainders of what has no sign: asked as signed numbers, and of divisors that are no literals.
CTS_CASE("glsl", "known_divisors") {
  constexpr const char* kConditions[] = {"int(((u.x >> 17u) + 17u) / 5u) < 2",
                                         "int(((u.y & 255u) | 64u) / 5u) < 12",
                                         "int((u.z | 255u) / 5u) < 51",
                                         "int((u.w % 1000u + 20u) / 5u) < 4",
                                         "(u.x & 25u) % (u.y | 31u) > (u.x & 25u)",
                                         "u.y % (u.z | 31u) < (u.z | 31u)",
                                         "u.z / (u.w | 31u) > u.z",
                                         "(u.w & 255u) / (u.x | 31u) > 255u",
                                         "(u.x & 255u) % (u.y & 15u | 1u) > 15u",
                                         "int(u.y & 255u) / int(u.z & 15u | 8u) > 31",
                                         "int(u.z & 255u) % int(u.w & 15u | 8u) > int(u.z & 255u)",
                                         "(u.w | 255u) / (u.x & 15u | 8u) == 0u",
                                         "u.x % max(u.y, 8u) >= max(u.y, 8u)",
                                         "u.y / ((u.z >> 4u) + 1u) > u.y",
                                         "u.z % (1u << (u.w & 7u)) > u.z",
                                         "((u.w & 2147483647u) | 62u) / (u.x >> 29u) != 0u",
                                         "u.x % min(u.y | 3u, 8u) > 15u",
                                         "(u.y | 2147483647u) % (8192u << (u.z & 15u)) < (8192u << (u.z & 15u))",
                                         "min(u.z & 255u, 215u) / (2147483647u << (u.w & 15u)) > 0u",
                                         "((u.w >> 29u) + 1663u) % ((u.x >> 24u) + 14u) >= 65062910u"};
  compare_decided(run, kConditions, "00000100000000010100");
}

// Sums beside literals: the operand's bits tell, unless something else reads the sum, too.
CTS_CASE("glsl", "known_sums") {
  constexpr const char* kConditions[] = {
      "(u.x | 372u) + 40u >= 7u",        "(u.y | 372u) + 40u < 28u",  "6u < (u.z | 372u) + 40u",
      "28u > (u.w | 372u) + 40u",        "(u.x | 244u) + 40u >= 9u",  "(u.y | 372u) + 41u >= 7u",
      "(u.z | 4294967280u) + 20u < 20u", "(u.w | 372u) + 40u >= 29u", "(u.x | 372u) + 60u >= 7u",
      "(u.x | 372u) + 60u != u.y",       "(u.y | 372u) + 80u == 7u",  "(u.y | 372u) + 80u < u.z"};
  compare_decided(run, kConditions, "101011111100");
}

// Operations beside their own operands.
CTS_CASE("glsl", "known_orders") {
  constexpr const char* kConditions[] = {"-int(u.x | 1u) == int(u.x | 1u)",
                                         "(u.y | 33u) != max(u.y | 33u, 26u)",
                                         "int(u.z | 11u) > int((u.z | 11u) | (u.w >> 27u))",
                                         "(u.w | 1u) >> 29u <= (u.w | 1u)",
                                         "(u.x > u.z ? u.y >> 23u : 658743351u) < u.y >> 23u",
                                         "(u.z | 13u) / 38u < (u.z | 13u)",
                                         "(u.w << 4u) % 40u > u.w << 4u",
                                         "(u.x >> 24u) + 25u >= u.x >> 24u",
                                         "-int(u.y >> 15u) <= int(u.y >> 15u)",
                                         "(u.z & 4u) % 37u == (u.z & 4u)",
                                         "(u.w >> 13u ^ 20u) != u.w >> 13u",
                                         "(u.x & 19u) >= (u.x & 19u) + 1u",
                                         "int(u.y >> 9u) <= int(u.y >> 9u) - 13",
                                         "(u.z | 960u) - 8u >= (u.z | 960u)",
                                         "((u.w | 14u) ^ 12u) > (u.w | 14u)",
                                         "((u.x & 25u) & (u.y | 31u)) != (u.x & 25u)",
                                         "int(max(u.y << 9u, 27u)) < int(u.y << 9u)",
                                         "int(u.z & 4096u) >> 3u <= int(u.z & 4096u)",
                                         "int(u.w >> 16u) < int(u.w >> 16u) - int(u.x >> 12u)",
                                         "min(u.y & 4u, 128u) != (u.y & 4u)"};
  compare_decided(run, kConditions, "00010101111000000100");
}

// Functions of literals that are found only in the reference's generator: what is 1 leaves the factor beside it alone.
CTS_CASE("glsl", "late_functions") {
  evaluate_specials(
      run, kVec4, 4,
      "  float n = 0.0 / b.w;\n"
      "  vec4 r0 = vec4(sqrt(1.0 - n), inversesqrt(4.0 + n) * 2.0, floor(1.5 + n), ceil(0.5 + n)) * a.z;\n"
      "  vec4 r1 = vec4(round(1.0 + n), trunc(1.5 + n), fract(n + 1.5) * 2.0, abs(1.0 + n)) * a.y;\n"
      "  vec4 r2 = vec4(float(int(n + 1.7)), float(uint(n + 1.0)), log2(n + 2.0), log2(n + 0.25) + 3.0) * a.x;\n"
      "  vec4 r3 = vec4(refract(a.wyw + vec3(0.25, 255.0, 3.0), a.wzz, n), length(vec2(n + 1.0, 0.0)) * a.w);\n");
}

// Quotients that are known to be zero make exponents literal, and the multiplication by 1 goes.
CTS_CASE("glsl", "late_literals") {
  evaluate_specials(run, kVec4, 4,
                    "  ivec4 small = (i & 255) / 1000003, none = pi.yzwx % 1 / pi.zxwy.x;\n"
                    "  vec4 r0 = ldexp(b, small), r1 = ldexp(b, none), r2 = ldexp(b, (small >> (i.wzyx & 31)) & 31);\n"
                    "  vec4 r3 = ldexp(b, (pi / 0) & 31);\n");
}

// What the rules take for the same value: sums of dot products read vectors, which differ in the order of their parts;
// literals of built-in functions are values of their own; three booleans are joined from the last to the first.
CTS_CASE("glsl", "order_of_rules") {
  evaluate_specials(run, kVec4, 3,
                    "  vec4 t0 = pow(a, p.zxzz), t1 = abs(a);\n"
                    "  vec4 r0 = vec4(1.7 * (p.yy * mat2(a.zw, a.wz)), 1.7 * (p.ww * mat2(b.zw, b.wz)));\n"
                    "  vec4 r1 = vec4(atanh(-0.25) + sinh(a.zxx), 0.0);\n"
                    "  float y = all(greaterThan(u.ywx, u.wyy)) ? t0.x : t1.w;\n"
                    "  vec4 r2 = vec4(distance(atan(vec2(pow(abs(10.0), p.z), y), b.xy), a.xy));\n");
}

}  // namespace
}  // namespace vitrine::cts
