// Draws and dispatches of an application as shader objects (VK_EXT_shader_object): a library to be loaded in front of
// the loader (LD_PRELOAD). On devices that offer the extension it makes shader objects beside each pipeline, and where
// the pipeline is bound it binds them and sets by commands what the pipeline has for good. Results must not change.
//
// Shader objects cannot be everything that a pipeline can (convertible()); such pipelines are bound as they are, so
// that both kinds alternate. They are bound inside of render pass objects, too, which the specification does not allow
// and this driver does not mind: the suite draws mostly there.
//
// LAYER_COUNTS=FILE appends how many pipelines became shader objects, and how many did not, when the process ends.
#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "state_commands.h"

#ifdef VK_EXT_shader_object
namespace {

using namespace vitrine::as_shader_objects;
namespace layer = vitrine::layer;

/// What is bound in a pipeline's place.
struct Converted {
  std::vector<VkShaderStageFlagBits> stages;
  std::vector<VkShaderEXT> shaders;
  std::vector<Set> states;
};

struct Layout {
  std::vector<VkDescriptorSetLayout> sets;
  std::vector<VkPushConstantRange> ranges;
};

std::recursive_mutex g_mutex;
std::map<VkDevice, std::unique_ptr<Functions>> g_devices;
std::map<VkCommandBuffer, const Functions*> g_buffers;
std::map<VkShaderModule, std::vector<uint32_t>> g_modules;
std::map<VkPipelineLayout, Layout> g_layouts;
std::map<VkPipeline, Converted> g_pipelines;

layer::Counts g_counts;

const Functions* functions_of(VkDevice device) {
  const auto found = g_devices.find(device);
  return found == g_devices.end() ? nullptr : found->second.get();
}

constexpr VkShaderStageFlagBits kGraphicsStages[] = {
    VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
    VK_SHADER_STAGE_GEOMETRY_BIT, VK_SHADER_STAGE_FRAGMENT_BIT};

/// False: they could not be made.
bool make_shaders(const Functions& f, const VkPipelineShaderStageCreateInfo* stages, uint32_t count,
                  VkPipelineLayout layout, Converted& out) {
  const auto known = g_layouts.find(layout);
  if (known == g_layouts.end()) return false;
  std::vector<VkShaderCreateInfoEXT> infos;
  for (uint32_t i = 0; i < count; ++i) {
    const VkPipelineShaderStageCreateInfo& stage = stages[i];
    const auto module = g_modules.find(stage.module);
    if (module == g_modules.end() || stage.flags) return false;
    VkShaderCreateInfoEXT info{VK_STRUCTURE_TYPE_SHADER_CREATE_INFO_EXT, nullptr};
    info.pNext =
        in_chain<void>(stage.pNext, VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO);
    info.stage = stage.stage;
    info.codeType = VK_SHADER_CODE_TYPE_SPIRV_EXT;
    info.codeSize = module->second.size() * 4;
    info.pCode = module->second.data();
    info.pName = stage.pName;
    info.setLayoutCount = static_cast<uint32_t>(known->second.sets.size());
    info.pSetLayouts = known->second.sets.data();
    info.pushConstantRangeCount = static_cast<uint32_t>(known->second.ranges.size());
    info.pPushConstantRanges = known->second.ranges.data();
    info.pSpecializationInfo = stage.pSpecializationInfo;
    infos.push_back(info);
    out.stages.push_back(stage.stage);
  }
  out.shaders.resize(count);
  if (f.CreateShadersEXT(f.device, count, infos.data(), nullptr, out.shaders.data()) == VK_SUCCESS) return true;
  for (const VkShaderEXT shader : out.shaders) f.DestroyShaderEXT(f.device, shader, nullptr);
  return false;
}

bool convert(const Functions& f, const VkGraphicsPipelineCreateInfo& info, Converted& out) {
  if (in_chain<void>(info.pNext, VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR)) return false;
  if (in_chain<void>(info.pNext, VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_LIBRARY_CREATE_INFO_EXT)) return false;
  if (!convertible(info) || !make_shaders(f, info.pStages, info.stageCount, info.layout, out)) return false;
  for (const VkShaderStageFlagBits stage : kGraphicsStages) {
    if (std::find(out.stages.begin(), out.stages.end(), stage) != out.stages.end()) continue;
    out.stages.push_back(stage);
    out.shaders.push_back(VK_NULL_HANDLE);
  }
  out.states = state_commands(f, info);
  return true;
}

bool convert(const Functions& f, const VkComputePipelineCreateInfo& info, Converted& out) {
  return make_shaders(f, &info.stage, 1, info.layout, out);
}

template <class Info>
void convert_all(VkDevice device, uint32_t count, const Info* infos, const VkPipeline* pipelines) {
  const std::lock_guard lock(g_mutex);
  const Functions* f = functions_of(device);
  if (!f) return;
  for (uint32_t i = 0; i < count; ++i) {
    Converted made;
    const bool converted = pipelines[i] && convert(*f, infos[i], made);
    ++(converted ? g_counts.replaced : g_counts.left);
    if (converted) g_pipelines[pipelines[i]] = std::move(made);
  }
}

}  // namespace

