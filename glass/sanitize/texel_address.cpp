// See texel_address.h.
#include "glass/sanitize/texel_address.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::ir::ImageOperand;

/// Coordinates of a texel in front of the array layer, and whether that follows.
struct Shape {
  std::uint32_t dims = 2;
  bool layered = false;
};

Shape shape_of(VkImageViewType type) {
  const bool one = type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
  if (one) return {1, type == VK_IMAGE_VIEW_TYPE_1D_ARRAY};
  if (type == VK_IMAGE_VIEW_TYPE_3D) return {3, false};
  return {2, type != VK_IMAGE_VIEW_TYPE_2D};
}

TexelBytes of_image(const texel::ImageView& view, const ImageLanes& operands, std::size_t lane) {
  const Shape shape = shape_of(view.type);
  std::int64_t at[3] = {};
  for (std::uint32_t c = 0; c < shape.dims; ++c) at[c] = operands.coordinate(c, lane);
  const std::int64_t layer = shape.layered ? operands.operand(ImageOperand::kCoord, shape.dims, lane).value_or(0) : 0;
  const std::int64_t level = operands.operand(ImageOperand::kLod, 0, lane).value_or(0);
  const std::int64_t sample = operands.operand(ImageOperand::kSample, 0, lane).value_or(0);
  const auto inside = [](std::int64_t number, std::uint32_t size) { return number >= 0 && number < size; };
  if (!inside(level, view.level_count) || !inside(layer, view.layer_count) || !inside(sample, view.samples)) return {};
  const texel::Extent& extent = view.level[level].extent;
  if (!inside(at[0], extent.width) || !inside(at[1], extent.height) || !inside(at[2], extent.depth)) return {};
  const auto block = [](std::int64_t texel, std::uint32_t size) { return static_cast<std::uint32_t>(texel) / size; };
  const std::byte* const address =
      view.block(static_cast<std::uint32_t>(level), static_cast<std::uint32_t>(layer),
                 static_cast<std::uint32_t>(sample), block(at[0], view.format->block_width),
                 block(at[1], view.format->block_height), static_cast<std::uint32_t>(at[2]));
  return {reinterpret_cast<std::uintptr_t>(address), view.format->block_bytes};
}

}  // namespace

TexelBytes texel_bytes(const spirv::Descriptor& image, const spirv::ImageOp& op, const ImageLanes& operands,
                       std::size_t lane) {
  if (op.info.dim != spirv::ir::ImageDim::kBuffer)
    return image.image->planes != nullptr ? TexelBytes{} : of_image(*image.image, operands, lane);
  const texel::BufferTexelView& view = *image.texels;
  const std::int64_t x = operands.coordinate(0, lane);
  if (x < 0 || static_cast<std::uint64_t>(x) >= view.count) return {};
  return {reinterpret_cast<std::uintptr_t>(view.data) + static_cast<std::uint64_t>(x) * view.format->block_bytes,
          view.format->block_bytes};
}

}  // namespace vitrine::glass::sanitize
