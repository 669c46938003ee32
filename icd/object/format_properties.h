// What formats and images can be used for: the claims of manifest/formats, asked by the entry points of physical
// devices and by object creation.
#pragma once

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// Zero features for formats that are not claimed.
VkFormatProperties format_properties(VkFormat format);

/// The features of a tiling with those that 32 bits have no room for (VkFormatProperties3).
VkFormatFeatureFlags2 wide_features(VkFormat format, VkFormatFeatureFlags features);

/// Answers vkGetPhysicalDeviceImageFormatProperties2 without its chains. VK_ERROR_FORMAT_NOT_SUPPORTED leaves *out
/// zero.
VkResult image_format_properties(const VkPhysicalDeviceImageFormatInfo2& info, VkImageFormatProperties* out);

}  // namespace vitrine::icd
