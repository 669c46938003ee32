// Float controls (VK_KHR_shader_float_controls): zeros keep their sign, infinities and NaN arise and stay, where an
// execution mode asks for that; rounding to nearest even is what happens anyway.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Execution modes of SPV_KHR_float_controls for a width.
std::string modes(bool preserve, bool to_nearest, int width) {
  const std::string head = "spirv_execution_mode(extensions = [\"SPV_KHR_float_controls\"], capabilities = [";
  std::string text = "#extension GL_EXT_spirv_intrinsics : require\n";
  if (preserve) text += head + "4466], 4461, " + std::to_string(width) + ");\n";
  if (to_nearest) text += head + "4467], 4462, " + std::to_string(width) + ");\n";
  return text;
}

/// What rewrites that ignore zeros, infinities or NaN would change: f of the bits of a and b as floats.
constexpr const char* kExpressions[] = {
    "a * 0.0",
    "a + 0.0",
    "a - 0.0",
    "0.0 - a",
    "a - a",
    "a / a",
    "0.0 / a",
    "a * b - a * b",
    "-(a - b)",
    "-(-a + b)",
    "a * -1.0",
    "a * 1.0",
    "(a + b) - b",
    "a * 2.0 + a * 2.0",
    "a * b + a * 3.0",
    "min(a, b)",
    "max(a, b)",
    "clamp(a, b, 1.0)",
    "abs(-a)",
    "a < b ? a : b",
    "!(a < b) ? a : b",
    "sqrt(a) * sqrt(a)",
    "inversesqrt(a)",
    "mix(a, b, 0.0)",
    "mix(a, b, 1.0)",
    "step(a, b)",
    "sign(a)",
    "fract(a)",
    "floor(a) + fract(a)",
    "exp2(log2(a))",
    "pow(a, 2.0)",
    "mod(a, b)",
    "dot(vec2(a, 0.0), vec2(0.0, b))",
    "length(vec2(a, 0.0))",
    "a == a ? 1.0 : 2.0",
    "a != a ? 1.0 : 2.0",
    "(a > 0.0 && a < 0.0) ? 1.0 : b",
    "float(int(a == b)) * a",
};

/// NaN of any sign and payload are one: SPIR-V leaves them open.
constexpr const char* kStore = "uint bits(float f) { return isnan(f) ? 0x7fffffffu : floatBitsToUint(f); }\n";

std::vector<uint32_t> operands(Run& run) {
  const uint32_t special[] = {0,          0x80000000, 0x7f800000, 0xff800000, 0x7fc00000, 0x3f800000,
                              0xbf800000, 0x7f7fffff, 0xff7fffff, 0x00800000, 0x80800000, 0x40490fdb};
  std::vector<uint32_t> words;
  for (uint32_t a : special)
    for (uint32_t b : special) words.insert(words.end(), {a, b});
  while (words.size() < 2 * 256) words.push_back((run.random.bits() & 0x83ffffff) | 0x3c000000);
  return words;
}

/// Every expression for every pair of operands.
void run_expressions(Run& run, const std::string& header) {
  run.require(run.gpu.has("VK_KHR_shader_float_controls"), "VK_KHR_shader_float_controls");
  constexpr uint32_t kCount = std::size(kExpressions);
  std::string code = "// target: vulkan1.1\n" + header + "layout(local_size_x = 64) in;\n" + kStore +
                     "layout(std430, binding = 0) buffer A { vec2 x[]; };\n"
                     "layout(std430, binding = 1) buffer R { uint r[]; };\n"
                     "void main() {\n  uint i = gl_GlobalInvocationID.x, at = i * " +
                     std::to_string(kCount) + "u;\n  float a = x[i].x, b = x[i].y;\n";
  for (uint32_t k = 0; k < kCount; k++)
    code += "  r[at + " + std::to_string(k) + "u] = bits(" + kExpressions[k] + ");\n";
  code += "}\n";
  run.note("shader", code);
  const Buffer in = run.buffer_of(operands(run)), out = run.buffer(256 * 4 * kCount);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, 4);
  run.out("results", out);
}

CTS_CASE("float_controls", "none") { run_expressions(run, ""); }
CTS_CASE("float_controls", "signed_zero_inf_nan_preserve") { run_expressions(run, modes(true, false, 32)); }
CTS_CASE("float_controls", "rounding_rte") { run_expressions(run, modes(false, true, 32)); }
CTS_CASE("float_controls", "both") { run_expressions(run, modes(true, true, 32)); }
CTS_CASE("float_controls", "of_another_width") { run_expressions(run, modes(true, true, 16)); }

/// The same in a fragment shader, where denormals are flushed.
CTS_CASE("float_controls", "fragment") {
  run.require(run.gpu.has("VK_KHR_shader_float_controls"), "VK_KHR_shader_float_controls");
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_UINT}});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = "// target: vulkan1.1\n" + modes(true, true, 32) + kStore +
                  "layout(location = 0) in vec2 uv;\nlayout(location = 0) out uvec4 o;\n"
                  "void main() {\n"
                  "  float a = floor(uv.x * 8.0) - 4.0, b = 1.0 / (floor(uv.y * 8.0) - 4.0);\n"
                  "  o = uvec4(bits(a * 0.0), bits(a - a * b), bits(a / a + 0.0), bits(-(a - b) * 1.0));\n"
                  "}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
