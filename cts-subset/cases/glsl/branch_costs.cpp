// Branches of every size around the one that the reference turns into selections: what an operation counts there shows
// in the last bits of a product with a literal, which its rules see through selections only.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kSizes = 8;

/// An expression of an integer; K: a number that tells the branches apart.
struct CostForm {
  const char* name;
  const char* value;
};

std::string numbered(std::string text, uint32_t k) {
  for (size_t at; (at = text.find('K')) != std::string::npos;) text.replace(at, 1, std::to_string(k));
  return text;
}

/// Branches with the expression and 0 to 7 operations more, at once and after rules have removed eight others.
void evaluate_costs(Run& run, const CostForm& form) {
  static const char* const fillers[] = {"q ^= i.y;", "q += i.z;", "q ^= i.w;", "q += i.x;",
                                        "q ^= i.z;", "q += i.w;", "q ^= i.x;"};
  ShaderBody body;
  body.statements = "  vec4 r0, r1, r2, r3;\n  ivec4 q0, q1, q2, q3;\n";
  for (uint32_t k = 0; k < 2 * kSizes; ++k) {
    const std::string n = std::to_string(k / 4), component = std::string(".") + "xyzw"[k % 4];
    std::string fill;
    for (uint32_t f = 0; f < k % kSizes; ++f) fill += std::string(" ") + fillers[f];
    if (k >= kSizes)
      for (int f = 0; f < 8; ++f) fill += " q += 0;";
    body.statements += numbered("  { float s; int q = 0; if (i.x > K) { s = K.7; q = int(" + std::string(form.value) +
                                    ");" + fill + " } else s = a.x * K.3; ",
                                k + 1) +
                       "r" + n + component + " = s * 1.7; q" + n + component + " = q; }\n";
  }
  for (const char* n : {"0", "1", "2", "3"}) {
    body.results.push_back({{Base::kFloat, 4}, std::string("r") + n});
    body.results.push_back({{Base::kInt, 4}, std::string("q") + n});
  }
  evaluate(run, Stage::kCompute, body);
}

const bool kCosts = [] {
  static const CostForm kForms[] = {
      {"extract_u", "bitfieldExtract(u.x, i.y, i.z)"},
      {"extract_i", "bitfieldExtract(i.x, i.y, i.z)"},
      {"extract_u_lit", "bitfieldExtract(u.x, K, 7)"},
      {"extract_i_lit", "bitfieldExtract(i.x, K, 7)"},
      {"extract_u0", "bitfieldExtract(u.x, 0, K)"},
      {"extract_vec", "bitfieldExtract(u, i.y, i.z).x ^ bitfieldExtract(u, i.y, K).y"},
      {"insert", "bitfieldInsert(i.x, i.y, i.z, i.w)"},
      {"insert_lit", "bitfieldInsert(i.x, i.y, K, 7)"},
      {"insert_insert", "bitfieldInsert(bitfieldInsert(u.x, K, 3, 7), u.x, i.y, i.w)"},
      {"insert_pack", "bitfieldInsert(packUnorm2x16(a.xy * K.5), u.x, 3, i.w)"},
      {"msb_i", "findMSB(i.y + K)"},
      {"msb_u_k", "findMSB(u.y + Ku)"},
      {"bool_equal", "(i.y > K) == (i.z > K)"},
      {"bool_unequal", "(i.y > K) != (i.z > K)"},
      {"bool_equal_mix", "((i.y > K) == (a.z > K.0)) == (a.w < K.0)"},
      {"bool_equal_not", "!((i.y > K) == (i.z > K))"},
      {"bool_equal_true", "(i.y > K) == true"},
      {"bool_equal_ne", "((i.y > K) == ((a.z > K.0) != (a.w > K.5))) ? 3 : K"},
      {"bool_equal_3", "(((i.y > K) == (a.z > K.0)) == (a.w > K.5)) == (a.x > a.y) ? 3 : K"},
      {"bool_equal_f", "(float(i.y > K) == float(a.z > K.0)) ? 3 : K"},
      {"bool_equal_sel", "((i.y > K ? true : a.z > K.0) == false) ? 3 : K"},
      {"all", "all(greaterThan(i, ivec4(K)))"},
      {"any", "any(greaterThan(i.xyz, ivec3(K)))"},
      {"bnot", "dot(vec4(not(greaterThan(i, ivec4(K)))), a)"},
      {"equal4", "i == pi"},
      {"unequal3f", "a.xyz != p.xyz"},
      {"mod_lit", "i.y % 8"},
      {"umod_lit", "u.y % 8u"},
      {"sign", "sign(i.y)"},
      {"sign_f", "sign(a.y)"},
      {"clamp", "clamp(i.y, i.z, i.w)"},
      {"smoothstep", "smoothstep(a.y, a.z, a.w)"},
      {"smooth_unpack", "smoothstep(a.y, a.z, unpackUnorm2x16(u.y + Ku).x) * 100.0"},
      {"step", "step(a.y, a.z)"},
      {"mix", "mix(a.y, a.z, a.w)"},
      {"fmod", "mod(a.y, a.z)"},
      {"reflect", "reflect(a.xyz, b.xyz).x"},
      {"refract", "refract(a.xy, b.xy, a.z).x"},
      {"length4", "length(a)"},
      {"ldexp_k", "ldexp(a.y + K.5, i.z)"},
      {"ldexp_lit", "ldexp(a.y + K.5, 7)"},
      {"modf", "modf(a.y + K.5, r0.x)"},
      {"asinh", "asinh(a.y)"},
      {"pack_unorm4_k", "packUnorm4x8(a * K.5)"},
      {"pack_snorm4_k", "packSnorm4x8(a * K.5)"},
      {"pack_unorm2_k", "packUnorm2x16(a.xy * K.5)"},
      {"pack_snorm2_k", "packSnorm2x16(a.xy * K.5)"},
      {"unpack_pack", "packSnorm2x16(unpackUnorm2x16(u.y + Ku))"},
      {"unpack_unorm4_w", "unpackUnorm4x8(u.y + Ku).w * 1000.0"},
      {"unpack_unorm4_xy", "dot(unpackUnorm4x8(u.y + Ku).xy, a.xy)"},
      {"unpack_snorm4_k", "unpackSnorm4x8(u.y + Ku).z * 1000.0"},
      {"unpack_snorm2_k", "unpackSnorm2x16(u.y + Ku).x * 1000.0"},
      {"unpack_unorm2_k", "unpackUnorm2x16(u.y + Ku).y * 1000.0"},
  };
  for (const CostForm& form : kForms)
    AddCase("glsl", std::string("branch_costs.") + form.name, [&form](Run& run) { evaluate_costs(run, form); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
