// 64-bit numbers where they live: buffers of every layout, push constants, shared memory, local arrays, functions,
// control flow and interfaces; and random expressions of doubles and 64-bit integers.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr char kInt64[] = "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n";
/// The bits of what is no NaN: which NaN a NaN is, nothing says, and mutated cases make some.
constexpr char kBits[] = "uvec2 bits(double x) { return isnan(x) ? uvec2(0u, 0x7ff80000u) : unpackDouble2x32(x); }\n";
const std::string kHead = std::string("#version 450\n") + kInt64 + "layout(local_size_x = 64) in;\n" +
                          "layout(std430, binding = 1) buffer Out { uvec2 result[]; };\n" + kBits;
constexpr uint32_t kCount = 256;

/// Runs a compute shader on two storage buffers: binding 0 holds random words, binding 1 takes 4096 words.
void run_compute(Run& run, const std::string& text, const std::vector<uint32_t>& words, uint32_t push_bytes = 0) {
  run.require(run.gpu.features.shaderInt64 && run.gpu.features.shaderFloat64, "64-bit numbers");
  run.note("shader", text);
  const Buffer in = run.buffer_of(words), out = run.buffer(kCount * 8 * 8);
  std::memset(out.data, 0, out.size);
  const Resources res =
      run.resources({storage_buffer(0, in), storage_buffer(1, out), uniform_buffer(2, in)}, push_bytes);
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, text));
  run.dispatch(res, pipeline, kCount / 64, std::as_bytes(std::span(words)).subspan(400, push_bytes));
  run.out("out", out);
  run.out("in", in);
}

/// Doubles between -1000 and 1000 with 32 random bits, so that sums and products round.
std::vector<uint32_t> doubles(Run& run, uint32_t count) {
  std::vector<uint32_t> words;
  for (uint32_t i = 0; i < count; ++i) {
    const double value = static_cast<double>(run.random.real(-1000.0f, 1000.0f)) + run.random.bits() * 0x1p-40;
    uint64_t bits;
    std::memcpy(&bits, &value, 8);
    words.push_back(static_cast<uint32_t>(bits));
    words.push_back(static_cast<uint32_t>(bits >> 32));
  }
  return words;
}

CTS_CASE("glsl", "wide.buffer_layouts") {
  run_compute(run, kHead + R"(
struct S { double d; float f; dvec3 v; int64_t l; dmat2x3 m; uint u; u64vec2 w; };
layout(std430, row_major, binding = 0) buffer In { S s[]; } a;
layout(std140, binding = 2) uniform U { dvec4 v; dmat3x2 m; layout(row_major) dmat2x3 n; i64vec3 l; double e[3]; } b;
void main() {
  uint id = gl_GlobalInvocationID.x, k = id % 5u;
  S s = a.s[k];
  dvec3 v = s.v * s.d + double(s.f) * b.v.xyz;
  v += s.m[1] + b.n[id & 1u] * b.e[id % 3u];
  double x = v.x + v[id % 3u] + s.m[id & 1u].y + b.m[id % 3u][id & 1u];
  int64_t l = s.l + int64_t(s.w.y) * b.l.z + int64_t(s.u);
  result[4u * id] = bits(x);
  result[4u * id + 1u] = uvec2(uint(l), uint(l >> 32));
  result[4u * id + 2u] = bits(b.v[id & 3u]);
  if (id < 5u) {
    a.s[id + 8u].v.y = x;
    a.s[id + 8u].m = b.n;
    a.s[id + 8u].w[id & 1u] = uint64_t(l);
    a.s[id + 8u].v[id % 3u] += 1.5lf;
  }
}
)",
              doubles(run, 512));
}

CTS_CASE("glsl", "wide.push_constants") {
  run_compute(run, kHead + R"(
layout(push_constant) uniform P { dvec2 v; double x; int64_t l; u64vec2 w; } p;
void main() {
  uint id = gl_GlobalInvocationID.x;
  result[2u * id] = bits(p.v[id & 1u] * p.x + double(id));
  uint64_t w = p.w[id & 1u] + uint64_t(p.l) / uint64_t(id + 1u);
  result[2u * id + 1u] = uvec2(uint(w), uint(w >> 32));
}
)",
              doubles(run, 256), 48);
}

CTS_CASE("glsl", "wide.shared_memory") {
  run_compute(run, kHead + R"(
layout(std430, binding = 0) buffer In { double d[]; };
shared double s[64];
shared i64vec3 t[64];
void main() {
  uint id = gl_GlobalInvocationID.x, n = gl_LocalInvocationIndex;
  s[n] = d[id];
  t[n] = i64vec3(int64_t(d[id]), int64_t(id) << 40, -int64_t(n));
  barrier();
  double sum = s[63u - n] * 2.0lf + s[(n * 7u) & 63u];
  t[(n + 5u) & 63u].y += int64_t(n);
  barrier();
  i64vec3 v = t[(n * 3u) & 63u] * int64_t(id);
  int64_t l = v.x ^ v.y ^ v[id % 3u];
  result[2u * id] = bits(sum);
  result[2u * id + 1u] = uvec2(uint(l), uint(l >> 32));
}
)",
              doubles(run, 256));
}

