// The pipeline of a bug file, the layout of its sets, and the sets.
#pragma once

#include <vector>

#include "glass/bug/bug.h"
#include "glass/replayer/device.h"
#include "glass/replayer/resources.h"

namespace vitrine::glass::replayer {

struct Bound {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets;           ///< null where the layout has none
  std::vector<std::uint32_t> dynamic_offsets;  ///< zeros: the offsets are in the descriptors
};

/// Layouts and sets; the pipeline comes with the functions below.
Bound make_sets(const Device& device, const bug::Bug& bug, const Resources& resources);
VkPipeline make_compute_pipeline(const Device& device, const bug::Bug& bug, VkPipelineLayout layout);
VkPipeline make_graphics_pipeline(const Device& device, const bug::Bug& bug, VkPipelineLayout layout);

/// A stage as the API has it: points into the Bug and this.
class StageInfo {
 public:
  StageInfo(const Device& device, const bug::Stage& stage);
  const VkPipelineShaderStageCreateInfo& info() const { return info_; }
  StageInfo(const StageInfo&) = delete;
  StageInfo& operator=(const StageInfo&) = delete;

 private:
  VkSpecializationInfo constants_{};
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size_{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
  VkPipelineShaderStageCreateInfo info_{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
};

}  // namespace vitrine::glass::replayer
