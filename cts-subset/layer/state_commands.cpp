// See state_commands.h.
#include "state_commands.h"

#include <algorithm>

#ifdef VK_EXT_shader_object
namespace vitrine::as_shader_objects {
namespace {

/// The state of a pipeline as commands.
class States {
 public:
  States(const Functions* f, const VkGraphicsPipelineCreateInfo& info, std::vector<Set>& out)
      : f_(f), info_(info), out_(out) {}

  bool dynamic(VkDynamicState state) const {
    const VkPipelineDynamicStateCreateInfo* d = info_.pDynamicState;
    return d && std::find(d->pDynamicStates, d->pDynamicStates + d->dynamicStateCount, state) !=
                    d->pDynamicStates + d->dynamicStateCount;
  }

  /// Whether shader objects can have all of it.
  bool convertible() const {
    // Strides and viewports would be set anew where the pipeline is bound.
    if (dynamic(VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE) || dynamic(VK_DYNAMIC_STATE_VIEWPORT)) return false;
    const auto* raster = info_.pRasterizationState;
    if (!raster) return false;
    const bool clips =
        in_chain<void>(raster->pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT) ||
        dynamic(VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT);
    if (dynamic(VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT) && !clips) return false;
    if (dynamic(VK_DYNAMIC_STATE_DISCARD_RECTANGLE_EXT)) return false;
    if (discards()) return true;
    const auto* samples = info_.pMultisampleState;
    if (samples && samples->sampleShadingEnable) return false;  // nothing says it but the shader
    constexpr VkPipelineColorBlendStateCreateFlags kOrdered =
        VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
    if (info_.pColorBlendState && (info_.pColorBlendState->flags & kOrdered)) return false;
    return !(info_.pDepthStencilState && info_.pDepthStencilState->flags);
  }

  void add_all() {
    add_input();
    add_rasterization();
    if (discards()) return;  // the rest may be dangling pointers
    add_viewports();
    add_discard_rectangles();
    add_samples();
    add_shading_rate();
    add_depth_stencil();
    add_blend();
  }

 private:
  bool discards() const {
    return info_.pRasterizationState->rasterizerDiscardEnable && !dynamic(VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE);
  }

  /// command(buffer, arguments…), where the pipeline has the state.
  template <class Command, class... Args>
  void add(VkDynamicState state, Command Functions::*command, Args... args) {
    if (dynamic(state) || !(f_->*command)) return;
    out_.push_back([=](const Functions& f, VkCommandBuffer b) { (f.*command)(b, args...); });
  }
  void add(VkDynamicState state, Set set) {
    if (!dynamic(state)) out_.push_back(std::move(set));
  }

  void add_input() {
    if (!dynamic(VK_DYNAMIC_STATE_VERTEX_INPUT_EXT) && info_.pVertexInputState) add_vertex_input();
    if (const auto* assembly = info_.pInputAssemblyState) {
      add(VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY, &Functions::CmdSetPrimitiveTopologyEXT, assembly->topology);
      add(VK_DYNAMIC_STATE_PRIMITIVE_RESTART_ENABLE, &Functions::CmdSetPrimitiveRestartEnableEXT,
          assembly->primitiveRestartEnable);
    }
    const auto* tessellation = info_.pTessellationState;
    const bool tessellates = std::any_of(info_.pStages, info_.pStages + info_.stageCount, [](const auto& s) {
      return s.stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
    });
    if (!tessellates || !tessellation) return;
    add(VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT, &Functions::CmdSetPatchControlPointsEXT,
        tessellation->patchControlPoints);
    const auto* origin = in_chain<VkPipelineTessellationDomainOriginStateCreateInfo>(
        tessellation->pNext, VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO);
    add(VK_DYNAMIC_STATE_TESSELLATION_DOMAIN_ORIGIN_EXT, &Functions::CmdSetTessellationDomainOriginEXT,
        origin ? origin->domainOrigin : VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT);
  }

