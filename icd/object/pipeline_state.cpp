// From VkGraphicsPipelineCreateInfo to raster::State (Vulkan 1.3.239, Pipelines: Graphics Pipelines, and the chapters
// of fixed function it refers to).
#include <algorithm>

#include "icd/edge/util.h"
#include "icd/object/pipeline.h"
#include "icd/object/render_pass.h"

namespace vitrine::icd {
namespace {

void fill_vertex_input(Pipeline& pipeline, const VkPipelineVertexInputStateCreateInfo& info) {
  for (std::uint32_t i = 0; i < info.vertexBindingDescriptionCount; ++i) {
    const VkVertexInputBindingDescription& b = info.pVertexBindingDescriptions[i];
    if (b.binding >= raster::kMaxVertexBindings) continue;
    pipeline.streams[b.binding] = {b.stride, 1, b.inputRate == VK_VERTEX_INPUT_RATE_INSTANCE, true};
  }
  if (const auto* divisors = find_in_chain<VkPipelineVertexInputDivisorStateCreateInfoEXT>(info.pNext)) {
    for (std::uint32_t i = 0; i < divisors->vertexBindingDivisorCount; ++i) {
      const VkVertexInputBindingDivisorDescriptionEXT& d = divisors->pVertexBindingDivisors[i];
      if (d.binding < raster::kMaxVertexBindings) pipeline.streams[d.binding].divisor = d.divisor;
    }
  }
  raster::State& state = pipeline.state;
  state.attribute_count = std::min(info.vertexAttributeDescriptionCount, raster::kMaxVertexAttributes);
  for (std::uint32_t i = 0; i < state.attribute_count; ++i) {
    const VkVertexInputAttributeDescription& a = info.pVertexAttributeDescriptions[i];
    state.attribute[i] = {a.location, a.binding, a.format, a.offset};
  }
}

bool tessellates(const VkGraphicsPipelineCreateInfo& info) {
  return std::any_of(info.pStages, info.pStages + info.stageCount, [](const VkPipelineShaderStageCreateInfo& stage) {
    return stage.stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
  });
}

void fill_tessellation(raster::State& state, const VkPipelineTessellationStateCreateInfo& info) {
  state.patch_control_points = info.patchControlPoints;
  if (const auto* origin = find_in_chain<VkPipelineTessellationDomainOriginStateCreateInfo>(info.pNext))
    state.domain_origin_lower_left = origin->domainOrigin == VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
}

/// What is dynamic is ignored here, and may be a dangling pointer.
void fill_viewports(raster::State& state, const VkPipelineViewportStateCreateInfo& info, const DynamicStates& dynamic) {
  state.viewport_count = std::min(info.viewportCount, raster::kMaxViewports);
  const std::uint32_t scissors = std::min(info.scissorCount, raster::kMaxViewports);
  if (!dynamic.test(DynamicState::kViewport) && !dynamic.test(DynamicState::kViewportCount)) {
    std::copy_n(info.pViewports, state.viewport_count, state.viewport.begin());
  }
  if (!dynamic.test(DynamicState::kScissor) && !dynamic.test(DynamicState::kScissorCount)) {
    std::copy_n(info.pScissors, scissors, state.scissor.begin());
  }
  if (const auto* control = find_in_chain<VkPipelineViewportDepthClipControlCreateInfoEXT>(info.pNext)) {
    state.negative_one_to_one = control->negativeOneToOne;
  }
}

/// The rectangles may be dynamic, and a null pointer then.
/// Without the structure all rectangles count if commands set them and switch them on.
void fill_discard_rectangles(Pipeline& pipeline, const VkGraphicsPipelineCreateInfo& info) {
  raster::State& state = pipeline.state;
  const bool dynamic = pipeline.dynamic.test(DynamicState::kDiscardRectangle);
  if (const auto* discard = find_in_chain<VkPipelineDiscardRectangleStateCreateInfoEXT>(info.pNext)) {
    state.discard_count = std::min(discard->discardRectangleCount, raster::kMaxDiscardRectangles);
    state.discard_inside = discard->discardRectangleMode == VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT;
    if (!dynamic) std::copy_n(discard->pDiscardRectangles, state.discard_count, state.discard.begin());
    return;
  }
#if VK_EXT_DISCARD_RECTANGLES_SPEC_VERSION >= 2
  if (dynamic && pipeline.dynamic.test(DynamicState::kDiscardRectangleEnable))
    state.discard_count = raster::kMaxDiscardRectangles;
#endif
}

void fill_lines(raster::State& state, const VkPipelineRasterizationLineStateCreateInfoEXT& info) {
  state.line_mode = info.lineRasterizationMode;
  state.line_stipple = info.stippledLineEnable;
  state.line_stipple_factor = info.lineStippleFactor;
  state.line_stipple_pattern = info.lineStipplePattern;
}

void fill_rasterization(Pipeline& pipeline, const VkPipelineRasterizationStateCreateInfo& info) {
  raster::State& state = pipeline.state;
  state.rasterizer_discard = info.rasterizerDiscardEnable;
  state.depth_clamp = info.depthClampEnable;
  state.depth_clip = !info.depthClampEnable;
  if (const auto* clip = find_in_chain<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(info.pNext)) {
    state.depth_clip = clip->depthClipEnable;
    pipeline.clip_follows_clamp = false;
  }
  if (pipeline.dynamic.test(DynamicState::kDepthClipEnable)) pipeline.clip_follows_clamp = false;
  if (const auto* mode = find_in_chain<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(info.pNext)) {
    state.provoking_vertex_last = mode->provokingVertexMode == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
  }
  if (const auto* stream = find_in_chain<VkPipelineRasterizationStateStreamCreateInfoEXT>(info.pNext)) {
    state.rasterized_stream = stream->rasterizationStream;
  }
  if (const auto* conservative = find_in_chain<VkPipelineRasterizationConservativeStateCreateInfoEXT>(info.pNext)) {
    state.overestimates =
        conservative->conservativeRasterizationMode == VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
  }
  if (const auto* lines = find_in_chain<VkPipelineRasterizationLineStateCreateInfoEXT>(info.pNext)) {
    fill_lines(state, *lines);
  }
  state.polygon_mode = info.polygonMode;
  state.cull_mode = info.cullMode;
  state.front_face = info.frontFace;
  state.depth_bias = info.depthBiasEnable;
  state.depth_bias_constant = info.depthBiasConstantFactor;
  state.depth_bias_clamp = info.depthBiasClamp;
  state.depth_bias_slope = info.depthBiasSlopeFactor;
  state.depth_bias_unit = depth_bias_unit(info.pNext);
  state.line_width = info.lineWidth;
}

void fill_multisample(Pipeline& pipeline, const VkPipelineMultisampleStateCreateInfo& info) {
  raster::State& state = pipeline.state;
  state.samples = static_cast<std::uint32_t>(info.rasterizationSamples);
  state.sample_shading = info.sampleShadingEnable;
  state.min_sample_shading = info.minSampleShading;
  state.sample_mask = info.pSampleMask ? info.pSampleMask[0] : ~0u;
  state.alpha_to_coverage = info.alphaToCoverageEnable;
  state.alpha_to_one = info.alphaToOneEnable;
  if (const auto* custom = find_in_chain<VkPipelineSampleLocationsStateCreateInfoEXT>(info.pNext)) {
    state.custom_locations = custom->sampleLocationsEnable;
    const bool needed = custom->sampleLocationsEnable || pipeline.dynamic.test(DynamicState::kSampleLocationsEnable);
    if (needed && !pipeline.dynamic.test(DynamicState::kSampleLocations)) {
      state.locations = sample_locations(custom->sampleLocationsInfo);
    }
  }
}

raster::StencilFace stencil_face(const VkStencilOpState& s) {
  return {s.failOp,
          s.passOp,
          s.depthFailOp,
          s.compareOp,
          static_cast<std::uint8_t>(s.compareMask),
          static_cast<std::uint8_t>(s.writeMask),
          static_cast<std::uint8_t>(s.reference)};
}

void fill_depth_stencil(raster::State& state, const VkPipelineDepthStencilStateCreateInfo& info) {
  constexpr VkPipelineDepthStencilStateCreateFlags kOrdered =
      VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
      VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
  if (info.flags & kOrdered) state.ordered_attachment_access = true;
  state.depth_test = info.depthTestEnable;
  state.depth_write = info.depthWriteEnable;
  state.depth_compare = info.depthCompareOp;
  state.depth_bounds_test = info.depthBoundsTestEnable;
  state.min_depth_bounds = info.minDepthBounds;
  state.max_depth_bounds = info.maxDepthBounds;
  state.stencil_test = info.stencilTestEnable;
  state.front = stencil_face(info.front);
  state.back = stencil_face(info.back);
}

void fill_blend(Pipeline& pipeline, const VkPipelineColorBlendStateCreateInfo& info) {
  raster::State& state = pipeline.state;
  if (info.flags & VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT) {
    state.ordered_attachment_access = true;
  }
  state.logic_op_enable = info.logicOpEnable;
  state.logic_op = info.logicOp;
  std::copy_n(info.blendConstants, 4, state.blend_constants.begin());
  if (const auto* writes = find_in_chain<VkPipelineColorWriteCreateInfoEXT>(info.pNext)) {
    for (std::uint32_t i = 0; i < std::min(writes->attachmentCount, raster::kMaxColorAttachments); ++i) {
      if (!writes->pColorWriteEnables[i]) pipeline.color_writes &= ~(1u << i);
    }
  }
  // Null where all of it is dynamic.
  for (std::uint32_t i = 0; info.pAttachments && i < std::min(info.attachmentCount, raster::kMaxColorAttachments);
       ++i) {
    const VkPipelineColorBlendAttachmentState& a = info.pAttachments[i];
    state.blend[i] = {.enable = a.blendEnable != VK_FALSE,
                      .src_color = a.srcColorBlendFactor,
                      .dst_color = a.dstColorBlendFactor,
                      .src_alpha = a.srcAlphaBlendFactor,
                      .dst_alpha = a.dstAlphaBlendFactor,
                      .color_op = a.colorBlendOp,
                      .alpha_op = a.alphaBlendOp,
                      .write_mask = a.colorWriteMask};
  }
  if (const auto* advanced = find_in_chain<VkPipelineColorBlendAdvancedStateCreateInfoEXT>(info.pNext)) {
    for (raster::BlendAttachment& blend : state.blend) {
      blend.src_premultiplied = advanced->srcPremultiplied;
      blend.dst_premultiplied = advanced->dstPremultiplied;
      blend.overlap = advanced->blendOverlap;
    }
  }
}

/// States that the info leaves to commands, of these parts: of others it has no say.
DynamicStates dynamic_states(const VkPipelineDynamicStateCreateInfo* info, VkGraphicsPipelineLibraryFlagsEXT parts) {
  DynamicStates states;
  for (std::uint32_t i = 0; info && i < info->dynamicStateCount; ++i) {
    const DynamicState state = dynamic_state_of(info->pDynamicStates[i]);
    if (state != DynamicState::kCount && (part_of(state) & parts)) states.set(state);
  }
  return states;
}

/// Whether pDepthStencilState counts: only the output part knows the attachments of dynamic rendering.
bool has_depth_stencil(const VkGraphicsPipelineCreateInfo& info, const Subpass& subpass,
                       VkGraphicsPipelineLibraryFlagsEXT parts) {
  if (!info.pDepthStencilState) return false;
  const bool knows = info.renderPass || (parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT);
  return !knows || subpass.depth_stencil != VK_ATTACHMENT_UNUSED;
}

std::uint32_t live_colors(const Subpass& subpass) {
  std::uint32_t live = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(subpass.colors.size(), raster::kMaxColorAttachments); ++i) {
    if (subpass.colors[i] != VK_ATTACHMENT_UNUSED) live |= 1u << i;
  }
  return live;
}

}  // namespace

