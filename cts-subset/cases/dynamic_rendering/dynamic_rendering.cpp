// Dynamic rendering: attachments without render pass objects, load operations, resolves, suspending and resuming,
// secondary command buffers, missing attachments, several layers.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"
#include "harness/random_clear.h"

namespace vitrine::cts {
namespace {

const char kThreeColors[] = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
layout(location = 2) out vec4 third;
void main() { first = passed; second = passed.wzyx; third = passed * 0.5; })";

/// Attachments of one dynamic rendering instance as Vulkan's structures.
struct Rendering {
  std::vector<Image> colors, resolves;
  std::optional<Image> depth, depth_resolve;
  uint32_t width, height, layers = 1, view_mask = 0;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  std::vector<VkRenderingAttachmentInfo> color_infos;
  VkRenderingAttachmentInfo depth_info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  VkRenderingAttachmentInfo stencil_info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  std::vector<VkFormat> formats;

  bool has_depth() const { return depth && (depth->aspects() & VK_IMAGE_ASPECT_DEPTH_BIT); }
  bool has_stencil() const { return depth && (depth->aspects() & VK_IMAGE_ASPECT_STENCIL_BIT); }

  VkPipelineRenderingCreateInfo pipeline_info() const {
    VkPipelineRenderingCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    info.viewMask = view_mask;
    info.colorAttachmentCount = static_cast<uint32_t>(formats.size());
    info.pColorAttachmentFormats = formats.data();
    if (has_depth()) info.depthAttachmentFormat = depth->spec.format;
    if (has_stencil()) info.stencilAttachmentFormat = depth->spec.format;
    return info;
  }
  void begin(Run& run, VkCommandBuffer cmd, VkRenderingFlags flags = 0) const {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.flags = flags;
    info.renderArea = {{0, 0}, {width, height}};
    info.layerCount = layers;
    info.viewMask = view_mask;
    info.colorAttachmentCount = static_cast<uint32_t>(color_infos.size());
    info.pColorAttachments = color_infos.data();
    info.pDepthAttachment = has_depth() ? &depth_info : nullptr;
    info.pStencilAttachment = has_stencil() ? &stencil_info : nullptr;
    CTS_COMMAND(run.gpu, CmdBeginRenderingKHR)(cmd, &info);
  }
  void end(Run& run, VkCommandBuffer cmd) const { CTS_COMMAND(run.gpu, CmdEndRenderingKHR)(cmd); }
  void out(Run& run) const {
    for (size_t i = 0; i < colors.size(); ++i) run.out("color" + std::to_string(i), colors[i]);
    for (size_t i = 0; i < resolves.size(); ++i) run.out("resolve" + std::to_string(i), resolves[i]);
    if (depth) run.out("depth", *depth);
    if (depth_resolve) run.out("depth_resolve", *depth_resolve);
    run.may_be_blank();
  }
};

struct RenderingSpec {
  std::vector<VkFormat> colors{VK_FORMAT_R8G8B8A8_UNORM};
  VkFormat depth = VK_FORMAT_UNDEFINED;
  uint32_t width = 64, height = 48, layers = 1;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool resolve = false;
};

void clear_all(Run& run, const Image& image) {
  run.once([&](VkCommandBuffer cmd) {
    const VkImageSubresourceRange range = image.range();
    const VkClearColorValue color{{0.2f, 0.4f, 0.6f, 0.8f}};
    const VkClearDepthStencilValue depth{0.75f, 3};
    if (image.aspects() & VK_IMAGE_ASPECT_COLOR_BIT)
      vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
    else
      vkCmdClearDepthStencilImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &depth, 1, &range);
  });
}

