// The discard rectangles test of a block of pixels (Vulkan 1.3.239, Discard Rectangles Test).
#include "raster/tile/discard_rectangles.h"

#include "raster/pixel_order.h"
#include "raster/pixel_rect.h"

namespace vitrine::raster {

base::LaneMask undiscarded_lanes(const PipelinePlan& plan, int x, int y) {
  const State& state = *plan.state;
  base::LaneMask inside = 0;
  for (std::uint32_t i = 0; i < state.discard_count; ++i) {
    const PixelRect rect = intersect(pixel_rect(state.discard[i]), {0, 0, 1 << 20, 1 << 20});
    if (!rect.empty()) inside |= rect_lanes(rect.x0 - x, rect.y0 - y, rect.x1 - x, rect.y1 - y);
  }
  return state.discard_inside ? ~inside : inside;
}

}  // namespace vitrine::raster
