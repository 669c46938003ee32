// Arrays of descriptors: elements named by constants, by loop counters and by values read from memory.
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kElements = 4;

const char kCode[] = R"(
layout(local_size_x = 64) in;
layout(std140, set = 0, binding = 0) uniform U { uvec4 value; } u[4];
layout(std430, set = 0, binding = 1) buffer S { uint value[]; } s[4];
layout(std430, set = 0, binding = 2) buffer Which { uint which; };
layout(std430, set = 0, binding = 3) buffer R { uint r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x, sum = 0u;
  for (int i = 0; i < 4; ++i) sum = sum * 7u + u[i].value.x + s[i].value[id];
  sum += u[which].value.y * 1000u + s[(which + 1u) & 3u].value[63u - id] + u[2].value.z;
  r[id] = sum;
  s[(which + 2u) & 3u].value[64u + id] = sum * 3u;
})";

CTS_CASE("glsl", "descriptor_array.buffers") {
  run.require(run.gpu.features.shaderUniformBufferArrayDynamicIndexing, "shaderUniformBufferArrayDynamicIndexing");
  run.require(run.gpu.features.shaderStorageBufferArrayDynamicIndexing, "shaderStorageBufferArrayDynamicIndexing");
  std::vector<Buffer> uniforms, stores;
  for (uint32_t i = 0; i < kElements; ++i) {
    std::vector<uint32_t> small(4), large(128);
    for (uint32_t& value : small) value = run.random.below(1000);
    for (uint32_t& value : large) value = run.random.below(1000);
    uniforms.push_back(run.buffer_of(small));
    stores.push_back(run.buffer_of(large));
  }
  Binding u = uniform_buffer(0, uniforms[0]), s = storage_buffer(1, stores[0]);
  for (uint32_t i = 1; i < kElements; ++i) {
    u.buffers.push_back(uniform_buffer(0, uniforms[i]).buffers[0]);
    s.buffers.push_back(storage_buffer(1, stores[i]).buffers[0]);
  }
  const Buffer which = run.buffer_of(std::vector<uint32_t>{run.random.below(kElements)});
  const Buffer out = run.buffer(256);
  const Resources res = run.resources({u, s, storage_buffer(2, which), storage_buffer(3, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, kCode));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
  for (uint32_t i = 0; i < kElements; ++i) run.out("stored" + std::to_string(i), stores[i]);
}

}  // namespace
}  // namespace vitrine::cts
