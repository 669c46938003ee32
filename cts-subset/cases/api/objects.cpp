// Objects and commands of the API itself: command buffers, queries, events, semaphores, memory, views, caches.
#include <cmath>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// A triangle into a target; what the command buffer cases record.
struct Triangle {
  Target target;
  VkPipeline pipeline;
  Buffer vertices;

  explicit Triangle(Run& run, TargetSpec target_spec = {}, std::vector<VkDynamicState> dynamic = {})
      : target(make_target(run, target_spec)) {
    GraphicsSpec spec;
    spec.vertex = kColorVertex;
    spec.fragment = kColorFragment;
    spec.floats({4, 4});
    spec.dynamic = std::move(dynamic);
    spec.blends = {VkPipelineColorBlendAttachmentState{VK_TRUE, VK_BLEND_FACTOR_CONSTANT_COLOR, VK_BLEND_FACTOR_ONE,
                                                       VK_BLEND_OP_ADD, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO,
                                                       VK_BLEND_OP_ADD, 0xf}};
    for (float& constant : spec.blend.blendConstants) constant = 0.5f;
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = target_spec.depth != 0;
    spec.depth.stencilTestEnable = target_spec.depth == VK_FORMAT_D24_UNORM_S8_UINT;
    spec.depth.front = spec.depth.back = {
        VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_LESS, 0xff, 0xff, 1};
    spec.raster.depthBiasEnable = VK_TRUE;
    pipeline = make_pipeline(run, spec, target);
    std::vector<float> values;
    // Corners about a third of a turn apart, so that every triangle covers the centre whatever the seed; the second one
    // faces the other way, so that the stencil tests of the third find the first.
    for (int i = 0; i < 9; ++i) {
      const int corner = i / 3 == 1 ? i % 3 : 2 - i % 3;
      const float turn = static_cast<float>(corner) * 2.0944f + run.random.real(-0.45f, 0.45f);
      const float radius = run.random.real(0.7f, 1.2f);
      for (const float v : {radius * std::cos(turn), radius * std::sin(turn), run.random.unit(), 1.0f})
        values.push_back(v);
      for (int c = 0; c < 4; ++c) values.push_back(run.random.unit());
    }
    vertices = run.buffer_of(values);
  }
  void draw(VkCommandBuffer cmd, uint32_t first = 0, uint32_t count = 9) const {
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, count, 1, first, 0);
  }
};

