// Accesses outside of what is bound: buffers, texel fetches, images, vertices, indices of arrays.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

void dispatch(Run& run, const Resources& res, const std::string& code, uint32_t groups = 1) {
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, groups, 1, 1);
  });
}

Buffer random_buffer(Run& run, uint32_t words) {
  std::vector<uint32_t> values(words);
  for (uint32_t& value : values) value = 1 + run.random.below(1000);
  return run.buffer_of(values);
}

CTS_CASE("robustness", "storage_buffer.read") {
  run.require(run.gpu.features.robustBufferAccess, "robustBufferAccess");
  const Buffer in = random_buffer(run, 40), out = run.buffer(256);
  Binding part = storage_buffer(0, in);
  part.buffers[0].range = 100;
  dispatch(run, run.resources({part, storage_buffer(1, out)}), R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer A { uint a[]; };
layout(std430, binding = 1) buffer R { uint r[]; };
void main() { uint id = gl_GlobalInvocationID.x; r[id] = a[id] + uint(a.length()) * 10000u; })");
  run.out("out", out);
}

CTS_CASE("robustness", "storage_buffer.write") {
  run.require(run.gpu.features.robustBufferAccess, "robustBufferAccess");
  const Buffer out = random_buffer(run, 64);
  Binding part = storage_buffer(0, out);
  part.buffers[0].range = 120;
  dispatch(run, run.resources({part}), R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() {
  r[gl_GlobalInvocationID.x * 2u] = 7u;
  atomicAdd(r[gl_GlobalInvocationID.x * 2u + 1u], 3u);
})");
  run.out("out", out);
}

CTS_CASE("robustness", "uniform_buffer.read") {
  run.require(run.gpu.features.robustBufferAccess, "robustBufferAccess");
  const Buffer in = random_buffer(run, 4 * 40), out = run.buffer(64 * 16);
  Binding part = uniform_buffer(0, in);
  part.buffers[0].range = 16 * 20;
  dispatch(run, run.resources({part, storage_buffer(1, out)}), R"(
layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform A { uvec4 a[20]; };
layout(std430, binding = 1) buffer R { uvec4 r[]; };
void main() { uint id = gl_GlobalInvocationID.x; r[id] = a[id] + 1u; })");
  run.out("out", out);
}

CTS_CASE("robustness", "image.fetch_load_store") {
  ImageSpec spec;
  spec.format = VK_FORMAT_R32_UINT;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  spec.extent = {5, 6, 1};
  const Image image = run.image(spec);
  run.fill_random(image);
  const Buffer out = run.buffer(1024 * 16);
  dispatch(run,
           run.resources(
               {sampled(0, image, run.sampler(VK_FILTER_NEAREST)), storage_image(1, image), storage_buffer(2, out)}),
           R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform usampler2D t;
layout(binding = 1, r32ui) uniform readonly uimage2D s;
layout(std430, binding = 2) buffer R { uvec4 r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  ivec2 p = ivec2(int(id % 12u) - 3, int(id / 12u % 12u) - 3);
  r[id * 2u] = texelFetch(t, p, int(id / 144u));
  r[id * 2u + 1u] = imageLoad(s, p);
})",
           8);
  run.out("out", out, VK_FORMAT_R32G32B32A32_UINT);
}

CTS_CASE("robustness", "vertex_buffer.short") {
  run.require(run.gpu.features.robustBufferAccess, "robustBufferAccess");
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color;
  gl_Position = vec4(float(gl_VertexIndex % 8) / 4.0 - 0.9, float(gl_VertexIndex / 8) / 4.0 - 0.9, 0.5, 1.0);
  gl_PointSize = 6.0;
})";
  spec.fragment = kColorFragment;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  spec.floats({4});
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values(4 * 20);
  for (float& value : values) value = 0.2f + 0.8f * run.random.unit();
  const Buffer vertices = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 32, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("robustness", "index.of_local_array") {
  const Buffer in = random_buffer(run, 64), out = run.buffer(256);
  dispatch(run, run.resources({storage_buffer(0, in), storage_buffer(1, out)}), R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer A { uint a[]; };
layout(std430, binding = 1) buffer R { uint r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  uint list[5] = uint[5](a[0], a[1], a[2], a[3], id);
  list[a[id] % 5u] += 100u;
  r[id] = list[(a[id] >> 2) % 5u];
})");
  run.out("out", out);
}

}  // namespace
}  // namespace vitrine::cts
