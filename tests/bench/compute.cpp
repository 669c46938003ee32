// Compute: streaming, matrix products, all-pairs forces; reduction, scan, histograms and blur; rounds of hash
// functions.
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

struct Kernel {
  std::string text;
  std::vector<VkDeviceSize> buffers;  ///< bytes of bindings 0, 1, ...
  std::uint32_t groups[3];
  double work;  ///< units of the row per dispatch
};

double measure(Run& run, const Kernel& kernel) {
  std::vector<cts::Binding> bindings;
  for (std::uint32_t i = 0; i < kernel.buffers.size(); ++i) {
    const cts::Buffer buffer = run.buffer(kernel.buffers[i]);
    for (VkDeviceSize k = 0; k < kernel.buffers[i] / 4; ++k) buffer.as<float>()[k] = static_cast<float>(k % 97) * 0.01f;
    bindings.push_back(cts::storage_buffer(i, buffer));
  }
  const cts::Resources resources = run.resources(bindings);
  const VkPipeline pipeline = run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, kernel.text));
  VkCommandBuffer cmd = begin_repeatable(run);
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
  vkCmdDispatch(cmd, kernel.groups[0], kernel.groups[1], kernel.groups[2]);
  return kernel.work / time_submissions(run, finish(cmd));
}

std::string storage(const char* names) {
  std::string text;
  int binding = 0;
  for (const char* name = names; *name; ++name, ++binding) {
    text += "layout(binding=" + std::to_string(binding) + ") buffer B" + *name + " { float " + *name + "[]; };\n";
  }
  return text;
}

Kernel saxpy() {
  constexpr std::uint32_t kCount = 1 << 22;
  return {"layout(local_size_x=256) in;" + storage("xy") +
              "void main() { uint i = gl_GlobalInvocationID.x; y[i] = 2.5 * x[i] + y[i]; }",
          {kCount * 4, kCount * 4},
          {kCount / 256, 1, 1},
          kCount * 12.0 / 1e9};
}

Kernel matmul_tiled() {
  constexpr std::uint32_t kSide = 256;
  return {
      "layout(local_size_x=16, local_size_y=16) in;" + storage("abc") +
          "shared float s[16][16], t[16][16]; void main() { uint x = gl_LocalInvocationID.x, y = "
          "gl_LocalInvocationID.y;"
          "uint gx = gl_GlobalInvocationID.x, gy = gl_GlobalInvocationID.y; float sum = 0.0;"
          "for (uint k = 0u; k < 256u; k += 16u) { s[y][x] = a[gy * 256u + k + x]; t[y][x] = b[(k + y) * 256u + gx];"
          "barrier(); for (uint i = 0u; i < 16u; ++i) sum += s[y][i] * t[i][x]; barrier(); } c[gy * 256u + gx] = sum; "
          "}",
      {kSide * kSide * 4, kSide * kSide * 4, kSide * kSide * 4},
      {kSide / 16, kSide / 16, 1},
      2.0 * kSide * kSide * kSide / 1e9};
}

Kernel matmul_naive() {
  constexpr std::uint32_t kSide = 256;
  return {"layout(local_size_x=16, local_size_y=16) in;" + storage("abc") +
              "void main() { uint gx = gl_GlobalInvocationID.x, gy = gl_GlobalInvocationID.y; float sum = 0.0;"
              "for (uint k = 0u; k < 256u; ++k) sum += a[gy * 256u + k] * b[k * 256u + gx]; c[gy * 256u + gx] = sum; }",
          {kSide * kSide * 4, kSide * kSide * 4, kSide * kSide * 4},
          {kSide / 16, kSide / 16, 1},
          2.0 * kSide * kSide * kSide / 1e9};
}

Kernel nbody() {
  constexpr std::uint32_t kBodies = 4096;
  return {
      "layout(local_size_x=64) in; layout(binding=0) buffer P { vec4 p[]; }; layout(binding=1) buffer F { vec4 f[]; };"
      "void main() { uint i = gl_GlobalInvocationID.x; vec3 me = p[i].xyz, sum = vec3(0); for (uint k = 0u; k < 4096u; "
      "++k) {"
      "vec3 d = p[k].xyz - me; float r = inversesqrt(dot(d, d) + 0.01); sum += d * (r * r * r * p[k].w); }"
      "f[i] = vec4(sum, 0.0); }",
      {kBodies * 16, kBodies * 16},
      {kBodies / 64, 1, 1},
      double{kBodies} * kBodies / 1e9};
}

Kernel reduce() {
  constexpr std::uint32_t kCount = 1 << 22;
  return {"layout(local_size_x=256) in;" + storage("xy") +
              "shared float s[256]; void main() { uint l = gl_LocalInvocationID.x, i = gl_WorkGroupID.x * 1024u + l;"
              "s[l] = x[i] + x[i + 256u] + x[i + 512u] + x[i + 768u]; barrier();"
              "for (uint k = 128u; k > 0u; k >>= 1) { if (l < k) s[l] += s[l + k]; barrier(); }"
              "if (l == 0u) y[gl_WorkGroupID.x] = s[0]; }",
          {kCount * 4, kCount / 1024 * 4},
          {kCount / 1024, 1, 1},
          kCount / 1e9};
}

