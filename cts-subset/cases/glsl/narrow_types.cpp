// Numbers of 8 and 16 bits where they live: buffers, push constants, shared memory, local arrays, control flow; in
// every stage.
#include "cases/glsl/evaluate.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

constexpr char kHead[] =
    "#version 450\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_8bit_storage : require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n"
    "layout(local_size_x = 64) in;\n"
    "layout(std430, binding = 1) buffer Out { uint result[]; };\n";
constexpr uint32_t kCount = 256;

void require_narrow(const Run& run) {
  const auto& features = run.gpu.extension_features;
  run.require(run.gpu.features.shaderInt16 && features.shaderInt8 && features.shaderFloat16,
              "8- and 16-bit arithmetic");
  run.require(features.storageBuffer8BitAccess && features.storageBuffer16BitAccess, "8- and 16-bit storage");
}

/// Words whose bytes are small numbers and whose halves are finite binary16.
std::vector<uint32_t> narrow_words(Run& run, uint32_t count) {
  std::vector<uint32_t> words;
  for (uint32_t i = 0; i < count; ++i) words.push_back(run.random.bits() & 0xbbffbbffu);
  return words;
}

/// Binding 0: `words` and `tail` bytes more; 1: results; 2: the same words as a uniform buffer.
void run_compute(Run& run, const std::string& text, uint32_t push_bytes = 0, uint32_t tail = 0) {
  require_narrow(run);
  run.note("shader", text);
  std::vector<uint32_t> words = narrow_words(run, 512);
  const Buffer uniform = run.buffer_of(words), in = run.buffer(tail == 0 ? 2048 : 256 + tail);
  std::memcpy(in.data, words.data(), in.size);
  const Buffer out = run.buffer(kCount * 4 * 8);
  std::memset(out.data, 0, out.size);
  const Resources res =
      run.resources({storage_buffer(0, in), storage_buffer(1, out), uniform_buffer(2, uniform)}, push_bytes);
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, text));
  run.dispatch(res, pipeline, kCount / 64, std::as_bytes(std::span(words)).first(push_bytes));
  run.out("out", out);
  run.out("in", in, VK_FORMAT_R8_UINT);
}

CTS_CASE("glsl", "narrow.buffer_layouts") {
  run_compute(run, std::string(kHead) + R"(
struct S { int8_t a; uint8_t b; int16_t c; float16_t h; u8vec3 v; f16vec3 w; i16vec2 x[3]; uint u; uint8_t z[5]; };
layout(std430, binding = 0) buffer In { S s[]; } a;
layout(std140, binding = 2) uniform U { u8vec4 v; float16_t h; i16vec3 x; f16vec2 e[3]; int8_t b[2]; } b;
void main() {
  uint id = gl_GlobalInvocationID.x, k = id % 7u;
  S s = a.s[k];
  int n = int(s.a) + int(s.b) * int(s.c) - int(s.v[id % 3u]);
  f16vec3 w = s.w * s.h + f16vec3(b.h);
  w.xy += b.e[id % 3u];
  result[8u * id] = uint(n);
  result[8u * id + 1u] = floatBitsToUint(float(w[id % 3u]));
  result[8u * id + 2u] = uint(s.x[id % 3u].y) ^ s.u;
  result[8u * id + 3u] = uint(b.v[id & 3u]) + (uint(s.z[id % 5u]) << 8);
  result[8u * id + 4u] = uint(int(b.x.z) + int(b.b[id & 1u]));
  if (id < 7u) {
    a.s[id + 20u].v = u8vec3(n, n >> 8, 7);
    a.s[id + 20u].w.y = w.x;
    a.s[id + 20u].x[id % 3u] = i16vec2(n, -n);
    a.s[id + 20u].z[id % 5u] = uint8_t(200u + id);
    a.s[id + 20u].h += float16_t(0.5);
  }
}
)");
}

/// Lanes write bytes between those that others read; the buffer ends in the middle of a word, and of a half.
CTS_CASE("glsl", "narrow.adjacent_bytes_and_bounds") {
  run_compute(run, std::string(kHead) + R"(
layout(std430, binding = 0) buffer In { uint8_t v[]; } a;
layout(std430, binding = 0) buffer Half { float16_t h[]; } b;
void main() {
  uint id = gl_GlobalInvocationID.x;
  uint8_t old = a.v[id + 10u];
  float16_t h = b.h[(id + 3u) | 1u];
  result[2u * id] = uint(old);
  result[2u * id + 1u] = floatBitsToUint(float(h));
  if ((id & 3u) == 2u) a.v[id + 10u] = uint8_t(old * uint8_t(3) + uint8_t(id));
}
)",
              0, 3);
}