VkCommandBuffer record_secondary(Run& run, const Triangle& triangle, uint32_t first, VkCommandBufferUsageFlags usage) {
  VkCommandBufferInheritanceInfo inheritance{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
  inheritance.renderPass = triangle.target.pass;
  inheritance.framebuffer = triangle.target.framebuffer;
  const VkCommandBuffer cmd =
      run.begin_secondary(inheritance, usage | VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT);
  triangle.draw(cmd, first, 3);
  CTS_VK(vkEndCommandBuffer(cmd));
  return cmd;
}

CTS_CASE("api", "command_buffer.secondary") {
  const Triangle triangle(run);
  const VkCommandBuffer secondaries[] = {record_secondary(run, triangle, 0, 0), record_secondary(run, triangle, 6, 0)};
  run.once([&](VkCommandBuffer cmd) {
    triangle.target.begin(cmd, VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
    vkCmdExecuteCommands(cmd, 2, secondaries);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, triangle.target);
}

CTS_CASE("api", "command_buffer.secondary_simultaneous") {
  const Triangle triangle(run);
  const VkCommandBuffer secondary = record_secondary(run, triangle, 3, VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 2; ++n) {
      triangle.target.begin(cmd, VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
      vkCmdExecuteCommands(cmd, 1, &secondary);
      vkCmdExecuteCommands(cmd, 1, &secondary);
      vkCmdEndRenderPass(cmd);
      run.barrier(cmd);
    }
  });
  out_target(run, triangle.target);
}

CTS_CASE("api", "command_buffer.secondary_outside_render_pass") {
  const Buffer buffer = run.buffer(256);
  const VkCommandBufferInheritanceInfo inheritance{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
  const VkCommandBuffer secondary = run.begin_secondary(inheritance, 0);
  vkCmdFillBuffer(secondary, buffer.handle, 16, 100, 0x12345678);
  CTS_VK(vkEndCommandBuffer(secondary));
  run.once([&](VkCommandBuffer cmd) { vkCmdExecuteCommands(cmd, 1, &secondary); });
  run.out("buffer", buffer);
}

CTS_CASE("api", "command_buffer.resubmitted") {
  const Buffer counter = run.buffer_of<uint32_t>({5, 0, 0, 0});
  const Resources res = run.resources({storage_buffer(0, counter)});
  const VkPipeline pipeline =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                         "layout(local_size_x = 1) in;\nlayout(binding = 0) buffer C { uint c[]; "
                                         "};\nvoid main() { c[1] = c[0]; c[0] = c[0] * 3u + 1u; }\n"));
  const VkCommandBuffer cmd = run.begin();
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
  vkCmdDispatch(cmd, 1, 1, 1);
  run.barrier(cmd);
  CTS_VK(vkEndCommandBuffer(cmd));
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &cmd;
  for (int n = 0; n < 5; ++n) {
    CTS_VK(vkQueueSubmit(run.gpu.queue, 1, &info, VK_NULL_HANDLE));
    CTS_VK(vkQueueWaitIdle(run.gpu.queue));
  }
  run.out("counter", counter);
}

CTS_CASE("api", "semaphores_and_batches") {
  const Buffer a = run.buffer_of<uint32_t>({1, 2, 3, 4, 5, 6, 7, 8}), b = run.buffer(32), c = run.buffer(32);
  VkSemaphoreCreateInfo semaphore_info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore;
  CTS_VK(vkCreateSemaphore(run.device, &semaphore_info, nullptr, &semaphore));
  run.own(semaphore, vkDestroySemaphore);
  const auto copy = [&](const Buffer& from, const Buffer& to, VkDeviceSize shift) {
    const VkCommandBuffer cmd = run.begin();
    const VkBufferCopy region{0, shift, 32 - shift};
    vkCmdCopyBuffer(cmd, from.handle, to.handle, 1, &region);
    run.barrier(cmd);
    CTS_VK(vkEndCommandBuffer(cmd));
    return cmd;
  };
  const VkCommandBuffer first = copy(a, b, 8), second = copy(b, c, 4);
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  VkSubmitInfo infos[2] = {{VK_STRUCTURE_TYPE_SUBMIT_INFO}, {VK_STRUCTURE_TYPE_SUBMIT_INFO}};
  infos[0].commandBufferCount = infos[1].commandBufferCount = 1;
  infos[0].pCommandBuffers = &first;
  infos[0].signalSemaphoreCount = 1;
  infos[0].pSignalSemaphores = &semaphore;
  infos[1].pCommandBuffers = &second;
  infos[1].waitSemaphoreCount = 1;
  infos[1].pWaitSemaphores = &semaphore;
  infos[1].pWaitDstStageMask = &stage;
  VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence;
  CTS_VK(vkCreateFence(run.device, &fence_info, nullptr, &fence));
  run.own(fence, vkDestroyFence);
  const VkResult before = vkGetFenceStatus(run.device, fence);
  CTS_VK(vkQueueSubmit(run.gpu.queue, 2, infos, fence));
  CTS_VK(vkWaitForFences(run.device, 1, &fence, VK_TRUE, UINT64_MAX));
  const VkResult after = vkGetFenceStatus(run.device, fence);
  CTS_VK(vkResetFences(run.device, 1, &fence));
  run.out("c", c);
  run.out("status", run.buffer_of<int32_t>({before, after, vkGetFenceStatus(run.device, fence)}));
}

CTS_CASE("api", "events") {
  VkEventCreateInfo info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO};
  VkEvent event;
  CTS_VK(vkCreateEvent(run.device, &info, nullptr, &event));
  run.own(event, vkDestroyEvent);
  std::vector<int32_t> states{vkGetEventStatus(run.device, event)};
  CTS_VK(vkSetEvent(run.device, event));
  states.push_back(vkGetEventStatus(run.device, event));
  CTS_VK(vkResetEvent(run.device, event));
  states.push_back(vkGetEventStatus(run.device, event));
  const Buffer buffer = run.buffer(64);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdFillBuffer(cmd, buffer.handle, 0, 32, 7);
    vkCmdSetEvent(cmd, event, VK_PIPELINE_STAGE_TRANSFER_BIT);
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    vkCmdWaitEvents(cmd, 1, &event, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 1, &memory, 0,
                    nullptr, 0, nullptr);
    const VkBufferCopy copy{0, 40, 16};
    vkCmdCopyBuffer(cmd, buffer.handle, buffer.handle, 1, &copy);
  });
  states.push_back(vkGetEventStatus(run.device, event));
  run.once([&](VkCommandBuffer cmd) { vkCmdResetEvent(cmd, event, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT); });
  states.push_back(vkGetEventStatus(run.device, event));
  run.out("states", run.buffer_of(states));
  run.out("buffer", buffer);
}