Rendering make_rendering(Run& run, const RenderingSpec& spec) {
  run.require(run.gpu.extension_features.dynamicRendering, "dynamicRendering");
  Rendering r;
  r.width = spec.width;
  r.height = spec.height;
  r.layers = spec.layers;
  r.samples = spec.samples;
  r.formats = spec.colors;
  ImageSpec image;
  image.extent = {spec.width, spec.height, 1};
  image.layers = spec.layers;
  image.view = spec.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  image.samples = spec.samples;
  image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const auto attachment = [&](const Image& made, VkAttachmentLoadOp load, VkClearValue clear) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = made.view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = load;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue = clear;
    return info;
  };
  const auto load = [&] { return run.random.pick({VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_LOAD_OP_CLEAR}); };
  for (const VkFormat format : spec.colors) {
    image.format = format;
    r.colors.push_back(run.image(image));
    clear_all(run, r.colors.back());
    const VkClearValue clear = random_clear(run.random, format, 1.0f);
    r.color_infos.push_back(attachment(r.colors.back(), load(), clear));
    if (!spec.resolve) continue;
    ImageSpec single = image;
    single.samples = VK_SAMPLE_COUNT_1_BIT;
    r.resolves.push_back(run.image(single));
    clear_all(run, r.resolves.back());
    r.color_infos.back().resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    r.color_infos.back().resolveImageView = r.resolves.back().view;
    r.color_infos.back().resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
  }
  if (spec.depth) {
    image.format = spec.depth;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    r.depth = run.image(image);
    clear_all(run, *r.depth);
    const VkClearValue depth = clear_value(spec.depth, run.random.unit(), 0, 0, 0);
    r.depth_info = attachment(*r.depth, load(), depth);
    const VkClearValue stencil = clear_value(spec.depth, 0, run.random.unit(), 0, 0);
    r.stencil_info = attachment(*r.depth, load(), stencil);
    if (spec.resolve) {
      ImageSpec single = image;
      single.samples = VK_SAMPLE_COUNT_1_BIT;
      r.depth_resolve = run.image(single);
      clear_all(run, *r.depth_resolve);
      for (VkRenderingAttachmentInfo* info : {&r.depth_info, &r.stencil_info}) {
        info->resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
        info->resolveImageView = r.depth_resolve->view;
        info->resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
      }
    }
  }
  return r;
}

/// A pipeline that draws coloured triangles with depth and stencil tests, and twelve triangles for it.
struct Scene {
  VkPipeline pipeline;
  Buffer vertices;

  Scene(Run& run, const Rendering& rendering, bool tests = true) {
    GraphicsSpec spec;
    spec.vertex = kColorVertex;
    spec.fragment = rendering.formats.size() > 1 ? kThreeColors : kColorFragment;
    spec.floats({4, 4});
    spec.depth.depthTestEnable = spec.depth.depthWriteEnable = tests && rendering.has_depth();
    spec.depth.stencilTestEnable = tests && rendering.has_stencil();
    spec.depth.front = spec.depth.back = {VK_STENCIL_OP_INCREMENT_AND_WRAP,
                                          VK_STENCIL_OP_REPLACE,
                                          VK_STENCIL_OP_INVERT,
                                          VK_COMPARE_OP_LESS,
                                          0xff,
                                          0xff,
                                          1};
    const VkPipelineRenderingCreateInfo info = rendering.pipeline_info();
    spec.next = &info;
    pipeline = make_pipeline(run, spec, VK_NULL_HANDLE, 0, static_cast<uint32_t>(rendering.formats.size()),
                             {rendering.width, rendering.height}, rendering.samples);
    const std::vector<float> values = random_colored_vertices(run.random, 36);
    vertices = run.buffer_of(values);
  }
  void draw(VkCommandBuffer cmd, uint32_t first = 0, uint32_t count = 36) const {
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, count, 1, first, 0);
  }
};

RenderingSpec random_spec(Random& random) {
  RenderingSpec spec;
  spec.width = 16 + random.below(90);
  spec.height = 16 + random.below(90);
  spec.samples = random.chance(0.3f) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  spec.resolve = spec.samples != VK_SAMPLE_COUNT_1_BIT && random.chance(0.7f);
  spec.colors.clear();
  for (uint32_t n = random.pick({0, 1, 1, 3}); n > 0; --n)
    spec.colors.push_back(random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                       VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT}));
  if (spec.colors.empty() || random.chance(0.6f))
    spec.depth = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT});
  return spec;
}

