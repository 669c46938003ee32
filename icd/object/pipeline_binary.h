// VkPipelineBinaryKHR: a stage of a pipeline by itself (Vulkan 1.4.309, Pipelines: Pipeline Binaries). A pipeline has
// one for each of its stages: first those of libraries that it links, in their order, then its own in the order of
// pStages. Only what makes the stage is in it (icd/object/stage_binary.h); state and layout come with the create info.
#pragma once

#include <span>
#include <string>

#include "icd/object/device.h"
#include "icd/object/pipeline.h"

namespace vitrine::icd {

/// Whether pipelines with these flags keep what binaries are made from.
bool captures_binaries(VkPipelineCreateFlags flags);

/// What the binaries in the chain of a create info give in place of its stages and of those of its libraries; empty:
/// none are there.
KeptStages stages_of_binaries(const void* chain, const HostMemory& memory);

/// Empty, or why they cannot stand for a pipeline of these stages.
std::string mismatch(const KeptStages& given, std::span<const VkShaderStageFlagBits> stages);

#ifdef VK_KHR_pipeline_binary
struct PipelineBinary : Object<VkPipelineBinaryKHR, VK_OBJECT_TYPE_PIPELINE_BINARY_KHR> {
  PipelineBinary(const HostMemory& m, std::shared_ptr<const KeptStage> s) : Object(m), stage(std::move(s)) {}
  const std::shared_ptr<const KeptStage> stage;
};
#endif

}  // namespace vitrine::icd
