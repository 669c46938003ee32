// See captured_objects.h: what images hold.
#include <algorithm>
#include <cstring>

#include "glass/bug/texels.h"
#include "glass/memory_shadow.h"
#include "icd/replay/captured_objects.h"
#include "texel/transfer.h"

namespace vitrine::icd {

using glass::bug::Blob;
using glass::bug::Bytes;

/// Of blocks that nothing has written, as a tool knows, and that are zero: they stay unwritten where it is replayed.
void CapturedObjects::take_written(const Image& image, glass::bug::Texels& texels) const {
  const glass::ShadowRegion* shadow = keeps_shadow_ ? glass::find_shadow(image.data) : nullptr;
  if (!shadow || image.desc().samples != 1) return;
  const texel::PlaneLayout& plane = image.layout.plane[texel::plane_of_aspect(image.layout, texels.aspect)];
  const texel::LevelLayout& level = plane.level[texels.level];
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  const auto [width, height, depth] = glass::bug::blocks_of(format, level.extent);
  Bytes written;
  for (std::uint32_t i = 0; i < texels.layers * depth * height; ++i) {
    const std::byte* row = image.data + plane.offset + level.offset + i % height * level.row_pitch +
                           i / height % depth * level.slice_pitch +
                           (texels.layer + i / height / depth) * plane.layer_stride;
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::byte* at = row + std::uint64_t{x} * format.block_bytes;
      const auto address = reinterpret_cast<std::uintptr_t>(at);
      const bool unwritten = shadow->first_unwritten(address, format.block_bytes, glass::Contents::kTexels) == 0 &&
                             std::all_of(at, at + format.block_bytes, [](std::byte b) { return b == std::byte{0}; });
      written.push_back(std::byte{!unwritten});
    }
  }
  const auto count = std::count(written.begin(), written.end(), std::byte{1});
  texels.unwritten = count == 0;
  if (count != 0 && static_cast<std::size_t>(count) != written.size())
    texels.written = std::make_shared<Bytes>(std::move(written));
}

Bytes CapturedObjects::packed(const Image& image, const glass::bug::Texels& texels) const {
  Bytes out(glass::bug::packed_bytes(image.layout, texels.aspect, texels.level, texels.layers));
  if (image.desc().samples != 1) {
    std::byte* to = out.data();
    glass::bug::for_each_sample_row(
        image.layout, texels.aspect, texels.layer, texels.layers,
        [&](std::uint64_t at, std::uint64_t bytes) { to = std::copy_n(image.data + at, bytes, to); });
    return out;
  }
  const texel::PlaneLayout& plane = image.layout.plane[texel::plane_of_aspect(image.layout, texels.aspect)];
  const texel::Extent& extent = plane.level[texels.level].extent;
  VkBufferImageCopy region{};
  region.imageSubresource = {static_cast<VkImageAspectFlags>(texels.aspect), texels.level, texels.layer, texels.layers};
  region.imageExtent = {extent.width, extent.height, extent.depth};
  texel::copy_image_to_buffer({&image.layout, image.data, nullptr}, out, region);
  return out;
}

void CapturedObjects::take_image(std::uint32_t number, Snapshots& snapshots) {
  const Image& image = *images_[number];
  const VkImageAspectFlags aspects = texel::format_desc(image.desc().format).aspects;
  for (const auto& [level, layers] : shown_[number]) {
    for (const VkImageAspectFlagBits aspect :
         {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
      if (!(aspects & aspect)) continue;
      glass::bug::Texels texels{aspect, level,   layers.first, layers.second - layers.first,
                                false,  nullptr, nullptr,      nullptr};
      const Bytes now = packed(image, texels);
      const texel::PlaneLayout& plane = image.layout.plane[texel::plane_of_aspect(image.layout, aspect)];
      Blob& kept = snapshots[image.data + plane.offset + plane.level[level].offset];
      if (!kept || *kept != now) kept = std::make_shared<Bytes>(now);
      texels.before = kept;
      take_written(image, texels);
      bug_.images[number].texels.push_back(std::move(texels));
    }
  }
}

}  // namespace vitrine::icd