  void add_vertex_input() {
    const VkPipelineVertexInputStateCreateInfo& input = *info_.pVertexInputState;
    const auto* divisors = in_chain<VkPipelineVertexInputDivisorStateCreateInfoEXT>(
        input.pNext, VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT);
    std::vector<VkVertexInputBindingDescription2EXT> bindings;
    for (const auto& b : copy(input.pVertexBindingDescriptions, input.vertexBindingDescriptionCount)) {
      uint32_t divisor = 1;
      for (uint32_t i = 0; divisors && i < divisors->vertexBindingDivisorCount; ++i)
        if (divisors->pVertexBindingDivisors[i].binding == b.binding)
          divisor = divisors->pVertexBindingDivisors[i].divisor;
      bindings.push_back({VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT, nullptr, b.binding, b.stride,
                          b.inputRate, divisor});
    }
    std::vector<VkVertexInputAttributeDescription2EXT> attributes;
    for (const auto& a : copy(input.pVertexAttributeDescriptions, input.vertexAttributeDescriptionCount))
      attributes.push_back({VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT, nullptr, a.location, a.binding,
                            a.format, a.offset});
    out_.push_back([=](const Functions& f, VkCommandBuffer b) {
      f.CmdSetVertexInputEXT(b, static_cast<uint32_t>(bindings.size()), bindings.data(),
                             static_cast<uint32_t>(attributes.size()), attributes.data());
    });
  }

  void add_rasterization() {
    const VkPipelineRasterizationStateCreateInfo& r = *info_.pRasterizationState;
    add(VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE, &Functions::CmdSetRasterizerDiscardEnableEXT,
        r.rasterizerDiscardEnable);
    add(VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT, &Functions::CmdSetDepthClampEnableEXT, r.depthClampEnable);
    const auto* clip = in_chain<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(
        r.pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT, &Functions::CmdSetDepthClipEnableEXT,
        clip ? clip->depthClipEnable : static_cast<VkBool32>(!r.depthClampEnable));
    add(VK_DYNAMIC_STATE_POLYGON_MODE_EXT, &Functions::CmdSetPolygonModeEXT, r.polygonMode);
    add(VK_DYNAMIC_STATE_CULL_MODE, &Functions::CmdSetCullModeEXT, r.cullMode);
    add(VK_DYNAMIC_STATE_FRONT_FACE, &Functions::CmdSetFrontFaceEXT, r.frontFace);
    add(VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE, &Functions::CmdSetDepthBiasEnableEXT, r.depthBiasEnable);
    const float constant = r.depthBiasConstantFactor, clamp = r.depthBiasClamp, slope = r.depthBiasSlopeFactor;
    add(VK_DYNAMIC_STATE_DEPTH_BIAS,
        [=](const Functions&, VkCommandBuffer b) { vkCmdSetDepthBias(b, constant, clamp, slope); });
    const float width = r.lineWidth;
    add(VK_DYNAMIC_STATE_LINE_WIDTH, [=](const Functions&, VkCommandBuffer b) { vkCmdSetLineWidth(b, width); });
    const auto* mode = in_chain<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(
        r.pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT, &Functions::CmdSetProvokingVertexModeEXT,
        mode ? mode->provokingVertexMode : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT);
    const auto* conservative = in_chain<VkPipelineRasterizationConservativeStateCreateInfoEXT>(
        r.pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_CONSERVATIVE_RASTERIZATION_MODE_EXT, &Functions::CmdSetConservativeRasterizationModeEXT,
        conservative ? conservative->conservativeRasterizationMode : VK_CONSERVATIVE_RASTERIZATION_MODE_DISABLED_EXT);
    const auto* stream = in_chain<VkPipelineRasterizationStateStreamCreateInfoEXT>(
        r.pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_STREAM_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_RASTERIZATION_STREAM_EXT, &Functions::CmdSetRasterizationStreamEXT,
        stream ? stream->rasterizationStream : 0);
    add_lines(r);
  }

