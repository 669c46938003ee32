// Which bind points a set of shader stages means.
#pragma once

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// Calls `bind` for each that has one of the stages: "the binding operation still affects all stages corresponding to
/// the given pipeline bind point(s)" (Vulkan 1.4.309, VkBindDescriptorSetsInfo).
template <class Bind>
void for_each_bind_point(VkShaderStageFlags stages, Bind bind) {
  if (stages & VK_SHADER_STAGE_ALL_GRAPHICS) bind(VK_PIPELINE_BIND_POINT_GRAPHICS);
  if (stages & VK_SHADER_STAGE_COMPUTE_BIT) bind(VK_PIPELINE_BIND_POINT_COMPUTE);
}

}  // namespace vitrine::icd
