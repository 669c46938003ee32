// State of a pipeline that is left to commands: of Vulkan 1.0, of the three extensions of extended dynamic state, and
// of those for vertex input, colour writes, lines and depth clipping.
#include "cases/pipeline/state/dynamic_state.h"

namespace vitrine::cts {
namespace {

bool eds1() {
  return both([](const auto& f) { return f.extendedDynamicState; });
}
bool eds2(VkBool32 VkPhysicalDeviceExtendedDynamicState2FeaturesEXT::*member) {
  return both([&](const auto& f) { return f.*member; });
}
bool eds3(VkBool32 VkPhysicalDeviceExtendedDynamicState3FeaturesEXT::*member) {
  return both([&](const auto& f) { return f.*member; });
}
using Second = VkPhysicalDeviceExtendedDynamicState2FeaturesEXT;
using Third = VkPhysicalDeviceExtendedDynamicState3FeaturesEXT;

/// Another topology for which the same geometry shader is right.
VkPrimitiveTopology other_of_class(VkPrimitiveTopology topology) {
  switch (topology) {
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
      return VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
      return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
      return VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY;
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
      return VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
    default:
      return topology;
  }
}

template <typename T>
T* copied(T& storage, const void* structure) {
  storage = *static_cast<const T*>(structure);
  return &storage;
}

}  // namespace

DynamicState::DynamicState(Run& run, Random& random, float share, const GraphicsSpec& right,
                           VkSampleCountFlagBits samples, uint32_t colors)
    : run_(run), random_(random), share_(share), right_(right), spec_(right) {
  spec_.raster.pNext = copy_chain(right.raster.pNext);
  spec_.viewport_next = copy_chain(right.viewport_next);
  spec_.blend.pNext = copy_chain(right.blend.pNext);
  spec_.tessellation.pNext = copy_chain(right.tessellation.pNext);
  leave_assembly();
  leave_viewports();
  leave_rasterization();
  if (line_) leave_lines();
  leave_depth();
  leave_stencil();
  leave_multisample(samples);
  leave_blending(colors);
  leave_vertex_input();
  // Only commands discard everything: a pipeline that does so by itself has neither a fragment shader nor its state.
  spec_.raster.rasterizerDiscardEnable = VK_FALSE;
}

void DynamicState::set(VkCommandBuffer cmd, const Buffer& vertices) const {
  for (const Set& command : commands_) command(cmd);
  if (binds_with_stride_) {
    const VkDeviceSize offset = 0, stride = right_.bindings[0].stride;
    CTS_COMMAND(run_.gpu, CmdBindVertexBuffers2EXT)(cmd, 0, 1, &vertices.handle, &offset, nullptr, &stride);
  } else {
    bind_vertices(cmd, vertices);
  }
}

std::string DynamicState::text() const {
  std::string text;
  for (const VkDynamicState state : spec_.dynamic) text += " " + std::to_string(state);
  return text;
}

const void* DynamicState::copy_chain(const void* next) {
  if (!next) return nullptr;
  const auto* structure = static_cast<const VkBaseInStructure*>(next);
  const auto rest = [&](auto* mine) {
    mine->pNext = copy_chain(structure->pNext);
    return mine;
  };
  switch (structure->sType) {
    case VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT:
      return rest(provoking_ = copied(provoking_storage_, next));
    case VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT:
      return rest(line_ = copied(line_storage_, next));
    case VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT:
      return rest(clip_ = copied(clip_storage_, next));
    case VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT:
      return rest(control_ = copied(control_storage_, next));
    case VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT:
      return rest(writes_ = copied(writes_storage_, next));
    case VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO:
      return rest(origin_ = copied(origin_storage_, next));
    default:
      return next;
  }
}

/// Always one random number, so that what a device lacks does not change what comes behind.
bool DynamicState::takes(VkDynamicState state, bool available) {
  if (!random_.chance(share_) || !available) return false;
  spec_.dynamic.push_back(state);
  return true;
}

void DynamicState::leave(VkDynamicState state, bool available, const std::function<void()>& spoil, Set set) {
  if (!takes(state, available)) return;
  spoil();
  commands_.push_back(std::move(set));
}

void DynamicState::leave_assembly() {
  const Gpu& gpu = run_.gpu;
  leave_value(
      VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY, eds1(),
      [this] { spec_.assembly.topology = other_of_class(right_.assembly.topology); },
      CTS_COMMAND(gpu, CmdSetPrimitiveTopologyEXT), right_.assembly.topology);
  leave_value(
      VK_DYNAMIC_STATE_PRIMITIVE_RESTART_ENABLE, eds2(&Second::extendedDynamicState2),
      [this] { spec_.assembly.primitiveRestartEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetPrimitiveRestartEnableEXT),
      right_.assembly.primitiveRestartEnable);
  if (right_.control.empty()) return;
  leave_value(
      VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT, eds2(&Second::extendedDynamicState2PatchControlPoints),
      [this] { spec_.tessellation.patchControlPoints = 7; }, CTS_COMMAND(gpu, CmdSetPatchControlPointsEXT),
      right_.tessellation.patchControlPoints);
  const auto origin = origin_ ? origin_->domainOrigin : VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT;
  leave_value(
      VK_DYNAMIC_STATE_TESSELLATION_DOMAIN_ORIGIN_EXT, eds3(&Third::extendedDynamicState3TessellationDomainOrigin),
      [this] {
        if (origin_) origin_->domainOrigin = VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT;
      },
      CTS_COMMAND(gpu, CmdSetTessellationDomainOriginEXT), origin);
}

/// Either with their number or without.
void DynamicState::leave_viewports() {
  const Gpu& gpu = run_.gpu;
  const auto count = static_cast<uint32_t>(right_.viewports.size());
  if (count == 0) return;
  const bool counted = eds1() && random_.chance(0.5f);
  const auto spoil_viewports = [this] {
    for (VkViewport& v : spec_.viewports) v = {1, 1, 5, 5, 0.5f, 0.5f};
  };
  const auto spoil_scissors = [this] {
    for (VkRect2D& r : spec_.scissors) r = {{2, 2}, {3, 3}};
  };
  leave(counted ? VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT : VK_DYNAMIC_STATE_VIEWPORT, true, spoil_viewports,
        [this, &gpu, counted, count](VkCommandBuffer c) {
          if (counted)
            CTS_COMMAND(gpu, CmdSetViewportWithCountEXT)(c, count, right_.viewports.data());
          else
            vkCmdSetViewport(c, 0, count, right_.viewports.data());
        });
  leave(counted ? VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT : VK_DYNAMIC_STATE_SCISSOR, true, spoil_scissors,
        [this, &gpu, counted, count](VkCommandBuffer c) {
          if (counted)
            CTS_COMMAND(gpu, CmdSetScissorWithCountEXT)(c, count, right_.scissors.data());
          else
            vkCmdSetScissor(c, 0, count, right_.scissors.data());
        });
  const bool control = both([](const auto& f) { return f.depthClipControl; });
  const VkBool32 symmetric = control_ && control_->negativeOneToOne;
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT,
      control && eds3(&Third::extendedDynamicState3DepthClipNegativeOneToOne),
      [this] {
        if (control_) control_->negativeOneToOne = VK_FALSE;
      },
      CTS_COMMAND(gpu, CmdSetDepthClipNegativeOneToOneEXT), symmetric);
}