CTS_RANDOM("dynamic_rendering", "random", 60) {
  const Rendering rendering = make_rendering(run, random_spec(run.random));
  const Scene scene(run, rendering);
  run.once([&](VkCommandBuffer cmd) {
    rendering.begin(run, cmd);
    scene.draw(cmd);
    rendering.end(run, cmd);
  });
  rendering.out(run);
}

/// Split over `parts` instances, each of which resumes the one before, in one or several command buffers.
void suspend_and_resume(Run& run, bool several_buffers) {
  RenderingSpec spec;
  spec.samples = VK_SAMPLE_COUNT_4_BIT;
  spec.resolve = true;
  spec.depth = VK_FORMAT_D24_UNORM_S8_UINT;
  const Rendering rendering = make_rendering(run, spec);
  const Scene scene(run, rendering);
  std::vector<VkCommandBuffer> buffers{run.begin()};
  for (uint32_t part = 0; part < 3; ++part) {
    if (part && several_buffers) {
      CTS_VK(vkEndCommandBuffer(buffers.back()));
      buffers.push_back(run.begin());
    }
    const VkRenderingFlags flags =
        (part ? VK_RENDERING_RESUMING_BIT : 0) | (part < 2 ? VK_RENDERING_SUSPENDING_BIT : 0);
    rendering.begin(run, buffers.back(), flags);
    scene.draw(buffers.back(), part * 12, 12);
    rendering.end(run, buffers.back());
  }
  run.barrier(buffers.back());
  CTS_VK(vkEndCommandBuffer(buffers.back()));
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = static_cast<uint32_t>(buffers.size());
  info.pCommandBuffers = buffers.data();
  CTS_VK(vkQueueSubmit(run.gpu.queue, 1, &info, VK_NULL_HANDLE));
  CTS_VK(vkQueueWaitIdle(run.gpu.queue));
  rendering.out(run);
}
CTS_CASE("dynamic_rendering", "suspend_resume.one_command_buffer") { suspend_and_resume(run, false); }
CTS_CASE("dynamic_rendering", "suspend_resume.three_command_buffers") { suspend_and_resume(run, true); }

CTS_CASE("dynamic_rendering", "secondary_command_buffers") {
  RenderingSpec spec;
  spec.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT};
  spec.depth = VK_FORMAT_D32_SFLOAT;
  const Rendering rendering = make_rendering(run, spec);
  const Scene scene(run, rendering);
  VkCommandBufferInheritanceRenderingInfo formats{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_RENDERING_INFO};
  formats.colorAttachmentCount = static_cast<uint32_t>(rendering.formats.size());
  formats.pColorAttachmentFormats = rendering.formats.data();
  formats.depthAttachmentFormat = spec.depth;
  formats.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const VkCommandBufferInheritanceInfo inheritance{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO, &formats};
  std::vector<VkCommandBuffer> secondaries;
  for (uint32_t i = 0; i < 3; ++i) {
    secondaries.push_back(run.begin_secondary(inheritance, VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT));
    scene.draw(secondaries.back(), 24 - 12 * i, 12);
    CTS_VK(vkEndCommandBuffer(secondaries.back()));
  }
  run.once([&](VkCommandBuffer cmd) {
    rendering.begin(run, cmd, VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT);
    vkCmdExecuteCommands(cmd, 3, secondaries.data());
    rendering.end(run, cmd);
  });
  rendering.out(run);
}

/// Colour 1 has a format in the pipeline but no view in the instance: what is written there is lost.
CTS_CASE("dynamic_rendering", "missing_view") {
  RenderingSpec spec;
  spec.colors = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT};
  Rendering rendering = make_rendering(run, spec);
  rendering.formats[1] = VK_FORMAT_UNDEFINED;
  rendering.color_infos[1].imageView = VK_NULL_HANDLE;
  const Scene scene(run, rendering);
  run.once([&](VkCommandBuffer cmd) {
    rendering.begin(run, cmd);
    scene.draw(cmd);
    rendering.end(run, cmd);
  });
  rendering.out(run);
}

