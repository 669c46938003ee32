// What the reference does where its bits depend on the CPU (DESIGN.md section 8).
#include <cstdio>

#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Recorded on the machine that defines the reference: sRGB bytes of seven values, and float to uint.
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
  const Target target = make_target(run, spec);
  GraphicsSpec graphics;
  graphics.vertex = kFullScreenVertex;
  graphics.fragment = R"(
layout(location = 0) out vec4 result;
void main() {
  float t = (floor(gl_FragCoord.y) * 256.0 + gl_FragCoord.x) / 65536.0;
  result = vec4(t, t * t, sqrt(t), 1.0);
})";
  const VkPipeline pipeline = make_pipeline(run, graphics, target);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  uint64_t hash = 0xcbf29ce484222325u;
  for (const unsigned char byte : run.download(target.colors[0], 0)) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

}  // namespace

void probe_reference() {
  Run run(gpus().reference, 1, 0);
  const std::vector<uint32_t> converted = float_to_uint(run);
  std::printf("reference: float to uint of -1, -0.5, 3e9, 5e9, NaN:");
  for (const uint32_t value : converted) std::printf(" %08x", value);
  const bool avx512 = converted[0] == 0xffffffffu && converted[3] == 0xffffffffu;
  std::printf(" (%s AVX-512)\n", avx512 ? "as with" : "UNLIKE");
  std::printf("reference: sRGB encode (RSQRTPS) of 65536 values: hash %016llx\n",
              static_cast<unsigned long long>(srgb_hash(run)));
}

}  // namespace vitrine::cts