void DynamicState::leave_rasterization() {
  const Gpu& gpu = run_.gpu;
  const VkPipelineRasterizationStateCreateInfo& right = right_.raster;
  VkPipelineRasterizationStateCreateInfo& wrong = spec_.raster;
  leave_value(
      VK_DYNAMIC_STATE_CULL_MODE, eds1(), [&] { wrong.cullMode = VK_CULL_MODE_FRONT_AND_BACK; },
      CTS_COMMAND(gpu, CmdSetCullModeEXT), right.cullMode);
  leave_value(
      VK_DYNAMIC_STATE_FRONT_FACE, eds1(), [&] { wrong.frontFace = static_cast<VkFrontFace>(1 - right.frontFace); },
      CTS_COMMAND(gpu, CmdSetFrontFaceEXT), right.frontFace);
  leave_value(
      VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE, eds2(&Second::extendedDynamicState2),
      [&] { wrong.rasterizerDiscardEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetRasterizerDiscardEnableEXT),
      right.rasterizerDiscardEnable);
  leave_value(
      VK_DYNAMIC_STATE_POLYGON_MODE_EXT, eds3(&Third::extendedDynamicState3PolygonMode),
      [&] { wrong.polygonMode = right.polygonMode ? VK_POLYGON_MODE_FILL : VK_POLYGON_MODE_LINE; },
      CTS_COMMAND(gpu, CmdSetPolygonModeEXT), right.polygonMode);
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT, eds3(&Third::extendedDynamicState3DepthClampEnable),
      [&] { wrong.depthClampEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetDepthClampEnableEXT), right.depthClampEnable);
  const bool clips = both([](const auto& f) { return f.depthClipEnable; });
  const VkBool32 clip = clip_ ? clip_->depthClipEnable : !right.depthClampEnable;
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT, clips && eds3(&Third::extendedDynamicState3DepthClipEnable),
      [this] {
        if (clip_) clip_->depthClipEnable = !clip_->depthClipEnable;
      },
      CTS_COMMAND(gpu, CmdSetDepthClipEnableEXT), clip);
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE, eds2(&Second::extendedDynamicState2),
      [&] { wrong.depthBiasEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetDepthBiasEnableEXT), right.depthBiasEnable);
  leave(
      VK_DYNAMIC_STATE_DEPTH_BIAS, true,
      [&] { wrong.depthBiasConstantFactor = wrong.depthBiasSlopeFactor = wrong.depthBiasClamp = 0; },
      [&right](VkCommandBuffer c) {
        vkCmdSetDepthBias(c, right.depthBiasConstantFactor, right.depthBiasClamp, right.depthBiasSlopeFactor);
      });
  leave(
      VK_DYNAMIC_STATE_LINE_WIDTH, true, [&] { wrong.lineWidth = 1; },
      [&right](VkCommandBuffer c) { vkCmdSetLineWidth(c, right.lineWidth); });
  if (!provoking_) return;
  const VkProvokingVertexModeEXT provoking = provoking_->provokingVertexMode;
  leave_value(
      VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT, eds3(&Third::extendedDynamicState3ProvokingVertexMode),
      [&] { provoking_->provokingVertexMode = static_cast<VkProvokingVertexModeEXT>(1 - provoking); },
      CTS_COMMAND(gpu, CmdSetProvokingVertexModeEXT), provoking);
}

