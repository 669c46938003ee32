// The state of a pipeline as commands that set it (VK_EXT_shader_object and what it takes from
// VK_EXT_extended_dynamic_state*).
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <vector>

#include "layer.h"

#ifdef VK_EXT_shader_object
namespace vitrine::as_shader_objects {

/// What a device is asked for by name.
struct Functions {
  VkDevice device = VK_NULL_HANDLE;
// clang-format off
#define EACH_FUNCTION(X) \
  X(CreateShadersEXT) X(DestroyShaderEXT) X(CmdBindShadersEXT) X(CmdSetVertexInputEXT) \
  X(CmdSetPrimitiveTopologyEXT) X(CmdSetPrimitiveRestartEnableEXT) X(CmdSetPatchControlPointsEXT) \
  X(CmdSetTessellationDomainOriginEXT) X(CmdSetViewportWithCountEXT) X(CmdSetScissorWithCountEXT) \
  X(CmdSetDepthClipNegativeOneToOneEXT) X(CmdSetRasterizerDiscardEnableEXT) X(CmdSetDepthClampEnableEXT) \
  X(CmdSetDepthClipEnableEXT) X(CmdSetPolygonModeEXT) X(CmdSetCullModeEXT) X(CmdSetFrontFaceEXT) \
  X(CmdSetDepthBiasEnableEXT) X(CmdSetLineRasterizationModeEXT) X(CmdSetLineStippleEnableEXT) \
  X(CmdSetLineStippleEXT) X(CmdSetProvokingVertexModeEXT) X(CmdSetConservativeRasterizationModeEXT) X(CmdSetRasterizationStreamEXT) \
  X(CmdSetDiscardRectangleEXT) X(CmdSetDiscardRectangleEnableEXT) X(CmdSetDiscardRectangleModeEXT) \
  X(CmdSetRasterizationSamplesEXT) X(CmdSetSampleMaskEXT) X(CmdSetAlphaToCoverageEnableEXT) \
  X(CmdSetAlphaToOneEnableEXT) X(CmdSetSampleLocationsEnableEXT) X(CmdSetSampleLocationsEXT) \
  X(CmdSetDepthTestEnableEXT) X(CmdSetDepthWriteEnableEXT) X(CmdSetDepthCompareOpEXT) \
  X(CmdSetDepthBoundsTestEnableEXT) X(CmdSetStencilTestEnableEXT) X(CmdSetStencilOpEXT) X(CmdSetLogicOpEnableEXT) \
  X(CmdSetLogicOpEXT) X(CmdSetColorBlendEnableEXT) X(CmdSetColorBlendEquationEXT) X(CmdSetColorBlendAdvancedEXT) \
  X(CmdSetColorWriteMaskEXT) X(CmdSetColorWriteEnableEXT) X(CmdSetFragmentShadingRateKHR)
// clang-format on
#define DECLARE(name) PFN_vk##name name = nullptr;
  EACH_FUNCTION(DECLARE)
#undef DECLARE

  explicit Functions(VkDevice d) : device(d) {
#define LOAD(name) name = reinterpret_cast<PFN_vk##name>(vkGetDeviceProcAddr(d, "vk" #name));
    EACH_FUNCTION(LOAD)
#undef LOAD
  }
};

using Set = std::function<void(const Functions&, VkCommandBuffer)>;

using layer::copy;
using layer::in_chain;

/// Whether shader objects can have all of the pipeline's state.
bool convertible(const VkGraphicsPipelineCreateInfo& info);

/// What sets the state that is not dynamic. It refers to nothing of the application's.
std::vector<Set> state_commands(const Functions& functions, const VkGraphicsPipelineCreateInfo& info);

}  // namespace vitrine::as_shader_objects
#endif
