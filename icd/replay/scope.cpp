// The end of a scope of drawing: resolves.
#include "icd/replay/scope.h"

#include <algorithm>

#include "icd/replay/written.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

texel::ImageView attachment_plane(const ImageView& view, VkImageAspectFlagBits aspect) {
  return aspect == VK_IMAGE_ASPECT_COLOR_BIT ? view.view : depth_stencil_plane(view, aspect);
}

}  // namespace

texel::ImageView depth_stencil_plane(const ImageView& view, VkImageAspectFlagBits aspect) {
  if (!(texel::format_desc(view.image->desc().format).aspects & aspect)) return {};
  return view_of_aspect(*view.image, aspect, view.type, view.format, view.range);
}

void describe_shading_rate(const ImageView* view, VkExtent2D texel, raster::PassDesc& desc) {
  if (!view || texel.width < raster::kBlockSize || texel.height < raster::kBlockSize) return;
  desc.shading_rate = &view->view;
  desc.shading_rate_texel = texel;
}

VkRect2D clip_area(const VkRect2D& area, std::uint32_t width, std::uint32_t height) {
  const std::int64_t x0 = std::max(area.offset.x, 0), y0 = std::max(area.offset.y, 0);
  const std::int64_t x1 = std::min<std::int64_t>(std::int64_t{area.offset.x} + area.extent.width, width);
  const std::int64_t y1 = std::min<std::int64_t>(std::int64_t{area.offset.y} + area.extent.height, height);
  return {{static_cast<std::int32_t>(x0), static_cast<std::int32_t>(y0)},
          {static_cast<std::uint32_t>(std::max<std::int64_t>(x1 - x0, 0)),
           static_cast<std::uint32_t>(std::max<std::int64_t>(y1 - y0, 0))}};
}

void end_scope(ReplayState& state) {
  flush_pass(state);
  state.pass.reset();
  if (state.observed) state.observed->pixel_pass.reset();
  const DrawScope& scope = state.scope;
  for (std::uint32_t i = 0; i < scope.resolve_count; ++i) {
    const PendingResolve& r = scope.resolve[i];
    const texel::ImageView source = attachment_plane(*r.source, r.aspect);
    const texel::ImageView target = attachment_plane(*r.target, r.aspect);
    if (!source.format || !target.format) continue;
    for_each_layer_range(scope.view_mask, scope.layers, [&](std::uint32_t layer, std::uint32_t count) {
      texel::resolve_view(source, target, r.mode, scope.area, layer, count);
      if (follows_attachments(state)) note_resolved(state, {r.target, r.aspect, scope.area, layer, count}, source);
    });
  }
  if (!scope.suspended) state.transients.clear();
}

}  // namespace vitrine::icd