void DynamicState::leave_lines() {
  const Gpu& gpu = run_.gpu;
  const VkPipelineRasterizationLineStateCreateInfoEXT right = *line_;
  leave_value(
      VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT, eds3(&Third::extendedDynamicState3LineRasterizationMode),
      [this] { line_->lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT; },
      CTS_COMMAND(gpu, CmdSetLineRasterizationModeEXT), right.lineRasterizationMode);
  leave_value(
      VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT, eds3(&Third::extendedDynamicState3LineStippleEnable),
      [this] { line_->stippledLineEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetLineStippleEnableEXT),
      right.stippledLineEnable);
  leave(
      VK_DYNAMIC_STATE_LINE_STIPPLE_EXT, true,
      [this] {
        line_->lineStippleFactor = 256;
        line_->lineStipplePattern = 0x5555;
      },
      [right, &gpu](VkCommandBuffer c) {
        CTS_COMMAND(gpu, CmdSetLineStippleEXT)(c, right.lineStippleFactor, right.lineStipplePattern);
      });
}

void DynamicState::leave_depth() {
  const Gpu& gpu = run_.gpu;
  const VkPipelineDepthStencilStateCreateInfo& right = right_.depth;
  VkPipelineDepthStencilStateCreateInfo& wrong = spec_.depth;
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE, eds1(), [&] { wrong.depthTestEnable = VK_FALSE; },
      CTS_COMMAND(gpu, CmdSetDepthTestEnableEXT), right.depthTestEnable);
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE, eds1(), [&] { wrong.depthWriteEnable = !right.depthWriteEnable; },
      CTS_COMMAND(gpu, CmdSetDepthWriteEnableEXT), right.depthWriteEnable);
  leave_value(
      VK_DYNAMIC_STATE_DEPTH_COMPARE_OP, eds1(),
      [&] { wrong.depthCompareOp = static_cast<VkCompareOp>(7 - right.depthCompareOp); },
      CTS_COMMAND(gpu, CmdSetDepthCompareOpEXT), right.depthCompareOp);
}

