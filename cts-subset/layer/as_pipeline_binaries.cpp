// Pipelines of an application from binaries (VK_KHR_pipeline_binary): a library to be loaded in front of the loader
// (LD_PRELOAD). On devices that offer the extension it makes each pipeline once more, keeps the data of its binaries,
// and when nothing of it is left makes it from those, without its modules: whole pipelines, libraries, and those that
// link them. Results must not change. Pipelines with feedback, or that may not be compiled, stay as they are.
//
// LAYER_COUNTS=FILE appends how many pipelines with stages were replaced, and how many were not, when the process ends.
#include <map>
#include <mutex>

#include "layer.h"

#ifdef VK_KHR_pipeline_binary
namespace {

namespace layer = vitrine::layer;

struct Functions {
  explicit Functions(VkDevice d)
      : device(d),
        create(load<PFN_vkCreatePipelineBinariesKHR>("vkCreatePipelineBinariesKHR")),
        destroy(load<PFN_vkDestroyPipelineBinaryKHR>("vkDestroyPipelineBinaryKHR")),
        get_data(load<PFN_vkGetPipelineBinaryDataKHR>("vkGetPipelineBinaryDataKHR")) {}
  template <class F>
  F load(const char* name) const {
    return reinterpret_cast<F>(vkGetDeviceProcAddr(device, name));
  }

  VkDevice device;
  PFN_vkCreatePipelineBinariesKHR create;
  PFN_vkDestroyPipelineBinaryKHR destroy;
  PFN_vkGetPipelineBinaryDataKHR get_data;
};

std::mutex g_mutex;
std::map<VkDevice, Functions> g_devices;
layer::Counts g_counts;

using Binaries = std::vector<VkPipelineBinaryKHR>;

/// What is kept of binaries.
struct Kept {
  std::vector<VkPipelineBinaryKeyKHR> keys;
  std::vector<std::vector<char>> data;
};

VkResult make_binaries(const Functions& f, const VkPipelineBinaryCreateInfoKHR& from, Binaries& out) {
  VkPipelineBinaryHandlesInfoKHR handles{VK_STRUCTURE_TYPE_PIPELINE_BINARY_HANDLES_INFO_KHR};
  VkResult result = f.create(f.device, &from, nullptr, &handles);
  if (result != VK_SUCCESS || !handles.pipelineBinaryCount) return result;
  out.resize(handles.pipelineBinaryCount);
  handles.pPipelineBinaries = out.data();
  return f.create(f.device, &from, nullptr, &handles);
}

void destroy_binaries(const Functions& f, const Binaries& binaries) {
  for (const VkPipelineBinaryKHR binary : binaries) f.destroy(f.device, binary, nullptr);
}

VkResult keep(const Functions& f, VkPipeline pipeline, Kept& kept) {
  VkPipelineBinaryCreateInfoKHR from{VK_STRUCTURE_TYPE_PIPELINE_BINARY_CREATE_INFO_KHR};
  from.pipeline = pipeline;
  Binaries binaries;
  VkResult result = make_binaries(f, from, binaries);
  for (std::size_t i = 0; result == VK_SUCCESS && i < binaries.size(); ++i) {
    const VkPipelineBinaryDataInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_BINARY_DATA_INFO_KHR, nullptr, binaries[i]};
    auto& key = kept.keys.emplace_back(VkPipelineBinaryKeyKHR{VK_STRUCTURE_TYPE_PIPELINE_BINARY_KEY_KHR});
    auto& data = kept.data.emplace_back();
    std::size_t size = 0;
    result = f.get_data(f.device, &info, &key, &size, nullptr);
    data.resize(size);
    if (result == VK_SUCCESS) result = f.get_data(f.device, &info, &key, &size, data.data());
  }
  destroy_binaries(f, binaries);
  return result;
}

VkResult read(const Functions& f, Kept& kept, Binaries& out) {
  std::vector<VkPipelineBinaryDataKHR> data;
  for (std::vector<char>& bytes : kept.data) data.push_back({bytes.size(), bytes.data()});
  const VkPipelineBinaryKeysAndDataKHR given{static_cast<uint32_t>(data.size()), kept.keys.data(), data.data()};
  VkPipelineBinaryCreateInfoKHR from{VK_STRUCTURE_TYPE_PIPELINE_BINARY_CREATE_INFO_KHR};
  from.pKeysAndDataInfo = &given;
  return make_binaries(f, from, out);
}

/// The info with its modules left out, as far as `stages` lives.
VkGraphicsPipelineCreateInfo without_modules(VkGraphicsPipelineCreateInfo info,
                                             std::vector<VkPipelineShaderStageCreateInfo>& stages) {
  stages = layer::copy(info.pStages, info.stageCount);
  for (VkPipelineShaderStageCreateInfo& stage : stages) stage.module = VK_NULL_HANDLE;
  info.pStages = stages.data();
  return info;
}

