// Viewport transforms and draw regions.
#include "raster/plan/viewports.h"

#include <algorithm>
#include <cmath>

#include "base/as_reference.h"

namespace vitrine::raster {
namespace {

using base::Deviation;

/// lavapipe-rasterization.md 1.1.
ViewportTransform viewport_transform(const VkViewport& viewport, bool negative_one_to_one) {
  ViewportTransform t;
  t.sx = 0.5f * viewport.width;
  t.tx = t.sx + viewport.x;
  t.sy = 0.5f * viewport.height;
  t.ty = t.sy + viewport.y;
  const double min = viewport.minDepth, max = viewport.maxDepth;
  if (negative_one_to_one) {
    t.sz = static_cast<float>(0.5 * (max - min));
    t.tz = static_cast<float>(0.5 * (min + max));
  } else {
    t.sz = static_cast<float>(max - min);
    t.tz = viewport.minDepth;
  }
  const float a = negative_one_to_one ? t.tz - t.sz : t.tz, b = t.tz + t.sz;
  t.z_min = std::min(a, b);
  t.z_max = std::max(a, b);
  return t;
}

/// 3.3: the pixels of a viewport.
PixelRect viewport_rect(const ViewportTransform& viewport) {
  const auto first = [](float offset) { return static_cast<int>(offset + 0.499f); };
  const auto last = [](float offset, float half) { return static_cast<int>(half * 2.0f + offset - 0.501f); };
  const float half = std::fabs(viewport.sy), x = viewport.tx - viewport.sx, y = viewport.ty - half;
  return {first(x), first(y), last(x, viewport.sx), last(y, half)};
}

}  // namespace

void plan_viewports(PipelinePlan& plan, const PassDesc& pass) {
  PixelRect framebuffer = pixel_rect(pass.render_area);
  framebuffer.x0 = framebuffer.y0 = 0;  // 3.3: the render area's offset does not clip
  const std::uint32_t count = std::clamp<std::uint32_t>(plan.state->viewport_count, 1, kMaxViewports);
  for (std::uint32_t i = 0; i < kMaxViewports; ++i) {
    const std::uint32_t source = i < count ? i : 0;
    plan.viewport[i] = viewport_transform(plan.state->viewport[source], plan.state->negative_one_to_one);
    plan.region[i] = intersect(framebuffer, pixel_rect(plan.state->scissor[source]));
  }
  plan.wide_region = intersect(plan.region[0], viewport_rect(plan.viewport[0]));
  if (plan.guard_band || base::as_reference(Deviation::kViewportScissor)) plan.region[0] = plan.wide_region;
  plan.discards = plan.state->discard_count != 0;
  plan.per_vertex_viewport = plan.out.viewport_index != kNoReg;
  plan.fused_transform = !plan.stages.any();
}

}  // namespace vitrine::raster
