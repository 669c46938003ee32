// Transfers: copies, clears, blits and resolves of whole regions (Vulkan 1.3.239, Copy Commands, Clear Commands).
// Large ones run in parallel on the worker pool. Regions that leave the image or the buffer are cut or ignored, never
// followed. Filling and copying buffers is memory copying and not here.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <span>

#include "texel/codec.h"
#include "texel/view.h"

namespace vitrine::texel {

/// An image in memory: its layout and the address of its first byte, or of each plane's of a disjoint image.
struct ImageMemory {
  const ImageLayout* layout = nullptr;
  std::byte* memory = nullptr;
  const std::array<std::byte*, 3>* disjoint = nullptr;

  std::byte* plane(std::uint32_t index) const {
    return (disjoint ? (*disjoint)[index] : memory) + layout->plane[index].offset;
  }
};

/// `buffer` is the whole buffer; region.bufferOffset counts from its first byte. One aspect per region.
void copy_buffer_to_image(std::span<const std::byte> buffer, const ImageMemory& image, const VkBufferImageCopy& region);
void copy_image_to_buffer(const ImageMemory& image, std::span<std::byte> buffer, const VkBufferImageCopy& region);

/// Raw copy between formats of one block size, all samples. Source and destination regions may not overlap.
void copy_image(const ImageMemory& source, const ImageMemory& destination, const VkImageCopy& region);

/// Scaled, flipped, converted (lavapipe-rasterization.md 11.3).
void blit_image(const ImageMemory& source, const ImageMemory& destination, const VkImageBlit& region, VkFilter filter);

/// Multisampled to single-sampled (lavapipe-rasterization.md 8.8): average of floats, sample 0 of integers.
void resolve_image(const ImageMemory& source, const ImageMemory& destination, const VkImageResolve& region);

/// Resolve of an attachment inside a render pass: level 0 of both views, texels of `area`, `layer_count` layers from
/// view layer `base_layer`. `mode`: of planes of depth and stencil; averages are rounded to the nearest number of the
/// format, halves up. Colours are resolved as resolve_image() does.
void resolve_view(const ImageView& source, const ImageView& destination, VkResolveModeFlagBits mode,
                  const VkRect2D& area, std::uint32_t base_layer, std::uint32_t layer_count);

/// The bytes a clear value becomes. Colours by the format's kind; depth and stencil formats take one plane each.
StoredTexel encode_clear_color(const FormatDesc& format, const VkClearColorValue& color);
StoredTexel encode_clear_depth(const FormatDesc& plane_format, float depth);
StoredTexel encode_clear_stencil(std::uint32_t stencil);

/// Fills `rows` rows of `row_bytes` bytes, `pitch` bytes apart, with texels of `block_bytes` bytes. On this thread.
void fill_rows(std::byte* first, std::uint64_t pitch, std::size_t row_bytes, std::size_t rows, const StoredTexel& value,
               std::size_t block_bytes);

/// Fills texels of `area` (cut to the level), all samples and slices, of `layer_count` layers from `base_layer` of the
/// view's level `level`: load ops, vkCmdClearAttachments.
void fill_view(const ImageView& view, std::uint32_t level, const VkRect2D& area, std::uint32_t base_layer,
               std::uint32_t layer_count, const StoredTexel& value);

/// vkCmdClearColorImage, vkCmdClearDepthStencilImage: whole levels and layers; VK_REMAINING_* allowed.
void clear_color_image(const ImageMemory& image, const VkClearColorValue& color, const VkImageSubresourceRange& range);
void clear_depth_stencil_image(const ImageMemory& image, const VkClearDepthStencilValue& value,
                               const VkImageSubresourceRange& range);

}  // namespace vitrine::texel
