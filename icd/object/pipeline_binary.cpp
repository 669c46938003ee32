// See pipeline_binary.h: pipelines and their binaries.
#include "icd/object/pipeline_binary.h"

#include "icd/edge/util.h"

namespace vitrine::icd {

bool captures_binaries([[maybe_unused]] VkPipelineCreateFlags flags) {
#ifdef VK_KHR_pipeline_binary
  return flags & VK_PIPELINE_CREATE_2_CAPTURE_DATA_BIT_KHR;
#else
  return false;
#endif
}

KeptStages stages_of_binaries([[maybe_unused]] const void* chain, const HostMemory& memory) {
  KeptStages out(memory);
#ifdef VK_KHR_pipeline_binary
  const auto* info = find_in_chain<VkPipelineBinaryInfoKHR>(chain);
  for (std::uint32_t i = 0; info && i < info->binaryCount; ++i)
    if (const auto* binary = from_nullable<PipelineBinary>(info->pPipelineBinaries[i]))
      out.push_back(binary->stage);
    else
      out.push_back(nullptr);
#endif
  return out;
}

std::string mismatch(const KeptStages& given, std::span<const VkShaderStageFlagBits> stages) {
  if (given.size() != stages.size())
    return "pipeline binaries for " + std::to_string(given.size()) + " stages are given to a pipeline that has " +
           std::to_string(stages.size());
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (!given[i]) return "pipeline binary " + std::to_string(i) + " is VK_NULL_HANDLE";
    if (given[i]->stage != stages[i])
      return "pipeline binary " + std::to_string(i) + " is of a " + stage_name(given[i]->stage) +
             " stage, in the place of a " + stage_name(stages[i]) + " stage";
  }
  return {};
}

}  // namespace vitrine::icd
