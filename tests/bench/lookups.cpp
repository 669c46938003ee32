// Lookups without a filter or outside of fragment shaders: texel buffers, storage images, explicit levels.
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr std::uint32_t kSide = 1024;

/// Million invocations per second of a compute shader of one invocation per pixel of a square of kSide.
double measure_compute(Run& run, const std::string& text, const std::vector<cts::Binding>& bindings) {
  const cts::Resources resources = run.resources(bindings);
  const std::string head = "layout(local_size_x=16, local_size_y=16) in;";
  const VkPipeline pipeline = run.compute(resources.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, head + text));
  VkCommandBuffer cmd = begin_repeatable(run);
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  resources.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
  vkCmdDispatch(cmd, kSide / 16, kSide / 16, 1);
  return double{kSide} * kSide / time_submissions(run, finish(cmd)) / 1e6;
}

cts::Image make_image(Run& run, VkFormat format, VkImageUsageFlags usage, std::uint32_t levels = 1) {
  cts::ImageSpec spec;
  spec.format = format;
  spec.extent = {kSide, kSide, 1};
  spec.usage = usage;
  spec.levels = levels;
  const cts::Image image = run.image(spec);
  run.fill_random(image);
  return image;
}

VkSampler make_trilinear(Run& run) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.maxLod = 1000;
  return run.sampler(info);
}

double sample_in_compute(Run& run) {
  const cts::Image image = make_image(run, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_SAMPLED_BIT, 10);
  return measure_compute(
      run,
      "layout(binding=0) uniform sampler2D t; layout(binding=1) buffer B { vec4 b[]; };"
      "void main() { uvec2 p = gl_GlobalInvocationID.xy; b[p.y * 1024u + p.x] = textureLod(t, vec2(p) / 700.0, 0.7); }",
      {cts::sampled(0, image, make_trilinear(run)), cts::storage_buffer(1, run.buffer(kSide * kSide * 16))});
}

double store_image(Run& run, VkFormat format, const char* layout) {
  const cts::Image image = make_image(run, format, VK_IMAGE_USAGE_STORAGE_BIT);
  return measure_compute(run,
                         std::string("layout(binding=0, ") + layout +
                             ") writeonly uniform image2D t; void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);"
                             "imageStore(t, p, vec4(p, 0.5, 1.0) * (1.0 / 1024.0)); }",
                         {cts::storage_image(0, image)});
}

double load_image(Run& run, VkFormat format, const char* layout) {
  const cts::Image image = make_image(run, format, VK_IMAGE_USAGE_STORAGE_BIT);
  return measure_compute(
      run,
      std::string("layout(binding=0, ") + layout +
          ") readonly uniform image2D t; layout(binding=1) buffer B { vec4 b[]; };"
          "void main() { uvec2 p = gl_GlobalInvocationID.xy; b[p.y * 1024u + p.x] = imageLoad(t, ivec2(p)); }",
      {cts::storage_image(0, image), cts::storage_buffer(1, run.buffer(kSide * kSide * 16))});
}

/// 25 loads around every pixel of a storage image, weighted, and a store.
double stencil_image(Run& run, VkFormat format, const char* layout) {
  const cts::Image from = make_image(run, format, VK_IMAGE_USAGE_STORAGE_BIT);
  const cts::Image to = make_image(run, format, VK_IMAGE_USAGE_STORAGE_BIT);
  const std::string qualifiers[] = {std::string("layout(binding=0, ") + layout + ") readonly uniform image2D t;",
                                    std::string("layout(binding=1, ") + layout + ") writeonly uniform image2D u;"};
  return measure_compute(
      run,
      qualifiers[0] + qualifiers[1] +
          "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); vec4 s = vec4(0); for (int y = -2; y <= 2; ++y)"
          "for (int x = -2; x <= 2; ++x) s += imageLoad(t, clamp(p + ivec2(x, y), ivec2(0), ivec2(1023))) * "
          "(1.0 / float(3 + x * x + y * y)); imageStore(u, p, s * 0.2); }",
      {cts::storage_image(0, from), cts::storage_image(1, to)});
}

