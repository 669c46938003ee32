// What the fast ways leave to packed waves: whatever is rare and needs more than varyings and FragCoord.
#include "raster/plan/routes.h"

#include <algorithm>

#include "raster/output/depth_compare.h"

namespace vitrine::raster {
namespace {

/// Whether a varying is wanted elsewhere than at the centre, or its plane.
bool reads_elsewhere(const PipelinePlan& plan) {
  return std::any_of(plan.read.begin(), plan.read.begin() + plan.read_count, [&](const VaryingRead& read) {
    return read.part != spirv::InputPart::kValue ||
           (read.location != spirv::SampleLocation::kCenter && plan.raster_samples > 1);
  });
}

}  // namespace

void plan_routes(PipelinePlan& plan, bool general, bool observed) {
  plan.windows = !general && !observed && plan.samples == 1 && plan.raster_samples == 1 && plan.sample_mask != 0 &&
                 !plan.discards && !plan.overestimates && !plan.rates.any;
  const bool rare_tests = plan.tests.stencil || plan.tests.depth_bounds || plan.as_reference.first_sample_depth;
  plan.tests_rows = !general && !rare_tests;
  // Depths beyond [0, 1] wrap in formats of fixed point.
  const bool clamps_inside = std::all_of(plan.viewport.begin(), plan.viewport.end(),
                                         [](const ViewportTransform& t) { return t.z_min >= 0 && t.z_max <= 1; });
  plan.hides_blocks =
      plan.tests_rows && plan.tests.depth && (plan.depth_order == TestOrder::kEarly || plan.early_reject) &&
      has_limit(plan.state->depth_compare) && plan.restricts_depth && (!plan.clamps_depth || clamps_inside);
  const FragmentRegisters& frag = plan.frag;
  const bool rare_inputs = frag.point_coord[0] != kNoReg || frag.point_coord[1] != kNoReg || frag.sample_id != kNoReg ||
                           frag.sample_position[0] != kNoReg || frag.sample_position[1] != kNoReg ||
                           frag.sample_mask_in != kNoReg || frag.helper != kNoReg || frag.layer != kNoReg ||
                           frag.view_index != kNoReg || frag.shading_rate != kNoReg || plan.rates.any ||
                           reads_elsewhere(plan) || plan.as_reference.one_sample_masks ||
                           plan.as_reference.first_sample_depth;
  const bool rare_outputs = frag.depth != kNoReg || frag.stencil != kNoReg || frag.sample_mask != kNoReg ||
                            plan.smooth_lines || plan.dual_source || plan.state->alpha_to_coverage || plan.alpha_to_one;
  const bool late_stencil = (plan.tests.stencil || plan.tests.depth_bounds) && plan.depth_order == TestOrder::kLate;
  plan.shades_blocks =
      !general && plan.shades && !plan.sample_shading && !rare_inputs && !rare_outputs && !late_stencil;
}

}  // namespace vitrine::raster