raster::DepthBiasUnit depth_bias_unit([[maybe_unused]] const void* chain) {
  using Unit = raster::DepthBiasUnit;
#ifdef VK_EXT_depth_bias_control
  if (const auto* how = find_in_chain<VkDepthBiasRepresentationInfoEXT>(chain)) {
    if (how->depthBiasRepresentation == VK_DEPTH_BIAS_REPRESENTATION_FLOAT_EXT) return Unit::kOne;
    const bool unorm =
        how->depthBiasRepresentation == VK_DEPTH_BIAS_REPRESENTATION_LEAST_REPRESENTABLE_VALUE_FORCE_UNORM_EXT;
    if (unorm) return how->depthBiasExact ? Unit::kExactUnorm : Unit::kUnorm;
    if (how->depthBiasExact) return Unit::kExactFormat;
  }
#endif
  return Unit::kFormat;
}

void fill_static_state(Pipeline& pipeline, const VkGraphicsPipelineCreateInfo& info, const Subpass& subpass,
                       VkGraphicsPipelineLibraryFlagsEXT parts) {
  raster::State& state = pipeline.state;
  pipeline.parts |= parts;
  pipeline.dynamic |= dynamic_states(info.pDynamicState, parts);
  // Structures may be missing whose members are all dynamic.
  if (parts & VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT) {
    if (!pipeline.dynamic.test(DynamicState::kVertexInput)) fill_vertex_input(pipeline, *info.pVertexInputState);
    if (const VkPipelineInputAssemblyStateCreateInfo* assembly = info.pInputAssemblyState) {
      state.topology = assembly->topology;
      state.primitive_restart = assembly->primitiveRestartEnable;
    }
  }
  const bool before = parts & VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT;
  if (before && info.pRasterizationState) fill_rasterization(pipeline, *info.pRasterizationState);
  // Without such a stage the pointer may dangle.
  if (before && tessellates(info) && info.pTessellationState) fill_tessellation(state, *info.pTessellationState);
  // Without rasterization, or without the attachments, the rest may be dangling pointers.
  if (pipeline.never_rasterizes()) return;
  if (before) fill_discard_rectangles(pipeline, info);
  if (before && info.pViewportState) fill_viewports(state, *info.pViewportState, pipeline.dynamic);
  const bool shader = parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT;
  // Both parts have it, and agree on it.
  if (const auto* rate = find_in_chain<VkPipelineFragmentShadingRateStateCreateInfoKHR>(info.pNext); rate && shader) {
    state.fragment_size = rate->fragmentSize;
    state.rate_combiners = {rate->combinerOps[0], rate->combinerOps[1]};
  }
  const bool output = parts & VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;
  if ((shader || output) && info.pMultisampleState) fill_multisample(pipeline, *info.pMultisampleState);
  if (shader && has_depth_stencil(info, subpass, parts)) fill_depth_stencil(state, *info.pDepthStencilState);
  if (!output) return;
  pipeline.live_colors = live_colors(subpass);
  if (!info.renderPass) {
    pipeline.locations = color_locations(info.pNext);
    const auto* rendering = find_in_chain<VkPipelineRenderingCreateInfo>(info.pNext);
    pipeline.has_depth = rendering && rendering->depthAttachmentFormat != VK_FORMAT_UNDEFINED;
    pipeline.has_stencil = rendering && rendering->stencilAttachmentFormat != VK_FORMAT_UNDEFINED;
  }
  if (pipeline.live_colors && info.pColorBlendState) fill_blend(pipeline, *info.pColorBlendState);
}

void leave_unnamed(const Pipeline& pipeline, ColorWrites writes, raster::State& state) {
  apply_color_writes(state, writes & pipeline.live_colors);
  if (!pipeline.has_depth) state.depth_test = state.depth_write = state.depth_bounds_test = false;
  if (!pipeline.has_stencil) state.stencil_test = false;
}

}  // namespace vitrine::icd
