// Copies between buffers and images (Vulkan 1.3.239, Copying Data Between Buffers and Images, Between Images): raw
// blocks.
#include <algorithm>
#include <cstring>

#include "texel/transfer/box.h"

namespace vitrine::texel {
namespace {

constexpr std::uint32_t kDepth24Mask = 0x00FFFFFF;

/// A depth plane of 24 bits keeps its upper 8 bits zero, whatever the buffer holds there.
void copy_depth24(std::byte* destination, const std::byte* source, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, source + i, sizeof(word));
    word &= kDepth24Mask;
    std::memcpy(destination + i, &word, sizeof(word));
  }
}

/// Copies all rows, slices and samples that both boxes have.
void copy_box(Box destination, const Box& source) {
  destination.columns = std::min(destination.columns, source.columns);
  destination.rows = std::min(destination.rows, source.rows);
  destination.slices = std::min(destination.slices, source.slices);
  destination.samples = std::min(destination.samples, source.samples);
  if (destination.empty()) return;
  const std::size_t bytes = destination.row_bytes();
  const bool mask = destination.format->format == VK_FORMAT_X8_D24_UNORM_PACK32;
  const bool one_run = !mask && bytes == destination.row_pitch && bytes == source.row_pitch;
  for_each_band(destination, bytes,
                [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t sample) {
                  if (one_run) {
                    std::memcpy(destination.row(slice, sample, first), source.row(slice, sample, first), bytes * count);
                    return;
                  }
                  for (std::uint32_t y = first; y < first + count; ++y) {
                    std::byte* to = destination.row(slice, sample, y);
                    const std::byte* from = source.row(slice, sample, y);
                    mask ? copy_depth24(to, from, bytes) : static_cast<void>(std::memcpy(to, from, bytes));
                  }
                });
}

/// The buffer side of a region as a box of the same blocks as `image`, empty if the buffer is too small for it.
Box buffer_box(std::byte* data, std::size_t size, const VkBufferImageCopy& region, const Box& image) {
  const FormatDesc& format = *image.format;
  const std::uint64_t length = region.bufferRowLength != 0 ? region.bufferRowLength : region.imageExtent.width;
  const std::uint64_t height = region.bufferImageHeight != 0 ? region.bufferImageHeight : region.imageExtent.height;
  Box box = image;
  box.row_pitch = (length + format.block_width - 1) / format.block_width * format.block_bytes;
  box.slice_pitch = (height + format.block_height - 1) / format.block_height * box.row_pitch;
  box.samples = 1;
  box.sample_stride = 0;
  const std::uint64_t end =
      region.bufferOffset + (image.slices - 1) * box.slice_pitch + (image.rows - 1) * box.row_pitch + image.row_bytes();
  if (image.empty() || region.bufferOffset > size || end > size) return {};
  box.origin = data + region.bufferOffset;
  return box;
}

Box region_box(const ImageMemory& image, const VkBufferImageCopy& region) {
  const auto aspect = static_cast<VkImageAspectFlagBits>(region.imageSubresource.aspectMask);
  Box box = make_box(image, aspect, region.imageSubresource, region.imageOffset, region.imageExtent);
  box.samples = std::min(box.samples, 1u);
  return box;
}

}  // namespace

void copy_buffer_to_image(std::span<const std::byte> buffer, const ImageMemory& image,
                          const VkBufferImageCopy& region) {
  const Box destination = region_box(image, region);
  if (destination.empty()) return;
  // The source box is only read.
  copy_box(destination, buffer_box(const_cast<std::byte*>(buffer.data()), buffer.size(), region, destination));
}

void copy_image_to_buffer(const ImageMemory& image, std::span<std::byte> buffer, const VkBufferImageCopy& region) {
  const Box source = region_box(image, region);
  if (source.empty()) return;
  copy_box(buffer_box(buffer.data(), buffer.size(), region, source), source);
}

void copy_image(const ImageMemory& source, const ImageMemory& destination, const VkImageCopy& region) {
  for (const auto aspect : {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT,
                            VK_IMAGE_ASPECT_PLANE_0_BIT, VK_IMAGE_ASPECT_PLANE_1_BIT, VK_IMAGE_ASPECT_PLANE_2_BIT}) {
    if ((region.srcSubresource.aspectMask & aspect) == 0) continue;
    const Box from = make_box(source, aspect, region.srcSubresource, region.srcOffset, region.extent);
    if (from.empty()) continue;
    const auto dst_aspect = (region.dstSubresource.aspectMask & aspect) != 0
                                ? aspect
                                : static_cast<VkImageAspectFlagBits>(region.dstSubresource.aspectMask);
    const ImageLayout& target = *destination.layout;
    // The extent counts texels of the source; with blocks of another extent the destination has as many blocks.
    const FormatDesc& format = format_desc(target.plane[plane_of_aspect(target, dst_aspect)].format);
    const VkExtent3D extent{from.columns * format.block_width, from.rows * format.block_height,
                            std::max(region.extent.depth, region.srcSubresource.layerCount)};
    VkImageSubresourceLayers layers = region.dstSubresource;
    layers.layerCount = std::max(layers.layerCount, region.extent.depth);
    const Box to = make_box(destination, dst_aspect, layers, region.dstOffset, extent);
    if (to.empty() || to.format->block_bytes != from.format->block_bytes) continue;
    copy_box(to, from);
  }
}

}  // namespace vitrine::texel
