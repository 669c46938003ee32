// What memory holds, through transfers: memory that tools watch stays unmapped, and what nothing has written unwritten.
#include <cstring>

#include "glass/bug/texels.h"
#include "glass/replayer/resources.h"

namespace vitrine::glass::replayer {
namespace {

/// A buffer over all of an allocation, for as long as it is copied.
VkBuffer cover(const Device& d, const bug::Memory& memory, VkDeviceMemory where) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = memory.size;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  must(vkCreateBuffer(d.device, &info, nullptr, &buffer), "vkCreateBuffer");
  must(vkBindBufferMemory(d.device, buffer, where, 0), "vkBindBufferMemory");
  return buffer;
}

VkBufferImageCopy region_of(const bug::Image& image, const bug::Texels& texels, std::uint64_t at) {
  const auto side = [&](std::uint32_t whole) { return std::max(whole >> texels.level, 1u); };
  VkBufferImageCopy region{};
  region.bufferOffset = at;
  region.imageSubresource = {static_cast<VkImageAspectFlags>(texels.aspect), texels.level, texels.layer, texels.layers};
  region.imageExtent = {side(image.extent.width), side(image.extent.height), side(image.extent.depth)};
  return region;
}

}  // namespace

Staging make_staging(const Device& d, std::uint64_t size) {
  Staging s;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = std::max<std::uint64_t>(size, 16);
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  must(vkCreateBuffer(d.device, &info, nullptr, &s.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(d.device, s.buffer, &needs);
  s.memory = allocate(d, needs, true);
  must(vkBindBufferMemory(d.device, s.buffer, s.memory, 0), "vkBindBufferMemory");
  void* mapped = nullptr;
  must(vkMapMemory(d.device, s.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  s.bytes = static_cast<std::byte*>(mapped);
  return s;
}

void destroy(const Device& d, const Staging& staging) {
  vkDestroyBuffer(d.device, staging.buffer, nullptr);
  vkFreeMemory(d.device, staging.memory, nullptr);
}

void check_texels(const bug::Bug& bug) {
  for (const bug::Image& image : bug.images) {
    texel::ImageDesc desc;
    desc.type = image.type;
    desc.format = image.format;
    desc.extent = image.extent;
    desc.levels = image.levels;
    desc.layers = image.layers;
    desc.samples = image.samples;
    texel::ImageLayout layout;
    const bool good = texel::format_desc(image.format).block_bytes != 0 && texel::make_image_layout(desc, layout);
    for (const bug::Texels& texels : image.texels)
      if (!good || bug::packed_bytes(layout, texels.aspect, texels.level, texels.layers) != texels.before->size())
        throw Failure("the file has not as many texels as its image");
  }
}

void copy_contents(const Device& d, const bug::Bug& bug, const Resources& resources, const Staging& staging,
                   bool back) {
  // Memory that is allocated holds zeros on Vitrine; others need not.
  const bool fresh = !back && bug.device == d.properties.deviceName;
  std::vector<VkBuffer> covers;
  for (std::size_t i = 0; i < bug.memories.size(); ++i)
    covers.push_back(cover(d, bug.memories[i], resources.memories[i]));
  submit(d, [&](VkCommandBuffer commands) {
    barrier(commands);
    std::uint64_t at = 0;
    const auto next = [&](const auto& content) { at = (at + content.before->size() + 15) / 16 * 16; };
    for (std::size_t i = 0; i < bug.memories.size(); ++i) {
      for (const bug::Piece& piece : bug.memories[i].pieces) {
        VkBufferCopy region{at, piece.offset, piece.before->size()};
        next(piece);
        if (piece.unwritten && fresh) continue;
        if (back) std::swap(region.srcOffset, region.dstOffset);
        vkCmdCopyBuffer(commands, back ? covers[i] : staging.buffer, back ? staging.buffer : covers[i], 1, &region);
      }
    }
    for (std::size_t i = 0; i < bug.images.size(); ++i) {
      for (const bug::Texels& texels : bug.images[i].texels) {
        const VkBufferImageCopy region = region_of(bug.images[i], texels, at);
        next(texels);
        if (texels.unwritten && fresh) continue;
        if (back)
          vkCmdCopyImageToBuffer(commands, resources.images[i], VK_IMAGE_LAYOUT_GENERAL, staging.buffer, 1, &region);
        else
          vkCmdCopyBufferToImage(commands, staging.buffer, resources.images[i], VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      }
    }
    barrier(commands);
  });
  for (const VkBuffer buffer : covers) vkDestroyBuffer(d.device, buffer, nullptr);
}

}  // namespace vitrine::glass::replayer
