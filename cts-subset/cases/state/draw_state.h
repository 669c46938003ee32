// A random draw: what it draws to, its stages and its fixed-function state.
#pragma once

#include <string>
#include <vector>

#include "cases/state/stages.h"

namespace vitrine::cts {

/// What the draws of a case have in common.
struct Scene {
  TargetSpec target;
  bool multisampled = false, has_depth = false, has_stencil = false;
};

/// What one draw does, and structures that its pipeline points to.
struct DrawState {
  DrawState() = default;
  DrawState(const DrawState&) = delete;  ///< the structures point to each other
  Stages stages;
  GraphicsSpec spec;
  FragmentNeeds fragment;
  Drawn drawn = Drawn::kTriangles;  ///< after the polygon mode
  bool polygon = false;             ///< a polygon mode other than FILL has an effect
  bool clipped = false;             ///< vertices outside of the view volume
  uint32_t vertices = 0, instances = 1;
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT};
  VkPipelineRasterizationLineStateCreateInfoEXT line{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT};
  VkPipelineRasterizationDepthClipStateCreateInfoEXT clip{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT};
  VkPipelineViewportDepthClipControlCreateInfoEXT control{
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT};
  VkSampleMask sample_mask = ~0u;
};

/// Whether lines are drawn, and in this mode.
bool draws_lines_as(const DrawState& draw, VkLineRasterizationModeEXT mode);
bool smooth_lines(const DrawState& draw);
/// Bresenham and smooth lines are drawn with one sample for all (deviations.md, line-depth-first-sample and
/// one-sample-line-masks).
bool one_sample_lines(const Scene& scene, const DrawState& draw);

/// Takes out of a draw what deviations.md lists, and returns the rows. What is left must be identical on both devices.
std::vector<std::string> remove_listed(const Scene& scene, DrawState& draw);

}  // namespace vitrine::cts
