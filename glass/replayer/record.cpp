// See record.h.
#include "glass/replayer/record.h"

#include <algorithm>

namespace vitrine::glass::replayer {
namespace {

using bug::kNone;

/// A word at a time: each has the stages of all ranges that it lies in ("VUID-vkCmdPushConstants-offset-01796").
void push_constants(VkCommandBuffer commands, const bug::Bug& bug, VkPipelineLayout layout) {
  for (std::uint32_t i = 0; i < bug::size_of(bug.push_constants) / 4; ++i) {
    VkShaderStageFlags stages = 0;
    for (const VkPushConstantRange& range : bug.push_ranges)
      if (i * 4 >= range.offset && i * 4 < range.offset + range.size) stages |= range.stageFlags;
    if (stages && (bug.pushed >> i & 1))
      vkCmdPushConstants(commands, layout, stages, i * 4, 4, bug.push_constants->data() + i * 4);
  }
}

void bind(VkCommandBuffer commands, const bug::Bug& bug, const Bound& bound) {
  const VkPipelineBindPoint point = bug.dispatches() ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
  vkCmdBindPipeline(commands, point, bound.pipeline);
  if (!bound.sets.empty())
    vkCmdBindDescriptorSets(commands, point, bound.layout, 0, static_cast<std::uint32_t>(bound.sets.size()),
                            bound.sets.data(), static_cast<std::uint32_t>(bound.dynamic_offsets.size()),
                            bound.dynamic_offsets.data());
  push_constants(commands, bug, bound.layout);
}

void dispatch(VkCommandBuffer commands, const bug::Bug& bug, const Resources& resources) {
  const bug::Command& c = bug.command;
  if (c.arguments != kNone)
    vkCmdDispatchIndirect(commands, resources.buffers[c.arguments], c.arguments_offset);
  else if (c.base == std::array<std::uint32_t, 3>{})
    vkCmdDispatch(commands, c.groups[0], c.groups[1], c.groups[2]);
  else
    vkCmdDispatchBase(commands, c.base[0], c.base[1], c.base[2], c.groups[0], c.groups[1], c.groups[2]);
}

VkRenderingAttachmentInfo attachment(std::uint32_t view, const Resources& resources) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = view == kNone ? VK_NULL_HANDLE : resources.views[view];
  info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  info.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

void begin_rendering(VkCommandBuffer commands, const bug::Rendering& r, const Resources& resources) {
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const std::uint32_t view : r.colors) colors.push_back(attachment(view, resources));
  const VkRenderingAttachmentInfo depth = attachment(r.depth, resources), stencil = attachment(r.stencil, resources);
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = r.area;
  info.layerCount = r.layers;
  info.viewMask = r.view_mask;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  if (r.depth != kNone) info.pDepthAttachment = &depth;
  if (r.stencil != kNone) info.pStencilAttachment = &stencil;
  VkRenderingFragmentShadingRateAttachmentInfoKHR rate{
      VK_STRUCTURE_TYPE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_INFO_KHR};
  rate.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  rate.shadingRateAttachmentTexelSize = r.rate_texel;
  if (r.rate != kNone) rate.imageView = resources.views[r.rate];
  if (r.rate != kNone) info.pNext = &rate;
  vkCmdBeginRendering(commands, &info);
}

void bind_streams(VkCommandBuffer commands, const bug::Bug& bug, const Resources& resources) {
  for (const bug::Stream& s : bug.streams) {
    if (s.buffer == kNone) continue;
    const VkDeviceSize offset = s.offset, size = s.size;
    vkCmdBindVertexBuffers2(commands, s.binding, 1, &resources.buffers[s.buffer], &offset, &size, nullptr);
  }
  const bug::Stream& indices = bug.command.indices;
  if (bug.command.indexed && indices.buffer != kNone)
    vkCmdBindIndexBuffer(commands, resources.buffers[indices.buffer], indices.offset, bug.command.index_type);
}

void draw_indirect(VkCommandBuffer commands, const bug::Command& c, const Resources& resources) {
  const VkBuffer buffer = resources.buffers[c.arguments];
  if (c.count_buffer != kNone) {
    const auto draw = c.indexed ? vkCmdDrawIndexedIndirectCount : vkCmdDrawIndirectCount;
    draw(commands, buffer, c.arguments_offset, resources.buffers[c.count_buffer], c.count_offset, c.draw_count,
         c.stride);
  } else {
    const auto draw = c.indexed ? vkCmdDrawIndexedIndirect : vkCmdDrawIndirect;
    draw(commands, buffer, c.arguments_offset, c.draw_count, c.stride);
  }
}

void draw_many(const Device& d, VkCommandBuffer commands, const bug::Command& c) {
  const auto count = static_cast<std::uint32_t>(c.draws.size());
  if (c.indexed) {
    std::vector<VkMultiDrawIndexedInfoEXT> draws;
    for (const bug::Draw& draw : c.draws) draws.push_back({draw.first, draw.count, draw.vertex_offset});
    d.function<PFN_vkCmdDrawMultiIndexedEXT>("vkCmdDrawMultiIndexedEXT")(commands, count, draws.data(), c.instances,
                                                                         c.first_instance, sizeof draws[0], nullptr);
  } else {
    std::vector<VkMultiDrawInfoEXT> draws;
    for (const bug::Draw& draw : c.draws) draws.push_back({draw.first, draw.count});
    d.function<PFN_vkCmdDrawMultiEXT>("vkCmdDrawMultiEXT")(commands, count, draws.data(), c.instances, c.first_instance,
                                                           sizeof draws[0]);
  }
}

void draw(const Device& d, VkCommandBuffer commands, const bug::Bug& bug, const Resources& resources) {
  const bug::Command& c = bug.command;
  if (c.arguments != kNone) {
    draw_indirect(commands, c, resources);
  } else if (c.draws.size() > 1) {
    draw_many(d, commands, c);
  } else if (c.draws.size() == 1) {
    const bug::Draw& one = c.draws[0];
    if (c.indexed)
      vkCmdDrawIndexed(commands, one.count, c.instances, one.first, one.vertex_offset, c.first_instance);
    else
      vkCmdDraw(commands, one.count, c.instances, one.first, c.first_instance);
  }
}

/// From where it stood: no counters are needed.
void begin_feedback(const Device& d, VkCommandBuffer commands, const bug::Bug& bug, const Resources& resources) {
  if (bug.feedback.empty()) return;
  const auto bind = d.function<PFN_vkCmdBindTransformFeedbackBuffersEXT>("vkCmdBindTransformFeedbackBuffersEXT");
  for (const bug::Stream& s : bug.feedback) {
    const VkDeviceSize offset = s.offset, size = s.size;
    bind(commands, s.binding, 1, &resources.buffers[s.buffer], &offset, &size);
  }
  d.function<PFN_vkCmdBeginTransformFeedbackEXT>("vkCmdBeginTransformFeedbackEXT")(commands, 0, 0, nullptr, nullptr);
}

void end_feedback(const Device& d, VkCommandBuffer commands, const bug::Bug& bug) {
  if (bug.feedback.empty()) return;
  d.function<PFN_vkCmdEndTransformFeedbackEXT>("vkCmdEndTransformFeedbackEXT")(commands, 0, 0, nullptr, nullptr);
}

/// The labels that were open, so that findings say the same.
void begin_labels(const Device& d, VkCommandBuffer commands, const bug::Bug& bug) {
  if (!d.names) return;
  const auto begin = d.function<PFN_vkCmdBeginDebugUtilsLabelEXT>("vkCmdBeginDebugUtilsLabelEXT");
  for (const std::string& label : bug.labels) {
    VkDebugUtilsLabelEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    info.pLabelName = label.c_str();
    begin(commands, &info);
  }
}

void end_labels(const Device& d, VkCommandBuffer commands, const bug::Bug& bug) {
  if (!d.names) return;
  const auto end = d.function<PFN_vkCmdEndDebugUtilsLabelEXT>("vkCmdEndDebugUtilsLabelEXT");
  for (std::size_t i = 0; i < bug.labels.size(); ++i) end(commands);
}

}  // namespace

void run(const Device& d, const bug::Bug& bug, const Resources& resources, const Bound& bound) {
  submit(d, [&](VkCommandBuffer commands) {
    begin_labels(d, commands, bug);
    bind(commands, bug, bound);
    if (bug.dispatches()) {
      dispatch(commands, bug, resources);
    } else {
      bind_streams(commands, bug, resources);
      begin_rendering(commands, bug.rendering, resources);
      begin_feedback(d, commands, bug, resources);
      draw(d, commands, bug, resources);
      end_feedback(d, commands, bug);
      vkCmdEndRendering(commands);
    }
    end_labels(d, commands, bug);
  });
}

}  // namespace vitrine::glass::replayer