void DynamicState::leave_stencil() {
  const Gpu& gpu = run_.gpu;
  const VkPipelineDepthStencilStateCreateInfo& right = right_.depth;
  VkPipelineDepthStencilStateCreateInfo& wrong = spec_.depth;
  leave_value(
      VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE, eds1(), [&] { wrong.stencilTestEnable = VK_FALSE; },
      CTS_COMMAND(gpu, CmdSetStencilTestEnableEXT), right.stencilTestEnable);
  leave(
      VK_DYNAMIC_STATE_STENCIL_OP, eds1(),
      [&] {
        for (VkStencilOpState* s : {&wrong.front, &wrong.back}) {
          s->failOp = s->passOp = s->depthFailOp = VK_STENCIL_OP_ZERO;
          s->compareOp = VK_COMPARE_OP_NEVER;
        }
      },
      [&right, &gpu](VkCommandBuffer c) {
        const auto set = CTS_COMMAND(gpu, CmdSetStencilOpEXT);
        const VkStencilOpState &f = right.front, &b = right.back;
        set(c, VK_STENCIL_FACE_FRONT_BIT, f.failOp, f.passOp, f.depthFailOp, f.compareOp);
        set(c, VK_STENCIL_FACE_BACK_BIT, b.failOp, b.passOp, b.depthFailOp, b.compareOp);
      });
  const auto leave_word = [&](VkDynamicState state, auto member, auto set) {
    leave(
        state, true, [&wrong, member] { wrong.front.*member = wrong.back.*member = 1; },
        [&right, member, set](VkCommandBuffer c) {
          set(c, VK_STENCIL_FACE_FRONT_BIT, right.front.*member);
          set(c, VK_STENCIL_FACE_BACK_BIT, right.back.*member);
        });
  };
  leave_word(VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK, &VkStencilOpState::compareMask, vkCmdSetStencilCompareMask);
  leave_word(VK_DYNAMIC_STATE_STENCIL_WRITE_MASK, &VkStencilOpState::writeMask, vkCmdSetStencilWriteMask);
  leave_word(VK_DYNAMIC_STATE_STENCIL_REFERENCE, &VkStencilOpState::reference, vkCmdSetStencilReference);
}

void DynamicState::leave_multisample(VkSampleCountFlagBits samples) {
  const Gpu& gpu = run_.gpu;
  const VkPipelineMultisampleStateCreateInfo& right = right_.multisample;
  VkPipelineMultisampleStateCreateInfo& wrong = spec_.multisample;
  leave(
      VK_DYNAMIC_STATE_SAMPLE_MASK_EXT, eds3(&Third::extendedDynamicState3SampleMask),
      [&] { wrong.pSampleMask = &spoiled_mask_; },
      [&right, &gpu, samples](VkCommandBuffer c) {
        const VkSampleMask all = ~0u;
        CTS_COMMAND(gpu, CmdSetSampleMaskEXT)(c, samples, right.pSampleMask ? right.pSampleMask : &all);
      });
  leave_value(
      VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT, eds3(&Third::extendedDynamicState3RasterizationSamples), [] {},
      CTS_COMMAND(gpu, CmdSetRasterizationSamplesEXT), samples);
  leave_value(
      VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT, eds3(&Third::extendedDynamicState3AlphaToCoverageEnable),
      [&] { wrong.alphaToCoverageEnable = VK_FALSE; }, CTS_COMMAND(gpu, CmdSetAlphaToCoverageEnableEXT),
      right.alphaToCoverageEnable);
  // Set by a command, alpha to one has another effect in the reference than in a pipeline.
  leave_value(
      VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT,
      !right.alphaToOneEnable && eds3(&Third::extendedDynamicState3AlphaToOneEnable),
      [&] { wrong.alphaToOneEnable = gpu.features.alphaToOne && !line_; }, CTS_COMMAND(gpu, CmdSetAlphaToOneEnableEXT),
      VK_FALSE);
}

