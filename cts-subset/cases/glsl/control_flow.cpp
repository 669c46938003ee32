// Fixed shaders in which the shape of control flow decides what the reference's rules see.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr Type kVec4{Base::kFloat, 4};

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

}  // namespace
}  // namespace vitrine::cts
