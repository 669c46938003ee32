// Commands of a run.
#include "tests/fuzz/api_run.h"

#include <algorithm>

namespace vitrine::fuzz {

using icd::make_struct;

void Run::record() {
  const auto pool = make_struct<VkCommandPoolCreateInfo>();
  demand(VK_CALL(CreateCommandPool)(w_.device, &pool, nullptr, &pool_) == VK_SUCCESS, "a command pool");
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = pool_;
  allocate.commandBufferCount = 1;
  demand(VK_CALL(AllocateCommandBuffers)(w_.device, &allocate, &commands_) == VK_SUCCESS, "a command buffer");
  const auto begin = make_struct<VkCommandBufferBeginInfo>();
  VK_CALL(BeginCommandBuffer)(commands_, &begin);
  for (const VkPipelineBindPoint point : {VK_PIPELINE_BIND_POINT_GRAPHICS, VK_PIPELINE_BIND_POINT_COMPUTE}) {
    VK_CALL(CmdBindDescriptorSets)(commands_, point, w_.layout, 0, 1, &set_, 0, nullptr);
    VK_CALL(CmdBindPipeline)(commands_, point, point == VK_PIPELINE_BIND_POINT_COMPUTE ? compute_ : graphics_);
  }
  for (std::uint32_t i = c_.between(1, 5); i-- != 0;) {
    std::uint32_t push[kPushBytes / 4];
    c_.fill(push, sizeof push);
    VK_CALL(CmdPushConstants)(commands_, w_.layout, VK_SHADER_STAGE_ALL, 0, kPushBytes, push);
    switch (c_.below(4)) {
      case 0:
        render();
        break;
      case 1:
        dispatch();
        break;
      case 2:
        transfer();
        break;
      default:
        render();
    }
    auto barrier = make_struct<VkMemoryBarrier>();
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    VK_CALL(CmdPipelineBarrier)
    (commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, nullptr, 0,
     nullptr);
  }
  demand(VK_CALL(EndCommandBuffer)(commands_) == VK_SUCCESS, "the end of a command buffer");
}

void Run::render() {
  auto colour = make_struct<VkRenderingAttachmentInfo>();
  colour.imageView = target_.view;
  colour.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  colour.loadOp = static_cast<VkAttachmentLoadOp>(c_.below(3));
  c_.fill(&colour.clearValue, sizeof colour.clearValue);
  auto depth = make_struct<VkRenderingAttachmentInfo>();
  depth.imageView = depth_.view;
  depth.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  depth.loadOp = static_cast<VkAttachmentLoadOp>(c_.below(3));
  depth.clearValue.depthStencil = {static_cast<float>(c_.below(3)) / 2, c_.below(256)};
  auto info = make_struct<VkRenderingInfo>();
  info.renderArea.extent = {target_.extent.width, target_.extent.height};
  info.layerCount = layers_;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &colour;
  info.pDepthAttachment = &depth;
  if (has_stencil()) info.pStencilAttachment = &depth;
  VK_CALL(CmdBeginRendering)(commands_, &info);
  for (std::uint32_t i = c_.between(1, 3); i-- != 0;) draw();
  VK_CALL(CmdEndRendering)(commands_);
}

void Run::draw() {
  const Buffer &vertices = some_buffer(), &instances = some_buffer(), &indices = some_buffer();
  const VkBuffer bound[] = {c_.one_in(12) ? VK_NULL_HANDLE : vertices.handle, instances.handle};
  const VkDeviceSize offsets[] = {bound[0] ? offset_in(vertices, 4, 4) : 0, offset_in(instances, 4, 4)};
  VK_CALL(CmdBindVertexBuffers)(commands_, 0, 2, bound, offsets);
  const auto index_type = static_cast<VkIndexType>(c_.below(2));
  VK_CALL(CmdBindIndexBuffer)(commands_, indices.handle, offset_in(indices, 4, 4), index_type);
  const std::uint32_t count = c_.below(c_.one_in(8) ? 5000 : 120), copies = c_.below(4);
  switch (c_.below(4)) {
    case 0:
      VK_CALL(CmdDraw)(commands_, count, copies, c_.hostile(), c_.hostile());
      break;
    case 1:
      VK_CALL(CmdDrawIndexed)
      (commands_, count, copies, c_.hostile(), static_cast<std::int32_t>(c_.hostile()), c_.hostile());
      break;
    default:
      draw_indirect(count, copies);
  }
}

void Run::draw_indirect(std::uint32_t count, std::uint32_t copies) {
  const bool indexed = c_.one_in(2);
  const VkDeviceSize bytes = indexed ? sizeof(VkDrawIndexedIndirectCommand) : sizeof(VkDrawIndirectCommand);
  const VkDeviceSize offset = take_parameters(bytes + 4);
  if (offset == parameters_.size) return;
  const Buffer& buffer = parameters_;
  std::uint32_t* const words = buffer.words + offset / 4;
  words[0] = count;
  words[1] = copies;
  words[bytes / 4] = c_.hostile();
  const auto stride = static_cast<std::uint32_t>(bytes);
  // A count from a buffer is limited by the commands that fit; a plain one says itself that they do.
  if (c_.one_in(2)) {
    const auto call = indexed ? VK_CALL(CmdDrawIndexedIndirectCount) : VK_CALL(CmdDrawIndirectCount);
    call(commands_, buffer.handle, offset, buffer.handle, offset + bytes, 1, stride);
  } else {
    const auto call = indexed ? VK_CALL(CmdDrawIndexedIndirect) : VK_CALL(CmdDrawIndirect);
    call(commands_, buffer.handle, offset, 1, stride);
  }
}

VkDeviceSize Run::take_parameters(VkDeviceSize bytes) {
  if (parameters_.size - used_parameters_ < bytes) return parameters_.size;
  used_parameters_ += bytes;
  return used_parameters_ - bytes;
}

void Run::dispatch() {
  if (c_.one_in(3)) {
    const VkDeviceSize offset = take_parameters(12);
    if (offset == parameters_.size) return;
    const Buffer& buffer = parameters_;
    for (std::size_t i = 0; i < 3; ++i) buffer.words[offset / 4 + i] = c_.below(5);
    return VK_CALL(CmdDispatchIndirect)(commands_, buffer.handle, offset);
  }
  VK_CALL(CmdDispatchBase)(commands_, 0, 0, 0, c_.below(9), c_.below(4), c_.below(3));
}

void Run::transfer() {
  const Buffer &from = some_buffer(), &to = some_buffer();
  switch (c_.below(5)) {
    case 0:
      VK_CALL(CmdFillBuffer)(commands_, to.handle, offset_in(to, 4, 4), VK_WHOLE_SIZE, c_.hostile());
      break;
    case 1: {
      if (from.handle == to.handle) break;
      const VkDeviceSize bytes = c_.between(1, static_cast<std::uint32_t>(std::min(from.size, to.size)));
      const VkBufferCopy region{offset_in(from, bytes, 1), offset_in(to, bytes, 1), bytes};
      VK_CALL(CmdCopyBuffer)(commands_, from.handle, to.handle, 1, &region);
      break;
    }
    case 2: {
      VkClearColorValue value;
      c_.fill(&value, sizeof value);
      const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
      VK_CALL(CmdClearColorImage)
      (commands_, c_.one_in(2) ? target_.image : canvas_.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
      break;
    }
    case 3: {
      if (samples_ != VK_SAMPLE_COUNT_1_BIT) break;
      const auto corner = [&](const Picture& p) {
        return VkOffset3D{static_cast<std::int32_t>(c_.below(p.extent.width + 1)),
                          static_cast<std::int32_t>(c_.below(p.extent.height + 1)), 0};
      };
      VkImageBlit region{};
      region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      region.srcOffsets[0] = corner(target_);
      region.srcOffsets[1] = corner(target_);
      region.dstOffsets[0] = corner(canvas_);
      region.dstOffsets[1] = corner(canvas_);
      region.srcOffsets[1].z = region.dstOffsets[1].z = 1;
      VK_CALL(CmdBlitImage)
      (commands_, target_.image, VK_IMAGE_LAYOUT_GENERAL, canvas_.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region,
       static_cast<VkFilter>(c_.below(2)));
      break;
    }
    default: {
      const VkDeviceSize bytes = VkDeviceSize{canvas_.extent.width} * canvas_.extent.height * 4;
      if (from.size < bytes) break;
      VkBufferImageCopy region{};
      region.bufferOffset = offset_in(from, bytes, 4);
      region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      region.imageExtent = canvas_.extent;
      if (c_.one_in(2))
        VK_CALL(CmdCopyBufferToImage)(commands_, from.handle, canvas_.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      else
        VK_CALL(CmdCopyImageToBuffer)(commands_, canvas_.image, VK_IMAGE_LAYOUT_GENERAL, from.handle, 1, &region);
    }
  }
}

}  // namespace vitrine::fuzz
