// What the reference does where its bits depend on the CPU (design.md section 8).
#include <algorithm>
#include <bit>
#include <cstdio>

#include "harness/execute.h"
#include "harness/graphics.h"
#include "harness/recorded.h"
#include "harness/reference.h"

#ifdef __SSE__
#include <immintrin.h>
#endif

namespace vitrine::cts {
namespace {

std::vector<uint32_t> float_to_uint(Run& run) {
  const Buffer in = run.buffer_of<float>({-1.0f, -0.5f, 3.0e9f, 5.0e9f, Random::from_bits(0x7fc00000)});
  const Buffer out = run.buffer(in.size);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 5) in;
layout(binding = 0) buffer In { float values[]; };
layout(binding = 1) buffer Out { uint results[]; };
void main() { results[gl_GlobalInvocationID.x] = uint(values[gl_GlobalInvocationID.x]); })"));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, 1, 1, 1);
  });
  return {out.as<uint32_t>(), out.as<uint32_t>() + 5};
}

uint64_t srgb_hash(Run& run) {
  TargetSpec spec;
  spec.colors = {VK_FORMAT_R8G8B8A8_SRGB};
  spec.width = spec.height = 256;
  const Target target = make_target(run, spec, true);
  GraphicsSpec graphics;
  graphics.vertex = kFullScreenVertex;
  graphics.fragment = R"(
layout(location = 0) out vec4 result;
void main() {
  float t = (floor(gl_FragCoord.y) * 256.0 + gl_FragCoord.x) / 65536.0;
  result = vec4(t, t * t, sqrt(t), 1.0);
})";
  const VkPipeline pipeline = make_pipeline(run, graphics, target);
  draw_once(run, target, pipeline);
  uint64_t hash = 0xcbf29ce484222325u;
  for (const unsigned char byte : run.download(target.colors[0], 0)) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

// As on an AMD processor with AVX-512. The last is of RSQRTPS itself, over [0.5, 2) in steps of 2^-12 of a binade.
constexpr uint32_t kRecordedFloatToUint[] = {0xffffffff, 0, 0xb2d05e00, 0xffffffff, 0xffffffff};
// Without AVX-512, which this device can follow.
constexpr uint32_t kOtherFloatToUint[] = {0xffffffff, 0, 0xb2d05e00, 0x2a05f200, 0};
constexpr uint64_t kRecordedSrgbHash = 0x7ec15a18a9834496;
#ifdef __SSE__
constexpr uint64_t kRecordedRsqrtHash = 0x5f8d15e90b98a325;
constexpr bool kHasRsqrt = true;
#else
constexpr uint64_t kRecordedRsqrtHash = 0;
constexpr bool kHasRsqrt = false;
#endif

bool same_values(const std::vector<uint32_t>& found, const uint32_t (&expected)[5]) {
  return std::equal(found.begin(), found.end(), std::begin(expected), std::end(expected));
}

bool lacks_avx512() {
#ifdef __x86_64__
  return !__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512dq") ||
         !__builtin_cpu_supports("avx512bw") || !__builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

ReferenceCpu ask() {
  ReferenceCpu result;
  bool has_same_rsqrt = kHasRsqrt;
  if (const Record* record = recorded_reference()) {
    result.float_to_uint = record->float_to_uint;
    result.srgb_hash = record->srgb_hash;
    has_same_rsqrt = rsqrt_hash() == record->rsqrt_hash;
  } else {
    Run run(gpus().reference, 1, 0);
    result.float_to_uint = float_to_uint(run);
    result.srgb_hash = srgb_hash(run);
  }
  result.float_to_uint_as_recorded = same_values(result.float_to_uint, kRecordedFloatToUint);
  result.uint_comparable = result.float_to_uint_as_recorded || same_values(result.float_to_uint, kOtherFloatToUint);
  result.srgb_as_recorded = result.srgb_hash == kRecordedSrgbHash;
  result.srgb_comparable = result.srgb_as_recorded || has_same_rsqrt;
  return result;
}

}  // namespace

uint64_t rsqrt_hash() {
#ifdef __SSE__
  uint64_t hash = 0xcbf29ce484222325u;
  for (uint32_t bits = 0x3f000000u; bits < 0x40000000u; bits += 2048) {
    const float result = _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(std::bit_cast<float>(bits))));
    hash = (hash ^ std::bit_cast<uint32_t>(result)) * 0x100000001b3u;
  }
  return hash;
#else
  return 0;
#endif
}

CpuSettings cpu_settings() {
  if (const Record* record = recorded_reference())
    return {record->srgb_hash != kRecordedSrgbHash, same_values(record->float_to_uint, kOtherFloatToUint)};
  return {kHasRsqrt && rsqrt_hash() != kRecordedRsqrtHash, lacks_avx512()};
}

const ReferenceCpu& reference_cpu() {
  static const ReferenceCpu result = ask();
  return result;
}

void print_reference_cpu() {
  const ReferenceCpu& cpu = reference_cpu();
  std::printf("reference: float to uint of -1, -0.5, 3e9, 5e9, NaN:");
  for (const uint32_t value : cpu.float_to_uint) std::printf(" %08x", value);
  std::printf(" (%s)\n", cpu.float_to_uint_as_recorded ? "as recorded"
                         : cpu.uint_comparable
                             ? "a CPU without AVX-512: this device follows it, VITRINE_REFERENCE_CPU=avx2"
                             : "NOT as recorded: cases with such conversions are left out");
  std::printf("reference: sRGB encode (RSQRTPS) of 65536 values: hash %016llx (%s)\n",
              static_cast<unsigned long long>(cpu.srgb_hash),
              cpu.srgb_as_recorded  ? "as recorded"
              : cpu.srgb_comparable ? "another CPU than recorded: this device follows it, VITRINE_RSQRT=cpu"
                                    : "NOT as recorded: cases with sRGB targets are left out");
}

}  // namespace vitrine::cts
