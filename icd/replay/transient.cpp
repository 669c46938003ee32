// Makes transient multisampled images and fills their samples.
#include "icd/replay/transient.h"

#include <cstring>
#include <new>

#include "icd/replay/scope.h"

namespace vitrine::icd {
namespace {

void replicate(const texel::ImageView& from, const texel::ImageView& to) {
  if (!from.format || !to.format) return;
  const texel::Extent& extent = to.level[0].extent;
  const std::size_t bytes = std::size_t{extent.width} * to.format->block_bytes;
  for (std::uint32_t layer = 0; layer < to.layer_count; ++layer)
    for (std::uint32_t sample = 0; sample < to.samples; ++sample)
      for (std::uint32_t y = 0; y < extent.height; ++y)
        std::memcpy(to.block(0, layer, sample, 0, y, 0), from.block(0, layer, 0, 0, y, 0), bytes);
}

void make_image(TransientAttachment& out, std::uint32_t samples) {
  const ImageView& single = *out.single;
  texel::ImageDesc desc;
  desc.format = single.format;
  desc.extent = {single.view.level[0].extent.width, single.view.level[0].extent.height, 1};
  desc.layers = single.view.layer_count;
  desc.samples = samples;
  if (!texel::make_image_layout(desc, out.image.layout)) throw std::bad_alloc();
  out.texels.resize(out.image.layout.size + out.image.layout.alignment);
  const auto address = reinterpret_cast<std::uintptr_t>(out.texels.data());
  out.image.data = out.texels.data() + (out.image.layout.alignment - address % out.image.layout.alignment);
}

void make_view(TransientAttachment& out) {
  const ImageView& single = *out.single;
  ImageView& view = out.view;
  view.image = &out.image;
  view.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  view.format = single.format;
  view.usage = single.usage;
  view.range = {single.range.aspectMask, 0, 1, 0, single.view.layer_count};
  const VkImageAspectFlags aspects = texel::format_desc(single.format).aspects;
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_STENCIL_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_COLOR_BIT}) {
    if (!(aspects & aspect)) continue;
    view.view = view_of_aspect(out.image, aspect, view.type, view.format, view.range);
    const bool color = aspect == VK_IMAGE_ASPECT_COLOR_BIT;
    replicate(color ? single.view : depth_stencil_plane(single, aspect), view.view);
  }
  view.stencil =
      aspects & VK_IMAGE_ASPECT_STENCIL_BIT ? depth_stencil_plane(view, VK_IMAGE_ASPECT_STENCIL_BIT) : view.view;
}

}  // namespace

const ImageView* transient_of(TransientAttachments& all, const ImageView* single, std::uint32_t samples) {
  if (!single || samples <= 1 || single->view.samples > 1) return single;
  for (const TransientAttachment& known : all)
    if (known.single == single) return &known.view;
  TransientAttachment& made = all.emplace_back(all.get_allocator().memory);
  made.single = single;
  make_image(made, samples);
  make_view(made);
  return &made.view;
}

}  // namespace vitrine::icd
