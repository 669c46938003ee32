// The discard rectangles test (Vulkan 1.3.239, Fragment Operations: Discard Rectangles Test).
#pragma once

#include "raster/plan.h"

namespace vitrine::raster {

/// The pixels of the block at (x, y) that the test leaves, in quad order; of a draw that has rectangles.
base::LaneMask undiscarded_lanes(const PipelinePlan& plan, int x, int y);

}  // namespace vitrine::raster
