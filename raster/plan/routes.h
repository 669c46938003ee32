// Which ways through the back end a draw may take (docs/raster.md).
#pragma once

#include "raster/plan.h"

namespace vitrine::raster {

/// Small windows, rows of depth, hidden blocks, shading of whole blocks. Wants all else that is planned. `general`:
/// none of them, for tests. `observed`: all but windows.
void plan_routes(PipelinePlan& plan, bool general, bool observed);

}  // namespace vitrine::raster
