// Vertex attributes: every format that the reference fetches, strides, offsets, instance rate, missing components.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

struct Attribute {
  VkFormat format;
  const char* name;
  uint32_t bytes;
  char kind;  ///< f, u or i: what the shader declares
};

#define ROW(name, bytes, kind) \
  { VK_FORMAT_##name, #name, bytes, kind }
const Attribute kAttributes[] = {
    ROW(R8_UNORM, 1, 'f'),
    ROW(R8G8_UNORM, 2, 'f'),
    ROW(R8G8B8A8_UNORM, 4, 'f'),
    ROW(B8G8R8A8_UNORM, 4, 'f'),
    ROW(R8_SNORM, 1, 'f'),
    ROW(R8G8_SNORM, 2, 'f'),
    ROW(R8G8B8A8_SNORM, 4, 'f'),
    ROW(R8G8B8A8_USCALED, 4, 'f'),
    ROW(R8G8B8A8_SSCALED, 4, 'f'),
    ROW(R8_UINT, 1, 'u'),
    ROW(R8G8_UINT, 2, 'u'),
    ROW(R8G8B8A8_UINT, 4, 'u'),
    ROW(R8_SINT, 1, 'i'),
    ROW(R8G8B8A8_SINT, 4, 'i'),
    ROW(R16_UNORM, 2, 'f'),
    ROW(R16G16_UNORM, 4, 'f'),
    ROW(R16G16B16A16_UNORM, 8, 'f'),
    ROW(R16G16_SNORM, 4, 'f'),
    ROW(R16G16B16A16_SNORM, 8, 'f'),
    ROW(R16G16B16A16_USCALED, 8, 'f'),
    ROW(R16G16B16A16_SSCALED, 8, 'f'),
    ROW(R16_UINT, 2, 'u'),
    ROW(R16G16_UINT, 4, 'u'),
    ROW(R16G16B16A16_UINT, 8, 'u'),
    ROW(R16G16_SINT, 4, 'i'),
    ROW(R16G16B16A16_SINT, 8, 'i'),
    ROW(R16_SFLOAT, 2, 'f'),
    ROW(R16G16_SFLOAT, 4, 'f'),
    ROW(R16G16B16A16_SFLOAT, 8, 'f'),
    ROW(R32_UINT, 4, 'u'),
    ROW(R32G32_UINT, 8, 'u'),
    ROW(R32G32B32_UINT, 12, 'u'),
    ROW(R32G32B32A32_UINT, 16, 'u'),
    ROW(R32_SINT, 4, 'i'),
    ROW(R32G32B32A32_SINT, 16, 'i'),
    ROW(R32_SFLOAT, 4, 'f'),
    ROW(R32G32_SFLOAT, 8, 'f'),
    ROW(R32G32B32_SFLOAT, 12, 'f'),
    ROW(R32G32B32A32_SFLOAT, 16, 'f'),
    ROW(A2B10G10R10_UNORM_PACK32, 4, 'f'),
    ROW(A2B10G10R10_SNORM_PACK32, 4, 'f'),
    ROW(A2R10G10B10_UNORM_PACK32, 4, 'f'),
    ROW(B10G11R11_UFLOAT_PACK32, 4, 'f'),
    ROW(A8B8G8R8_UNORM_PACK32, 4, 'f'),
    ROW(R8G8B8_UNORM, 3, 'f'),
    ROW(R16G16B16_SFLOAT, 6, 'f'),
};
#undef ROW

/// Each vertex is one pixel of a 64x64 target that receives the attribute, unchanged and flat.
void fetch_format(Run& run, const Attribute& attribute) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(run.gpu.physical, attribute.format, &properties);
  run.require(properties.bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT, attribute.name);
  TargetSpec target_spec;
  target_spec.colors = {attribute.kind == 'f'   ? VK_FORMAT_R32G32B32A32_SFLOAT
                        : attribute.kind == 'u' ? VK_FORMAT_R32G32B32A32_UINT
                                                : VK_FORMAT_R32G32B32A32_SINT};
  const Target target = make_target(run, target_spec);
  const std::string type = attribute.kind == 'f' ? "vec4" : std::string(1, attribute.kind) + "vec4";
  GraphicsSpec spec;
  spec.vertex = "layout(location = 3) in " + type + " value;\nlayout(location = 0) flat out " + type + R"( passed;
void main() {
  passed = value;
  gl_Position = vec4((float(gl_VertexIndex & 63) + 0.5) / 32.0 - 1.0, (float(gl_VertexIndex >> 6) + 0.5) / 32.0 - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
})";
  spec.fragment = "layout(location = 0) flat in " + type + " passed;\nlayout(location = 0) out " + type +
                  " result;\nvoid main() { result = passed; }\n";
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const uint32_t stride = (attribute.bytes + 3) / 4 * 4 + 8;
  spec.bindings = {{2, stride, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{3, 2, attribute.format, 4}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer vertices = run.buffer(stride * 4096 + 64);
  for (VkDeviceSize i = 0; i < vertices.size; ++i)
    vertices.data[i] = static_cast<unsigned char>(run.random.bits() >> 24);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices, 2);
    vkCmdDraw(cmd, 4096, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

const bool kRegistered = [] {
  for (const Attribute& attribute : kAttributes)
    AddCase("pipeline", std::string("vertex_input.") + attribute.name,
            [&attribute](Run& run) { fetch_format(run, attribute); });
  return true;
}();

CTS_CASE("pipeline", "vertex_input.several_bindings") {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in mat2x4 m;
layout(location = 4) in vec3 tint;
layout(location = 5) in float alpha;
layout(location = 0) out vec4 passed;
void main() {
  passed = vec4(tint, alpha) + m[1] * 0.1;
  gl_Position = vec4(position * 0.5 + m[0].xy, m[0].z * 0.25 + 0.5, 1.0);
})";
  spec.fragment = kColorFragment;
  spec.bindings = {{0, 8, VK_VERTEX_INPUT_RATE_VERTEX},
                   {1, 32, VK_VERTEX_INPUT_RATE_INSTANCE},
                   {5, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
                     {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                     {2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
                     {4, 5, VK_FORMAT_R32G32B32_SFLOAT, 0},
                     {5, 5, VK_FORMAT_R32_SFLOAT, 12}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  std::vector<float> values(4096);
  for (float& value : values) value = run.random.real(-1, 1);
  const Buffer buffer = run.buffer_of(values);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    const VkBuffer buffers[] = {buffer.handle, buffer.handle};
    const VkDeviceSize offsets[] = {128, 1024}, last = 64;
    vkCmdBindVertexBuffers(cmd, 0, 2, buffers, offsets);
    vkCmdBindVertexBuffers(cmd, 5, 1, buffers, &last);
    vkCmdDraw(cmd, 18, 4, 3, 1);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

CTS_CASE("pipeline", "vertex_input.stride_zero") {
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.bindings = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX}, {1, 0, VK_VERTEX_INPUT_RATE_VERTEX}};
  spec.attributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0}};
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer positions = run.buffer_of<float>({-0.8f, -0.7f, 0, 1, 0.9f, -0.2f, 0, 1, 0.1f, 0.8f, 0, 1});
  const Buffer color = run.buffer_of<float>({0.3f, 0.6f, 0.9f, 1.0f});
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, positions, 0);
    bind_vertices(cmd, color, 1);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
}

}  // namespace
}  // namespace vitrine::cts
