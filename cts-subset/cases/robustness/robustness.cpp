// Accesses outside of what is bound: buffers, texel fetches, images, vertices, indices of arrays.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

void dispatch(Run& run, const Resources& res, const std::string& code, uint32_t groups = 1) {
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, groups);
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

Binding null_buffer(uint32_t binding, VkDescriptorType type) {
  return {binding, type, {{VK_NULL_HANDLE, 0, VK_WHOLE_SIZE}}, {}, {}};
}
Binding null_image(uint32_t binding, VkDescriptorType type, VkSampler sampler = VK_NULL_HANDLE) {
  return {binding, type, {}, {{sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL}}, {}};
}

CTS_CASE("robustness", "null.buffers") {
  run.require(run.gpu.extension_features.nullDescriptor, "nullDescriptor");
  const Buffer out = run.buffer(64 * 4);
  dispatch(run,
           run.resources({null_buffer(0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                          null_buffer(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER), storage_buffer(2, out)}),
           R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer A { uint a[]; };
layout(std140, binding = 1) uniform B { uvec4 b[4]; };
layout(std430, binding = 2) buffer R { uint r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  a[id] = 5u;  // the reference hands a stored value to a load of the same element
  r[id] = id + a[id + 64u] * 3u + b[id & 3u].y * 7u + uint(a.length()) * 1000u + atomicAdd(a[1], 1u);
})");
  run.out("out", out);
}

CTS_CASE("robustness", "null.images") {
  run.require(run.gpu.extension_features.nullDescriptor, "nullDescriptor");
  const Buffer out = run.buffer(64 * 16);
  const VkSampler sampler = run.sampler(VK_FILTER_LINEAR);
  Binding texels{2, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {VK_NULL_HANDLE}};
  dispatch(run,
           run.resources({null_image(0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sampler),
                          null_image(1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE), texels, storage_buffer(3, out)}),
           R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D t;
layout(binding = 1, rgba8) uniform image2D s;
layout(binding = 2) uniform samplerBuffer b;
layout(std430, binding = 3) buffer R { vec4 r[]; };
void main() {
  int id = int(gl_GlobalInvocationID.x);
  imageStore(s, ivec2(id), vec4(1.0));
  vec4 sum = texture(t, vec2(id) / 64.0) + texelFetch(t, ivec2(id), 0) * 2.0 + imageLoad(s, ivec2(id)) * 4.0;
  r[id] = sum + texelFetch(b, id) * 8.0 + float(id);
})");
  run.out("out", out, VK_FORMAT_R32G32B32A32_SFLOAT);
}

/// Vectors that begin inside of the bound range and end outside: each component by itself.
CTS_CASE("robustness", "vector_partly_outside") {
  run.require(run.gpu.extension_features.robustBufferAccess2, "robustBufferAccess2");
  const Buffer in = random_buffer(run, 64), out = run.buffer(64 * 16), stored = random_buffer(run, 64);
  Binding part = storage_buffer(0, in), target = storage_buffer(2, stored);
  part.buffers[0].range = target.buffers[0].range = 16 * 5 + 8;
  dispatch(run, run.resources({part, storage_buffer(1, out), target}), R"(
#extension GL_EXT_scalar_block_layout : enable
layout(local_size_x = 16) in;
layout(std430, binding = 0) buffer A { uvec4 a[]; };
layout(std430, binding = 1) buffer R { uvec4 r[]; };
layout(std430, binding = 2) buffer S { uvec4 s[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  r[id] = a[id];
  s[id] = uvec4(id + 1u);
})");
  run.out("out", out);
  run.out("stored", stored);
}

/// Coordinates, layers, levels and samples that do not exist, for formats with and without alpha.
void image_outside(Run& run, VkFormat format, VkImageViewType view, const char* sampler_type, const char* coord) {
  run.require(run.gpu.extension_features.robustImageAccess2, "robustImageAccess2");
  ImageSpec spec;
  spec.format = format;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  spec.view = view;
  spec.extent = {5, view == VK_IMAGE_VIEW_TYPE_1D ? 1u : 6u, view == VK_IMAGE_VIEW_TYPE_3D ? 3u : 1u};
  spec.layers = view == VK_IMAGE_VIEW_TYPE_2D_ARRAY ? 3 : 1;
  spec.levels = 2;
  const Image image = run.image(spec);
  run.fill_random(image);
  const Buffer out = run.buffer(512 * 16);
  dispatch(run, run.resources({sampled(0, image, run.sampler(VK_FILTER_NEAREST)), storage_buffer(1, out)}),
           std::string("layout(local_size_x = 64) in;\nlayout(binding = 0) uniform ") + sampler_type +
               " t;\nlayout(std430, binding = 1) buffer R { vec4 r[]; };\n"
               "void main() {\n"
               "  int id = int(gl_GlobalInvocationID.x), x = id % 8 - 1, y = id / 8 % 8 - 1, z = id / 64 % 6 - 1;\n"
               "  r[id] = texelFetch(t, " +
               coord + ", id / 128 - 1);\n}\n",
           8);
  run.out("out", out, VK_FORMAT_R32G32B32A32_SFLOAT);
}

const bool kOutside = [] {
  struct Row {
    const char* name;
    VkImageViewType view;
    const char *sampler, *coord;
  };
  const Row kRows[] = {{"1d", VK_IMAGE_VIEW_TYPE_1D, "sampler1D", "x + y"},
                       {"2d", VK_IMAGE_VIEW_TYPE_2D, "sampler2D", "ivec2(x, y)"},
                       {"3d", VK_IMAGE_VIEW_TYPE_3D, "sampler3D", "ivec3(x, y, z)"},
                       {"2d_array", VK_IMAGE_VIEW_TYPE_2D_ARRAY, "sampler2DArray", "ivec3(x, y, z)"}};
  for (const Row& row : kRows)
    for (const auto& [format, name] : {std::pair{VK_FORMAT_R8G8B8A8_UNORM, "rgba"}, {VK_FORMAT_R8G8_UNORM, "rg"}})
      AddCase("robustness", std::string("image_outside.") + row.name + "." + name,
              [=, format = format](Run& run) { image_outside(run, format, row.view, row.sampler, row.coord); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
