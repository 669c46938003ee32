// Draws a scene of random draws: targets, scopes, queries, transform feedback, predicates, secondary command buffers.
#include "cases/pipeline/state/render.h"

#include <algorithm>

#include "cases/pipeline/state/dynamic_state.h"
#include "harness/execute.h"

namespace vitrine::cts {
namespace {

constexpr VkDeviceSize kCaptureBytes = VkDeviceSize{1} << 18;
constexpr VkQueryPipelineStatisticFlags kStatistics = VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                                                      VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                                                      VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT |
                                                      VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT;
constexpr uint32_t kStatisticCount = 4;

/// The attachments of a scene and the commands around its draws.
class Pass {
 public:
  Pass(Run& run, const Scene& scene, const std::vector<VkClearValue>& clears)
      : run_(run), scene_(scene), target_(make_target(run, scene.target)) {
    std::copy_n(clears.begin(), scene.target.colors.size(), target_.clears.begin());
    if (scene.target.depth) target_.clears.back() = clears.back();
    if (scene.dynamic_rendering) describe();
    if (scene.target.view_mask) clear_layers();
  }
  Pass(const Pass&) = delete;

  VkPipeline pipeline(const GraphicsSpec& spec) const {
    if (!scene_.dynamic_rendering) return make_pipeline(run_, spec, target_);
    GraphicsSpec dynamic = spec;
    VkPipelineRenderingCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    info.viewMask = scene_.target.view_mask;
    info.colorAttachmentCount = static_cast<uint32_t>(scene_.target.colors.size());
    info.pColorAttachmentFormats = scene_.target.colors.data();
    info.depthAttachmentFormat = scene_.has_depth ? scene_.target.depth : VK_FORMAT_UNDEFINED;
    info.stencilAttachmentFormat = scene_.has_stencil ? scene_.target.depth : VK_FORMAT_UNDEFINED;
    dynamic.next = &info;
    return make_pipeline(run_, dynamic, VK_NULL_HANDLE, 0, info.colorAttachmentCount,
                         {scene_.target.width, scene_.target.height}, scene_.target.samples);
  }

  void begin(VkCommandBuffer cmd, VkRenderingFlags flags = 0) const {
    if (!scene_.dynamic_rendering) {
      target_.begin(cmd, scene_.secondary ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS : VK_SUBPASS_CONTENTS_INLINE);
      return;
    }
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.flags = flags | (scene_.secondary ? VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT : 0);
    info.renderArea = target_.rect();
    info.layerCount = scene_.target.view_mask ? 1 : scene_.target.layers;
    info.viewMask = scene_.target.view_mask;
    info.colorAttachmentCount = static_cast<uint32_t>(colors_.size());
    info.pColorAttachments = colors_.data();
    info.pDepthAttachment = scene_.has_depth ? &depth_ : nullptr;
    info.pStencilAttachment = scene_.has_stencil ? &stencil_ : nullptr;
    CTS_COMMAND(run_.gpu, CmdBeginRenderingKHR)(cmd, &info);
  }
  void end(VkCommandBuffer cmd) const {
    if (scene_.dynamic_rendering)
      CTS_COMMAND(run_.gpu, CmdEndRenderingKHR)(cmd);
    else
      vkCmdEndRenderPass(cmd);
  }
  /// A secondary command buffer for this pass, begun.
  VkCommandBuffer begin_secondary() const {
    VkCommandBufferInheritanceRenderingInfo formats{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_RENDERING_INFO};
    formats.viewMask = scene_.target.view_mask;
    formats.colorAttachmentCount = static_cast<uint32_t>(scene_.target.colors.size());
    formats.pColorAttachmentFormats = scene_.target.colors.data();
    formats.depthAttachmentFormat = scene_.has_depth ? scene_.target.depth : VK_FORMAT_UNDEFINED;
    formats.stencilAttachmentFormat = scene_.has_stencil ? scene_.target.depth : VK_FORMAT_UNDEFINED;
    formats.rasterizationSamples = scene_.target.samples;
    VkCommandBufferInheritanceInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
    if (scene_.dynamic_rendering) {
      info.pNext = &formats;
    } else {
      info.renderPass = target_.pass;
      info.framebuffer = target_.framebuffer;
    }
    return run_.begin_secondary(info, VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT);
  }
  void out() const {
    out_target(run_, target_);
    if (depth_resolve_) run_.out("depth_resolve", *depth_resolve_);
  }

