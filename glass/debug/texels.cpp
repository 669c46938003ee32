// See texels.h. Which coordinate is what: Vulkan 1.3.239, Image Views, and SPIR-V 3.42.10, OpImageRead.
#include "glass/debug/texels.h"

#include "texel/view.h"

namespace vitrine::glass::debug {
namespace {

bool inside(std::int64_t number, std::uint64_t size) {
  return number >= 0 && static_cast<std::uint64_t>(number) < size;
}

/// Coordinates in front of the array layer.
std::uint32_t dimensions_of(VkImageViewType type) {
  if (type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY) return 1;
  return type == VK_IMAGE_VIEW_TYPE_3D ? 3 : 2;
}

bool is_layered(VkImageViewType type) {
  return type != VK_IMAGE_VIEW_TYPE_1D && type != VK_IMAGE_VIEW_TYPE_2D && type != VK_IMAGE_VIEW_TYPE_3D;
}

std::optional<StoredTexelAt> find_in_view(const texel::ImageView& view, const TexelCoordinates& at) {
  std::size_t next = dimensions_of(view.type);
  std::int64_t place[3] = {};
  for (std::size_t c = 0; c < next; ++c) place[c] = at[c];
  const std::int64_t layer = is_layered(view.type) ? at[next++] : 0;
  const std::int64_t sample = view.samples > 1 ? at[next] : 0, level = view.samples > 1 ? 0 : at[next];
  if (!inside(level, view.level_count) || !inside(layer, view.layer_count) || !inside(sample, view.samples))
    return std::nullopt;
  const texel::Extent& extent = view.level[level].extent;
  if (!inside(place[0], extent.width) || !inside(place[1], extent.height) || !inside(place[2], extent.depth))
    return std::nullopt;
  return StoredTexelAt{view.block(static_cast<std::uint32_t>(level), static_cast<std::uint32_t>(layer),
                                  static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(place[0]),
                                  static_cast<std::uint32_t>(place[1]), static_cast<std::uint32_t>(place[2])),
                       view.format->block_bytes, view.format};
}

}  // namespace

std::optional<ImageShape> shape_of(const spirv::Descriptor& image) {
  ImageShape shape;
  if (image.texels != nullptr && image.texels->data != nullptr) {
    shape = {image.texels->format, 1, {static_cast<std::uint32_t>(image.texels->count)}};
  } else if (image.image != nullptr && image.image->planes == nullptr && image.image->level_count != 0) {
    const texel::ImageView& view = *image.image;
    const texel::Extent& extent = view.level[0].extent;
    shape = {view.format, dimensions_of(view.type), {extent.width, extent.height, extent.depth}};
    if (is_layered(view.type)) shape.size[shape.dimensions++] = view.layer_count;
  }
  if (shape.format == nullptr || texel::texel_decoder(*shape.format) == nullptr) return std::nullopt;
  return shape;
}

std::optional<StoredTexelAt> find_texel(const spirv::Descriptor& image, const TexelCoordinates& at) {
  std::optional<StoredTexelAt> found;
  if (image.texels != nullptr && image.texels->data != nullptr) {
    const texel::BufferTexelView& view = *image.texels;
    if (inside(at[0], view.count))
      found = {view.data + static_cast<std::uint64_t>(at[0]) * view.format->block_bytes, view.format->block_bytes,
               view.format};
  } else if (image.image != nullptr && image.image->planes == nullptr) {
    found = find_in_view(*image.image, at);
  }
  if (found && texel::texel_decoder(*found->format) == nullptr) found.reset();
  return found;
}

texel::Texel decode(const StoredTexelAt& texel) {
  texel::Texel decoded{};
  texel::texel_decoder (*texel.format)(*texel.format, texel.at, decoded);
  return decoded;
}

bool encode(const StoredTexelAt& where, const texel::Texel& texel, std::array<std::byte, 16>& bytes) {
  const texel::TexelEncoder encoder = texel::texel_encoder(*where.format, texel::Encoding::kStore);
  if (encoder == nullptr || where.bytes > bytes.size()) return false;
  encoder(*where.format, texel, bytes.data());
  return true;
}

}  // namespace vitrine::glass::debug