  void add_lines(const VkPipelineRasterizationStateCreateInfo& r) {
    VkPipelineRasterizationLineStateCreateInfoEXT lines{};
    lines.lineStippleFactor = 1;
    if (const auto* given = in_chain<VkPipelineRasterizationLineStateCreateInfoEXT>(
            r.pNext, VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT))
      lines = *given;
    add(VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT, &Functions::CmdSetLineRasterizationModeEXT,
        lines.lineRasterizationMode);
    add(VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT, &Functions::CmdSetLineStippleEnableEXT, lines.stippledLineEnable);
    if (lines.stippledLineEnable || dynamic(VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT))
      add(VK_DYNAMIC_STATE_LINE_STIPPLE_EXT, &Functions::CmdSetLineStippleEXT, lines.lineStippleFactor,
          lines.lineStipplePattern);
  }

  void add_viewports() {
    const VkPipelineViewportStateCreateInfo* v = info_.pViewportState;
    if (!v) return;
    if (!dynamic(VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT)) {
      const auto viewports = copy(v->pViewports, v->viewportCount);
      out_.push_back([=](const Functions& f, VkCommandBuffer b) {
        f.CmdSetViewportWithCountEXT(b, static_cast<uint32_t>(viewports.size()), viewports.data());
      });
    }
    if (!dynamic(VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT) && !dynamic(VK_DYNAMIC_STATE_SCISSOR)) {
      const auto scissors = copy(v->pScissors, v->scissorCount);
      out_.push_back([=](const Functions& f, VkCommandBuffer b) {
        f.CmdSetScissorWithCountEXT(b, static_cast<uint32_t>(scissors.size()), scissors.data());
      });
    }
    const auto* control = in_chain<VkPipelineViewportDepthClipControlCreateInfoEXT>(
        v->pNext, VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT, &Functions::CmdSetDepthClipNegativeOneToOneEXT,
        control ? control->negativeOneToOne : VK_FALSE);
  }

  /// Rectangles that the pipeline does not have are empty ones.
  void add_discard_rectangles() {
    const auto* d = in_chain<VkPipelineDiscardRectangleStateCreateInfoEXT>(
        info_.pNext, VK_STRUCTURE_TYPE_PIPELINE_DISCARD_RECTANGLE_STATE_CREATE_INFO_EXT);
    add(VK_DYNAMIC_STATE_DISCARD_RECTANGLE_ENABLE_EXT, &Functions::CmdSetDiscardRectangleEnableEXT,
        static_cast<VkBool32>(d && d->discardRectangleCount));
    if (!d || !f_->CmdSetDiscardRectangleEXT) return;
    add(VK_DYNAMIC_STATE_DISCARD_RECTANGLE_MODE_EXT, &Functions::CmdSetDiscardRectangleModeEXT,
        d->discardRectangleMode);
    auto rectangles = copy(d->pDiscardRectangles, d->discardRectangleCount);
    rectangles.resize(8, VkRect2D{});
    out_.push_back([=](const Functions& f, VkCommandBuffer b) {
      f.CmdSetDiscardRectangleEXT(b, 0, static_cast<uint32_t>(rectangles.size()), rectangles.data());
    });
  }

