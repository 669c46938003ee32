// A random draw: what it draws to, its stages and its fixed-function state.
#pragma once

#include <string>
#include <vector>

#include "cases/pipeline/state/stages.h"

namespace vitrine::cts {

/// What the draws of a case have in common.
struct Scene {
  TargetSpec target;
  bool multisampled = false, has_depth = false, has_stencil = false;
  bool unrestricted = false;       ///< the device has VK_EXT_depth_range_unrestricted
  bool dynamic_rendering = false;  ///< instead of a render pass object
  bool suspends = false;           ///< with dynamic rendering: every draw has a scope, which resumes the one before
  bool secondary = false;          ///< draws are recorded in a secondary command buffer
  bool resolves_depth = false;     ///< with dynamic rendering: depth and stencil have a resolve attachment

  bool attachmentless() const { return target.colors.empty() && !target.depth; }
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
  VkPipelineTessellationDomainOriginStateCreateInfo origin{
      VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO};
  std::vector<VkBool32> color_writes;
  VkPipelineColorWriteCreateInfoEXT color_write_info{VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT};
  VkSampleMask sample_mask = ~0u;
  float dynamic_share = 0;   ///< how much of the state is left to commands
  bool queried = false;      ///< counted by queries
  bool indirect = false;     ///< the command reads its parameters from a buffer
  bool conditional = false;  ///< by a predicate
  uint32_t predicate = 0;
  VkConditionalRenderingFlagsEXT predicate_flags = 0;
};

/// Whether lines are drawn, and in this mode.
bool draws_lines_as(const DrawState& draw, VkLineRasterizationModeEXT mode);
bool smooth_lines(const DrawState& draw);
/// Bresenham and smooth lines are drawn with one sample for all (deviations.md, line-depth-first-sample and
/// one-sample-line-masks).
bool one_sample_lines(const Scene& scene, const DrawState& draw);

/// The state in words.
std::string describe(const Scene& scene, const DrawState& draw);

/// Takes out of a draw what deviations.md lists, and returns the rows. What is left must be identical on both devices.
std::vector<std::string> remove_listed(const Scene& scene, DrawState& draw);

}  // namespace vitrine::cts
