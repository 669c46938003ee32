// Cuts transfer regions to what exists and hands their rows to the worker pool.
#include "texel/transfer/box.h"

#include <algorithm>

#include "base/workers.h"

namespace vitrine::texel {
namespace {

/// Below this a loop on one thread is faster than waking another.
constexpr std::size_t kParallelBytes = 1u << 20;
constexpr std::size_t kBandBytes = 1u << 18;

/// Cuts [offset, offset + extent) to [0, size) and converts it to blocks. Returns the number of blocks, 0 if none.
std::uint32_t cut(std::int32_t offset, std::uint32_t extent, std::uint32_t size, std::uint32_t block,
                  std::uint32_t& first) {
  first = 0;
  if (offset < 0 || static_cast<std::uint32_t>(offset) >= size) return 0;
  const std::uint32_t start = static_cast<std::uint32_t>(offset);
  const std::uint32_t texels = std::min(extent, size - start);
  first = start / block;
  return (start % block + texels + block - 1) / block;
}

}  // namespace

Box make_box(const ImageMemory& image, VkImageAspectFlagBits aspect, const VkImageSubresourceLayers& layers,
             const VkOffset3D& offset, const VkExtent3D& extent) {
  const ImageLayout& layout = *image.layout;
  Box box;
  if (layers.mipLevel >= layout.desc.levels) return box;
  const std::uint32_t index = plane_of_aspect(layout, aspect);
  const PlaneLayout& plane = layout.plane[index];
  const LevelLayout& level = plane.level[layers.mipLevel];
  const bool is_3d = layout.desc.type == VK_IMAGE_TYPE_3D;
  box.format = &format_desc(plane.format);
  box.samples = layout.desc.samples;
  box.row_pitch = level.row_pitch;
  box.slice_pitch = is_3d ? level.slice_pitch : plane.layer_stride;
  box.sample_stride = level.sample_stride;
  std::uint32_t x = 0, y = 0, z = 0;
  box.columns = cut(offset.x, extent.width, level.extent.width, box.format->block_width, x);
  box.rows = cut(offset.y, extent.height, level.extent.height, box.format->block_height, y);
  if (is_3d) {
    box.slices = cut(offset.z, extent.depth, level.extent.depth, 1, z);
  } else if (layers.baseArrayLayer < layout.desc.layers) {
    z = layers.baseArrayLayer;
    box.slices = std::min(layers.layerCount, layout.desc.layers - z);
  }
  box.origin = image.plane(index) + level.offset + z * box.slice_pitch + y * box.row_pitch +
               std::size_t{x} * box.format->block_bytes;
  return box;
}

void for_each_band(const Box& box, std::size_t row_cost,
                   base::FunctionRef<void(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)> body) {
  if (box.empty()) return;
  const std::size_t planes = std::size_t{box.slices} * box.samples;
  if (row_cost * box.rows * planes < kParallelBytes) {
    for (std::uint32_t slice = 0; slice < box.slices; ++slice) {
      for (std::uint32_t sample = 0; sample < box.samples; ++sample) body(0, box.rows, slice, sample);
    }
    return;
  }
  const std::size_t band_rows = std::clamp<std::size_t>(kBandBytes / std::max<std::size_t>(row_cost, 1), 1, box.rows);
  const std::size_t bands = (box.rows + band_rows - 1) / band_rows;
  base::parallel_for(bands * planes, [&](std::size_t index, std::size_t) {
    const std::size_t first = index % bands * band_rows;
    const std::size_t plane = index / bands;
    body(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::min(band_rows, box.rows - first)),
         static_cast<std::uint32_t>(plane / box.samples), static_cast<std::uint32_t>(plane % box.samples));
  });
}

}  // namespace vitrine::texel