VkComputePipelineCreateInfo without_modules(VkComputePipelineCreateInfo info,
                                            std::vector<VkPipelineShaderStageCreateInfo>&) {
  info.stage.module = VK_NULL_HANDLE;
  return info;
}

template <class Info>
bool replaceable(const Info& info) {
  return !(info.flags & VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT) &&
         !layer::in_chain<void>(info.pNext, VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO) &&
         !layer::in_chain<void>(info.pNext, VK_STRUCTURE_TYPE_PIPELINE_CREATE_FLAGS_2_CREATE_INFO_KHR);
}

/// Puts the pipeline from binaries in the place of the one that `info` made. `create` makes one of an info.
template <class Info, class Create>
VkResult replace(const Functions& f, const Info& info, const VkAllocationCallbacks* allocator, VkPipeline& pipeline,
                 Create create) {
  VkPipelineCreateFlags2CreateInfoKHR flags{VK_STRUCTURE_TYPE_PIPELINE_CREATE_FLAGS_2_CREATE_INFO_KHR, info.pNext,
                                            info.flags | VK_PIPELINE_CREATE_2_CAPTURE_DATA_BIT_KHR};
  Info more = info;
  more.pNext = &flags;
  VkPipeline captured = VK_NULL_HANDLE;
  Kept kept;
  VkResult result = create(more, captured);
  if (result == VK_SUCCESS) result = keep(f, captured, kept);
  NEXT(vkDestroyPipeline)(f.device, captured, allocator);
  if (result != VK_SUCCESS || kept.keys.empty()) return result;
  ++g_counts.replaced;
  NEXT(vkDestroyPipeline)(f.device, pipeline, allocator);
  pipeline = VK_NULL_HANDLE;
  Binaries binaries;
  result = read(f, kept, binaries);
  const VkPipelineBinaryInfoKHR given{VK_STRUCTURE_TYPE_PIPELINE_BINARY_INFO_KHR, &flags,
                                      static_cast<uint32_t>(binaries.size()), binaries.data()};
  flags.flags = info.flags;
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  more = without_modules(info, stages);
  more.pNext = &given;
  if (result == VK_SUCCESS) result = create(more, pipeline);
  destroy_binaries(f, binaries);
  return result;
}

template <class Info, class Create>
VkResult replace_all(VkDevice device, uint32_t count, const Info* infos, const VkAllocationCallbacks* allocator,
                     VkPipeline* pipelines, Create create) {
  const std::lock_guard lock(g_mutex);
  const auto found = g_devices.find(device);
  VkResult result = VK_SUCCESS;
  for (uint32_t i = 0; found != g_devices.end() && i < count && result == VK_SUCCESS; ++i) {
    if (replaceable(infos[i]))
      result = replace(found->second, infos[i], allocator, pipelines[i], create);
    else
      ++g_counts.left;
  }
  return result;
}

}  // namespace

extern "C" {

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDevice* device) {
  if (!layer::offers(physical, VK_KHR_PIPELINE_BINARY_EXTENSION_NAME))
    return NEXT(vkCreateDevice)(physical, info, allocator, device);
  const std::vector<const char*> names =
      layer::names_with(*info, {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, VK_KHR_MAINTENANCE_5_EXTENSION_NAME,
                                VK_KHR_PIPELINE_BINARY_EXTENSION_NAME});
  VkPhysicalDevicePipelineBinaryFeaturesKHR feature{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_BINARY_FEATURES_KHR,
                                                    const_cast<void*>(info->pNext), VK_TRUE};
  VkDeviceCreateInfo more = *info;
  more.pNext = &feature;
  more.enabledExtensionCount = static_cast<uint32_t>(names.size());
  more.ppEnabledExtensionNames = names.data();
  const VkResult result = NEXT(vkCreateDevice)(physical, &more, allocator, device);
  const std::lock_guard lock(g_mutex);
  if (result == VK_SUCCESS) g_devices.insert_or_assign(*device, Functions(*device));
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                         const VkGraphicsPipelineCreateInfo* infos,
                                                         const VkAllocationCallbacks* allocator,
                                                         VkPipeline* pipelines) {
  const VkResult result = NEXT(vkCreateGraphicsPipelines)(device, cache, count, infos, allocator, pipelines);
  if (result != VK_SUCCESS) return result;
  return replace_all(device, count, infos, allocator, pipelines,
                     [&](const VkGraphicsPipelineCreateInfo& info, VkPipeline& out) {
                       return NEXT(vkCreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, allocator, &out);
                     });
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                        const VkComputePipelineCreateInfo* infos,
                                                        const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  const VkResult result = NEXT(vkCreateComputePipelines)(device, cache, count, infos, allocator, pipelines);
  if (result != VK_SUCCESS) return result;
  return replace_all(device, count, infos, allocator, pipelines,
                     [&](const VkComputePipelineCreateInfo& info, VkPipeline& out) {
                       return NEXT(vkCreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, allocator, &out);
                     });
}
}
#endif
