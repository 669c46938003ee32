// What memory holds, through transfers: memory that tools watch stays unmapped, and what nothing has written unwritten.
#include <algorithm>
#include <cstring>
#include <map>

#include "glass/bug/texels.h"
#include "glass/replayer/resources.h"

namespace vitrine::glass::replayer {
namespace {

/// Calls f(buffer, region) for the parts of a piece that lie in buffers: from `staging`, where it begins at `at`. No
/// buffer of our own lies over the memory, since tools would know it for one of the application's.
template <class F>
void for_each_part(const bug::Bug& bug, std::size_t memory, const bug::Piece& piece, std::uint64_t at, const F& f) {
  const std::uint64_t end = piece.offset + piece.before->size();
  std::uint64_t done = piece.offset;
  while (done < end) {
    std::size_t best = bug.buffers.size();
    std::uint64_t best_end = done, next = end;
    for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
      const bug::Buffer& b = bug.buffers[i];
      if (b.memory != memory || b.gone) continue;
      if (b.offset > done) next = std::min(next, b.offset);
      if (b.offset > done || b.offset + b.size <= best_end) continue;
      best = i;
      best_end = b.offset + b.size;
    }
    if (best == bug.buffers.size()) {
      done = next;
      continue;
    }
    best_end = std::min(best_end, end);
    f(best, VkBufferCopy{at + (done - piece.offset), done - bug.buffers[best].offset, best_end - done});
    done = best_end;
  }
}

VkBufferImageCopy region_of(const bug::Image& image, const bug::Texels& texels, std::uint64_t at) {
  const auto side = [&](std::uint32_t whole) { return std::max(whole >> texels.level, 1u); };
  VkBufferImageCopy region{};
  region.bufferOffset = at;
  region.imageSubresource = {static_cast<VkImageAspectFlags>(texels.aspect), texels.level, texels.layer, texels.layers};
  region.imageExtent = {side(image.extent.width), side(image.extent.height), side(image.extent.depth)};
  return region;
}

texel::ImageDesc desc_of(const bug::Image& image) {
  texel::ImageDesc desc;
  desc.type = image.type;
  desc.format = image.format;
  desc.extent = image.extent;
  desc.levels = image.levels;
  desc.layers = image.layers;
  desc.samples = image.samples;
  return desc;
}

/// Of an image of several samples, between its memory and what is packed: as Vitrine lays it out.
void copy_samples(const Device& d, const bug::Image& image, VkImage made, VkDeviceMemory memory,
                  const bug::Texels& texels, std::byte* packed, bool back) {
  texel::ImageLayout layout;
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(d.device, made, &needs);
  if (!texel::make_image_layout(desc_of(image), layout)) throw Failure("the file has an image that cannot be");
  void* mapped = nullptr;
  must(vkMapMemory(d.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  auto* const held = static_cast<std::byte*>(mapped);
  bug::for_each_sample_row(layout, texels.aspect, texels.layer, texels.layers,
                           [&](std::uint64_t at, std::uint64_t bytes) {
                             if (at + bytes > needs.size) throw Failure("the image is laid out in another way here");
                             std::memcpy(back ? packed : held + at, back ? held + at : packed, bytes);
                             packed += bytes;
                           });
  vkUnmapMemory(d.device, memory);
}

/// Of texels of which some were never written: those that were, row by row.
std::vector<VkBufferImageCopy> written_regions(const bug::Image& image, const bug::Texels& texels, std::uint64_t at) {
  const VkBufferImageCopy whole = region_of(image, texels, at);
  if (!texels.written) return {whole};
  const texel::FormatDesc& format = texel::format_desc(image.format);
  const auto [width, height, depth] =
      bug::blocks_of(format, {whole.imageExtent.width, whole.imageExtent.height, whole.imageExtent.depth});
  const std::uint64_t bytes = texels.before->size() / texels.written->size();
  const auto is_written = [&](std::uint64_t block) { return (*texels.written)[block] != std::byte{0}; };
  std::vector<VkBufferImageCopy> regions;
  for (std::uint32_t row = 0; row < texels.layers * depth * height; ++row) {
    for (std::uint32_t first = 0, x = 0; first < width; first = x + 1) {
      for (x = first; x < width && is_written(std::uint64_t{row} * width + x);) ++x;
      if (x == first) continue;
      VkBufferImageCopy part = whole;
      part.bufferOffset = at + (std::uint64_t{row} * width + first) * bytes;
      part.imageSubresource.baseArrayLayer += row / height / depth;
      part.imageSubresource.layerCount = 1;
      const std::uint32_t left = first * format.block_width, top = row % height * format.block_height,
                          front = row / height % depth * format.block_depth;
      part.imageOffset = {static_cast<std::int32_t>(left), static_cast<std::int32_t>(top),
                          static_cast<std::int32_t>(front)};
      part.imageExtent = {std::min((x - first) * format.block_width, whole.imageExtent.width - left),
                          std::min<std::uint32_t>(format.block_height, whole.imageExtent.height - top),
                          std::min<std::uint32_t>(format.block_depth, whole.imageExtent.depth - front)};
      regions.push_back(part);
    }
  }
  return regions;
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
    const texel::ImageDesc desc = desc_of(image);
    texel::ImageLayout layout;
    const bool good = texel::format_desc(image.format).block_bytes != 0 && texel::make_image_layout(desc, layout);
    for (const bug::Texels& texels : image.texels) {
      if (!good || bug::packed_bytes(layout, texels.aspect, texels.level, texels.layers) != texels.before->size())
        throw Failure("the file has not as many texels as its image");
      if (!texels.written) continue;
      const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, texels.aspect)];
      const texel::FormatDesc& format = texel::format_desc(plane.format);
      if (bug::blocks_of(format, plane.level[texels.level].extent).count() * texels.layers != texels.written->size())
        throw Failure("the file does not know of as many texels as its image has");
    }
  }
}

