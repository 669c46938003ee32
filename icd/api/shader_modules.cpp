// Shader modules and pipeline caches (Vulkan 1.3.239, Shaders: Shader Modules; Pipelines: Pipeline Cache).
#include "icd/object/shader_module.h"

#include <cstring>

#include "icd/edge/diagnostics.h"
#include "icd/entry_points.h"
#include "icd/object/device.h"
#include "spirv/compile.h"

namespace vitrine::icd {
namespace {

void write_identifier(const ShaderKey& key, VkShaderModuleIdentifierEXT& out) {
  static_assert(sizeof key <= VK_MAX_SHADER_MODULE_IDENTIFIER_SIZE_EXT);
  out.identifierSize = sizeof key;
  std::memcpy(out.identifier, key.data(), sizeof key);
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  Device& d = from_handle<Device>(device);
  const std::string problem = spirv::check_module({info->pCode, info->codeSize / sizeof(std::uint32_t)});
  if (!problem.empty()) {
    report_error(d, ref(d), "shader", problem);
    return VK_ERROR_INVALID_SHADER_NV;  // as other drivers do for words that are not SPIR-V
  }
  Owned<ShaderModule> object(create_object<ShaderModule>(d.memory, allocator));
  object->words.assign(info->pCode, info->pCode + info->codeSize / sizeof(std::uint32_t));
  object->identifier = identifier_of(object->words);
  *module = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyShaderModule(VkDevice, VkShaderModule module, const VkAllocationCallbacks*) {
  destroy_handle<ShaderModule>(module);
}

VKAPI_ATTR void VKAPI_CALL GetShaderModuleIdentifierEXT(VkDevice, VkShaderModule module,
                                                        VkShaderModuleIdentifierEXT* identifier) {
  write_identifier(from_handle<ShaderModule>(module).identifier, *identifier);
}

VKAPI_ATTR void VKAPI_CALL GetShaderModuleCreateInfoIdentifierEXT(VkDevice, const VkShaderModuleCreateInfo* info,
                                                                  VkShaderModuleIdentifierEXT* identifier) {
  write_identifier(identifier_of({info->pCode, info->codeSize / sizeof(std::uint32_t)}), *identifier);
}

VKAPI_ATTR VkResult VKAPI_CALL CreatePipelineCache(VkDevice device, const VkPipelineCacheCreateInfo*,
                                                   const VkAllocationCallbacks* allocator, VkPipelineCache* cache) {
  *cache = to_handle(create_object<PipelineCache>(from_handle<Device>(device).memory, allocator));
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineCache(VkDevice, VkPipelineCache cache, const VkAllocationCallbacks*) {
  destroy_handle<PipelineCache>(cache);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineCacheData(VkDevice device, VkPipelineCache, std::size_t* size, void* data) {
  const VkPhysicalDeviceProperties& properties = from_handle<Device>(device).physical_device.properties;
  VkPipelineCacheHeaderVersionOne header{};
  header.headerSize = sizeof header;
  header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
  header.vendorID = properties.vendorID;
  header.deviceID = properties.deviceID;
  std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE);
  if (!data) {
    *size = sizeof header;
    return VK_SUCCESS;
  }
  if (*size < sizeof header) {
    *size = 0;
    return VK_INCOMPLETE;
  }
  std::memcpy(data, &header, sizeof header);
  *size = sizeof header;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL MergePipelineCaches(VkDevice, VkPipelineCache, std::uint32_t, const VkPipelineCache*) {
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
