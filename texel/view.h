// Memory seen as texels: the layout of a whole image, and the views that shaders, attachments and transfers work on. A
// view is a non-owning value that knows addresses; it knows no handle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "texel/format.h"

namespace vitrine::texel {

inline constexpr std::uint32_t kMaxLevels = 16;  ///< images up to 32768 texels wide

struct Extent {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::uint32_t depth = 1;
};

/// Where one mip level lies. Texel blocks of a row are adjacent. Address of block (x, y, z) of layer l, sample s:
/// base + offset + l*layer_stride + s*sample_stride + z*slice_pitch + y*row_pitch + x*block_bytes.
struct LevelLayout {
  std::uint64_t offset = 0;         ///< bytes from the start of the plane of layer 0
  Extent extent;                    ///< texels
  std::uint64_t row_pitch = 0;      ///< bytes between block rows
  std::uint64_t slice_pitch = 0;    ///< bytes between depth slices (3D)
  std::uint64_t sample_stride = 0;  ///< bytes between samples
};

/// One memory plane of an image: an aspect of a depth/stencil format, a plane of a multi-planar one, or the whole
/// colour image. Depth and stencil of a combined format are separate planes in memory, so that each is a plain format:
/// D24S8 = D24 in 32-bit words (X8_D24 layout) + S8; D32S8 = D32 + S8.
struct PlaneLayout {
  VkFormat format = VK_FORMAT_UNDEFINED;  ///< plain single-aspect format of the plane
  std::uint64_t offset = 0;               ///< bytes from the start of the memory: the image's, or the plane's own
  std::uint64_t size = 0;                 ///< bytes of all layers
  std::uint64_t layer_stride = 0;         ///< bytes between array layers
  std::array<LevelLayout, kMaxLevels> level{};
};

struct ImageDesc {
  VkImageType type = VK_IMAGE_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Extent extent;
  std::uint32_t levels = 1;
  std::uint32_t layers = 1;
  std::uint32_t samples = 1;
  bool linear_tiling = false;
  bool disjoint = false;  ///< each plane has memory of its own
};

struct ImageLayout {
  ImageDesc desc;
  std::uint32_t plane_count = 1;
  std::array<PlaneLayout, 3> plane{};  ///< depth/stencil: depth first, then stencil (or stencil alone at 0)
  std::uint64_t size = 0;              ///< bytes
  std::uint64_t alignment = 64;        ///< bytes
};

/// Computes offsets and pitches; `size` covers all planes of an image that is not disjoint. False if the size overflows
/// 2^63 bytes.
bool make_image_layout(const ImageDesc& desc, ImageLayout& layout);

/// Index in ImageLayout::plane of one aspect bit (COLOR, DEPTH, STENCIL, PLANE_n).
std::uint32_t plane_of_aspect(const ImageLayout& layout, VkImageAspectFlagBits aspect);

/// One image as one plane of texels of one format, restricted to a range of levels and layers: what a descriptor, an
/// attachment or a transfer names. Built by make_image_view from an ImageLayout and the image's memory.
struct ImageView {
  std::byte* base = nullptr;  ///< address of the plane, layer `base_layer` (memory + plane offset + layer offset)
  std::uint64_t layer_stride = 0;
  const FormatDesc* format = nullptr;  ///< view_format_desc() of the view (which may differ from the image's)
  VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
  std::array<std::uint8_t, 4> swizzle{0, 1, 2, 3};  ///< per output component: 0..3 = RGBA, 4 = zero, 5 = one
  std::uint32_t level_count = 1;
  std::uint32_t layer_count = 1;
  std::uint32_t samples = 1;
  std::uint32_t base_level = 0;  ///< of the image; level[0] below is already this one
  float min_lod = 0;             ///< the sampler goes no lower (VkImageViewMinLodCreateInfoEXT), from base_level on
  std::uint32_t min_level = 0;   ///< its floor: levels in front of it have no texels for reads, writes and gathers
  Extent level0_extent;          ///< of the image's level 0: lavapipe decides power-of-two addressing by it
  std::array<LevelLayout, kMaxLevels> level{};  ///< [0] is the view's first level
  /// What a Y'CbCr conversion samples: views of FormatDesc::plane of the format; null for other formats.
  const ImageView* planes = nullptr;
  /// Of a view of 64-bit texels: two views whose components are the low and the high words of its own components,
  /// swizzled, for fetches and lookups (make_word_view). Null for other formats.
  const ImageView* words = nullptr;

  std::byte* block(std::uint32_t lvl, std::uint32_t layer, std::uint32_t sample, std::uint32_t bx, std::uint32_t by,
                   std::uint32_t bz) const {
    const LevelLayout& l = level[lvl];
    return base + l.offset + layer * layer_stride + sample * l.sample_stride + bz * l.slice_pitch + by * l.row_pitch +
           std::uint64_t{bx} * format->block_bytes;
  }
};

struct ImageViewDesc {
  VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkComponentMapping components{};
  VkImageAspectFlagBits aspect = VK_IMAGE_ASPECT_COLOR_BIT;  ///< one aspect
  std::uint32_t base_level = 0, level_count = 1;
  std::uint32_t base_layer = 0, layer_count = 1;
};

/// `memory` is the address of the image's first byte, or of the plane's in a disjoint image. Counts must be resolved
/// (no VK_REMAINING_*).
ImageView make_image_view(const ImageLayout& layout, std::byte* memory, const ImageViewDesc& desc);

/// The view of FormatDesc::plane[index] of an image whose format requires a conversion: what ImageView::planes points
/// to. `memory` as above; `desc` names the image's format and the colour aspect.
ImageView make_sampled_plane(const ImageLayout& layout, std::byte* memory, const ImageViewDesc& desc,
                             std::uint32_t index);

/// ImageView::words[high] of a view whose format is R64_UINT or R64_SINT.
ImageView make_word_view(const ImageView& view, bool high);

/// A texel buffer.
struct BufferTexelView {
  std::byte* data = nullptr;
  std::uint64_t count = 0;             ///< texels
  const FormatDesc* format = nullptr;  ///< view_format_desc()
};

}  // namespace vitrine::texel