void DynamicState::leave_blending(uint32_t colors) {
  const Gpu& gpu = run_.gpu;
  using Blend = VkPipelineColorBlendAttachmentState;
  const std::vector<Blend>& right = right_.blends;
  std::vector<Blend>& wrong = spec_.blends;
  leave(
      VK_DYNAMIC_STATE_BLEND_CONSTANTS, true,
      [this] {
        for (float& constant : spec_.blend.blendConstants) constant = 0.4f;
      },
      [this](VkCommandBuffer c) { vkCmdSetBlendConstants(c, right_.blend.blendConstants); });
  leave_value(
      VK_DYNAMIC_STATE_LOGIC_OP_EXT, eds2(&Second::extendedDynamicState2LogicOp),
      [this] { spec_.blend.logicOp = static_cast<VkLogicOp>(15 - right_.blend.logicOp); },
      CTS_COMMAND(gpu, CmdSetLogicOpEXT), right_.blend.logicOp);
  leave_value(
      VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT, eds3(&Third::extendedDynamicState3LogicOpEnable),
      [this] { spec_.blend.logicOpEnable = !right_.blend.logicOpEnable; }, CTS_COMMAND(gpu, CmdSetLogicOpEnableEXT),
      right_.blend.logicOpEnable);
  if (colors == 0 || right.size() != colors) return;
  leave(
      VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT, eds3(&Third::extendedDynamicState3ColorBlendEnable),
      [&] {
        for (Blend& b : wrong) b.blendEnable = VK_FALSE;
      },
      [&right, &gpu](VkCommandBuffer c) {
        std::vector<VkBool32> enables;
        for (const Blend& b : right) enables.push_back(b.blendEnable);
        CTS_COMMAND(gpu, CmdSetColorBlendEnableEXT)(c, 0, static_cast<uint32_t>(enables.size()), enables.data());
      });
  leave(
      VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT, eds3(&Third::extendedDynamicState3ColorBlendEquation),
      [&] {
        for (Blend& b : wrong) {
          b.srcColorBlendFactor = b.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
          b.dstColorBlendFactor = b.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
          b.colorBlendOp = b.alphaBlendOp = VK_BLEND_OP_ADD;
        }
      },
      [&right, &gpu](VkCommandBuffer c) {
        std::vector<VkColorBlendEquationEXT> equations;
        for (const Blend& b : right)
          equations.push_back({b.srcColorBlendFactor, b.dstColorBlendFactor, b.colorBlendOp, b.srcAlphaBlendFactor,
                               b.dstAlphaBlendFactor, b.alphaBlendOp});
        CTS_COMMAND(gpu, CmdSetColorBlendEquationEXT)
        (c, 0, static_cast<uint32_t>(equations.size()), equations.data());
      });
  leave(
      VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT, eds3(&Third::extendedDynamicState3ColorWriteMask),
      [&] {
        for (Blend& b : wrong) b.colorWriteMask = 0;
      },
      [&right, &gpu](VkCommandBuffer c) {
        std::vector<VkColorComponentFlags> masks;
        for (const Blend& b : right) masks.push_back(b.colorWriteMask);
        CTS_COMMAND(gpu, CmdSetColorWriteMaskEXT)(c, 0, static_cast<uint32_t>(masks.size()), masks.data());
      });
  const std::vector<VkBool32> writes =
      writes_ ? std::vector<VkBool32>(writes_->pColorWriteEnables, writes_->pColorWriteEnables + colors)
              : std::vector<VkBool32>(colors, VK_TRUE);
  leave(
      VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT, both([](const auto& f) { return f.colorWriteEnable; }),
      [&] {
        // The structure's array stays: it is the application's. Without the structure everything is written.
        if (writes_) spec_.blend.pNext = nullptr;
      },
      [writes, &gpu](VkCommandBuffer c) {
        CTS_COMMAND(gpu, CmdSetColorWriteEnableEXT)(c, static_cast<uint32_t>(writes.size()), writes.data());
      });
}

/// Either all of the vertex input, or the stride alone.
void DynamicState::leave_vertex_input() {
  const Gpu& gpu = run_.gpu;
  if (right_.bindings.size() != 1) return;
  const bool all = both([](const auto& f) { return f.vertexInputDynamicState; }) && random_.chance(0.5f);
  if (!all) {
    binds_with_stride_ = takes(VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE, eds1());
    if (binds_with_stride_) spec_.bindings[0].stride = 16;
    return;
  }
  leave(
      VK_DYNAMIC_STATE_VERTEX_INPUT_EXT, true,
      [this] {
        spec_.bindings.clear();
        spec_.attributes.clear();
      },
      [this, &gpu](VkCommandBuffer c) {
        const VkVertexInputBindingDescription& b = right_.bindings[0];
        const VkVertexInputBindingDescription2EXT binding{
            VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT, nullptr, b.binding, b.stride, b.inputRate, 1};
        std::vector<VkVertexInputAttributeDescription2EXT> attributes;
        for (const VkVertexInputAttributeDescription& a : right_.attributes)
          attributes.push_back({VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT, nullptr, a.location,
                                a.binding, a.format, a.offset});
        CTS_COMMAND(gpu, CmdSetVertexInputEXT)
        (c, 1, &binding, static_cast<uint32_t>(attributes.size()), attributes.data());
      });
}

}  // namespace vitrine::cts