 private:
  VkRenderingAttachmentInfo attachment(const Image& image, const VkClearValue& clear) const {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = image.view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue = clear;
    return info;
  }
  static void resolve(VkRenderingAttachmentInfo& info, const Image& image, VkResolveModeFlagBits mode) {
    info.resolveMode = mode;
    info.resolveImageView = image.view;
    info.resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
  }
  void describe() {
    for (size_t i = 0; i < target_.colors.size(); ++i) {
      colors_.push_back(attachment(target_.colors[i], target_.clears[i]));
      if (target_.resolves.empty()) continue;
      const bool integer = is_integer(format_info(scene_.target.colors[i]));
      resolve(colors_.back(), target_.resolves[i],
              integer ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_AVERAGE_BIT);
    }
    if (!target_.depth) return;
    depth_ = stencil_ = attachment(*target_.depth, target_.clears.back());
    if (!scene_.resolves_depth) return;
    ImageSpec single = target_.depth->spec;
    single.samples = VK_SAMPLE_COUNT_1_BIT;
    depth_resolve_ = run_.image(single);
    resolve(depth_, *depth_resolve_, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT);
    resolve(stencil_, *depth_resolve_, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT);
  }

  /// Layers without a view are not written.
  void clear_layers() {
    std::vector<Image> images = target_.colors;
    images.insert(images.end(), target_.resolves.begin(), target_.resolves.end());
    if (target_.depth) images.push_back(*target_.depth);
    if (depth_resolve_) images.push_back(*depth_resolve_);
    run_.once([&](VkCommandBuffer cmd) {
      for (const Image& image : images) {
        const VkImageSubresourceRange range = image.range();
        const VkClearValue value = clear_value(image.spec.format, 0.3f, 0.5f, 0.7f, 0.9f);
        if (image.aspects() & VK_IMAGE_ASPECT_COLOR_BIT)
          vkCmdClearColorImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &value.color, 1, &range);
        else
          vkCmdClearDepthStencilImage(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, &value.depthStencil, 1, &range);
      }
    });
  }