// Conversions of conversions back, which the reference takes for truncation or nothing, and literal zeros that only its
// code generator finds.
CTS_CASE("glsl", "narrow.conversions_back") {
  run_compute(run, std::string(kHead) + R"(
layout(std430, binding = 0) buffer In { f16vec2 h[]; } a;
void main() {
  uint id = gl_GlobalInvocationID.x;
  f16vec2 h = clamp(a.h[id], f16vec2(-100.0), f16vec2(100.0));
  int16_t whole = int16_t(float16BitsToUint16(h.x));
  float16_t zero = float16_t(uint(0)) / (h.x * h.x);
  precise float16_t negated = -(h.y * zero);
  result[6u * id] = uint(float16BitsToUint16(float16_t(int8_t(h.x))));
  result[6u * id + 1u] = uint(float16BitsToUint16(float16_t(int16_t(h.x))));
  result[6u * id + 2u] = uint(float16BitsToUint16(float16_t(int64_t(h.y))));
  result[6u * id + 3u] = uint(int16_t(float16_t(whole)));
  result[6u * id + 4u] = uint(int16_t(float(whole)));
  result[6u * id + 5u] = uint(float16BitsToUint16(negated));
}
)");
}

CTS_CASE("glsl", "narrow.push_constants") {
  run_compute(run, std::string(kHead) + R"(
layout(push_constant) uniform P { u8vec4 v; int8_t x; float16_t h; i16vec2 w; f16vec4 f; uint8_t a[16]; } p;
void main() {
  uint id = gl_GlobalInvocationID.x;
  result[2u * id] = uint(p.v[id & 3u]) + uint(int(p.x) * int(p.w.y)) + uint(p.a[id & 15u]);
  result[2u * id + 1u] = floatBitsToUint(float(p.f[id & 3u] * p.h));
}
)",
              48);
}

CTS_CASE("glsl", "narrow.shared_memory_and_local_arrays") {
  run_compute(run, std::string(kHead) + R"(
layout(std430, binding = 0) buffer In { uint16_t v[]; } a;
shared uint8_t s[64];
shared f16vec3 t[64];
int16_t twist(inout int8_t x, int16_t y) { x += int8_t(y); return int16_t(y * int16_t(x)); }
void main() {
  uint id = gl_GlobalInvocationID.x, n = gl_LocalInvocationIndex;
  s[n] = uint8_t(a.v[id]);
  t[n] = f16vec3(float16_t(id), uint16BitsToFloat16(a.v[id] & uint16_t(0x3fff)), float16_t(0.1));
  barrier();
  int8_t local[9];
  for (int k = 0; k < 9; k++) local[k] = int8_t(s[(n * 5u + uint(k)) & 63u]);
  int16_t sum = int16_t(id);
  for (int k = 0; k < int(id % 11u); k++) {
    sum += twist(local[(k + int(id)) % 9], sum);
    if (sum > int16_t(20000)) break;
    sum -= int16_t(local[k % 9]);
  }
  f16vec3 h = t[63u - n] * t[(n * 3u) & 63u] + t[n].zxy;
  switch (int(sum) & 3) {
    case 0: h.x += float16_t(1.0); break;
    case 3: h = -h;
    default: h *= float16_t(3.0);
  }
  result[2u * id] = uint(int(sum));
  result[2u * id + 1u] = packHalf2x16(vec2(h.xy)) ^ floatBitsToUint(float(h.z));
}
)");
}

CTS_CASE("glsl", "narrow.packing_and_constants") {
  run_compute(run, std::string(kHead) + R"(
layout(constant_id = 0) const int16_t kS = int16_t(-1234);
layout(constant_id = 1) const float16_t kH = float16_t(0.3);
layout(constant_id = 2) const uint8_t kB = uint8_t(250);
const uint8_t kSum = uint8_t(kB + uint8_t(10));
const int8_t kTable[4] = int8_t[](int8_t(-128), int8_t(127), int8_t(-1), int8_t(5));
layout(std430, binding = 0) buffer In { uint v[]; } a;
void main() {
  uint id = gl_GlobalInvocationID.x;
  u8vec4 bytes = unpack8(a.v[id]);
  i16vec2 shorts = unpack16(int(a.v[id]));
  bytes.x += kSum;
  shorts.y *= kS;
  f16vec2 h = unpackFloat2x16(a.v[id] & 0x3fff3fffu) * kH;
  result[4u * id] = pack32(bytes);
  result[4u * id + 1u] = uint(pack32(shorts)) + uint(int(kTable[id & 3u]));
  result[4u * id + 2u] = packFloat2x16(h);
  uvec2 wide = unpack32(pack64(u16vec4(bytes.xy, uint16_t(id), uint16_t(7))));
  result[4u * id + 3u] = wide.x ^ wide.y;
}
)");
}

/// binary16 has denormals where binary32 flushes them.
CTS_CASE("glsl", "narrow.half_in_fragments") {
  require_narrow(run);
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32G32B32A32_UINT}});
  const Resources res = run.resources({});
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
      "layout(location = 0) in vec2 uv;\nlayout(location = 0) out uvec4 color;\n"
      "void main() {\n"
      "  float16_t x = float16_t(uv.x * 1e-4), y = float16_t(uv.y);\n"
      "  float16_t z = x * y, d = float16_t(dFdx(float(y * y)) + fwidth(float(x)));\n"
      "  int16_t n = int16_t(gl_FragCoord.x) * int16_t(1000);\n"
      "  uint8_t b = uint8_t(gl_FragCoord.y) << uint8_t(3);\n"
      "  color = uvec4(floatBitsToUint(float(z)), floatBitsToUint(float(d)), uint(int(n)), uint(b));\n}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
