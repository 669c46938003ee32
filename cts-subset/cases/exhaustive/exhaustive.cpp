// Functions of one 32-bit number, for every number: a generator per function whose cases are stretches of 2^20 numbers,
// so that --count=4096 covers all of them (a few by default, some hours for all).
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kStretch = 1u << 20, kStretches = 4096, kLocal = 64;
/// The stretch that begins with 1.0: the first one to be run.
constexpr uint32_t kStretch1 = 0x3f800000 / kStretch;

struct Row {
  const char* name;
  const char* code;  ///< of f (float) or u (its bits); float or uint
};

constexpr Row kRows[] = {
    {"sin", "sin(f)"},
    {"cos", "cos(f)"},
    {"tan", "tan(f)"},
    {"asin", "asin(f)"},
    {"acos", "acos(f)"},
    {"atan", "atan(f)"},
    {"sinh", "sinh(f)"},
    {"cosh", "cosh(f)"},
    {"tanh", "tanh(f)"},
    {"asinh", "asinh(f)"},
    {"acosh", "acosh(f)"},
    {"atanh", "atanh(f)"},
    {"exp", "exp(f)"},
    {"exp2", "exp2(f)"},
    {"log", "log(f)"},
    {"log2", "log2(f)"},
    {"sqrt", "sqrt(f)"},
    {"inversesqrt", "inversesqrt(f)"},
    {"reciprocal", "1.0 / f"},
    {"floor", "floor(f)"},
    {"ceil", "ceil(f)"},
    {"trunc", "trunc(f)"},
    {"round", "round(f)"},
    {"fract", "fract(f)"},
    {"sign", "sign(f)"},
    {"pow_of_itself", "pow(abs(f), f)"},
    {"float_to_int", "uint(int(f))"},
    {"float_to_uint", "uint(f)"},
    {"int_to_float", "float(int(u))"},
    {"uint_to_float", "float(u)"},
    {"pack_half", "packHalf2x16(vec2(f, 1.0))"},
    {"unpack_half", "dot(unpackHalf2x16(u), vec2(1.0, 0.5))"},
    {"pack_unorm_4x8", "packUnorm4x8(vec4(f, 0.0, 1.0, f))"},
    {"pack_snorm_4x8", "packSnorm4x8(vec4(f, 0.0, 1.0, f))"},
    {"pack_unorm_2x16", "packUnorm2x16(vec2(f, 0.5))"},
    {"pack_snorm_2x16", "packSnorm2x16(vec2(f, 0.5))"},
    {"unpack_unorm_4x8", "dot(unpackUnorm4x8(u), vec4(1.0, 3.0, 5.0, 7.0))"},
    {"unpack_snorm_4x8", "dot(unpackSnorm4x8(u), vec4(1.0, 3.0, 5.0, 7.0))"},
    {"ldexp", "ldexp(f, 3)"},
    {"frexp", "frexp(f, e) + float(e)"},
    {"find_msb", "uint(findMSB(u) + 100 * findMSB(int(u)) + 10000 * findLSB(u))"},
    {"bit_count", "uint(bitCount(u)) ^ bitfieldReverse(u)"},
};

/// NaN have one sign and payload (SPIR-V leaves them open).
void run_stretch(Run& run, const Row& row) {
  run.require(run.index < kStretches, "numbers that are not done yet");
  const uint32_t stretch = (kStretch1 + run.index * 389) % kStretches;  // 389 is odd: each once
  const std::string code = "layout(local_size_x = " + std::to_string(kLocal) +
                           ") in;\nlayout(std430, binding = 0) buffer R { uint r[]; };\n"
                           "layout(push_constant) uniform P { uint first; } p;\n"
                           "uint bits(float f) { return isnan(f) ? 0x7fffffffu : floatBitsToUint(f); }\n"
                           "uint bits(uint u) { return u; }\n"
                           "void main() {\n  uint i = gl_GlobalInvocationID.x, u = p.first + i;\n"
                           "  float f = uintBitsToFloat(u);\n  int e;\n  r[i] = bits(" +
                           row.code + ");\n}\n";
  const Buffer out = run.buffer(uint64_t{kStretch} * 4);
  const Resources res = run.resources({storage_buffer(0, out)}, 4);
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  const uint32_t first = stretch * kStretch;
  run.dispatch(res, pipeline, kStretch / kLocal, std::as_bytes(std::span(&first, 1)));
  run.out("from_" + std::to_string(first), out).may_be_blank = true;
}

const bool kRegistered = [] {
  for (const Row& row : kRows) AddGenerator("exhaustive", row.name, 1, [&row](Run& run) { run_stretch(run, row); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
