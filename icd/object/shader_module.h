// VkShaderModule and VkPipelineCache.
#pragma once

#include <memory>
#include <mutex>
#include <span>

#include "icd/object/object.h"

namespace vitrine::icd {

/// The words as given; pipelines compile them.
struct ShaderModule : Object<VkShaderModule, VK_OBJECT_TYPE_SHADER_MODULE> {
  explicit ShaderModule(const HostMemory& m) : Object(m), words(m) {}
  Vector<std::uint32_t> words;
};

/// The words of a stage: its module's, or those in the VkShaderModuleCreateInfo that stands for one.
std::span<const std::uint32_t> words_of(const VkPipelineShaderStageCreateInfo& stage);

struct CompiledShader;

/// Keeps compiled shaders alive (icd/object/shader_cache.h). Nothing is worth writing down, because a pipeline is ready
/// in microseconds: the data is a valid header alone.
struct PipelineCache : Object<VkPipelineCache, VK_OBJECT_TYPE_PIPELINE_CACHE> {
  explicit PipelineCache(const HostMemory& m) : Object(m), kept(m) {}

  std::mutex mutex;
  Vector<std::shared_ptr<const CompiledShader>> kept;
};

}  // namespace vitrine::icd