/// Texels of a uniform texel buffer, scattered over it.
double fetch_texels(Run& run, VkFormat format, std::uint32_t bytes) {
  constexpr std::uint32_t kTexels = 1 << 16;
  const cts::Buffer buffer = run.buffer(kTexels * bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  for (std::uint32_t i = 0; i < kTexels * bytes; ++i) buffer.data[i] = static_cast<unsigned char>(i * 37 & 0x3B);
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view;
  CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &view));
  run.own(view, vkDestroyBufferView);
  const cts::Resources resources = run.resources({{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {view}}});
  return measure_fragments(run,
                           "layout(location=0) in vec2 uv; layout(location=0) out vec4 o; layout(binding=0) uniform "
                           "samplerBuffer t; void main() { ivec2 p = ivec2(gl_FragCoord.xy);"
                           "o = texelFetch(t, p.x * 37 + p.y * 11 & 65535); }",
                           &resources);
}

/// Million vertices per second: heights looked up for triangles too small to cover a sample.
double sample_in_vertices(Run& run) {
  const cts::Image image = make_image(run, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_SAMPLED_BIT, 10);
  const cts::Resources resources = run.resources({cts::sampled(0, image, make_trilinear(run))});
  const cts::Target target = make_screen(run, 256, 256);
  cts::GraphicsSpec spec;
  spec.layout = resources.layout;
  spec.vertex =
      "layout(location=0) out vec4 c; layout(binding=0) uniform sampler2D t;"
      "void main() { vec2 p = vec2(gl_VertexIndex % 300, gl_VertexIndex / 300) / 300.0; c = textureLod(t, p, 1.3);"
      "gl_Position = vec4(p * 2.0 - 1.0, c.x * 0.5, 1.0) * vec4(1e-6, 1e-6, 1.0, 1.0); }";
  spec.fragment = cts::kColorFragment;
  const VkPipeline pipeline = cts::make_pipeline(run, spec, target);
  constexpr std::uint32_t kVertices = 90000;
  VkCommandBuffer cmd = begin_repeatable(run);
  target.begin(cmd);
  cts::bind_pipeline(cmd, pipeline);
  resources.bind(cmd);
  vkCmdDraw(cmd, kVertices, 1, 0, 0);
  vkCmdEndRenderPass(cmd);
  return kVertices / time_submissions(run, finish(cmd)) / 1e6;
}

}  // namespace

std::vector<Workload> lookup_workloads() {
  return {
      {"tex_compute", "Mpix/s", false, sample_in_compute},
      {"tex_vertex", "Mvert/s", false, sample_in_vertices},
      {"tbo_rgba8", "Mpix/s", false, [](Run& run) { return fetch_texels(run, VK_FORMAT_R8G8B8A8_UNORM, 4); }},
      {"tbo_rgba32f", "Mpix/s", false, [](Run& run) { return fetch_texels(run, VK_FORMAT_R32G32B32A32_SFLOAT, 16); }},
      {"tbo_r8", "Mpix/s", false, [](Run& run) { return fetch_texels(run, VK_FORMAT_R8_UNORM, 1); }},
      {"img_load_rgba8", "Mpix/s", false, [](Run& run) { return load_image(run, VK_FORMAT_R8G8B8A8_UNORM, "rgba8"); }},
      {"img_load_r32f", "Mpix/s", false, [](Run& run) { return load_image(run, VK_FORMAT_R32_SFLOAT, "r32f"); }},
      {"img_stencil_rgba8", "Mpix/s", false,
       [](Run& run) { return stencil_image(run, VK_FORMAT_R8G8B8A8_UNORM, "rgba8"); }},
      {"img_stencil_r32f", "Mpix/s", false, [](Run& run) { return stencil_image(run, VK_FORMAT_R32_SFLOAT, "r32f"); }},
      {"img_store_rgba8", "Mpix/s", false,
       [](Run& run) { return store_image(run, VK_FORMAT_R8G8B8A8_UNORM, "rgba8"); }},
      {"img_store_rgba16f", "Mpix/s", false,
       [](Run& run) { return store_image(run, VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f"); }},
      {"img_store_r32f", "Mpix/s", false, [](Run& run) { return store_image(run, VK_FORMAT_R32_SFLOAT, "r32f"); }}};
}

}  // namespace vitrine::bench
