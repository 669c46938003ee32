// Shader-bound full-screen fragments: arithmetic, transcendental functions, integers, divergence.
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

const std::string kHead = "layout(location=0) in vec2 uv; layout(location=0) out vec4 o;\n";

std::string fma200() {
  std::string text = kHead + "void main() { vec4 a = vec4(uv, uv.yx);\n";
  for (int i = 0; i < 50; ++i) text += "a = a * vec4(0.99, 1.01, 0.98, 1.02) + vec4(0.01, -0.01, 0.02, -0.02);\n";
  return text + "o = a; }";
}

const std::string kTransc = kHead +
                            "void main() { vec4 a = vec4(uv, uv.yx) + 0.5; for (int i = 0; i < 4; ++i) {"
                            " a = sin(a) + 1.5; a = log2(a); a = exp2(a * 0.5); } o = a; }";
const std::string kIntHash =
    kHead +
    "void main() { uvec2 p = uvec2(gl_FragCoord.xy); uint h = p.x * 1973u + p.y * 9277u;"
    "for (int i = 0; i < 24; ++i) { h ^= h >> 16; h *= 0x7feb352du; h ^= h >> 15; h *= 0x846ca68bu;"
    "h ^= h >> 16; h += uint(i); } o = vec4(float(h & 255u) / 255.0); }";
const std::string kNoise =
    kHead +
    "float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }"
    "float noise(vec2 p) { vec2 i = floor(p), f = fract(p); f = f * f * (3.0 - 2.0 * f);"
    "return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y); }"
    "void main() { float s = 0.0, a = 0.5; vec2 p = uv * 8.0; for (int i = 0; i < 5; ++i) { s += a * noise(p); p *= "
    "2.03;"
    "a *= 0.5; } o = vec4(s); }";
/// Five octaves of values at the points of a lattice, made by hashing integers.
const std::string kLattice =
    kHead +
    "uint mix32(uint h) { h ^= h >> 15; h *= 0x2c1b3c6du; h ^= h >> 12; h *= 0x297a2d39u; return h ^ h >> 15; }"
    "float at(ivec2 p) { return float(mix32(uint(p.x) * 0x8da6b343u ^ uint(p.y) * 0xd8163841u) >> 8) / 16777216.0; }"
    "float lattice(vec2 p) { ivec2 i = ivec2(floor(p)); vec2 f = p - floor(p); f = f * f * f * (f * (f * 6.0 - 15.0) + "
    "10.0); return mix(mix(at(i), at(i + ivec2(1, 0)), f.x), mix(at(i + ivec2(0, 1)), at(i + ivec2(1)), f.x), f.y); }"
    "void main() { vec2 p = uv * 9.0 + 3.0; float sum = 0.0, a = 0.5; for (int k = 0; k < 5; ++k) {"
    "sum += a * lattice(p); p = mat2(1.6, 1.2, -1.2, 1.6) * p; a *= 0.5; } o = vec4(sum, sum * sum, 1.0 - sum, 1.0); }";
const std::string kMandel = kHead +
                            "void main() { vec2 c = uv * vec2(3.0, 2.0) - vec2(2.2, 1.0), z = vec2(0); int n = 0;"
                            "for (; n < 64 && dot(z, z) < 4.0; ++n) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + "
                            "c; o = vec4(float(n) / 64.0); }";
const std::string kSdf =
    kHead +
    "float map(vec3 p) { vec3 q = abs(p) - vec3(0.6); float box = length(max(q, 0.0)) - 0.1;"
    "float ball = length(p - vec3(0.7, 0.5, 0.0)) - 0.6; return min(min(box, ball), p.y + 1.0); }"
    "void main() { vec3 ro = vec3(0, 0.5, -3), rd = normalize(vec3(uv * 2.0 - 1.0, 1.5)); float t = 0.0;"
    "for (int i = 0; i < 48; ++i) { float d = map(ro + rd * t); if (d < 0.001) break; t += d; if (t > 20.0) break; }"
    "vec3 p = ro + rd * t; vec2 e = vec2(0.001, 0); vec3 n = normalize(vec3(map(p + e.xyy) - map(p - e.xyy),"
    "map(p + e.yxy) - map(p - e.yxy), map(p + e.yyx) - map(p - e.yyx))); o = vec4(n * 0.5 + 0.5, 1.0) * exp(-0.1 * t); "
    "}";

/// Position, normal and colour of a pixel are made up; 32 lights come from a uniform buffer.
const std::string kDeferred =
    kHead +
    "struct Light { vec4 at, colour; }; layout(binding=0) uniform L { Light l[32]; };"
    "void main() { vec3 p = vec3(uv * 8.0 - 4.0, sin(uv.x * 20.0) * 0.2), n = normalize(vec3(cos(uv * 30.0), 2.0));"
    "vec3 v = normalize(vec3(0, 0, 5) - p), sum = vec3(0.02); for (int i = 0; i < 32; ++i) {"
    "vec3 d = l[i].at.xyz - p; float r2 = dot(d, d); if (r2 > l[i].at.w) continue; vec3 w = d * inversesqrt(r2);"
    "float diffuse = max(dot(n, w), 0.0), gloss = max(dot(n, normalize(w + v)), 0.0); gloss *= gloss; gloss *= gloss;"
    "sum += l[i].colour.rgb * ((diffuse + gloss * gloss) / (1.0 + r2)); } o = vec4(sum, 1.0); }";

double measure_deferred(Run& run) {
  std::vector<float> lights;
  for (int i = 0; i < 32; ++i) {
    const float at = static_cast<float>(i);
    lights.insert(lights.end(), {at * 0.25f - 4, static_cast<float>(i * 7 % 32) * 0.25f - 4, 1, 12});
    lights.insert(lights.end(), {0.5f + at / 64, 1 - at / 64, static_cast<float>(i % 5) / 4, 0});
  }
  const cts::Resources resources = run.resources({cts::uniform_buffer(0, run.buffer_of(lights))});
  return measure_fragments(run, kDeferred, &resources);
}

}  // namespace

std::vector<Workload> shader_workloads() {
  const auto row = [](const char* name, std::string text) {
    return Workload{name, "Mpix/s", false, [text](Run& run) { return measure_fragments(run, text); }};
  };
  return {row("fs_fma200", fma200()), row("fs_mandel", kMandel),
          row("fs_noise", kNoise),    row("fs_lattice", kLattice),
          row("fs_transc", kTransc),  row("fs_inthash", kIntHash),
          row("scene_sdf", kSdf),     {"fs_deferred32", "Mpix/s", false, measure_deferred}};
}

}  // namespace vitrine::bench
