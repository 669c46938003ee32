// What runs of the fuzzer of the API share: a device with every feature on, shaders that use what they are given
// without looking, and a layout of descriptors for all of them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "icd/edge/util.h"
#include "icd/edge/vulkan_api.h"

extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name);

namespace vitrine::fuzz {

#define FUZZ_CALL(instance, name) reinterpret_cast<PFN_vk##name>(vk_icdGetInstanceProcAddr(instance, "vk" #name))

/// Bindings of set 0.
inline constexpr std::array<VkDescriptorType, 6> kBindings{
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,         VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,   VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};
inline constexpr std::uint32_t kPushBytes = 32;

struct World {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::vector<VkShaderModule> vertex, control, evaluation, geometry, fragment, compute;
};

/// Ends the process with a message where something that must work does not.
void demand(bool condition, const std::string& what);

/// The world as it is now; made at the first call.
World& world();
/// The device is lost: another one.
void replace_device();

/// A run over the bytes. Ends the process where the driver gives an error that it must not give.
void run_api(const std::uint8_t* data, std::size_t size);

}  // namespace vitrine::fuzz
