// The texts of the seeds, and their modules.
#include "tests/fuzz/seeds.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/glsl/compile.h"

namespace vitrine::fuzz {
namespace {

struct Seed {
  VkShaderStageFlagBits stage;
  const char* text;
};

constexpr char kSubgroupExtensions[] =
    "#extension GL_KHR_shader_subgroup_basic : enable\n#extension GL_KHR_shader_subgroup_vote : enable\n"
    "#extension GL_KHR_shader_subgroup_ballot : enable\n#extension GL_KHR_shader_subgroup_arithmetic : enable\n"
    "#extension GL_KHR_shader_subgroup_shuffle : enable\n#extension GL_KHR_shader_subgroup_clustered : enable\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types : enable\n#extension GL_EXT_buffer_reference : enable\n"
    "#extension GL_EXT_shader_atomic_int64 : enable\n#extension GL_EXT_demote_to_helper_invocation : enable\n";

constexpr Seed kSeeds[] = {
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 100) in;
layout(binding = 0) buffer A { uint a[]; };
shared uint s[100];
uint f(uint x, inout uint y) { for (uint i = 0u; i < (x & 15u); i++) { if (i == 7u) return y; y = y * 3u + i; } return x; }
void main() {
  uint i = gl_LocalInvocationIndex, y = a[i];
  s[i] = y;
  barrier();
  switch (y % 5u) { case 0u: y += s[99u - i]; case 1u: y ^= 9u; break; case 2u: y = f(y, s[i]); break; default: y--; }
  do { y = y / 2u + 1u; if ((y & 8u) != 0u) continue; y ^= i; } while (y > 40u);
  atomicAdd(a[y % 7u], i);
  a[i] = bitfieldExtract(y, 3, 5) + bitCount(y) + uint(findMSB(y));
})"},
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 8) in;
struct P { vec3 p; float w; mat3 m; vec2 t[3]; };
layout(binding = 1, std430) buffer B { P p[]; };
layout(binding = 2, std140) uniform U { mat4 m; vec4 v[4]; int n; } u;
layout(push_constant) uniform C { uint k; float f; } c;
void main() {
  uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * 8u;
  P q = p[i & 3u];
  float array[5] = float[5](1.0, 2.0, q.w, 4.0, c.f);
  q.p = cross(normalize(q.p + 1.0), q.m * vec3(array[i % 5u], 0.5, 2.0));
  q.m = inverse(transpose(q.m)) * determinant(q.m);
  array[c.k % 5u] = length(q.p) + smoothstep(0.0, 1.0, q.w) + mix(q.w, 2.0, 0.25);
  q.t[i % 3u] = (u.m * vec4(q.p, 1.0)).xy * sin(array[1]) + exp2(u.v[u.n & 3].xy) + pow(abs(q.t[0]), vec2(1.5));
  p[i & 3u] = q;
})"},
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(binding = 0) buffer A { uint a[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, x = a[i];
  for (;;) { uint first = subgroupBroadcastFirst(x); if (first == x) { x += subgroupAdd(i); break; } }
  x ^= subgroupBallot(x > 7u).x + subgroupShuffleXor(x, 3u) + subgroupInclusiveMax(x) + subgroupClusteredMin(x, 8u);
  if (subgroupAny(x == 5u) || subgroupElect()) x++;
  a[i] = x + gl_SubgroupInvocationID;
})"},
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(binding = 0, std430) buffer A { uint8_t b[16]; float16_t h[16]; int64_t l[16]; double d[16]; i16vec3 v[8]; };
void main() {
  uint i = gl_GlobalInvocationID.x & 15u;
  b[i] = uint8_t(b[i] * uint8_t(3) + uint8_t(i));
  h[i] = sqrt(abs(h[i])) + float16_t(d[i]);
  l[i] = (l[i] << 3) / int64_t(i + 1u) % 77l + int64_t(b[i]);
  d[i] = fma(d[i], 2.0lf, floor(d[i])) - double(l[i]);
  v[i & 7u] += i16vec3(i) * v[(i + 1u) & 7u].zyx;
  atomicMax(l[i], 5l);
})"},
    {VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(buffer_reference) buffer Node;
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Node { uint n; Node next; };
layout(binding = 0, std430) buffer A { Node first; uint r[]; };
void main() {
  Node at = first;
  uint s = 0u;
  for (int k = 0; k < 9; k++) { s = s * 31u + at.n; at = at.next; }
  r[gl_GlobalInvocationID.x] = s;
})"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(location = 0) in vec4 p;
layout(location = 1) flat in ivec2 q;
layout(location = 2) centroid in vec2 e;
layout(location = 0) out vec4 c;
layout(location = 1) out uint id;
layout(binding = 0) uniform sampler2D t[2];
layout(binding = 1) uniform textureCube k;
layout(binding = 2) uniform sampler s;
layout(binding = 3, rgba8) uniform image2D w;
float f(inout float x, int n) { for (int i = 0; i < n; i++) { if (x > 3.0) return x; x *= p.y; } return x; }
void main() {
  float a[3] = float[3](p.x, p.y, p.z), x = a[q.x % 3];
  if (q.y == 5) discard;
  c = texture(t[q.x & 1], p.xy) + textureLod(samplerCube(k, s), p.xyz, 1.0) + textureGather(t[0], e, 1);
  c += imageLoad(w, q) * f(x, 5) + vec4(dFdx(x), dFdy(x), fwidth(p.z), interpolateAtOffset(p, vec2(0.25)).x);
  if (c.x < 0.5) demote;
  c.w = modf(p.w, a[1]) + float(textureSize(t[1], 0).x) + (helperInvocationEXT() ? 1.0 : 2.0);
  imageStore(w, q, c);
  id = packHalf2x16(c.xy) ^ floatBitsToUint(ldexp(c.z, q.x));
})"},
    {VK_SHADER_STAGE_VERTEX_BIT, R"(
layout(location = 0) in vec3 p;
layout(location = 1) in mat3 m;
layout(location = 0) out Out { vec3 n; flat int k; vec2 uv[2]; } o;
layout(binding = 4, std140, row_major) uniform U { mat4x3 v[2]; bool b; } u;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[3]; };
void main() {
  o.n = m * p;
  o.k = gl_VertexIndex * 3 + gl_InstanceIndex;
  o.uv[o.k & 1] = p.xy;
  for (int i = 0; i < 3; i++) gl_ClipDistance[i] = dot(o.n, p) - float(i);
  gl_Position = vec4(u.v[o.k & 1] * vec4(p, 1.0), u.b ? 1.0 : 2.0);
})"},
    {VK_SHADER_STAGE_GEOMETRY_BIT, R"(
layout(triangles, invocations = 2) in;
layout(triangle_strip, max_vertices = 6) out;
layout(location = 0) in vec4 a[];
layout(location = 0) out vec4 b;
void main() {
  for (int i = 0; i < 3; i++) {
    gl_Position = gl_in[i].gl_Position + float(gl_InvocationID);
    b = a[(i + 1) % 3];
    EmitVertex();
    if (b.x > 2.0) EndPrimitive();
  }
})"},
    {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(
layout(vertices = 3) out;
layout(location = 0) in vec2 a[];
layout(location = 0) out vec2 b[];
layout(location = 1) patch out vec3 c;
void main() {
  b[gl_InvocationID] = a[gl_InvocationID].yx;
  barrier();
  if (gl_InvocationID == 0) { c = vec3(b[1], b[2].x); gl_TessLevelOuter[1] = c.x; gl_TessLevelInner[0] = 2.0; }
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
})"},
    {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(
layout(triangles, fractional_odd_spacing, cw) in;
layout(location = 0) in vec2 b[];
layout(location = 1) patch in vec3 c;
layout(location = 0) out vec2 o;
void main() {
  o = b[0] * gl_TessCoord.x + b[1] * gl_TessCoord.y + c.xy;
  gl_Position = gl_in[gl_PrimitiveID % 3].gl_Position + vec4(gl_TessLevelOuter[2], gl_TessCoord);
})"},
};

Words compile_seed(const Seed& seed) {
  const std::string text = std::string("#version 460\n") + kSubgroupExtensions + seed.text;
  std::string log;
  Words words = test::compile_glsl(seed.stage, text, test::VulkanVersion::k12, log);
  if (words.empty()) {
    std::fprintf(stderr, "%s\n%s\n", text.c_str(), log.c_str());
    std::exit(2);
  }
  return words;
}

}  // namespace

std::vector<Module> compile_seeds() {
  std::vector<Module> modules;
  for (const Seed& seed : kSeeds) modules.push_back({seed.stage, compile_seed(seed)});
  return modules;
}

}  // namespace vitrine::fuzz