void occlusion(Run& run, VkSampleCountFlagBits samples, bool wide) {
  run.require(run.gpu.features.occlusionQueryPrecise, "occlusionQueryPrecise");
  TargetSpec target_spec;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  target_spec.samples = samples;
  const Triangle triangle(run, target_spec);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, 4);
  const Buffer results = run.buffer(4 * 16);
  const VkQueryResultFlags flags =
      VK_QUERY_RESULT_WAIT_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT | (wide ? VK_QUERY_RESULT_64_BIT : 0);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 4);
    triangle.target.begin(cmd);
    for (uint32_t n = 0; n < 3; ++n) {
      vkCmdBeginQuery(cmd, pool, n, VK_QUERY_CONTROL_PRECISE_BIT);
      triangle.draw(cmd, n * 3, 3);
      vkCmdEndQuery(cmd, pool, n);
    }
    vkCmdBeginQuery(cmd, pool, 3, VK_QUERY_CONTROL_PRECISE_BIT);
    triangle.draw(cmd);
    vkCmdEndQuery(cmd, pool, 3);
    vkCmdEndRenderPass(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 4, results.handle, 0, 16, flags);
  });
  std::vector<uint32_t> host(16);
  CTS_VK(vkGetQueryPoolResults(run.device, pool, 0, 4, 64, host.data(), 16, flags));
  run.out("copied", results);
  run.out("host", run.buffer_of(host));
}

CTS_CASE("api", "query.occlusion_32") { occlusion(run, VK_SAMPLE_COUNT_1_BIT, false); }
CTS_CASE("api", "query.occlusion_64") { occlusion(run, VK_SAMPLE_COUNT_1_BIT, true); }
CTS_CASE("api", "query.occlusion_multisample") { occlusion(run, VK_SAMPLE_COUNT_4_BIT, true); }

CTS_CASE("api", "query.pipeline_statistics") {
  run.require(run.gpu.features.pipelineStatisticsQuery, "pipelineStatisticsQuery");
  const Triangle triangle(run);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                                           VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                                               VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    triangle.target.begin(cmd);
    vkCmdBeginQuery(cmd, pool, 0, 0);
    triangle.draw(cmd);
    triangle.draw(cmd, 3, 3);
    vkCmdEndQuery(cmd, pool, 0);
    vkCmdEndRenderPass(cmd);
  });
  std::vector<uint64_t> counts(2);
  CTS_VK(vkGetQueryPoolResults(run.device, pool, 0, 1, 16, counts.data(), 16,
                               VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
  run.out("counts", run.buffer_of(counts));
}

CTS_CASE("api", "query.timestamp_is_monotonic") {
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_TIMESTAMP, 2);
  const Buffer buffer = run.buffer(1 << 16);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 2);
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, pool, 0);
    vkCmdFillBuffer(cmd, buffer.handle, 0, VK_WHOLE_SIZE, 1);
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 1);
  });
  uint64_t times[2] = {};
  const VkResult got =
      vkGetQueryPoolResults(run.device, pool, 0, 2, 16, times, 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  run.out("ordered", run.buffer_of<uint32_t>({times[1] >= times[0], times[0] != 0, static_cast<uint32_t>(got), 7}));
}

