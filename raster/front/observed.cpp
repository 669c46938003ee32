// Bounds and coverage of whole primitives, one row of samples at a time (lavapipe-rasterization.md 3.2 and 3.3).
#include "raster/front/observed.h"

#include <algorithm>
#include <cstdlib>

#include "raster/front/setup.h"
#include "raster/front/window_coverage.h"

namespace vitrine::raster {
namespace {

/// Pixels of which a sample can be covered, as setup finds them, but cut to nothing.
PixelRect bounds_of(const PipelinePlan& plan, const Primitive& p) {
  const int first = plan.raster_samples > 1 ? 0 : 255;
  if (plan.overestimates && p.kind == PrimitiveKind::kTriangle) {
    const auto [left, right] = std::minmax({p.x[0], p.x[1], p.x[2]});
    const auto [top, bottom] = std::minmax({p.y[0], p.y[1], p.y[2]});
    return pixels_between(plan, left, top, right, bottom);
  }
  const int corners = p.kind == PrimitiveKind::kTriangle ? 3 : p.kind == PrimitiveKind::kLine ? 4 : 2;
  const auto [left, right] = std::minmax_element(p.x, p.x + corners);
  const auto [top, bottom] = std::minmax_element(p.y, p.y + corners);
  const int last = p.kind == PrimitiveKind::kLine ? 0 : 1;
  return {(*left + first) >> 8, (*top + first) >> 8, (*right - last) >> 8, (*bottom - last) >> 8};
}

/// The largest whole number that is not above n / d; d > 0.
std::int64_t floor_of(std::int64_t n, std::int64_t d) { return n >= 0 ? n / d : -((d - 1 - n) / d); }

/// Whether the primitive covers sample (sx, sy) of a pixel [x0, x1] of row y. An edge is inside where
/// f - a * x >= 0, f being its value at the row's first pixel (raster/tile/coverage.h).
bool covers_row(const PrimitiveEdges& edges, std::int64_t sx, std::int64_t sy, std::int64_t y, std::int64_t x0,
                std::int64_t x1) {
  for (std::uint32_t i = 0; i < edges.count; ++i) {
    const PrimitiveEdge& e = edges.edge[i];
    const std::int64_t f = ((e.c - 1 - e.a * sx + e.b * sy) >> 8) + e.b * y;
    if (e.a > 0)
      x1 = std::min(x1, floor_of(f, e.a));
    else if (e.a < 0)
      x0 = std::max(x0, -floor_of(f, -e.a));
    else if (f < 0)
      return false;
  }
  return x0 <= x1;
}

/// Whether a triangle's pixels are those of a window at their first ones, so that it can be covered at once.
bool fits_window(const PipelinePlan& plan, const Primitive& p, const PixelRect& rect) {
  constexpr std::int32_t kReach = 24 << 8;  // of corners, from the window
  if (plan.raster_samples != 1 || p.kind != PrimitiveKind::kTriangle || plan.overestimates || rect.empty())
    return false;
  const int x = rect.x0 & ~1, y = rect.y0 & ~1;
  if (rect.x1 - x >= kBlockSize || rect.y1 - y >= kBlockSize) return false;
  return std::all_of(p.x, p.x + 3, [&](std::int32_t at) { return std::abs(at - (x << 8)) <= kReach; }) &&
         std::all_of(p.y, p.y + 3, [&](std::int32_t at) { return std::abs(at - (y << 8)) <= kReach; });
}

/// Its window.
base::LaneMask window_of(const Primitive& p, const PixelRect& rect) {
  const int x = rect.x0 & ~1, y = rect.y0 & ~1;
  const bool small = rect.x1 - x < 4 && rect.y1 - y < 4;
  return cover_window(p.x, p.y, x, y, small) & rect_lanes(rect.x0 - x, rect.y0 - y, rect.x1 - x, rect.y1 - y);
}

bool covers_sample(const PipelinePlan& plan, const Primitive& p, const PixelRect& rect) {
  if (plan.overestimates) return !rect.empty();
  const PrimitiveEdges edges = edges_of(p);
  for (int y = rect.y0; y <= rect.y1; ++y)
    for (std::uint32_t s = 0; s < plan.raster_samples; ++s)
      if (covers_row(edges, plan.locations->x[s], plan.locations->y[s], y, rect.x0, rect.x1)) return true;
  return false;
}

}  // namespace

void finish_observed(const Chunk& chunk, const PassDesc& pass, PrimitiveList& primitives) {
  const PipelinePlan& plan = *chunk.draw->plan;
  PixelRect framebuffer = pixel_rect(pass.render_area);
  framebuffer.x0 = framebuffer.y0 = 0;
  auto mark = primitives.marks().begin();
  std::optional<std::uint32_t> instance;
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    Primitive& p = primitives[i];
    for (; mark != primitives.marks().end() && mark->first <= i; ++mark)
      instance = chunk.draw->instances->index_of(mark->instance);
    const PixelRect rect = intersect(bounds_of(plan, p), framebuffer);
    const bool small = fits_window(plan, p, rect);
    if (small) p.window = window_of(p, rect);
    const auto fate =
        (small ? p.window != 0 : covers_sample(plan, p, rect)) ? PrimitiveFate::kRasterized : PrimitiveFate::kNoSample;
    for (int triangle = p.kind == PrimitiveKind::kRectangle ? 2 : 1; triangle > 0; --triangle)
      chunk.watch->primitive(p.id, instance, fate);
    if (rect.empty()) continue;
    p.x0 = static_cast<std::uint16_t>(rect.x0);
    p.y0 = static_cast<std::uint16_t>(rect.y0);
    p.x1 = static_cast<std::uint16_t>(rect.x1);
    p.y1 = static_cast<std::uint16_t>(rect.y1);
  }
}

}  // namespace vitrine::raster
