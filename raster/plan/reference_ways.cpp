// Rows of deviations.md that VITRINE_AS_REFERENCE asks for (base/as_reference.h), as far as they concern a draw.
#include "raster/plan/reference_ways.h"

#include <algorithm>

#include "base/as_reference.h"
#include "raster/plan/rectangles.h"

namespace vitrine::raster {
namespace {

using base::as_reference;
using base::Deviation;

bool reads_primitive_id(const spirv::ShaderInterface* shader) {
  return shader && std::any_of(shader->inputs.begin(), shader->inputs.end(), [](const spirv::InterfaceSlot& slot) {
           return slot.built_in == spirv::BuiltIn::kPrimitiveId;
         });
}

/// The clip-space position is taken for the window's: "(-1, -1, 2, 2) with depth 0..1" moves and scales nothing.
bool is_identity(const State& state) {
  const VkViewport& v = state.viewport[0];
  return state.viewport_count == 1 && v.x == -1 && v.y == -1 && v.width == 2 && v.height == 2 && v.minDepth == 0 &&
         v.maxDepth == 1 && !state.negative_one_to_one;
}

void plan_stages_ways(PipelinePlan& plan, const DrawCall& draw) {
  ReferenceWays& ways = plan.as_reference;
  if (!plan.stages.evaluation) return;
  ways.numbers_segments = as_reference(Deviation::kPatchNumbers);
  if (as_reference(Deviation::kTessellatedVertices)) ways.tessellated_mask = 0xffff;
  ways.evaluated_ids = as_reference(Deviation::kTessellationPrimitiveId) && !plan.stages.geometry &&
                       reads_primitive_id(plan.stages.evaluation);
  if (!ways.numbers_segments && ways.tessellated_mask == ~0u) return;
  ways.segment = segment_of(plan.shape, draw.index_data != nullptr);
  plan.chunk_positions = 1;  // a chunk for each
}

void plan_line_ways(PipelinePlan& plan) {
  ReferenceWays& ways = plan.as_reference;
  const State& state = *plan.state;
  const bool adjacent = state.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY;
  ways.flushes_flat = as_reference(Deviation::kStippleFlatIntegers);
  ways.stipples_lines =
      as_reference(Deviation::kStipplePerLine) && !plan.stages.any() && (adjacent || plan.frag.primitive_id != kNoReg);
  ways.outlines_face_front = as_reference(Deviation::kPolygonModeFacing) && plan.frag.front_facing == kNoReg;
  ways.smooth_outlines_face_front = as_reference(Deviation::kSmoothOutlineFacing);
  ways.scales_integers = as_reference(Deviation::kSmoothLineIntegers);
  const bool one_sample = plan.draws_lines && plan.raster_samples == 1 && plan.samples > 1;
  ways.one_sample_masks = one_sample && as_reference(Deviation::kOneSampleLineMasks);
  if (ways.one_sample_masks) plan.sample_mask = (1u << plan.samples) - 1;
  ways.first_sample_depth = one_sample && as_reference(Deviation::kLineDepthFirstSample);
  ways.needs_corner = plan.raster_samples > 1 && as_reference(Deviation::kMultisampleShortLines);
  if (plan.smooth_lines && as_reference(Deviation::kSmoothLineSampleMask)) plan.frag.sample_mask = kNoReg;
}

}  // namespace

void plan_reference_ways(PipelinePlan& plan, const DrawCall& draw, const PassDesc& pass) {
  ReferenceWays& ways = plan.as_reference;
  ways = {};
  const bool replaces = plan.frag.sample_mask != kNoReg || plan.frag.depth != kNoReg || plan.frag.stencil != kNoReg;
  plan.alpha_to_one = plan.state->alpha_to_one && !(replaces && as_reference(Deviation::kAlphaToOneBesideMask));
  if (base::asked_rows().rows == 0) return;
  // lavapipe-rasterization.md 8.2
  if (plan.samples == 1 && plan.state->sample_mask != 0 && as_reference(Deviation::kOneSampleMask))
    plan.sample_mask = 1;
  plan_stages_ways(plan, draw);
  plan_line_ways(plan);
  ways.keeps_outside_points = as_reference(Deviation::kPointClipping);
  if (as_reference(Deviation::kLargePoints)) ways.largest_point = 255;
  ways.divides = !(as_reference(Deviation::kIdentityViewport) && is_identity(*plan.state));
  ways.leaks_scissor = plan.raster_samples > 1 && as_reference(Deviation::kMultisampleScissor);
  ways.nine_vertices = as_reference(Deviation::kNineVertices) &&
                       plan.state->topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST && !plan.stages.any() &&
                       !plan.bias_in_vertices && plan.out.cull_count == 0 && !reads_flat(plan);
  ways.first_layer = as_reference(Deviation::kMultiviewLayers) && pass.view_mask != 0;
  ways.counts_segments =
      as_reference(Deviation::kLongStripVertices) && !plan.stages.evaluation && plan.shape.first > plan.shape.step;
  if ((ways.first_layer || ways.counts_segments) && ways.segment == 0)
    ways.segment = segment_of(plan.shape, draw.index_data != nullptr);
  if (ways.first_layer) plan.chunk_positions = 1;
}

}  // namespace vitrine::raster