CTS_CASE("api", "dynamic_state.everything") {
  TargetSpec target_spec;
  target_spec.depth = VK_FORMAT_D24_UNORM_S8_UINT;
  const Triangle triangle(
      run, target_spec,
      {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_LINE_WIDTH, VK_DYNAMIC_STATE_DEPTH_BIAS,
       VK_DYNAMIC_STATE_BLEND_CONSTANTS, VK_DYNAMIC_STATE_DEPTH_BOUNDS, VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK,
       VK_DYNAMIC_STATE_STENCIL_WRITE_MASK, VK_DYNAMIC_STATE_STENCIL_REFERENCE});
  run.once([&](VkCommandBuffer cmd) {
    triangle.target.begin(cmd);
    for (uint32_t n = 0; n < 3; ++n) {
      const auto f = static_cast<float>(n);
      const VkViewport viewport{f * 5.0f, f * 3.0f, 64.0f - f * 12.0f, 60.0f, 0.1f * f, 1.0f};
      const VkRect2D scissor{{static_cast<int32_t>(n) * 4, 2}, {50, 40 + n * 6}};
      const float constants[4] = {0.2f + f * 0.3f, 0.5f, 0.9f - f * 0.3f, 1.0f};
      vkCmdSetViewport(cmd, 0, 1, &viewport);
      vkCmdSetScissor(cmd, 0, 1, &scissor);
      vkCmdSetLineWidth(cmd, 1.0f);
      vkCmdSetDepthBias(cmd, f * 100.0f, 0.0f, f * 0.5f);
      vkCmdSetBlendConstants(cmd, constants);
      vkCmdSetDepthBounds(cmd, 0.0f, 1.0f);
      vkCmdSetStencilCompareMask(cmd, VK_STENCIL_FACE_FRONT_AND_BACK, 0x0f + n);
      vkCmdSetStencilWriteMask(cmd, VK_STENCIL_FACE_FRONT_BIT, 0xff >> n);
      vkCmdSetStencilWriteMask(cmd, VK_STENCIL_FACE_BACK_BIT, 0xf0);
      vkCmdSetStencilReference(cmd, VK_STENCIL_FACE_FRONT_AND_BACK, n * 3);
      triangle.draw(cmd, n * 3, 3);
    }
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, triangle.target);
}

CTS_CASE("api", "pipeline_cache") {
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache caches[2];
  for (VkPipelineCache& cache : caches) {
    CTS_VK(vkCreatePipelineCache(run.device, &info, nullptr, &cache));
    run.own(cache, vkDestroyPipelineCache);
  }
  GraphicsSpec spec;
  const Target target = make_target(run, {});
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(uv, uv.yx); }\n";
  spec.cache = caches[0];
  make_pipeline(run, spec, target);
  CTS_VK(vkMergePipelineCaches(run.device, caches[1], 1, caches));
  size_t size = 0;
  CTS_VK(vkGetPipelineCacheData(run.device, caches[1], &size, nullptr));
  std::vector<unsigned char> data(size);
  CTS_VK(vkGetPipelineCacheData(run.device, caches[1], &size, data.data()));
  if (size < 32) throw std::runtime_error("pipeline cache data is shorter than its header");
  info.initialDataSize = size;
  info.pInitialData = data.data();
  VkPipelineCache third;
  CTS_VK(vkCreatePipelineCache(run.device, &info, nullptr, &third));
  run.own(third, vkDestroyPipelineCache);
  spec.cache = third;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline);
  out_target(run, target);
}

CTS_CASE("api", "descriptor_arrays_and_dynamic_offsets") {
  const Buffer values = run.buffer(4096), out = run.buffer(64 * 4);
  for (uint32_t i = 0; i < 1024; ++i) values.as<uint32_t>()[i] = i;
  Binding list = storage_buffer(0, values);
  list.buffers = {{values.handle, 0, 256}, {values.handle, 1024, 256}, {values.handle, 2048, 256}};
  Binding moving = uniform_buffer(1, values);
  moving.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
  moving.buffers[0].range = 256;
  const Resources res = run.resources({list, moving, storage_buffer(2, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 16) in;
layout(std430, binding = 0) buffer L { uint v[]; } list[3];
layout(std140, binding = 1) uniform M { uvec4 m[16]; };
layout(std430, binding = 2) buffer R { uint r[]; };
void main() {
  uint id = gl_LocalInvocationIndex;
  r[m[0].x / 64u * 16u + id] = list[0].v[id] + list[1].v[id] * 3u + list[2].v[id + 1u] + m[id].y * 1000u;
})"));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    for (const uint32_t offset : {0u, 256u, 512u, 768u}) {
      vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, res.layout, 0, 1, &res.set, 1, &offset);
      vkCmdDispatch(cmd, 1, 1, 1);
    }
  });
  run.out("out", out);
}