void copy_contents(const Device& d, const bug::Bug& bug, const Resources& resources, const Staging& staging,
                   bool back) {
  // Memory that is allocated holds zeros on Vitrine; others need not.
  const bool fresh = !back && bug.device == d.properties.deviceName;
  submit(d, [&](VkCommandBuffer commands) {
    barrier(commands);
    std::uint64_t at = 0;
    const auto next = [&](const auto& content) { at = (at + content.before->size() + 15) / 16 * 16; };
    for (std::size_t i = 0; i < bug.memories.size(); ++i) {
      for (const bug::Piece& piece : bug.memories[i].pieces) {
        const std::uint64_t from = at;
        next(piece);
        if (piece.unwritten && fresh) continue;
        for_each_part(bug, i, piece, from, [&](std::size_t number, VkBufferCopy region) {
          const VkBuffer buffer = resources.buffers[number];
          if (back) std::swap(region.srcOffset, region.dstOffset);
          vkCmdCopyBuffer(commands, back ? buffer : staging.buffer, back ? staging.buffer : buffer, 1, &region);
        });
      }
    }
    for (std::size_t i = 0; i < bug.images.size(); ++i) {
      for (const bug::Texels& texels : bug.images[i].texels) {
        const std::uint64_t from = at;
        next(texels);
        if ((texels.unwritten && fresh) || bug.images[i].samples != 1) continue;
        const VkBufferImageCopy whole = region_of(bug.images[i], texels, from);
        if (back) {
          vkCmdCopyImageToBuffer(commands, resources.images[i], VK_IMAGE_LAYOUT_GENERAL, staging.buffer, 1, &whole);
          continue;
        }
        const auto regions = fresh ? written_regions(bug.images[i], texels, from) : std::vector{whole};
        vkCmdCopyBufferToImage(commands, staging.buffer, resources.images[i], VK_IMAGE_LAYOUT_GENERAL,
                               static_cast<std::uint32_t>(regions.size()), regions.data());
      }
    }
    barrier(commands);
  });
  std::map<const void*, std::byte*> packed;
  for_each_content(bug, [&](const auto& content, std::uint64_t at) { packed[&content] = staging.bytes + at; });
  for (std::size_t i = 0; i < bug.images.size(); ++i)
    for (const bug::Texels& texels : bug.images[i].texels)
      if (bug.images[i].samples != 1)
        copy_samples(d, bug.images[i], resources.images[i], resources.image_memories[i], texels, packed.at(&texels),
                     back);
}

}  // namespace vitrine::glass::replayer
