// What formats and images can be used for: the claims of manifest/formats, asked by the entry points of physical
// devices and by object creation.
#pragma once

#include <cstdint>

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// Zero features for formats that are not claimed.
VkFormatProperties format_properties(VkFormat format);

/// The features of a tiling with those that 32 bits have no room for (VkFormatProperties3).
VkFormatFeatureFlags2 wide_features(VkFormat format, VkFormatFeatureFlags features);

/// DRM_FORMAT_MOD_LINEAR, the one modifier of this device (VK_EXT_image_drm_format_modifier).
inline constexpr std::uint64_t kLinearModifier = 0;

/// What images of the linear modifier can be used for. Zero where it is not offered: for depth, stencil and compressed
/// formats, which no other device would understand.
VkFormatFeatureFlags modifier_features(VkFormat format);

/// What an image of the tiling, and of the modifier that the chain names, can be used for. Zero for tilings and
/// modifiers that this device does not know.
VkFormatFeatureFlags features_of_tiling(const VkPhysicalDeviceImageFormatInfo2& info);

/// Answers vkGetPhysicalDeviceImageFormatProperties2 of the chain only as far as the modifier.
/// VK_ERROR_FORMAT_NOT_SUPPORTED leaves *out zero.
VkResult image_format_properties(const VkPhysicalDeviceImageFormatInfo2& info, VkImageFormatProperties* out);

}  // namespace vitrine::icd