/// Inclusive sums of blocks of 1024 and the sum of each block: the first pass of a scan.
Kernel prefix_sum() {
  constexpr std::uint32_t kCount = 1 << 22;
  return {"layout(local_size_x=256) in;" + storage("xyz") +
              "shared float s[256]; void main() { uint l = gl_LocalInvocationID.x, i = gl_GlobalInvocationID.x * 4u;"
              "vec4 v = vec4(x[i], x[i + 1u], x[i + 2u], x[i + 3u]); v.y += v.x; v.z += v.y; v.w += v.z; s[l] = v.w;"
              "barrier(); for (uint k = 1u; k < 256u; k <<= 1) { float t = l >= k ? s[l - k] : 0.0; barrier(); s[l] += "
              "t; barrier(); }"
              "v += s[l] - v.w; y[i] = v.x; y[i + 1u] = v.y; y[i + 2u] = v.z; y[i + 3u] = v.w;"
              "if (l == 255u) z[gl_WorkGroupID.x] = v.w; }",
          {kCount * 4, kCount * 4, kCount / 1024 * 4},
          {kCount / 1024, 1, 1},
          kCount / 1e9};
}

/// 256 bins in shared memory, then added to those of the whole.
Kernel histogram() {
  constexpr std::uint32_t kCount = 1 << 22;
  return {
      "layout(local_size_x=256) in; layout(binding=0) buffer X { uint x[]; }; layout(binding=1) buffer H { uint h[]; "
      "}; shared uint s[256]; void main() { uint l = gl_LocalInvocationID.x; s[l] = 0u; barrier();"
      "for (uint k = 0u; k < 16u; ++k) { uint v = x[gl_WorkGroupID.x * 4096u + k * 256u + l];"
      "atomicAdd(s[v * 0x9e3779b1u >> 24], 1u); } barrier(); atomicAdd(h[l], s[l]); }",
      {kCount * 4, 256 * 4},
      {kCount / 4096, 1, 1},
      kCount / 1e9};
}

/// The same straight to the buffer's bins.
Kernel histogram_global() {
  constexpr std::uint32_t kCount = 1 << 20;
  return {
      "layout(local_size_x=256) in; layout(binding=0) buffer X { uint x[]; }; layout(binding=1) buffer H { uint h[]; "
      "}; void main() { uint v = x[gl_GlobalInvocationID.x]; atomicAdd(h[v * 0x9e3779b1u >> 24], 1u); }",
      {kCount * 4, 256 * 4},
      {kCount / 256, 1, 1},
      kCount / 1e9};
}

/// 64 rounds of eight variables that hand on their values, as the functions of SHA-2 do, with made-up constants.
Kernel sha_rounds() {
  constexpr std::uint32_t kCount = 1 << 15;
  return {
      "layout(local_size_x=64) in; layout(binding=0) buffer X { uint x[]; }; layout(binding=1) buffer Y { uint y[]; };"
      "uint turn(uint v, int n) { return v >> n | v << 32 - n; }"
      "void main() { uint i = gl_GlobalInvocationID.x, w[16]; for (int k = 0; k < 16; ++k) w[k] = x[i] * uint(2 * k + "
      "1);"
      "uint a = 0x6a09e667u, b = 0xbb67ae85u, c = 0x3c6ef372u, d = 0xa54ff53au, e = 0x510e527fu, f = 0x9b05688cu,"
      "g = 0x1f83d9abu, h = 0x5be0cd19u; for (int r = 0; r < 64; ++r) {"
      "uint s = turn(e, 6) ^ turn(e, 11) ^ turn(e, 25), t = h + s + (e & f ^ ~e & g) + uint(r) * 0x9e3779b9u + w[0];"
      "uint u = (turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + (a & b ^ a & c ^ b & c);"
      "uint n = w[0] + (turn(w[1], 7) ^ turn(w[1], 18) ^ w[1] >> 3) + w[9] + (turn(w[14], 17) ^ turn(w[14], 19) ^ "
      "w[14] >> 10);"
      "for (int k = 0; k < 15; ++k) w[k] = w[k + 1]; w[15] = n;"
      "h = g; g = f; f = e; e = d + t; d = c; c = b; b = a; a = t + u; } y[i] = a ^ e ^ c + g; }",
      {kCount * 4, kCount * 4},
      {kCount / 64, 1, 1},
      kCount * 64.0 / 1e9};
}

