// VkShaderModule and VkPipelineCache.
#pragma once

#include "icd/object.h"

namespace vitrine::icd {

/// The words as given; pipelines compile them.
struct ShaderModule : Object<VkShaderModule, VK_OBJECT_TYPE_SHADER_MODULE> {
  explicit ShaderModule(const HostMemory& m) : Object(m), words(m) {}
  Vector<std::uint32_t> words;
};

/// Interpreted pipelines are ready in microseconds, so nothing is worth keeping: the data is a valid header alone.
struct PipelineCache : Object<VkPipelineCache, VK_OBJECT_TYPE_PIPELINE_CACHE> {
  using Object::Object;
};

}  // namespace vitrine::icd