/// An attachment that the instance neither loads nor stores nor uses stays as it was. The reference, which does not
/// know the operations, loads and stores it.
CTS_CASE("dynamic_rendering", "load_store_op_none") {
  run.require(gpus().device.has("VK_EXT_load_store_op_none"), "VK_EXT_load_store_op_none");
  RenderingSpec spec;
  spec.depth = VK_FORMAT_D24_UNORM_S8_UINT;
  Rendering rendering = make_rendering(run, spec);
  const bool none = run.gpu.has("VK_EXT_load_store_op_none");
  for (VkRenderingAttachmentInfo* info : {&rendering.depth_info, &rendering.stencil_info}) {
    info->loadOp = none ? VK_ATTACHMENT_LOAD_OP_NONE_EXT : VK_ATTACHMENT_LOAD_OP_LOAD;
    info->storeOp = none ? VK_ATTACHMENT_STORE_OP_NONE : VK_ATTACHMENT_STORE_OP_STORE;
  }
  const Scene scene(run, rendering, false);
  run.once([&](VkCommandBuffer cmd) {
    rendering.begin(run, cmd);
    scene.draw(cmd);
    rendering.end(run, cmd);
  });
  rendering.out(run);
}

/// Without attachments: fragments count what they cover, and a query counts samples.
CTS_CASE("dynamic_rendering", "no_attachments") {
  run.require(run.gpu.extension_features.dynamicRendering, "dynamicRendering");
  constexpr VkExtent2D kSize{45, 33};
  const Buffer counters = run.buffer(size_t{4} * kSize.width * kSize.height);
  const Resources res = run.resources({storage_buffer(0, counters)});
  const VkPipelineRenderingCreateInfo formats{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment =
      "layout(binding = 0) buffer Counters { uint counters[]; };\n"
      "void main() { atomicAdd(counters[uint(gl_FragCoord.y) * 45u + uint(gl_FragCoord.x)], 1u); }\n";
  spec.floats({4, 4});
  spec.layout = res.layout;
  spec.next = &formats;
  const VkPipeline pipeline = make_pipeline(run, spec, VK_NULL_HANDLE, 0, 0, kSize, VK_SAMPLE_COUNT_1_BIT);
  std::vector<float> values;
  for (int i = 0; i < 30; ++i) {
    for (const float v : {run.random.real(-1.1f, 1.1f), run.random.real(-1.1f, 1.1f), 0.5f, 1.0f}) values.push_back(v);
    values.insert(values.end(), 4, 1.0f);
  }
  const Buffer vertices = run.buffer_of(values);
  const VkQueryPool pool = make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, 1);
  const Buffer passed = run.buffer(16);
  run.once([&](VkCommandBuffer cmd) {
    vkCmdResetQueryPool(cmd, pool, 0, 1);
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, kSize};
    info.layerCount = 1;
    CTS_COMMAND(run.gpu, CmdBeginRenderingKHR)(cmd, &info);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdBeginQuery(cmd, pool, 0, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdDraw(cmd, 30, 1, 0, 0);
    vkCmdEndQuery(cmd, pool, 0);
    CTS_COMMAND(run.gpu, CmdEndRenderingKHR)(cmd);
    vkCmdCopyQueryPoolResults(cmd, pool, 0, 1, passed.handle, 0, 8, VK_QUERY_RESULT_WAIT_BIT);
  });
  run.out("counters", counters);
  run.out("passed", passed);
}

/// Clears reach every layer, draws the first.
CTS_CASE("dynamic_rendering", "layers") {
  RenderingSpec spec;
  spec.layers = 3;
  spec.depth = VK_FORMAT_D32_SFLOAT;
  Rendering rendering = make_rendering(run, spec);
  rendering.color_infos[0].loadOp = rendering.depth_info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  const Scene scene(run, rendering);
  run.once([&](VkCommandBuffer cmd) {
    rendering.begin(run, cmd);
    scene.draw(cmd);
    const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, clear_value(spec.colors[0], 1, 0, 1, 1)};
    const VkClearRect rect{{{3, 5}, {20, 10}}, 1, 2};
    vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
    rendering.end(run, cmd);
  });
  rendering.out(run);
}

}  // namespace
}  // namespace vitrine::cts
