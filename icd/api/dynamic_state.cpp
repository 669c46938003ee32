// Recording dynamic state (Vulkan 1.3.239, Pipelines: Dynamic State, and the commands of the fixed-function chapters).
#include <algorithm>
#include <bit>

#include "icd/entry_points.h"
#include "icd/object/pipeline.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

/// Calls fill(index in the application's array, attachment) for every attachment of the command.
template <class Fill>
void record_blend(VkCommandBuffer buffer, DynamicState which, std::uint32_t first, std::uint32_t count, Fill fill) {
  const auto attachments = from_handle<CommandBuffer>(buffer).arena.add_array<raster::BlendAttachment>(count);
  for (std::uint32_t i = 0; i < count; ++i) fill(i, attachments[i]);
  record(buffer, CmdSetBlend{which, first, attachments});
}

template <class T>
void record_value(VkCommandBuffer buffer, DynamicState which, T value) {
  if constexpr (std::is_same_v<T, float>) {
    record(buffer, CmdSetValue{which, std::bit_cast<std::uint32_t>(value)});
  } else {
    record(buffer, CmdSetValue{which, static_cast<std::uint32_t>(value)});
  }
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdSetViewport(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                          const VkViewport* viewports) {
  record(buffer, icd::CmdSetViewport{first, copy_array(buffer, viewports, count), false});
}

VKAPI_ATTR void VKAPI_CALL CmdSetScissor(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                         const VkRect2D* scissors) {
  record(buffer, icd::CmdSetScissor{first, copy_array(buffer, scissors, count)});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDiscardRectangleEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                     const VkRect2D* rectangles) {
  record(buffer, icd::CmdSetDiscardRectangle{first, copy_array(buffer, rectangles, count)});
}

#if VK_EXT_DISCARD_RECTANGLES_SPEC_VERSION >= 2
/// As many as the pipeline has (resolve_state()).
VKAPI_ATTR void VKAPI_CALL CmdSetDiscardRectangleEnableEXT(VkCommandBuffer buffer, VkBool32 enable) {
  record_value(buffer, DynamicState::kDiscardRectangleEnable, enable ? raster::kMaxDiscardRectangles : 0);
}

VKAPI_ATTR void VKAPI_CALL CmdSetDiscardRectangleModeEXT(VkCommandBuffer buffer, VkDiscardRectangleModeEXT mode) {
  record_value(buffer, DynamicState::kDiscardRectangleMode, mode == VK_DISCARD_RECTANGLE_MODE_EXCLUSIVE_EXT);
}
#endif

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBias(VkCommandBuffer buffer, float constant, float clamp, float slope) {
  record(buffer, icd::CmdSetDepthBias{constant, clamp, slope, raster::DepthBiasUnit::kFormat});
}

#ifdef VK_EXT_depth_bias_control
VKAPI_ATTR void VKAPI_CALL CmdSetDepthBias2EXT(VkCommandBuffer buffer, const VkDepthBiasInfoEXT* info) {
  record(buffer, icd::CmdSetDepthBias{info->depthBiasConstantFactor, info->depthBiasClamp, info->depthBiasSlopeFactor,
                                      depth_bias_unit(info->pNext)});
}
#endif

VKAPI_ATTR void VKAPI_CALL CmdSetFragmentShadingRateKHR(VkCommandBuffer buffer, const VkExtent2D* size,
                                                        const VkFragmentShadingRateCombinerOpKHR combiners[2]) {
  record(buffer, icd::CmdSetFragmentShadingRate{*size, {combiners[0], combiners[1]}});
}

#ifdef VK_EXT_attachment_feedback_loop_dynamic_state
/// Shaders see what is in memory, whether it is an attachment or not.
VKAPI_ATTR void VKAPI_CALL CmdSetAttachmentFeedbackLoopEnableEXT(VkCommandBuffer, VkImageAspectFlags) {}
#endif

VKAPI_ATTR void VKAPI_CALL CmdSetBlendConstants(VkCommandBuffer buffer, const float constants[4]) {
  record(buffer, icd::CmdSetBlendConstants{{constants[0], constants[1], constants[2], constants[3]}});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBounds(VkCommandBuffer buffer, float min, float max) {
  record(buffer, icd::CmdSetDepthBounds{min, max});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilCompareMask(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                    std::uint32_t mask) {
  record(buffer, icd::CmdSetStencil{&raster::StencilFace::compare_mask, faces, mask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilWriteMask(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                  std::uint32_t mask) {
  record(buffer, icd::CmdSetStencil{&raster::StencilFace::write_mask, faces, mask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilReference(VkCommandBuffer buffer, VkStencilFaceFlags faces,
                                                  std::uint32_t reference) {
  record(buffer, icd::CmdSetStencil{&raster::StencilFace::reference, faces, reference});
}

VKAPI_ATTR void VKAPI_CALL CmdSetViewportWithCount(VkCommandBuffer buffer, std::uint32_t count,
                                                   const VkViewport* viewports) {
  record(buffer, icd::CmdSetViewport{0, copy_array(buffer, viewports, count), true});
}

VKAPI_ATTR void VKAPI_CALL CmdSetScissorWithCount(VkCommandBuffer buffer, std::uint32_t count,
                                                  const VkRect2D* scissors) {
  CmdSetScissor(buffer, 0, count, scissors);
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilOp(VkCommandBuffer buffer, VkStencilFaceFlags faces, VkStencilOp fail,
                                           VkStencilOp pass, VkStencilOp depth_fail, VkCompareOp compare) {
  record(buffer, icd::CmdSetStencilOp{faces, fail, pass, depth_fail, compare});
}

VKAPI_ATTR void VKAPI_CALL CmdSetSampleLocationsEXT(VkCommandBuffer buffer, const VkSampleLocationsInfoEXT* info) {
  record(buffer, icd::CmdSetSampleLocations{sample_locations(*info)});
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineStippleEXT(VkCommandBuffer buffer, std::uint32_t factor, std::uint16_t pattern) {
  record(buffer, icd::CmdSetLineStipple{factor, pattern});
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorWriteEnableEXT(VkCommandBuffer buffer, std::uint32_t count,
                                                     const VkBool32* enables) {
  ColorWrites writes = kAllColorWrites;
  for (std::uint32_t i = 0; i < std::min(count, raster::kMaxColorAttachments); ++i) {
    if (!enables[i]) writes &= ~(1u << i);
  }
  record(buffer, icd::CmdSetColorWriteEnable{writes});
}

VKAPI_ATTR void VKAPI_CALL CmdSetVertexInputEXT(VkCommandBuffer buffer, std::uint32_t binding_count,
                                                const VkVertexInputBindingDescription2EXT* bindings,
                                                std::uint32_t attribute_count,
                                                const VkVertexInputAttributeDescription2EXT* attributes) {
  record(buffer, icd::CmdSetVertexInput{copy_array(buffer, bindings, binding_count),
                                        copy_array(buffer, attributes, attribute_count)});
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorBlendEnableEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                     const VkBool32* enables) {
  record_blend(buffer, DynamicState::kBlendEnable, first, count,
               [&](std::uint32_t i, raster::BlendAttachment& out) { out.enable = enables[i] != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorBlendEquationEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                       const VkColorBlendEquationEXT* equations) {
  record_blend(buffer, DynamicState::kBlendEquation, first, count, [&](std::uint32_t i, raster::BlendAttachment& out) {
    const VkColorBlendEquationEXT& e = equations[i];
    out.src_color = e.srcColorBlendFactor;
    out.dst_color = e.dstColorBlendFactor;
    out.color_op = e.colorBlendOp;
    out.src_alpha = e.srcAlphaBlendFactor;
    out.dst_alpha = e.dstAlphaBlendFactor;
    out.alpha_op = e.alphaBlendOp;
  });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorBlendAdvancedEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                       const VkColorBlendAdvancedEXT* blends) {
  record_blend(buffer, DynamicState::kBlendAdvanced, first, count, [&](std::uint32_t i, raster::BlendAttachment& out) {
    const VkColorBlendAdvancedEXT& b = blends[i];
    out.color_op = out.alpha_op = b.advancedBlendOp;
    out.src_premultiplied = b.srcPremultiplied != VK_FALSE;
    out.dst_premultiplied = b.dstPremultiplied != VK_FALSE;
    out.overlap = b.blendOverlap;
    out.clamped = b.clampResults != VK_FALSE;
  });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorWriteMaskEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                   const VkColorComponentFlags* masks) {
  record_blend(buffer, DynamicState::kWriteMask, first, count,
               [&](std::uint32_t i, raster::BlendAttachment& out) { out.write_mask = masks[i]; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetSampleMaskEXT(VkCommandBuffer buffer, VkSampleCountFlagBits,
                                               const VkSampleMask* masks) {
  record_value(buffer, DynamicState::kSampleMask, masks[0]);
}

VKAPI_ATTR void VKAPI_CALL CmdSetProvokingVertexModeEXT(VkCommandBuffer buffer, VkProvokingVertexModeEXT mode) {
  record_value(buffer, DynamicState::kProvokingVertexMode, mode == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT);
}

VKAPI_ATTR void VKAPI_CALL CmdSetConservativeRasterizationModeEXT(VkCommandBuffer buffer,
                                                                  VkConservativeRasterizationModeEXT mode) {
  record_value(buffer, DynamicState::kConservativeRasterizationMode,
               mode == VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT);
}

/// No more than the limit maxExtraPrimitiveOverestimationSize, which is 0.
VKAPI_ATTR void VKAPI_CALL CmdSetExtraPrimitiveOverestimationSizeEXT(VkCommandBuffer, float) {}

// Commands whose argument is the word that CmdSetValue takes.

#define VITRINE_DYNAMIC_STATE(...)
#define VITRINE_DYNAMIC_VALUE(...)
#define VITRINE_DYNAMIC_COMMAND(name, vulkan, part, member, command, type) \
  VKAPI_ATTR void VKAPI_CALL command(VkCommandBuffer buffer, type value) { \
    record_value(buffer, DynamicState::k##name, value);                    \
  }
#include "icd/record/dynamic_state.def"

// Commands of VK_EXT_extended_dynamic_state3 and VK_EXT_shader_object whose features are not claimed: they have
// addresses, but no valid call.

VKAPI_ATTR void VKAPI_CALL CmdSetViewportWScalingEnableNV(VkCommandBuffer, VkBool32) {}
VKAPI_ATTR void VKAPI_CALL CmdSetViewportSwizzleNV(VkCommandBuffer, std::uint32_t, std::uint32_t,
                                                   const VkViewportSwizzleNV*) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageToColorEnableNV(VkCommandBuffer, VkBool32) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageToColorLocationNV(VkCommandBuffer, std::uint32_t) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageModulationModeNV(VkCommandBuffer, VkCoverageModulationModeNV) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageModulationTableEnableNV(VkCommandBuffer, VkBool32) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageModulationTableNV(VkCommandBuffer, std::uint32_t, const float*) {}
VKAPI_ATTR void VKAPI_CALL CmdSetShadingRateImageEnableNV(VkCommandBuffer, VkBool32) {}
VKAPI_ATTR void VKAPI_CALL CmdSetRepresentativeFragmentTestEnableNV(VkCommandBuffer, VkBool32) {}
VKAPI_ATTR void VKAPI_CALL CmdSetCoverageReductionModeNV(VkCommandBuffer, VkCoverageReductionModeNV) {}
#ifdef VK_EXT_depth_clamp_control
VKAPI_ATTR void VKAPI_CALL CmdSetDepthClampRangeEXT(VkCommandBuffer, VkDepthClampModeEXT, const VkDepthClampRangeEXT*) {
}
#endif

}  // namespace entry
}  // namespace vitrine::icd
