// Sample counts, order of tests and colour writers of a draw: what fixed function does to its fragments.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Sample counts and locations, kinds of lines, depth bias. Wants plan.stages.
void plan_rasterization(PipelinePlan& plan, const PassDesc& pass);

/// Which tests there are, and when they are done relative to shading (lavapipe-rasterization.md 5.2, 5.4). What ends
/// late there and could be tested early without being seen is rejected early and decided late here. Wants plan.frag.
void plan_tests(PipelinePlan& plan, const PassDesc& pass);

/// How colours reach the attachments, and whether the fragment shader need run. `general`: without the fast functions.
void plan_colors(PipelinePlan& plan, const PassDesc& pass, bool general);

/// Whether what fragments compute reaches anything: only observers see the others run.
bool fragments_have_effects(const PipelinePlan& plan);

}  // namespace vitrine::raster
