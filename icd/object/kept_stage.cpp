// Copies of stages, and the structures of the API over them.
#include "icd/object/kept_stage.h"

#include "icd/edge/util.h"

namespace vitrine::icd {

StageInfo::StageInfo(const KeptStage& kept)
    : module_(make_struct<VkShaderModuleCreateInfo>()),
      subgroup_size_(make_struct<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>()),
      specialization_{static_cast<std::uint32_t>(kept.map.size()), kept.map.data(), kept.data.size(), kept.data.data()},
      stage_(make_struct<VkPipelineShaderStageCreateInfo>(&module_)) {
  module_.codeSize = kept.words.size() * sizeof(std::uint32_t);
  module_.pCode = kept.words.data();
  subgroup_size_.requiredSubgroupSize = kept.subgroup_size;
  if (kept.subgroup_size) module_.pNext = &subgroup_size_;
  stage_.stage = kept.stage;
  stage_.pName = kept.entry_point.c_str();
  stage_.pSpecializationInfo = &specialization_;
}

KeptStage copy_stage(const VkPipelineShaderStageCreateInfo& stage, const HostMemory& memory) {
  KeptStage out(memory);
  out.stage = stage.stage;
  const std::span<const std::uint32_t> words = words_of(stage);
  out.words.assign(words.begin(), words.end());
  out.entry_point = stage.pName;
  if (const auto* size = find_in_chain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(stage.pNext)) {
    out.subgroup_size = size->requiredSubgroupSize;
  }
  if (const VkSpecializationInfo* s = stage.pSpecializationInfo) {
    out.map.assign(s->pMapEntries, s->pMapEntries + s->mapEntryCount);
    const auto* bytes = static_cast<const std::byte*>(s->pData);
    out.data.assign(bytes, bytes + s->dataSize);
  }
  return out;
}

}  // namespace vitrine::icd
