// What runs of the fuzzer of the API share: a device with every feature on, shaders that use what they are given
// without looking, and a layout of descriptors for all of them.
#pragma once

#include <array>
#include <vector>

#include "icd/edge/util.h"
#include "icd/edge/vulkan_api.h"
#include "tests/fuzz/driver.h"

namespace vitrine::fuzz {

/// Bindings of set 0.
inline constexpr std::array<VkDescriptorType, 6> kBindings{
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,         VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,   VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};
inline constexpr std::uint32_t kPushBytes = 32;

struct World : Driver {
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipelineCache pipelines = VK_NULL_HANDLE;  ///< the few shaders are translated once, not for each run
  std::vector<VkShaderModule> vertex, control, evaluation, geometry, fragment, compute;
};

/// The world as it is now; made at the first call.
World& world();
/// The device is lost: another one.
void replace_device();

}  // namespace vitrine::fuzz