CTS_CASE("glsl", "wide.local_arrays_and_control_flow") {
  run_compute(run, kHead + R"(
layout(std430, binding = 0) buffer In { double d[]; };
struct Pair { double x; i64vec2 l; };
double pick(Pair p, inout int64_t n) { n += p.l.y; return n > 100l ? p.x : -p.x; }
void main() {
  uint id = gl_GlobalInvocationID.x;
  double a[8];
  Pair p[3];
  for (int k = 0; k < 8; k++) a[k] = d[(id + uint(k)) & 255u];
  for (int k = 0; k < 3; k++) p[k] = Pair(a[k], i64vec2(int64_t(a[k + 1]), int64_t(k) * 50l));
  p[id % 3u].l[id & 1u] += 7l;
  a[id & 7u] = 0.125lf;
  int64_t n = int64_t(id);
  double sum = 0.0lf;
  for (uint k = 0u; k < (id & 15u); k++) {
    sum += a[(k * id) & 7u];
    if (sum > 500.0lf) { sum = sum / 3.0lf; continue; }
    sum += pick(p[(k + id) % 3u], n);
    if (n > 400l) break;
  }
  switch (int(n & 3l)) {
    case 0: sum += 1.0lf; break;
    case 2: sum *= 2.0lf;
    case 3: n = -n; break;
    default: n = n * n;
  }
  result[2u * id] = bits(sum);
  result[2u * id + 1u] = uvec2(uint(n), uint(n >> 32));
}
)",
              doubles(run, 256));
}

CTS_CASE("glsl", "wide.constants_and_specialization") {
  run_compute(run, kHead + R"(
layout(constant_id = 0) const double kD = 2.5lf;
layout(constant_id = 1) const int64_t kL = -0x123456789abcdefl;
const dvec3 kTable[3] = dvec3[](dvec3(0.1lf, 1e300lf, -3.0lf), dvec3(4.0lf), dvec3(1.0lf / 3.0lf));
const int64_t kSum = kL * 3l - (kL >> 7) + (kL / 1000l) % 77l;
layout(std430, binding = 0) buffer In { double d[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  double x = kTable[(id >> 2) % 3u][id % 3u] * d[id] + kD;
  int64_t l = kSum + (kL ^ int64_t(id));
  result[2u * id] = bits(x);
  result[2u * id + 1u] = uvec2(uint(l), uint(l >> 32));
}
)",
              doubles(run, 256));
}

/// Flat interface variables of 64 bits, in every size.
CTS_CASE("glsl", "wide.interface") {
  run.require(run.gpu.features.shaderInt64 && run.gpu.features.shaderFloat64, "64-bit numbers");
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_UINT}});
  GraphicsSpec spec;
  const Resources res = run.resources({});
  spec.layout = res.layout;
  spec.vertex = std::string("#version 450\n") + kInt64 + R"(
layout(location = 0) flat out dvec3 v;
layout(location = 2) flat out double x;
layout(location = 3) flat out int64_t l;
layout(location = 4) flat out dmat2 m;
layout(location = 6, component = 2) flat out uint64_t w;
void main() {
  const vec2 corner[3] = vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3));
  gl_Position = vec4(corner[gl_VertexIndex], 0.5, 1.0);
  double d = double(gl_VertexIndex + 1) / 3.0lf;
  v = dvec3(d, d * d, -d);
  x = sqrt(d);
  l = int64_t(gl_VertexIndex - 7) * 0x123456789l;
  m = dmat2(d, 2.0lf, 3.0lf / d, 4.0lf);
  w = uint64_t(l) >> 3;
}
)";
  spec.fragment = std::string("#version 450\n") + kInt64 + R"(
layout(location = 0) flat in dvec3 v;
layout(location = 2) flat in double x;
layout(location = 3) flat in int64_t l;
layout(location = 4) flat in dmat2 m;
layout(location = 6, component = 2) flat in uint64_t w;
layout(location = 0) out uvec4 color;
)" + kBits + R"(
void main() {
  dvec4 all = dvec4(v * double(gl_FragCoord.x), x) + dvec4(m[0], m[1]) * double(gl_FragCoord.y);
  int k = int(gl_FragCoord.x) & 3;
  uint64_t n = uint64_t(l) + w * uint64_t(gl_FragCoord.y);
  color = uvec4(bits(all[k]), uint(n), uint(n >> 32));
}
)";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
