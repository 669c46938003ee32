// Fragment operations of a draw (Vulkan 1.3.239, Fragment Operations; The Framebuffer).
#include "raster/plan/fragment_operations.h"

#include <algorithm>
#include <cmath>

#include "base/as_reference.h"
#include "raster/output/color.h"
#include "raster/output/depth_compare.h"
#include "texel/format.h"

namespace vitrine::raster {
namespace {

using base::Deviation;

using spirv::ShaderInterface;

bool stencil_writes(const StencilFace& face) { return face.write_mask != 0; }

bool reads_at_centroid(const PipelinePlan& plan) {
  return std::any_of(plan.read.begin(), plan.read.begin() + plan.read_count,
                     [](const VaryingRead& read) { return read.location == spirv::SampleLocation::kCentroid; });
}

}  // namespace

void plan_rasterization(PipelinePlan& plan, const PassDesc& pass) {
  const State& state = *plan.state;
  plan.draws_points = plan.corners == 1;
  plan.draws_lines = plan.corners == 2;
  plan.samples = std::max<std::uint32_t>(pass.samples, 1);
  // Vulkan 1.3.239, VkGraphicsPipelineCreateInfo: without attachments the pipeline's sample count holds.
  const auto is_used = [](const texel::ImageView& view) { return view.format != nullptr; };
  const bool attached = is_used(pass.depth) || is_used(pass.stencil) ||
                        std::any_of(pass.color.begin(), pass.color.begin() + pass.color_count, is_used);
  if (!attached) plan.samples = std::clamp<std::uint32_t>(state.samples, 1, kMaxSamples);
  plan.raster_samples = plan.samples;
  const bool single = state.line_mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ||
                      state.line_mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
  if (plan.draws_lines && single) plan.raster_samples = 1;
  const bool custom = state.custom_locations && plan.raster_samples > 1 && state.locations.count == plan.raster_samples;
  plan.locations = custom ? &state.locations : &standard_locations(plan.raster_samples);
  plan.smooth_lines = state.line_mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT &&
                      plan.raster_samples == 1 &&
                      (plan.draws_lines || (state.polygon_mode == VK_POLYGON_MODE_LINE && !plan.draws_points));
  plan.overestimates =
      state.overestimates && !plan.draws_lines && !plan.draws_points && state.polygon_mode == VK_POLYGON_MODE_FILL;
  plan.pixel_offset = plan.raster_samples > 1 ? 0.0f : 0.5f;
  plan.sample_mask = state.sample_mask & ((1u << plan.samples) - 1);
  const bool wants = state.sample_shading && std::ceil(static_cast<float>(plan.samples) * state.min_sample_shading) > 1;
  plan.sample_shading = plan.raster_samples > 1 && plan.fragment && (wants || plan.fragment->per_sample);
  plan.depth_bias = state.depth_bias && (state.depth_bias_slope != 0 || state.depth_bias_constant != 0);
  const bool areas = !plan.draws_lines && !plan.draws_points;
  plan.bias_in_vertices = state.polygon_mode != VK_POLYGON_MODE_FILL && areas;
  if (areas && plan.depth_bias && base::as_reference(Deviation::kLineStateDepthBias))
    plan.bias_in_vertices |= state.line_stipple || state.line_mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
}

void plan_tests(PipelinePlan& plan, const PassDesc& pass) {
  const State& state = *plan.state;
  plan.tests.state = &state;
  plan.tests.depth = state.depth_test && pass.depth.format != nullptr;
  plan.tests.depth_write = plan.tests.depth && state.depth_write;
  plan.tests.depth_bounds = state.depth_bounds_test && pass.depth.format != nullptr;
  plan.tests.stencil = state.stencil_test && pass.stencil.format != nullptr;
  const ShaderInterface* fragment = plan.fragment;
  const texel::FormatDesc* depth_format = pass.depth.format;
  plan.clamps_depth = state.depth_clamp;
  plan.restricts_depth = !state.unrestricted_depth || depth_format == nullptr ||
                         depth_format->channel[0].numeric != texel::Numeric::kSfloat;
  // Numbers of fixed point stay in [0, 1] after the depth clamp, too.
  if (state.unrestricted_depth && plan.restricts_depth)
    for (ViewportTransform& viewport : plan.viewport) {
      viewport.z_min = std::clamp(viewport.z_min, 0.0f, 1.0f);
      viewport.z_max = std::clamp(viewport.z_max, 0.0f, 1.0f);
    }
  if (plan.smooth_lines && base::as_reference(Deviation::kSmoothLineDepthClamp)) {
    plan.clamps_depth = false;
    plan.restricts_depth = true;
  }
  plan.counts_early =
      fragment && fragment->early_fragment_tests && !base::as_reference(Deviation::kEarlySampleCounting);
  plan.may_kill = state.alpha_to_coverage || (fragment && (fragment->uses_discard || plan.frag.sample_mask != kNoReg));
  plan.depth_order = TestOrder::kNone;
  plan.early_reject = false;
  plan.in_order = fragment && fragment->writes_memory;
  if (!plan.tests.depth && !plan.tests.depth_bounds && !plan.tests.stencil) return;
  plan.depth_order = TestOrder::kEarly;
  if (!fragment || fragment->early_fragment_tests) return;
  if (state.ordered_attachment_access || fragment->reads_attachment) {
    plan.depth_order = TestOrder::kLate;  // the fragment may see the depth before its own
    return;
  }
  const bool replaces = plan.frag.depth != kNoReg || plan.frag.stencil != kNoReg;
  if (!replaces && !fragment->writes_memory && !plan.may_kill) return;
  plan.depth_order = TestOrder::kLate;
  const bool stencil_changes = plan.tests.stencil && (stencil_writes(state.front) || stencil_writes(state.back));
  if (replaces || fragment->writes_memory || stencil_changes) return;
  const bool sees_rejects = plan.raster_samples > 1 && reads_at_centroid(plan);
  plan.in_order |= sees_rejects;
  plan.early_reject = sees_rejects || (!plan.tests.stencil && !plan.tests.depth_bounds &&
                                       (has_limit(state.depth_compare) || !plan.tests.depth_write));
}

void plan_colors(PipelinePlan& plan, const PassDesc& pass, bool general) {
  plan.color_count = std::min(pass.color_count, kMaxColorAttachments);
  const ShaderInterface* fragment = plan.fragment;
  plan.replaces_colors = fragment && !plan.may_kill && !fragment->writes_memory && plan.color_count != 0 &&
                         plan.depth_order == TestOrder::kNone && plan.sample_mask == (1u << plan.samples) - 1 &&
                         !plan.discards;
  const auto& second = plan.frag.color_second;
  plan.dual_source = std::any_of(second.begin(), second.end(), [](std::uint32_t reg) { return reg != kNoReg; });
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    plan.writer[i] = {};
    if (!pass.color[i].format) continue;
    const auto& color = plan.frag.color[i];
    // Blending may have use for the second colour alone.
    const bool written = (i == 0 && plan.dual_source) ||
                         std::any_of(color.begin(), color.end(), [](std::uint32_t reg) { return reg != kNoReg; });
    const texel::FormatDesc* format = pass.color[i].format;
    if (!fragment || !written) {
      plan.replaces_colors = false;
      continue;
    }
    plan.writer[i] =
        (general ? make_general_color_writer : make_color_writer)(format->format, plan.state->blend[i], *plan.state);
    plan.replaces_colors &= plan.writer[i].function != nullptr && !plan.writer[i].reads_destination();
  }
  plan.shades = fragments_have_effects(plan);
}

bool fragments_have_effects(const PipelinePlan& plan) {
  const ShaderInterface* fragment = plan.fragment;
  if (!fragment) return false;
  const auto* const writers = plan.writer.data();
  return fragment->writes_memory || plan.may_kill || plan.frag.depth != kNoReg || plan.frag.stencil != kNoReg ||
         std::any_of(writers, writers + plan.color_count, [](const ColorWriter& w) { return w.function != nullptr; });
}

}  // namespace vitrine::raster