  void add_samples() {
    VkPipelineMultisampleStateCreateInfo m{};
    m.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    if (info_.pMultisampleState) m = *info_.pMultisampleState;
    const VkSampleMask mask = m.pSampleMask ? *m.pSampleMask : ~0u;
    const VkSampleCountFlagBits samples = m.rasterizationSamples;
    add(VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT, &Functions::CmdSetRasterizationSamplesEXT, samples);
    add(VK_DYNAMIC_STATE_SAMPLE_MASK_EXT,
        [=](const Functions& f, VkCommandBuffer b) { f.CmdSetSampleMaskEXT(b, samples, &mask); });
    add(VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT, &Functions::CmdSetAlphaToCoverageEnableEXT,
        m.alphaToCoverageEnable);
    add(VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT, &Functions::CmdSetAlphaToOneEnableEXT, m.alphaToOneEnable);
    const auto* custom = in_chain<VkPipelineSampleLocationsStateCreateInfoEXT>(
        m.pNext, VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT);
    const VkBool32 enabled = custom ? custom->sampleLocationsEnable : VK_FALSE;
    add(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_ENABLE_EXT, &Functions::CmdSetSampleLocationsEnableEXT, enabled);
    if (!custom || !(enabled || dynamic(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_ENABLE_EXT))) return;
    VkSampleLocationsInfoEXT info = custom->sampleLocationsInfo;
    const auto places = copy(info.pSampleLocations, info.sampleLocationsCount);
    info.pNext = nullptr;
    add(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT, [=](const Functions& f, VkCommandBuffer b) {
      VkSampleLocationsInfoEXT again = info;
      again.pSampleLocations = places.data();
      f.CmdSetSampleLocationsEXT(b, &again);
    });
  }

  void add_shading_rate() {
    if (!f_->CmdSetFragmentShadingRateKHR) return;
    VkPipelineFragmentShadingRateStateCreateInfoKHR rate{};
    rate.fragmentSize = {1, 1};
    if (const auto* given = in_chain<VkPipelineFragmentShadingRateStateCreateInfoKHR>(
            info_.pNext, VK_STRUCTURE_TYPE_PIPELINE_FRAGMENT_SHADING_RATE_STATE_CREATE_INFO_KHR))
      rate = *given;
    add(VK_DYNAMIC_STATE_FRAGMENT_SHADING_RATE_KHR, [=](const Functions& f, VkCommandBuffer b) {
      f.CmdSetFragmentShadingRateKHR(b, &rate.fragmentSize, rate.combinerOps);
    });
  }

  void add_depth_stencil() {
    VkPipelineDepthStencilStateCreateInfo d{};
    d.depthCompareOp = VK_COMPARE_OP_ALWAYS;
    if (info_.pDepthStencilState) d = *info_.pDepthStencilState;
    add(VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE, &Functions::CmdSetDepthTestEnableEXT, d.depthTestEnable);
    add(VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE, &Functions::CmdSetDepthWriteEnableEXT, d.depthWriteEnable);
    add(VK_DYNAMIC_STATE_DEPTH_COMPARE_OP, &Functions::CmdSetDepthCompareOpEXT, d.depthCompareOp);
    add(VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE, &Functions::CmdSetDepthBoundsTestEnableEXT, d.depthBoundsTestEnable);
    add(VK_DYNAMIC_STATE_DEPTH_BOUNDS,
        [=](const Functions&, VkCommandBuffer b) { vkCmdSetDepthBounds(b, d.minDepthBounds, d.maxDepthBounds); });
    add(VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE, &Functions::CmdSetStencilTestEnableEXT, d.stencilTestEnable);
    const auto face = [&](VkStencilFaceFlags which, const VkStencilOpState& s) {
      add(VK_DYNAMIC_STATE_STENCIL_OP, &Functions::CmdSetStencilOpEXT, which, s.failOp, s.passOp, s.depthFailOp,
          s.compareOp);
      add(VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK,
          [=](const Functions&, VkCommandBuffer b) { vkCmdSetStencilCompareMask(b, which, s.compareMask); });
      add(VK_DYNAMIC_STATE_STENCIL_WRITE_MASK,
          [=](const Functions&, VkCommandBuffer b) { vkCmdSetStencilWriteMask(b, which, s.writeMask); });
      add(VK_DYNAMIC_STATE_STENCIL_REFERENCE,
          [=](const Functions&, VkCommandBuffer b) { vkCmdSetStencilReference(b, which, s.reference); });
    };
    face(VK_STENCIL_FACE_FRONT_BIT, d.front);
    face(VK_STENCIL_FACE_BACK_BIT, d.back);
  }

