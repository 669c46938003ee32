// Extensions that became core in Vulkan 1.2 and 1.3 and are mostly new forms of old commands.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

void require_copy2(Run& run) { run.require(run.gpu.has("VK_KHR_copy_commands2"), "VK_KHR_copy_commands2"); }

ImageSpec color_image(VkFormat format = VK_FORMAT_R8G8B8A8_UNORM) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = {40, 30, 1};
  return spec;
}

CTS_CASE("api", "copy_commands2.buffers_and_images") {
  require_copy2(run);
  const Image source = run.image(color_image()), target = run.image(color_image());
  run.fill_random(source);
  run.fill_random(target);
  const Buffer bytes = run.buffer(40 * 30 * 4), copy = run.buffer(40 * 30 * 4);
  run.once([&](VkCommandBuffer cmd) {
    const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    const VkImageCopy2 image_region{
        VK_STRUCTURE_TYPE_IMAGE_COPY_2, nullptr, source.layers(), {3, 4, 0}, target.layers(), {10, 2, 0}, {20, 25, 1}};
    const VkCopyImageInfo2 image_info{
        VK_STRUCTURE_TYPE_COPY_IMAGE_INFO_2, nullptr, source.handle, general, target.handle, general, 1, &image_region};
    CTS_COMMAND(run.gpu, CmdCopyImage2KHR)(cmd, &image_info);
    run.barrier(cmd);
    const VkBufferImageCopy2 out_region{
        VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2, nullptr, 0, 0, 0, target.layers(), {0, 0, 0}, {40, 30, 1}};
    const VkCopyImageToBufferInfo2 out_info{
        VK_STRUCTURE_TYPE_COPY_IMAGE_TO_BUFFER_INFO_2, nullptr, target.handle, general, bytes.handle, 1, &out_region};
    CTS_COMMAND(run.gpu, CmdCopyImageToBuffer2KHR)(cmd, &out_info);
    run.barrier(cmd);
    const VkBufferCopy2 regions[2] = {{VK_STRUCTURE_TYPE_BUFFER_COPY_2, nullptr, 0, 400, 2000},
                                      {VK_STRUCTURE_TYPE_BUFFER_COPY_2, nullptr, 1200, 3000, 1500}};
    const VkCopyBufferInfo2 info{VK_STRUCTURE_TYPE_COPY_BUFFER_INFO_2, nullptr, bytes.handle, copy.handle, 2, regions};
    CTS_COMMAND(run.gpu, CmdCopyBuffer2KHR)(cmd, &info);
    run.barrier(cmd);
    const VkBufferImageCopy2 in_region{
        VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2, nullptr, 400, 0, 0, source.layers(), {1, 1, 0}, {30, 14, 1}};
    const VkCopyBufferToImageInfo2 in_info{
        VK_STRUCTURE_TYPE_COPY_BUFFER_TO_IMAGE_INFO_2, nullptr, copy.handle, source.handle, general, 1, &in_region};
    CTS_COMMAND(run.gpu, CmdCopyBufferToImage2KHR)(cmd, &in_info);
  });
  run.out("source", source);
  run.out("target", target);
  run.out("copy", copy);
}

CTS_CASE("api", "copy_commands2.blit_and_resolve") {
  require_copy2(run);
  const Image source = run.image(color_image()), target = run.image(color_image());
  ImageSpec spec = color_image();
  spec.samples = VK_SAMPLE_COUNT_4_BIT;
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image samples = run.image(spec);
  run.fill_random(source);
  run.fill_random(target);
  run.once([&](VkCommandBuffer cmd) {
    const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    const VkImageBlit2 blit{VK_STRUCTURE_TYPE_IMAGE_BLIT_2, nullptr,         source.layers(),
                            {{0, 0, 0}, {40, 30, 1}},       target.layers(), {{35, 2, 0}, {4, 28, 1}}};
    const VkBlitImageInfo2 info{VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2,
                                nullptr,
                                source.handle,
                                general,
                                target.handle,
                                general,
                                1,
                                &blit,
                                VK_FILTER_LINEAR};
    CTS_COMMAND(run.gpu, CmdBlitImage2KHR)(cmd, &info);
    const VkClearColorValue color{{0.3f, 0.6f, 0.9f, 1.0f}};
    const VkImageSubresourceRange range = samples.range();
    vkCmdClearColorImage(cmd, samples.handle, general, &color, 1, &range);
    run.barrier(cmd);
    const VkImageResolve2 resolve{VK_STRUCTURE_TYPE_IMAGE_RESOLVE_2,
                                  nullptr,
                                  samples.layers(),
                                  {0, 0, 0},
                                  source.layers(),
                                  {5, 6, 0},
                                  {17, 13, 1}};
    const VkResolveImageInfo2 resolve_info{
        VK_STRUCTURE_TYPE_RESOLVE_IMAGE_INFO_2, nullptr, samples.handle, general, source.handle, general, 1, &resolve};
    CTS_COMMAND(run.gpu, CmdResolveImage2KHR)(cmd, &resolve_info);
  });
  run.out("source", source);
  run.out("target", target);
}

