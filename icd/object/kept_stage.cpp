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

void copy_specialization(const VkSpecializationInfo* info, KeptStage& out) {
  if (!info) return;
  const auto* bytes = static_cast<const std::byte*>(info->pData);
  for (std::uint32_t i = 0; i < info->mapEntryCount; ++i) {
    const VkSpecializationMapEntry& entry = info->pMapEntries[i];
    out.map.push_back({entry.constantID, static_cast<std::uint32_t>(out.data.size()), entry.size});
    out.data.insert(out.data.end(), bytes + entry.offset, bytes + entry.offset + entry.size);
  }
}

std::shared_ptr<KeptStage> keep_stage(const VkPipelineShaderStageCreateInfo& stage, const HostMemory& memory) {
  const auto out = std::allocate_shared<KeptStage>(HostAllocator<KeptStage>(memory), memory);
  out->stage = stage.stage;
  const std::span<const std::uint32_t> words = words_of(stage);
  out->words.assign(words.begin(), words.end());
  out->entry_point = stage.pName;
  if (const auto* size = find_in_chain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(stage.pNext)) {
    out->subgroup_size = size->requiredSubgroupSize;
  }
  copy_specialization(stage.pSpecializationInfo, *out);
  return out;
}

}  // namespace vitrine::icd
