// Where the texels of an image lie: planes, layers, mip levels, samples (Vulkan 1.3.239, Resource Creation, "Images").
#include "texel/layout.h"

#include <algorithm>

namespace vitrine::texel {
namespace {

/// Rows start and end on this, so that vector code may read and write whole registers inside a row's pitch.
constexpr std::uint64_t kRowAlignment = 64;
/// Gathers of narrow texels read whole 32-bit words: room for that behind the last one.
constexpr std::uint64_t kTailPadding = 64;
constexpr std::uint64_t kSizeLimit = std::uint64_t{1} << 62;

std::uint64_t align_up(std::uint64_t value, std::uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

/// For value >= 1, up to the largest.
std::uint32_t divide_up(std::uint32_t value, std::uint32_t divisor) { return (value - 1) / divisor + 1; }

/// Adds a * b to sum; false when the result reaches the limit.
bool accumulate(std::uint64_t& sum, std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  if (__builtin_mul_overflow(a, b, &product) || product >= kSizeLimit) return false;
  sum += product;
  return sum < kSizeLimit;
}

/// The plain formats of the planes of an image's format, depth before stencil. Returns their number.
std::uint32_t plane_formats(VkFormat format, std::array<VkFormat, 3>& out) {
  const FormatDesc& desc = format_desc(format);
  if (desc.plane_count > 1) {
    std::transform(desc.plane.begin(), desc.plane.end(), out.begin(), [](const Plane& p) { return p.format; });
    return desc.plane_count;
  }
  if (!desc.has_depth() || !desc.has_stencil()) {
    out[0] = format;
    return 1;
  }
  const Channel& depth = desc.channel[0];
  out[0] = depth.numeric == Numeric::kSfloat ? VK_FORMAT_D32_SFLOAT
           : depth.bits == 16                ? VK_FORMAT_D16_UNORM
                                             : VK_FORMAT_X8_D24_UNORM_PACK32;
  out[1] = VK_FORMAT_S8_UINT;
  return 2;
}

/// The extent of a plane's level 0.
Extent plane_extent(const ImageDesc& desc, std::uint32_t plane) {
  const FormatDesc& format = format_desc(desc.format);
  if (format.plane_count == 1) return desc.extent;
  const Plane& part = format.plane[plane];
  return {divide_up(desc.extent.width, part.width_divisor), divide_up(desc.extent.height, part.height_divisor),
          desc.extent.depth};
}

/// Fills the levels of a plane; `layer_size` receives the bytes of one layer.
bool place_levels(const ImageDesc& desc, const Extent& extent, PlaneLayout& plane, std::uint64_t& layer_size) {
  const FormatDesc& format = format_desc(plane.format);
  layer_size = 0;
  for (std::uint32_t i = 0; i < desc.levels; ++i) {
    LevelLayout& level = plane.level[i];
    level.extent = {std::max(1u, extent.width >> i), std::max(1u, extent.height >> i), std::max(1u, extent.depth >> i)};
    const std::uint64_t columns = divide_up(level.extent.width, format.block_width);
    const std::uint64_t rows = divide_up(level.extent.height, format.block_height);
    const std::uint64_t slices = divide_up(level.extent.depth, format.block_depth);
    level.offset = layer_size;
    level.row_pitch = align_up(columns * format.block_bytes, kRowAlignment);
    if (!accumulate(level.slice_pitch, level.row_pitch, rows)) return false;
    if (!accumulate(level.sample_stride, level.slice_pitch, slices)) return false;
    if (!accumulate(layer_size, level.sample_stride, desc.samples)) return false;
  }
  return true;
}

bool is_aligned(const PlanePlace& place) {
  return place.offset % kRowAlignment == 0 && place.row_pitch % kRowAlignment == 0;
}

/// Moves a plane of one level to where somebody else wants it.
bool move_plane(const ImageDesc& desc, const PlanePlace& place, PlaneLayout& plane) {
  LevelLayout& level = plane.level[0];
  const std::uint64_t rows = divide_up(level.extent.height, format_desc(plane.format).block_height);
  if (!is_aligned(place) || place.row_pitch < level.row_pitch || place.offset >= kSizeLimit) return false;
  std::uint64_t layer_bytes = 0;
  if (!accumulate(layer_bytes, place.row_pitch, rows)) return false;
  const bool layered = desc.layers > 1;
  if (layered && (place.layer_stride % kRowAlignment != 0 || place.layer_stride < layer_bytes)) return false;
  plane.offset = place.offset;
  plane.layer_stride = layered ? place.layer_stride : layer_bytes;
  plane.size = layer_bytes;
  level.row_pitch = place.row_pitch;
  level.slice_pitch = level.sample_stride = layer_bytes;
  return accumulate(plane.size, plane.layer_stride, desc.layers - 1);
}

}  // namespace

bool make_image_layout(const ImageDesc& desc, ImageLayout& layout) {
  layout = {};
  layout.desc = desc;
  const FormatDesc& format = format_desc(desc.format);
  if (format.block_bytes == 0 || desc.levels > kMaxLevels) return false;
  std::array<VkFormat, 3> formats{};
  layout.plane_count = plane_formats(desc.format, formats);
  for (std::uint32_t i = 0; i < layout.plane_count; ++i) {
    PlaneLayout& plane = layout.plane[i];
    plane.format = formats[i];
    plane.offset = desc.disjoint ? 0 : layout.size;
    if (!place_levels(desc, plane_extent(desc, i), plane, plane.layer_stride)) return false;
    if (!accumulate(plane.size, plane.layer_stride, desc.layers)) return false;
    if (!accumulate(layout.size, plane.size, 1)) return false;
  }
  layout.size += kTailPadding;
  return true;
}

bool make_image_layout(const ImageDesc& desc, std::span<const PlanePlace> places, ImageLayout& layout) {
  const bool flat = desc.levels == 1 && desc.samples == 1 && desc.extent.depth == 1 && desc.layers != 0;
  if (!flat || !make_image_layout(desc, layout) || places.size() != layout.plane_count) return false;
  layout.size = 0;
  for (std::uint32_t i = 0; i < layout.plane_count; ++i) {
    PlaneLayout& plane = layout.plane[i];
    if (!move_plane(desc, places[i], plane)) return false;
    std::uint64_t end = plane.offset;
    if (!accumulate(end, plane.size, 1)) return false;
    layout.size = std::max(layout.size, end);
  }
  layout.size += kTailPadding;
  return true;
}

std::uint32_t plane_of_aspect(const ImageLayout& layout, VkImageAspectFlagBits aspect) {
  switch (aspect) {
    case VK_IMAGE_ASPECT_STENCIL_BIT:
    case VK_IMAGE_ASPECT_PLANE_1_BIT:
    case VK_IMAGE_ASPECT_MEMORY_PLANE_1_BIT_EXT:
      return layout.plane_count > 1;
    case VK_IMAGE_ASPECT_PLANE_2_BIT:
    case VK_IMAGE_ASPECT_MEMORY_PLANE_2_BIT_EXT:
      return layout.plane_count > 2 ? 2 : 0;
    default:
      return 0;
  }
}

}  // namespace vitrine::texel
