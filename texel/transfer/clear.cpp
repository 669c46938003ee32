// Clears: a value becomes stored bytes once, then rows are filled (Vulkan 1.3.239, Clear Commands).
#include <algorithm>

#include "base/numeric.h"
#include "texel/transfer/box.h"

namespace vitrine::texel {
namespace {

void fill_box(const Box& box, const StoredTexel& value) {
  if (box.empty() || box.format->block_bytes > value.bytes.size()) return;
  const std::size_t bytes = box.row_bytes();
  for_each_band(box, bytes, [&](std::uint32_t first, std::uint32_t count, std::uint32_t slice, std::uint32_t sample) {
    fill_rows(box.row(slice, sample, first), box.row_pitch, bytes, count, value, box.format->block_bytes);
  });
}

void fill_range(const ImageMemory& image, VkImageAspectFlagBits aspect, const VkImageSubresourceRange& range,
                const StoredTexel& value) {
  const ImageDesc& desc = image.layout->desc;
  const std::uint32_t levels = std::min(range.levelCount, desc.levels - std::min(desc.levels, range.baseMipLevel));
  for (std::uint32_t i = 0; i < levels; ++i) {
    // make_box cuts the counts, VK_REMAINING_ARRAY_LAYERS included.
    const VkImageSubresourceLayers layers{static_cast<VkImageAspectFlags>(aspect), range.baseMipLevel + i,
                                          range.baseArrayLayer, range.layerCount};
    constexpr VkExtent3D kWhole{UINT32_MAX, UINT32_MAX, UINT32_MAX};
    fill_box(make_box(image, aspect, layers, {0, 0, 0}, kWhole), value);
  }
}

}  // namespace

StoredTexel encode_clear_color(const FormatDesc& format, const VkClearColorValue& color) {
  StoredTexel value;
  const Texel texel{color.uint32[0], color.uint32[1], color.uint32[2], color.uint32[3]};
  // Of a 64-bit component "the first 2 array elements ... are reinterpreted as a single 64-bit element" (Vulkan 1.4,
  // Clear Values).
  encode_texel(view_format_desc(format.format), Encoding::kClear, texel, value.bytes.data());
  return value;
}

StoredTexel encode_clear_depth(const FormatDesc& plane_format, float depth) {
  StoredTexel value;
  encode_texel(plane_format, Encoding::kClear, {base::bits_of(depth), 0, 0, 0}, value.bytes.data());
  return value;
}

StoredTexel encode_clear_stencil(std::uint32_t stencil) {
  StoredTexel value;
  value.bytes[0] = static_cast<std::byte>(stencil & 0xFF);
  return value;
}

void fill_view(const ImageView& view, std::uint32_t level, const VkRect2D& area, std::uint32_t base_layer,
               std::uint32_t layer_count, const StoredTexel& value) {
  if (level >= view.level_count || base_layer >= view.layer_count) return;
  const LevelLayout& l = view.level[level];
  const auto cut = [](std::int64_t at, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, size));
  };
  const std::uint32_t x0 = cut(area.offset.x, l.extent.width);
  const std::uint32_t x1 = cut(std::int64_t{area.offset.x} + area.extent.width, l.extent.width);
  const std::uint32_t y0 = cut(area.offset.y, l.extent.height);
  const std::uint32_t y1 = cut(std::int64_t{area.offset.y} + area.extent.height, l.extent.height);
  Box box;
  box.format = view.format;
  box.columns = x1 - x0;
  box.rows = y1 - y0;
  box.samples = view.samples;
  box.row_pitch = l.row_pitch;
  box.sample_stride = l.sample_stride;
  const std::uint32_t layers = std::min(layer_count, view.layer_count - base_layer);
  for (std::uint32_t layer = base_layer; layer < base_layer + layers; ++layer) {
    box.slices = l.extent.depth;
    box.slice_pitch = l.slice_pitch;
    box.origin = view.block(level, layer, 0, x0, y0, 0);
    fill_box(box, value);
  }
}

void clear_color_image(const ImageMemory& image, const VkClearColorValue& color, const VkImageSubresourceRange& range) {
  const FormatDesc& format = format_desc(image.layout->desc.format);
  if (format.is_compressed() || format.requires_conversion()) return;
  fill_range(image, VK_IMAGE_ASPECT_COLOR_BIT, range, encode_clear_color(format, color));
}

void clear_depth_stencil_image(const ImageMemory& image, const VkClearDepthStencilValue& value,
                               const VkImageSubresourceRange& range) {
  if (range.aspectMask & VK_IMAGE_ASPECT_DEPTH_BIT) {
    const FormatDesc& format = format_desc(image.layout->plane[0].format);
    fill_range(image, VK_IMAGE_ASPECT_DEPTH_BIT, range, encode_clear_depth(format, value.depth));
  }
  if (range.aspectMask & VK_IMAGE_ASPECT_STENCIL_BIT) {
    fill_range(image, VK_IMAGE_ASPECT_STENCIL_BIT, range, encode_clear_stencil(value.stencil));
  }
}

}  // namespace vitrine::texel
