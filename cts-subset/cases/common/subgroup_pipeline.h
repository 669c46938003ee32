// Compute pipelines with subgroups of 8 invocations on both devices (subgroup size control): the reference's size, so
// that sizes, masks and the order of sums compare.
#pragma once

#include "harness/run.h"

namespace vitrine::cts {

inline constexpr uint32_t kSubgroupSize = 8;

inline VkPipeline subgroup_pipeline(Run& run, VkPipelineLayout layout, VkShaderModule module) {
  run.require(run.gpu.extension_features.subgroupSizeControl, "subgroupSizeControl");
  VkPhysicalDeviceSubgroupSizeControlProperties sizes{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes};
  vkGetPhysicalDeviceProperties2(run.gpu.physical, &properties);
  run.require(sizes.minSubgroupSize <= kSubgroupSize && sizes.maxSubgroupSize >= kSubgroupSize, "subgroups of 8");
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo required{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
  required.requiredSubgroupSize = kSubgroupSize;
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                &required,
                0,
                VK_SHADER_STAGE_COMPUTE_BIT,
                module,
                "main",
                nullptr};
  info.layout = layout;
  VkPipeline result;
  CTS_VK(vkCreateComputePipelines(run.device, VK_NULL_HANDLE, 1, &info, nullptr, &result));
  return run.own(result, vkDestroyPipeline);
}

}  // namespace vitrine::cts
