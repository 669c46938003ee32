// From VkGraphicsPipelineCreateInfo to raster::State (Vulkan 1.3.239, Pipelines: Graphics Pipelines, and the chapters
// of fixed function it refers to).
#include <algorithm>

#include "icd/pipeline.h"
#include "icd/render_pass.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

std::uint32_t dynamic_bit(VkDynamicState state) {
  switch (state) {
    case VK_DYNAMIC_STATE_VIEWPORT:
      return kDynamicViewport;
    case VK_DYNAMIC_STATE_SCISSOR:
      return kDynamicScissor;
    case VK_DYNAMIC_STATE_LINE_WIDTH:
      return kDynamicLineWidth;
    case VK_DYNAMIC_STATE_DEPTH_BIAS:
      return kDynamicDepthBias;
    case VK_DYNAMIC_STATE_BLEND_CONSTANTS:
      return kDynamicBlendConstants;
    case VK_DYNAMIC_STATE_DEPTH_BOUNDS:
      return kDynamicDepthBounds;
    case VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK:
      return kDynamicStencilCompareMask;
    case VK_DYNAMIC_STATE_STENCIL_WRITE_MASK:
      return kDynamicStencilWriteMask;
    case VK_DYNAMIC_STATE_STENCIL_REFERENCE:
      return kDynamicStencilReference;
    default:
      return 0;
  }
}

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

/// What is dynamic is ignored here, and may be a dangling pointer.
void fill_viewports(raster::State& state, const VkPipelineViewportStateCreateInfo& info, std::uint32_t dynamic) {
  state.viewport_count = std::min(info.viewportCount, raster::kMaxViewports);
  const std::uint32_t scissors = std::min(info.scissorCount, raster::kMaxViewports);
  if (!(dynamic & kDynamicViewport)) std::copy_n(info.pViewports, state.viewport_count, state.viewport.begin());
  if (!(dynamic & kDynamicScissor)) std::copy_n(info.pScissors, scissors, state.scissor.begin());
  if (const auto* control = find_in_chain<VkPipelineViewportDepthClipControlCreateInfoEXT>(info.pNext))
    state.negative_one_to_one = control->negativeOneToOne;
}

void fill_rasterization(raster::State& state, const VkPipelineRasterizationStateCreateInfo& info) {
  state.rasterizer_discard = info.rasterizerDiscardEnable;
  state.depth_clamp = info.depthClampEnable;
  const auto* clip = find_in_chain<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(info.pNext);
  state.depth_clip = clip ? clip->depthClipEnable : !info.depthClampEnable;
  state.polygon_mode = info.polygonMode;
  state.cull_mode = info.cullMode;
  state.front_face = info.frontFace;
  state.depth_bias = info.depthBiasEnable;
  state.depth_bias_constant = info.depthBiasConstantFactor;
  state.depth_bias_clamp = info.depthBiasClamp;
  state.depth_bias_slope = info.depthBiasSlopeFactor;
  state.line_width = info.lineWidth;
  if (const auto* vertex = find_in_chain<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(info.pNext))
    state.provoking_vertex_last = vertex->provokingVertexMode == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
  if (const auto* line = find_in_chain<VkPipelineRasterizationLineStateCreateInfoEXT>(info.pNext)) {
    state.line_mode = line->lineRasterizationMode;
    state.line_stipple = line->stippledLineEnable;
    state.line_stipple_factor = line->lineStippleFactor;
    state.line_stipple_pattern = line->lineStipplePattern;
  }
}

void fill_multisample(raster::State& state, const VkPipelineMultisampleStateCreateInfo& info) {
  state.samples = static_cast<std::uint32_t>(info.rasterizationSamples);
  state.sample_shading = info.sampleShadingEnable;
  state.min_sample_shading = info.minSampleShading;
  state.sample_mask = info.pSampleMask ? info.pSampleMask[0] : ~0u;
  state.alpha_to_coverage = info.alphaToCoverageEnable;
  state.alpha_to_one = info.alphaToOneEnable;
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
  state.depth_test = info.depthTestEnable;
  state.depth_write = info.depthTestEnable && info.depthWriteEnable;
  state.depth_compare = info.depthCompareOp;
  state.depth_bounds_test = info.depthBoundsTestEnable;
  state.min_depth_bounds = info.minDepthBounds;
  state.max_depth_bounds = info.maxDepthBounds;
  state.stencil_test = info.stencilTestEnable;
  state.front = stencil_face(info.front);
  state.back = stencil_face(info.back);
}

void fill_blend(raster::State& state, const VkPipelineColorBlendStateCreateInfo& info) {
  state.logic_op_enable = info.logicOpEnable;
  state.logic_op = info.logicOp;
  std::copy_n(info.blendConstants, 4, state.blend_constants.begin());
  for (std::uint32_t i = 0; i < std::min(info.attachmentCount, raster::kMaxColorAttachments); ++i) {
    const VkPipelineColorBlendAttachmentState& a = info.pAttachments[i];
    state.blend[i] = {a.blendEnable != VK_FALSE, a.srcColorBlendFactor, a.dstColorBlendFactor, a.srcAlphaBlendFactor,
                      a.dstAlphaBlendFactor,     a.colorBlendOp,        a.alphaBlendOp,        a.colorWriteMask};
  }
}

bool has_color(const Subpass& subpass) {
  return std::any_of(subpass.colors.begin(), subpass.colors.end(),
                     [](std::uint32_t a) { return a != VK_ATTACHMENT_UNUSED; });
}

}  // namespace

void fill_static_state(Pipeline& pipeline, const VkGraphicsPipelineCreateInfo& info, const Subpass& subpass) {
  raster::State& state = pipeline.state;
  if (info.pDynamicState) {
    for (std::uint32_t i = 0; i < info.pDynamicState->dynamicStateCount; ++i) {
      pipeline.dynamic |= dynamic_bit(info.pDynamicState->pDynamicStates[i]);
    }
  }
  fill_vertex_input(pipeline, *info.pVertexInputState);
  state.topology = info.pInputAssemblyState->topology;
  state.primitive_restart = info.pInputAssemblyState->primitiveRestartEnable;
  fill_rasterization(state, *info.pRasterizationState);
  // Without rasterization, or without the attachments, the rest may be dangling pointers.
  if (state.rasterizer_discard) return;
  fill_viewports(state, *info.pViewportState, pipeline.dynamic);
  fill_multisample(state, *info.pMultisampleState);
  if (subpass.depth_stencil != VK_ATTACHMENT_UNUSED) fill_depth_stencil(state, *info.pDepthStencilState);
  if (has_color(subpass)) fill_blend(state, *info.pColorBlendState);
}

}  // namespace vitrine::icd
