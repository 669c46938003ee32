// VkShaderModule and VkPipelineCache.
#pragma once

#include <memory>
#include <mutex>
#include <span>

#include "icd/object/object.h"
#include "icd/object/shader_table.h"

namespace vitrine::icd {

/// The words as given; pipelines compile them.
struct ShaderModule : Object<VkShaderModule, VK_OBJECT_TYPE_SHADER_MODULE> {
  explicit ShaderModule(const HostMemory& m) : Object(m), words(m) {}
  Vector<std::uint32_t> words;
  ShaderKey identifier{};  ///< of the words
};

/// The words of a stage: its module's, or those in the VkShaderModuleCreateInfo that stands for one.
std::span<const std::uint32_t> words_of(const VkPipelineShaderStageCreateInfo& stage);

/// What stands for the words: the same for equal ones, in every process (VK_EXT_shader_module_identifier).
ShaderKey identifier_of(std::span<const std::uint32_t> words);
/// Of a stage's words, or of those that it names by their identifier alone.
ShaderKey identifier_of(const VkPipelineShaderStageCreateInfo& stage);

struct CompiledShader;

/// Keeps compiled shaders alive (icd/object/shader_cache.h). Nothing is worth writing down, because a pipeline is ready
/// in microseconds: the data is a valid header alone.
struct PipelineCache : Object<VkPipelineCache, VK_OBJECT_TYPE_PIPELINE_CACHE> {
  explicit PipelineCache(const HostMemory& m) : Object(m), kept(m) {}

  std::mutex mutex;
  Vector<std::shared_ptr<const CompiledShader>> kept;
};

}  // namespace vitrine::icd