  void add_blend() {
    if (!info_.pColorBlendState) return;
    const VkPipelineColorBlendStateCreateInfo& c = *info_.pColorBlendState;
    add(VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT, &Functions::CmdSetLogicOpEnableEXT, c.logicOpEnable);
    add(VK_DYNAMIC_STATE_LOGIC_OP_EXT, &Functions::CmdSetLogicOpEXT, c.logicOp);
    const std::vector<float> constants(c.blendConstants, c.blendConstants + 4);
    add(VK_DYNAMIC_STATE_BLEND_CONSTANTS,
        [=](const Functions&, VkCommandBuffer b) { vkCmdSetBlendConstants(b, constants.data()); });
    const auto* writes =
        in_chain<VkPipelineColorWriteCreateInfoEXT>(c.pNext, VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT);
    std::vector<VkBool32> enables(std::max(c.attachmentCount, 8u), VK_TRUE);
    if (writes) std::copy_n(writes->pColorWriteEnables, writes->attachmentCount, enables.begin());
    if (f_->CmdSetColorWriteEnableEXT)
      add(VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT, [=](const Functions& f, VkCommandBuffer b) {
        f.CmdSetColorWriteEnableEXT(b, static_cast<uint32_t>(enables.size()), enables.data());
      });
    const auto* advanced = in_chain<VkPipelineColorBlendAdvancedStateCreateInfoEXT>(
        c.pNext, VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT);
    const auto attachments = copy(c.pAttachments, c.attachmentCount);
    for (uint32_t i = 0; i < attachments.size(); ++i) add_attachment(i, attachments[i], advanced);
  }

  void add_attachment(uint32_t i, const VkPipelineColorBlendAttachmentState& a,
                      const VkPipelineColorBlendAdvancedStateCreateInfoEXT* advanced) {
    add(VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT,
        [=](const Functions& f, VkCommandBuffer b) { f.CmdSetColorBlendEnableEXT(b, i, 1, &a.blendEnable); });
    add(VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT,
        [=](const Functions& f, VkCommandBuffer b) { f.CmdSetColorWriteMaskEXT(b, i, 1, &a.colorWriteMask); });
    if (dynamic(VK_DYNAMIC_STATE_COLOR_BLEND_ADVANCED_EXT)) return;
    if (a.colorBlendOp >= VK_BLEND_OP_ZERO_EXT && !dynamic(VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT)) {
      VkColorBlendAdvancedEXT blend{a.colorBlendOp, VK_TRUE, VK_TRUE, VK_BLEND_OVERLAP_UNCORRELATED_EXT, VK_FALSE};
      if (advanced) {
        blend.srcPremultiplied = advanced->srcPremultiplied;
        blend.dstPremultiplied = advanced->dstPremultiplied;
        blend.blendOverlap = advanced->blendOverlap;
      }
      out_.push_back([=](const Functions& f, VkCommandBuffer b) { f.CmdSetColorBlendAdvancedEXT(b, i, 1, &blend); });
      return;
    }
    const VkColorBlendEquationEXT equation{a.srcColorBlendFactor, a.dstColorBlendFactor, a.colorBlendOp,
                                           a.srcAlphaBlendFactor, a.dstAlphaBlendFactor, a.alphaBlendOp};
    add(VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT,
        [=](const Functions& f, VkCommandBuffer b) { f.CmdSetColorBlendEquationEXT(b, i, 1, &equation); });
  }

  const Functions* f_;  ///< null where nothing is added
  const VkGraphicsPipelineCreateInfo& info_;
  std::vector<Set>& out_;
};

}  // namespace

bool convertible(const VkGraphicsPipelineCreateInfo& info) {
  std::vector<Set> none;
  return States(nullptr, info, none).convertible();
}

std::vector<Set> state_commands(const Functions& functions, const VkGraphicsPipelineCreateInfo& info) {
  std::vector<Set> commands;
  States(&functions, info, commands).add_all();
  return commands;
}

}  // namespace vitrine::as_shader_objects
#endif
