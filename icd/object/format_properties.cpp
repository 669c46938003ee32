// Capabilities of formats and images (Vulkan 1.3.239, Capabilities: Format Properties, Additional Image Capabilities).
#include "icd/object/format_properties.h"

#include <algorithm>
#include <bit>

#include "icd/edge/util.h"
#include "icd/properties.h"
#include "icd/registry/registry.h"
#include "texel/format.h"

namespace vitrine::icd {
namespace {

/// Usages that need a format feature; usages not listed need a transfer or nothing.
struct UsageRule {
  VkImageUsageFlags usage;
  VkFormatFeatureFlags any_of;
};
constexpr UsageRule kUsageRules[] = {
    {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_FORMAT_FEATURE_TRANSFER_SRC_BIT},
    {VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_FORMAT_FEATURE_TRANSFER_DST_BIT},
    {VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT},
    {VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
    {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT,
     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR,
     VK_FORMAT_FEATURE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR},
#ifdef VK_EXT_host_image_copy
    {VK_IMAGE_USAGE_HOST_TRANSFER_BIT_EXT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT},
#endif
};

constexpr VkImageUsageFlags kKnownUsages =
    VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR |
#ifdef VK_EXT_host_image_copy
    VK_IMAGE_USAGE_HOST_TRANSFER_BIT_EXT |
#endif
    VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;

constexpr VkImageCreateFlags kUnsupportedFlags = VK_IMAGE_CREATE_SPARSE_BINDING_BIT |
                                                 VK_IMAGE_CREATE_SPARSE_RESIDENCY_BIT |
                                                 VK_IMAGE_CREATE_SPARSE_ALIASED_BIT | VK_IMAGE_CREATE_PROTECTED_BIT;

bool usage_supported(VkImageUsageFlags usage, VkFormatFeatureFlags features) {
  if (usage == 0 || (usage & ~kKnownUsages) != 0) return false;
  return std::all_of(std::begin(kUsageRules), std::end(kUsageRules),
                     [&](const UsageRule& rule) { return (usage & rule.usage) == 0 || (features & rule.any_of) != 0; });
}

bool flags_supported(const VkPhysicalDeviceImageFormatInfo2& info, VkFormatFeatureFlags features) {
  if (info.flags & kUnsupportedFlags) return false;
  if ((info.flags & VK_IMAGE_CREATE_DISJOINT_BIT) && !(features & VK_FORMAT_FEATURE_DISJOINT_BIT)) return false;
  if ((info.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) && info.type != VK_IMAGE_TYPE_2D) return false;
  return !(info.flags & VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT) || info.type == VK_IMAGE_TYPE_3D;
}

VkSampleCountFlags sample_counts(const VkPhysicalDeviceImageFormatInfo2& info, VkFormatFeatureFlags features) {
  const VkPhysicalDeviceLimits& limits = kClaimedPhysicalDeviceProperties.limits;
  const bool attachment =
      features & (VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
  if (info.type != VK_IMAGE_TYPE_2D || info.tiling != VK_IMAGE_TILING_OPTIMAL || !attachment ||
      (info.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) ||
      (info.usage & VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR)) {
    return VK_SAMPLE_COUNT_1_BIT;
  }
  VkSampleCountFlags counts = limits.framebufferColorSampleCounts;
  if (features & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) counts = limits.framebufferDepthSampleCounts;
  if (info.usage & VK_IMAGE_USAGE_STORAGE_BIT) counts &= limits.storageImageSampleCounts;
  return counts;
}

VkExtent3D max_extent(VkImageType type, VkImageCreateFlags flags) {
  const VkPhysicalDeviceLimits& limits = kClaimedPhysicalDeviceProperties.limits;
  if (type == VK_IMAGE_TYPE_1D) return {limits.maxImageDimension1D, 1, 1};
  if (flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT)
    return {limits.maxImageDimensionCube, limits.maxImageDimensionCube, 1};
  if (type == VK_IMAGE_TYPE_2D) return {limits.maxImageDimension2D, limits.maxImageDimension2D, 1};
  // Wide and high as flat images; the limit holds for the depth.
  return {limits.maxImageDimension2D, limits.maxImageDimension2D, limits.maxImageDimension3D};
}

}  // namespace

VkFormatProperties format_properties(VkFormat format) {
  for (const FormatClaim& claim : format_claims()) {
    if (claim.format == format) return claim.properties;
  }
  return {};
}

VkFormatFeatureFlags2 wide_features(VkFormat format, VkFormatFeatureFlags features) {
  VkFormatFeatureFlags2 wide = features;
  const std::span<const Feature> claimed = claimed_features();
  const auto claims = [&](Feature f) { return std::find(claimed.begin(), claimed.end(), f) != claimed.end(); };
  if (features & (VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT)) {
    if (claims(Feature::shaderStorageImageReadWithoutFormat))
      wide |= VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT;
    if (claims(Feature::shaderStorageImageWriteWithoutFormat)) {
      wide |= VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    }
  }
  // Comparing samplers work on what has a depth aspect.
  const bool depth = texel::format_desc(format).aspects & VK_IMAGE_ASPECT_DEPTH_BIT;
  if (depth && (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) {
    wide |= VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT;
  }
#ifdef VK_EXT_host_image_copy
  // The host copies into and out of whatever can be sampled.
  if (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) wide |= VK_FORMAT_FEATURE_2_HOST_IMAGE_TRANSFER_BIT_EXT;
#endif
  return wide;
}

VkFormatFeatureFlags modifier_features(VkFormat format) {
  const texel::FormatDesc& desc = texel::format_desc(format);
  if (desc.is_depth_stencil() || desc.is_compressed()) return 0;
  return format_properties(format).linearTilingFeatures;
}

VkFormatFeatureFlags features_of_tiling(const VkPhysicalDeviceImageFormatInfo2& info) {
  if (info.tiling == VK_IMAGE_TILING_OPTIMAL) return format_properties(info.format).optimalTilingFeatures;
  if (info.tiling == VK_IMAGE_TILING_LINEAR) return format_properties(info.format).linearTilingFeatures;
  if (info.tiling != VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT) return 0;
  const auto* modifier = find_in_chain<VkPhysicalDeviceImageDrmFormatModifierInfoEXT>(info.pNext);
  return modifier && modifier->drmFormatModifier == kLinearModifier ? modifier_features(info.format) : 0;
}

VkResult image_format_properties(const VkPhysicalDeviceImageFormatInfo2& info, VkImageFormatProperties* out) {
  *out = {};
  const bool shared = info.tiling == VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT;
  const VkFormatFeatureFlags features = features_of_tiling(info);
  // EXTENDED_USAGE lets views of compatible formats have usages that the image's own format lacks.
  const bool usage_ok = (info.flags & VK_IMAGE_CREATE_EXTENDED_USAGE_BIT) || usage_supported(info.usage, features);
  if (features == 0 || !usage_ok || !flags_supported(info, features) || info.type > VK_IMAGE_TYPE_3D) {
    return VK_ERROR_FORMAT_NOT_SUPPORTED;
  }
  // Other devices know pictures.
  if (shared && info.type != VK_IMAGE_TYPE_2D) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  const bool conversion = texel::format_desc(info.format).requires_conversion();
  if (conversion && (info.type != VK_IMAGE_TYPE_2D || (info.flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT))) {
    return VK_ERROR_FORMAT_NOT_SUPPORTED;
  }
  const VkPhysicalDeviceLimits& limits = kClaimedPhysicalDeviceProperties.limits;
  out->maxExtent = max_extent(info.type, info.flags);
  out->maxMipLevels = conversion || shared ? 1 : static_cast<std::uint32_t>(std::bit_width(out->maxExtent.width));
  out->maxArrayLayers = info.type == VK_IMAGE_TYPE_3D ? 1 : limits.maxImageArrayLayers;
  out->sampleCounts = conversion ? VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT} : sample_counts(info, features);
  // An image fills one allocation at most.
  out->maxResourceSize = kClaimedPhysicalDeviceMaintenance3Properties.maxMemoryAllocationSize;
  return VK_SUCCESS;
}

}  // namespace vitrine::icd