/// Queries that only the host ever resets.
CTS_CASE("api", "host_query_reset") {
  run.require(run.gpu.extension_features.hostQueryReset, "hostQueryReset");
  const Target target = make_target(run, {});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 c;\nvoid main() { c = uv.xyxy; }\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, 4);
  const auto reset = CTS_COMMAND(run.gpu, ResetQueryPoolEXT);
  reset(run.device, pool, 0, 4);
  std::vector<uint32_t> results(16, 77);
  const auto read = [&](uint32_t at) {
    vkGetQueryPoolResults(run.device, pool, 0, 4, 32, &results[at], 8, VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
  };
  const auto query = [&](uint32_t number) {
    run.once([&](VkCommandBuffer cmd) {
      target.begin(cmd);
      bind_pipeline(cmd, pipeline);
      vkCmdBeginQuery(cmd, pool, number, VK_QUERY_CONTROL_PRECISE_BIT);
      vkCmdDraw(cmd, 3, 1, 0, 0);
      vkCmdEndQuery(cmd, pool, number);
      vkCmdEndRenderPass(cmd);
    });
  };
  run.require(run.gpu.features.occlusionQueryPrecise, "occlusionQueryPrecise");
  query(1);
  query(2);
  reset(run.device, pool, 1, 1);
  read(0);
  query(1);
  reset(run.device, pool, 2, 2);
  read(8);
  for (size_t i = 0; i < results.size(); i += 2)
    if (!results[i + 1]) results[i] = 77;  // "the value is undefined" without availability
  run.out("results", run.buffer_of(results));
}

/// Blocks whose members lie where only the relaxed layout rules allow them.
void block_layout(Run& run, bool claimed, const char* feature, const std::string& layout, const std::string& members,
                  const std::string& sum) {
  run.require(claimed, feature);
  std::vector<float> values(256);
  for (float& value : values) value = run.random.real(-8, 8);
  const Buffer uniform = run.buffer_of(values), storage = run.buffer_of(values), result = run.buffer(64 * 4);
  const Resources res =
      run.resources({uniform_buffer(0, uniform), storage_buffer(1, storage), storage_buffer(2, result)});
  const VkPipeline pipeline = run.compute(
      res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                             "#extension GL_EXT_scalar_block_layout : require\nlayout(local_size_x = 64) in;\n"
                             "struct S { float f; vec3 v; };\nlayout(" +
                                 layout + ", binding = 0) uniform U {" + members + "} u;\nlayout(" + layout +
                                 ", binding = 1) readonly buffer B {" + members +
                                 "} b;\nlayout(binding = 2) buffer R { float r[]; };\n"
                                 "void main() { uint i = gl_LocalInvocationIndex; r[i] = " +
                                 sum + "; }\n"));
  run.dispatch(res, pipeline, 1);
  run.out("result", result, VK_FORMAT_R32_SFLOAT);
}

CTS_CASE("glsl", "block_layout.uniform_std430") {
  block_layout(run, run.gpu.extension_features.uniformBufferStandardLayout, "uniformBufferStandardLayout", "std430",
               "float list[11]; vec2 pairs[9]; S s[3]; mat2 m[2]; float tail[50];",
               "u.list[i % 11u] + b.list[(i * 3u) % 11u] * u.pairs[i % 9u].y + u.s[i % 3u].v.z - b.s[i % 3u].f + "
               "u.m[i & 1u][1].x + u.tail[i % 50u]");
}
CTS_CASE("glsl", "block_layout.scalar") {
  block_layout(run, run.gpu.extension_features.scalarBlockLayout, "scalarBlockLayout", "scalar",
               "vec3 first[7]; float x; S s[5]; vec3 y; mat3 m[2]; float tail[50];",
               "u.first[i % 7u].z + b.first[(i * 3u) % 7u].x * u.x + u.s[i % 5u].v.y - b.s[i % 5u].f + b.y.z + "
               "u.m[i & 1u][2].y + u.tail[i % 50u]");
}

}  // namespace
}  // namespace vitrine::cts