  Run& run_;
  const Scene& scene_;
  Target target_;
  std::vector<VkRenderingAttachmentInfo> colors_;
  VkRenderingAttachmentInfo depth_{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}, stencil_ = depth_;
  std::optional<Image> depth_resolve_;
};

/// What one draw needs on a device, and what it gives beside the attachments.
struct PreparedDraw {
  const RecordedDraw& draw;
  std::unique_ptr<DynamicState> state;
  VkPipeline pipeline = VK_NULL_HANDLE;
  Buffer captured[2], predicate;
};

/// Queries of all draws of a scene: 0 .. draws - 1 of either pool.
struct Queries {
  VkQueryPool samples = VK_NULL_HANDLE, statistics = VK_NULL_HANDLE;
  Buffer results;  ///< 32-bit words: of every draw the samples and the statistics
};

void issue(VkCommandBuffer cmd, const RecordedDraw& draw) {
  const DrawState& state = draw.state;
  if (draw.indexed) vkCmdBindIndexBuffer(cmd, draw.indices.handle, 0, draw.index_type);
  if (state.indirect && draw.indexed)
    vkCmdDrawIndexedIndirect(cmd, draw.command.handle, 0, 1, 0);
  else if (state.indirect)
    vkCmdDrawIndirect(cmd, draw.command.handle, 0, 1, 0);
  else if (draw.indexed)
    vkCmdDrawIndexed(cmd, state.vertices, state.instances, 0, static_cast<int32_t>(draw.first_vertex),
                     draw.first_instance);
  else
    vkCmdDraw(cmd, state.vertices, state.instances, draw.first_vertex, draw.first_instance);
}

void record_draw(Run& run, VkCommandBuffer cmd, const PreparedDraw& prepared, const Queries& queries, uint32_t n,
                 const Resources* resources) {
  const DrawState& state = prepared.draw.state;
  const Gpu& gpu = run.gpu;
  if (prepared.draw.clear) {
    const VkClearRect rect{prepared.draw.cleared, 0, 1};
    vkCmdClearAttachments(cmd, 1, &*prepared.draw.clear, 1, &rect);
  }
  bind_pipeline(cmd, prepared.pipeline);
  prepared.state->set(cmd, prepared.draw.vertices);
  if (resources) resources->bind(cmd);
  if (state.queried) {
    vkCmdBeginQuery(cmd, queries.samples, n, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdBeginQuery(cmd, queries.statistics, n, 0);
  }
  if (state.conditional) {
    VkConditionalRenderingBeginInfoEXT info{VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT};
    info.buffer = prepared.predicate.handle;
    info.flags = state.predicate_flags;
    CTS_COMMAND(gpu, CmdBeginConditionalRenderingEXT)(cmd, &info);
  }
  if (state.stages.captured) {
    const VkBuffer handles[] = {prepared.captured[0].handle, prepared.captured[1].handle};
    const VkDeviceSize offsets[] = {0, 0};
    CTS_COMMAND(gpu, CmdBindTransformFeedbackBuffersEXT)(cmd, 0, 2, handles, offsets, nullptr);
    CTS_COMMAND(gpu, CmdBeginTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
  }
  issue(cmd, prepared.draw);
  if (state.stages.captured) CTS_COMMAND(gpu, CmdEndTransformFeedbackEXT)(cmd, 0, 0, nullptr, nullptr);
  if (state.conditional) CTS_COMMAND(gpu, CmdEndConditionalRenderingEXT)(cmd);
  if (state.queried) {
    vkCmdEndQuery(cmd, queries.samples, n);
    vkCmdEndQuery(cmd, queries.statistics, n);
  }
}

PreparedDraw prepare(Run& run, const Scene& scene, const Pass& pass, const RecordedDraw& draw,
                     const Resources* resources) {
  PreparedDraw prepared{draw, {}, {}, {}, {}};
  Random random(draw.seed);
  GraphicsSpec spec = draw.state.spec;
  if (resources) spec.layout = resources->layout;
  prepared.state = std::make_unique<DynamicState>(run, random, draw.state.dynamic_share, spec, scene.target.samples,
                                                  static_cast<uint32_t>(scene.target.colors.size()));
  prepared.pipeline = pass.pipeline(prepared.state->spec());
  if (draw.state.stages.captured)
    for (Buffer& buffer : prepared.captured) {
      buffer = run.buffer(kCaptureBytes, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
      std::memset(buffer.data, 0xee, kCaptureBytes);
    }
  if (draw.state.conditional) {
    prepared.predicate = run.buffer(16, VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT);
    *prepared.predicate.as<uint32_t>() = draw.state.predicate;
  }
  return prepared;
}

Queries make_queries(Run& run, const std::vector<std::unique_ptr<RecordedDraw>>& draws) {
  Queries queries;
  const auto count = static_cast<uint32_t>(draws.size());
  queries.samples = make_query_pool(run, VK_QUERY_TYPE_OCCLUSION, count);
  queries.statistics = make_query_pool(run, VK_QUERY_TYPE_PIPELINE_STATISTICS, count, kStatistics);
  queries.results = run.buffer(VkDeviceSize{count} * (1 + kStatisticCount) * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  std::memset(queries.results.data, 0, queries.results.size);
  return queries;
}

void read_queries(VkCommandBuffer cmd, const Queries& queries, uint32_t n) {
  const VkDeviceSize at = VkDeviceSize{n} * (1 + kStatisticCount) * 4;
  vkCmdCopyQueryPoolResults(cmd, queries.samples, n, 1, queries.results.handle, at, 0, VK_QUERY_RESULT_WAIT_BIT);
  vkCmdCopyQueryPoolResults(cmd, queries.statistics, n, 1, queries.results.handle, at + 4, 0, VK_QUERY_RESULT_WAIT_BIT);
}

}  // namespace

void render(Run& run, const Scene& scene, const std::vector<VkClearValue>& clears,
            const std::vector<std::unique_ptr<RecordedDraw>>& draws, const std::string& prefix) {
  const Pass pass(run, scene, clears);
  const size_t first_output = run.outputs.size();
  const bool counts = std::any_of(draws.begin(), draws.end(), [](const auto& d) { return d->state.fragment.counts; });
  const Buffer counters = run.buffer(counts ? VkDeviceSize{4} * kCountedRow * kCountedRow : 16);
  std::memset(counters.data, 0, counters.size);
  const Resources resources = run.resources({storage_buffer(0, counters)});
  const Resources* counting = counts ? &resources : nullptr;
  std::vector<PreparedDraw> prepared;
  bool queried = false;
  for (const auto& draw : draws) {
    prepared.push_back(prepare(run, scene, pass, *draw, counting));
    queried |= draw->state.queried;
    run.note(prefix + "draw" + std::to_string(prepared.size() - 1),
             describe(scene, draw->state) + "dynamic" + prepared.back().state->text() + "\n");
  }
  const Queries queries = queried ? make_queries(run, draws) : Queries{};
  const auto last = static_cast<uint32_t>(draws.size()) - 1;
  const auto record_all = [&](VkCommandBuffer cmd) {
    for (uint32_t n = 0; n <= last; ++n) {
      record_draw(run, cmd, prepared[n], queries, n, counting);
      if (!scene.suspends || n == last) continue;
      pass.end(cmd);
      pass.begin(cmd, VK_RENDERING_RESUMING_BIT | (n + 1 < last ? VK_RENDERING_SUSPENDING_BIT : 0));
    }
  };
  VkCommandBuffer secondary = VK_NULL_HANDLE;
  if (scene.secondary) {
    secondary = pass.begin_secondary();
    record_all(secondary);
    CTS_VK(vkEndCommandBuffer(secondary));
  }
  run.once([&](VkCommandBuffer cmd) {
    if (queried) {
      vkCmdResetQueryPool(cmd, queries.samples, 0, last + 1);
      vkCmdResetQueryPool(cmd, queries.statistics, 0, last + 1);
    }
    pass.begin(cmd, scene.suspends && last > 0 ? VK_RENDERING_SUSPENDING_BIT : 0);
    if (secondary)
      vkCmdExecuteCommands(cmd, 1, &secondary);
    else
      record_all(cmd);
    pass.end(cmd);
    for (uint32_t n = 0; n <= last; ++n)
      if (draws[n]->state.queried) read_queries(cmd, queries, n);
  });
  pass.out();
  if (counting) run.out("counters", counters);
  if (queried) run.out("queries", queries.results);
  for (uint32_t n = 0; n <= last; ++n)
    if (draws[n]->state.stages.captured)
      for (int b = 0; b < 2; ++b)
        run.out("captured" + std::to_string(n) + "_" + std::to_string(b), prepared[n].captured[b],
                VK_FORMAT_R32_SFLOAT);
  for (size_t i = first_output; i < run.outputs.size(); ++i) run.outputs[i].name = prefix + run.outputs[i].name;
}

}  // namespace vitrine::cts
