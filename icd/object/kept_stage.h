// A stage of a pipeline as the application gave it, kept to be compiled later (of a library when it is linked, of a
// device with performance queries when one of them sees it) or to be given back (binaries).
#pragma once

#include <memory>

#include "icd/object/shader_module.h"

namespace vitrine::icd {

/// Copies of what the application gave.
struct KeptStage {
  explicit KeptStage(const HostMemory& m) : words(m), entry_point(m), map(m), data(m) {}

  VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
  Vector<std::uint32_t> words;
  String entry_point;
  std::uint32_t subgroup_size = 0;       ///< required; 0: none is
  Vector<VkSpecializationMapEntry> map;  ///< in the application's order
  Vector<std::byte> data;                ///< of each entry in turn, without gaps
};

/// Stages that several pipelines may share, in memory of the device.
using KeptStages = Vector<std::shared_ptr<const KeptStage>>;

/// Such a stage as a create info, which points to it.
class StageInfo {
 public:
  explicit StageInfo(const KeptStage& kept);
  StageInfo(const StageInfo&) = delete;
  StageInfo& operator=(const StageInfo&) = delete;
  const VkPipelineShaderStageCreateInfo& info() const { return stage_; }

 private:
  VkShaderModuleCreateInfo module_;
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup_size_;
  VkSpecializationInfo specialization_;
  VkPipelineShaderStageCreateInfo stage_;
};

/// What a stage is specialized with. `info` may be null.
void copy_specialization(const VkSpecializationInfo* info, KeptStage& out);

/// Without words if the application names them by their identifier alone.
std::shared_ptr<KeptStage> keep_stage(const VkPipelineShaderStageCreateInfo& stage, const HostMemory& memory);

}  // namespace vitrine::icd
