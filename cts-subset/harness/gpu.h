// The two devices of the suite, in one instance of the real loader.
#pragma once

#include <vulkan/vulkan.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "cts-subset/extensions.h"

namespace vitrine::cts {

/// A Vulkan call returned an error: the case fails on this device.
struct VulkanError : std::runtime_error {
  VulkanError(VkResult code, const char* call);
  VkResult code;
};
/// The device does not claim what the case needs: counted as unsupported, not as a failure.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws VulkanError for negative results.
void check(VkResult result, const char* call);
#define CTS_VK(call) ::vitrine::cts::check((call), #call)

struct Gpu {
  std::string name;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceFeatures features{};     ///< all that the device offers; all are enabled
  ExtensionFeatures extension_features{};  ///< offered and enabled; all false where the extension is missing
  std::vector<std::string> extensions;     ///< of kWantedExtensions: offered and enabled
  std::vector<std::string> offered;        ///< all extensions of the device
  VkPhysicalDeviceMemoryProperties memory{};
  std::map<VkFormat, VkFormatProperties> recorded_formats;  ///< of a device that is only recorded (claims.h)

  VkFormatProperties format_properties(VkFormat format) const;
  VkFormatFeatureFlags features_of(VkFormat format, VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL) const;
  /// Index of a memory type out of `allowed` with all of `wanted`.
  uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const;
  bool has(const char* extension) const;
  PFN_vkVoidFunction command(const char* name) const;
};

/// A command of an extension: CTS_COMMAND(run.gpu, CmdCopyBuffer2KHR)(cmd, &info). Null if the device does not have it.
#define CTS_COMMAND(gpu, name) (reinterpret_cast<PFN_vk##name>((gpu).command("vk" #name)))

struct Gpus {
  VkInstance instance = VK_NULL_HANDLE;
  uint32_t api_version = VK_API_VERSION_1_0;  ///< what both devices support, at most 1.1
  Gpu device, reference;
  bool same_driver = false;  ///< the reference stands on both sides: the suite tests itself
};

/// Creates both devices at the first call. Throws if a driver cannot be found. Where the reference is recorded, it can
/// be asked what it claims, and no more.
Gpus& gpus();
/// Fills `extensions` from `offered`.
void keep_wanted_extensions(Gpu& gpu);
/// The driver's own name of its version (VkPhysicalDeviceDriverProperties::driverInfo).
std::string driver_info(const Gpu& gpu);
/// Destroys and creates a device again, after it was lost.
void recreate(Gpu& gpu);
void destroy_gpus();

/// Validation errors since the last call, each once.
std::vector<std::string> take_validation_errors();
/// What a tool of this driver (VITRINE_TOOLS) said of a shader: the rule that it breaks, and the message.
struct Finding {
  std::string rule, message;
};
/// Findings since the last call. Only faults, no warnings.
std::vector<Finding> take_findings();
/// Whether the validation layer is there and on.
bool validation_is_on();

}  // namespace vitrine::cts