CTS_CASE("api", "texel_buffers") {
  const Buffer values = run.buffer(1024,
                                   VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT),
               out = run.buffer(64 * 16);
  for (uint32_t i = 0; i < 1024; ++i) values.data[i] = static_cast<unsigned char>(run.random.bits() >> 24);
  const auto view = [&](VkFormat format, VkDeviceSize offset, VkDeviceSize range) {
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = values.handle;
    info.format = format;
    info.offset = offset;
    info.range = range;
    VkBufferView result;
    CTS_VK(vkCreateBufferView(run.device, &info, nullptr, &result));
    return run.own(result, vkDestroyBufferView);
  };
  const Resources res =
      run.resources({{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, {}, {}, {view(VK_FORMAT_R8G8B8A8_UNORM, 0, 256)}},
                     {1, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, {}, {}, {view(VK_FORMAT_R32_UINT, 512, 256)}},
                     storage_buffer(2, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform samplerBuffer t;
layout(binding = 1, r32ui) uniform uimageBuffer s;
layout(std430, binding = 2) buffer R { vec4 r[]; };
void main() {
  int id = int(gl_LocalInvocationIndex);
  r[id] = texelFetch(t, id * 2) + float(textureSize(t));
  imageStore(s, id, imageLoad(s, id) + uint(imageSize(s)));
})"));
  run.dispatch(res, pipeline, 1);
  run.out("out", out, VK_FORMAT_R32G32B32A32_SFLOAT);
  run.out("values", values);
}

CTS_CASE("api", "image.linear_tiling_mapped") {
  ImageSpec spec;
  spec.tiling = VK_IMAGE_TILING_LINEAR;
  spec.extent = {19, 7, 1};
  const Image image = run.image(spec);
  run.fill_random(image);
  const VkImageSubresource part{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
  VkSubresourceLayout layout;
  vkGetImageSubresourceLayout(run.device, image.handle, &part, &layout);
  void* data = nullptr;
  CTS_VK(vkMapMemory(run.device, image.memory, 0, VK_WHOLE_SIZE, 0, &data));
  const Buffer seen = run.buffer(19 * 7 * 4);
  for (uint32_t y = 0; y < 7; ++y)
    std::memcpy(seen.data + y * 76, static_cast<unsigned char*>(data) + layout.offset + y * layout.rowPitch, 76);
  run.out("seen", seen, VK_FORMAT_R8G8B8A8_UNORM);
  run.out("image", image);
}

CTS_CASE("api", "image.views_of_levels_layers_and_formats") {
  ImageSpec spec;
  spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  spec.levels = 4;
  spec.layers = 6;
  spec.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  Image image = run.image(spec);
  run.fill_random(image);
  const Buffer out = run.buffer(4096 * 16);
  const VkComponentMapping swizzle{VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R,
                                   VK_COMPONENT_SWIZZLE_A};
  Image views[3] = {image, image, image};
  views[0].view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_SRGB,
                                 {VK_IMAGE_ASPECT_COLOR_BIT, 1, 2, 3, 1}, swizzle);
  views[1].view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R8G8B8A8_UNORM,
                                 {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 2, 3});
  views[2].view =
      run.image_view(image, VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_R8G8B8A8_UNORM, {VK_IMAGE_ASPECT_COLOR_BIT, 2, 1, 0, 6});
  const VkSampler sampler = run.sampler(VK_FILTER_NEAREST);
  const Resources res = run.resources({sampled(0, views[0], sampler), sampled(1, views[1], sampler),
                                       sampled(2, views[2], sampler), storage_buffer(3, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D a;
layout(binding = 1) uniform sampler2DArray b;
layout(binding = 2) uniform samplerCube c;
layout(std430, binding = 3) buffer R { vec4 r[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  vec2 p = vec2(float(id % 64u) + 0.5, float(id / 64u) + 0.5) / 64.0;
  r[id] = textureLod(a, p, float(id & 1u)) + textureLod(b, vec3(p, float(id % 3u)), 0.0) * 2.0 + textureLod(c, vec3(p - 0.5, 0.3), 0.0) * 4.0;
})"));
  run.dispatch(res, pipeline, 64);
  run.out("out", out, VK_FORMAT_R32G32B32A32_SFLOAT);
}

CTS_CASE("api", "resolve_image") {
  TargetSpec target_spec;
  target_spec.samples = VK_SAMPLE_COUNT_4_BIT;
  const Triangle triangle(run, target_spec);
  ImageSpec spec;
  spec.extent = {80, 80, 1};
  const Image resolved = run.image(spec);
  run.fill_random(resolved);
  run.once([&](VkCommandBuffer cmd) {
    triangle.target.begin(cmd);
    triangle.draw(cmd);
    vkCmdEndRenderPass(cmd);
    run.barrier(cmd);
    VkImageResolve region{};
    region.srcSubresource = region.dstSubresource = resolved.layers();
    region.srcOffset = {4, 8, 0};
    region.dstOffset = {10, 2, 0};
    region.extent = {50, 40, 1};
    vkCmdResolveImage(cmd, triangle.target.colors[0].handle, VK_IMAGE_LAYOUT_GENERAL, resolved.handle,
                      VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
  run.out("resolved", resolved);
}

}  // namespace
}  // namespace vitrine::cts