/// The same with the words of the message derived from the invocation in every round: eight variables alone.
Kernel hash_rounds() {
  constexpr std::uint32_t kCount = 1 << 16;
  return {
      "layout(local_size_x=64) in; layout(binding=0) buffer X { uint x[]; }; layout(binding=1) buffer Y { uint y[]; };"
      "uint turn(uint v, int n) { return v << n | v >> 32 - n; }"
      "void main() { uint i = gl_GlobalInvocationID.x, k = x[i];"
      "uint a = k, b = k ^ 0xbb67ae85u, c = 0x3c6ef372u, d = k + 0xa54ff53au, e = 0x510e527fu, f = k * 0x9b05688cu,"
      "g = 0x1f83d9abu, h = 0x5be0cd19u; for (uint r = 0u; r < 48u; ++r) {"
      "uint t = h + (turn(e, 26) ^ turn(e, 21) ^ turn(e, 7)) + (e & f ^ ~e & g) + (k ^ r * 0x428a2f98u);"
      "uint u = (turn(a, 30) ^ turn(a, 19) ^ turn(a, 10)) + (a & b ^ a & c ^ b & c);"
      "h = g; g = f; f = e; e = d + t; d = c; c = b; b = a; a = t + u; } y[i] = a ^ b ^ c ^ d ^ e ^ f ^ g ^ h; }",
      {kCount * 4, kCount * 4},
      {kCount / 64, 1, 1},
      kCount * 48.0 / 1e9};
}

/// Ten double rounds of additions, exclusive ors and rotations on sixteen words, as ChaCha does.
Kernel quarter_rounds() {
  constexpr std::uint32_t kCount = 1 << 15;
  const auto quarter = [](int a, int b, int c, int d) {
    std::string text;
    const auto step = [&](int to, int from, int turned, int by) {
      const auto word = [](int k) { return "s[" + std::to_string(k) + "]"; };
      text += word(to) + " += " + word(from) + "; " + word(turned) + " ^= " + word(to) + "; " + word(turned) + " = " +
              word(turned) + " << " + std::to_string(by) + " | " + word(turned) + " >> " + std::to_string(32 - by) +
              "; ";
    };
    step(a, b, d, 16);
    step(c, d, b, 12);
    step(a, b, d, 8);
    step(c, d, b, 7);
    return text;
  };
  std::string rounds;
  for (int k = 0; k < 4; ++k) rounds += quarter(k, k + 4, k + 8, k + 12);
  for (int k = 0; k < 4; ++k) rounds += quarter(k, 4 + (k + 1) % 4, 8 + (k + 2) % 4, 12 + (k + 3) % 4);
  return {
      "layout(local_size_x=64) in; layout(binding=0) buffer X { uint x[]; }; layout(binding=1) buffer Y { uint y[]; };"
      "void main() { uint i = gl_GlobalInvocationID.x, s[16]; for (int k = 0; k < 16; ++k) s[k] = x[i] + uint(k) * "
      "0x61707865u; for (int r = 0; r < 10; ++r) { " +
          rounds + "} uint sum = 0u; for (int k = 0; k < 16; ++k) sum = sum * 31u + s[k]; y[i] = sum; }",
      {kCount * 4, kCount * 4},
      {kCount / 64, 1, 1},
      kCount * 80.0 / 1e9};
}

/// Nine taps across a picture of floats, a row of the workgroup in shared memory.
Kernel blur() {
  constexpr std::uint32_t kSide = 1024;
  return {
      "layout(local_size_x=128) in;" + storage("xy") +
          "shared float s[136]; void main() { uint l = gl_LocalInvocationID.x, row = gl_WorkGroupID.y * 1024u;"
          "int at = int(gl_GlobalInvocationID.x); s[l + 4u] = x[row + uint(at)];"
          "if (l < 4u) s[l] = x[row + uint(max(at - 4, 0))]; if (l >= 124u) s[l + 8u] = x[row + uint(min(at + 4, "
          "1023))];"
          "barrier(); y[row + uint(at)] = 0.2270 * s[l + 4u] + 0.1945 * (s[l + 3u] + s[l + 5u]) + 0.1216 * (s[l + 2u] "
          "+ s[l + 6u]) + 0.0540 * (s[l + 1u] + s[l + 7u]) + 0.0162 * (s[l] + s[l + 8u]); }",
      {kSide * kSide * 4, kSide * kSide * 4},
      {kSide / 128, kSide, 1},
      double{kSide} * kSide / 1e6};
}

}  // namespace

std::vector<Workload> compute_workloads() {
  const auto row = [](const char* name, const char* unit, Kernel (*kernel)()) {
    return Workload{name, unit, false, [kernel](Run& run) { return measure(run, kernel()); }};
  };
  return {row("c_saxpy", "GB/s", saxpy),
          row("c_matmul_tiled", "GFLOP/s", matmul_tiled),
          row("c_matmul_naive", "GFLOP/s", matmul_naive),
          row("c_nbody", "Ginter/s", nbody),
          row("c_reduce", "Gelem/s", reduce),
          row("c_prefix_sum", "Gelem/s", prefix_sum),
          row("c_histogram", "Gelem/s", histogram),
          row("c_hist_global", "Gelem/s", histogram_global),
          row("c_sha_rounds", "Ground/s", sha_rounds),
          row("c_hash_rounds", "Ground/s", hash_rounds),
          row("c_quarter_rounds", "Gquart/s", quarter_rounds),
          row("c_blur", "Mpix/s", blur)};
}

}  // namespace vitrine::bench
