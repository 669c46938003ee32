// Boxes of texel blocks inside one level of one plane: what every transfer works on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/function_ref.h"
#include "texel/transfer.h"

namespace vitrine::texel {

/// Rows of adjacent blocks in slices (depth slices of 3D images, array layers of others) and samples. `origin` is the
/// first block of slice 0, sample 0.
struct Box {
  std::byte* origin = nullptr;
  const FormatDesc* format = nullptr;
  std::uint32_t columns = 0;  ///< blocks
  std::uint32_t rows = 0;     ///< block rows
  std::uint32_t slices = 0;
  std::uint32_t samples = 1;
  std::uint64_t row_pitch = 0;  ///< bytes
  std::uint64_t slice_pitch = 0;
  std::uint64_t sample_stride = 0;

  std::size_t row_bytes() const { return std::size_t{columns} * format->block_bytes; }
  std::byte* row(std::uint32_t slice, std::uint32_t sample, std::uint32_t y) const {
    return origin + slice * slice_pitch + sample * sample_stride + y * row_pitch;
  }
  bool empty() const { return columns == 0 || rows == 0 || slices == 0; }
};

/// The box of an image region, cut to the level and the layers. Offsets and extents are texels of the image's format;
/// for 3D images slices are z, for others layers. Empty if nothing is left or the subresource does not exist.
Box make_box(const ImageMemory& image, VkImageAspectFlagBits aspect, const VkImageSubresourceLayers& layers,
             const VkOffset3D& offset, const VkExtent3D& extent);

/// Calls body(first_row, row_count, slice, sample) over all rows of a box, in parallel if the work is large.
/// `row_cost` is bytes touched per row.
void for_each_band(const Box& box, std::size_t row_cost,
                   base::FunctionRef<void(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)> body);

}  // namespace vitrine::texel