extern "C" {

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDevice* device) {
  if (!layer::offers(physical, VK_EXT_SHADER_OBJECT_EXTENSION_NAME))
    return NEXT(vkCreateDevice)(physical, info, allocator, device);
  const std::vector<const char*> names =
      layer::names_with(*info, {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, VK_EXT_SHADER_OBJECT_EXTENSION_NAME});
  VkPhysicalDeviceShaderObjectFeaturesEXT feature{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_OBJECT_FEATURES_EXT,
                                                  const_cast<void*>(info->pNext), VK_TRUE};
  VkDeviceCreateInfo more = *info;
  more.pNext = &feature;
  more.enabledExtensionCount = static_cast<uint32_t>(names.size());
  more.ppEnabledExtensionNames = names.data();
  const VkResult result = NEXT(vkCreateDevice)(physical, &more, allocator, device);
  const std::lock_guard lock(g_mutex);
  if (result == VK_SUCCESS) g_devices[*device] = std::make_unique<Functions>(*device);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkAllocateCommandBuffers(VkDevice device, const VkCommandBufferAllocateInfo* info,
                                                        VkCommandBuffer* buffers) {
  const VkResult result = NEXT(vkAllocateCommandBuffers)(device, info, buffers);
  const std::lock_guard lock(g_mutex);
  for (uint32_t i = 0; result == VK_SUCCESS && i < info->commandBufferCount; ++i)
    g_buffers[buffers[i]] = functions_of(device);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  const VkResult result = NEXT(vkCreateShaderModule)(device, info, allocator, module);
  const std::lock_guard lock(g_mutex);
  if (result == VK_SUCCESS) g_modules[*module].assign(info->pCode, info->pCode + info->codeSize / 4);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreatePipelineLayout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                                      const VkAllocationCallbacks* allocator,
                                                      VkPipelineLayout* layout) {
  const VkResult result = NEXT(vkCreatePipelineLayout)(device, info, allocator, layout);
  const std::lock_guard lock(g_mutex);
  if (result == VK_SUCCESS)
    g_layouts[*layout] = {copy(info->pSetLayouts, info->setLayoutCount),
                          copy(info->pPushConstantRanges, info->pushConstantRangeCount)};
  return result;
}

/// Pipeline layouts may still name it.
VKAPI_ATTR void VKAPI_CALL vkDestroyDescriptorSetLayout(VkDevice device, VkDescriptorSetLayout layout,
                                                        const VkAllocationCallbacks* allocator) {
  const std::lock_guard lock(g_mutex);
  if (!functions_of(device)) NEXT(vkDestroyDescriptorSetLayout)(device, layout, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                         const VkGraphicsPipelineCreateInfo* infos,
                                                         const VkAllocationCallbacks* allocator,
                                                         VkPipeline* pipelines) {
  const VkResult result = NEXT(vkCreateGraphicsPipelines)(device, cache, count, infos, allocator, pipelines);
  if (result == VK_SUCCESS) convert_all(device, count, infos, pipelines);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                        const VkComputePipelineCreateInfo* infos,
                                                        const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  const VkResult result = NEXT(vkCreateComputePipelines)(device, cache, count, infos, allocator, pipelines);
  if (result == VK_SUCCESS) convert_all(device, count, infos, pipelines);
  return result;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyPipeline(VkDevice device, VkPipeline pipeline,
                                             const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard lock(g_mutex);
    const auto found = g_pipelines.find(pipeline);
    const Functions* f = functions_of(device);
    if (f && found != g_pipelines.end()) {
      for (const VkShaderEXT shader : found->second.shaders) f->DestroyShaderEXT(device, shader, nullptr);
      g_pipelines.erase(found);
    }
  }
  NEXT(vkDestroyPipeline)(device, pipeline, allocator);
}

VKAPI_ATTR void VKAPI_CALL vkCmdBindPipeline(VkCommandBuffer buffer, VkPipelineBindPoint point, VkPipeline pipeline) {
  const std::lock_guard lock(g_mutex);
  const auto found = g_pipelines.find(pipeline);
  const auto known = g_buffers.find(buffer);
  const Functions* f = known == g_buffers.end() ? nullptr : known->second;
  if (!f || found == g_pipelines.end()) return NEXT(vkCmdBindPipeline)(buffer, point, pipeline);
  const Converted& c = found->second;
  for (const Set& set : c.states) set(*f, buffer);
  f->CmdBindShadersEXT(buffer, static_cast<uint32_t>(c.stages.size()), c.stages.data(), c.shaders.data());
}
}
#endif
