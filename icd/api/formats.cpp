// Format and image capabilities of physical devices (Vulkan 1.3.239, Capabilities; Sparse Resources).
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/external.h"
#include "icd/object/format_properties.h"
#include "icd/properties.h"
#include "icd/registry/registry.h"
#include "raster/fragment_rate.h"
#include "texel/format.h"

namespace vitrine::icd {
namespace {

/// The modifiers of a format: the linear one where it is offered, in both widths of the flags.
template <class List, class Modifier, class Flags>
void write_modifiers(List& list, Modifier* modifiers, VkFormat format, Flags features) {
  OutArray<Modifier> array(&list.drmFormatModifierCount, modifiers);
  if (features != 0) array.push({kLinearModifier, texel::format_desc(format).plane_count, features});
  array.result();
}

/// Views of two dimensions, whatever the image is, have cubic filters.
void write_cubic(const VkPhysicalDeviceImageFormatInfo2& info, VkFilterCubicImageViewImageFormatPropertiesEXT& out) {
  const auto* view = find_in_chain<VkPhysicalDeviceImageViewImageFormatInfoEXT>(info.pNext);
  const bool flat =
      view && (view->imageViewType == VK_IMAGE_VIEW_TYPE_2D || view->imageViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY);
  const VkFormatFeatureFlags features = features_of_tiling(info);
  out.filterCubic = flat && (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT);
  out.filterCubicMinmax = out.filterCubic && (features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT);
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties(VkPhysicalDevice, VkFormat format,
                                                             VkFormatProperties* out) {
  *out = format_properties(format);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties2(VkPhysicalDevice, VkFormat format,
                                                              VkFormatProperties2* out) {
  out->formatProperties = format_properties(format);
  if (auto* wide = find_in_out_chain<VkFormatProperties3>(out->pNext)) {
    wide->linearTilingFeatures = wide_features(format, out->formatProperties.linearTilingFeatures);
    wide->optimalTilingFeatures = wide_features(format, out->formatProperties.optimalTilingFeatures);
    wide->bufferFeatures = wide_features(format, out->formatProperties.bufferFeatures);
  }
  const VkFormatFeatureFlags shared = modifier_features(format);
  if (auto* list = find_in_out_chain<VkDrmFormatModifierPropertiesListEXT>(out->pNext))
    write_modifiers(*list, list->pDrmFormatModifierProperties, format, shared);
  if (auto* list = find_in_out_chain<VkDrmFormatModifierPropertiesList2EXT>(out->pNext))
    write_modifiers(*list, list->pDrmFormatModifierProperties, format, wide_features(format, shared));
  if (auto* resolve = find_in_out_chain<VkSubpassResolvePerformanceQueryEXT>(out->pNext)) resolve->optimal = VK_FALSE;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMultisamplePropertiesEXT(VkPhysicalDevice, VkSampleCountFlagBits samples,
                                                                     VkMultisamplePropertiesEXT* out) {
  auto claimed = make_struct<VkPhysicalDeviceSampleLocationsPropertiesEXT>();
  write_property_chain(&claimed);
  const bool located = samples & claimed.sampleLocationSampleCounts;
  out->maxSampleLocationGridSize = located ? VkExtent2D{1, 1} : VkExtent2D{0, 0};
}

/// Vulkan 1.3.239, Fragment Shading Rates: from the largest width down, and of a width from the largest height down.
VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceFragmentShadingRatesKHR(VkPhysicalDevice, std::uint32_t* count,
                                                                        VkPhysicalDeviceFragmentShadingRateKHR* rates) {
  OutArray<VkPhysicalDeviceFragmentShadingRateKHR> array(count, rates);
  const VkSampleCountFlags possible = kClaimedPhysicalDeviceProperties.limits.framebufferColorSampleCounts;
  for (std::uint32_t w = 3; w-- != 0;)
    for (std::uint32_t h = 3; h-- != 0;) {
      const raster::FragmentRate rate = raster::make_rate(w, h);
      VkSampleCountFlags samples = rate == 0 ? ~VkSampleCountFlags{0} : 0;
      for (VkSampleCountFlags bit = 1; bit <= possible; bit <<= 1)
        if ((possible & bit) != 0 && raster::supports_rate(rate, bit)) samples |= bit;
      if (VkPhysicalDeviceFragmentShadingRateKHR* const out = array.next()) {
        out->sampleCounts = samples;
        out->fragmentSize = {raster::width_of(rate), raster::height_of(rate)};
      }
    }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties(VkPhysicalDevice, VkFormat format,
                                                                      VkImageType type, VkImageTiling tiling,
                                                                      VkImageUsageFlags usage, VkImageCreateFlags flags,
                                                                      VkImageFormatProperties* out) {
  VkPhysicalDeviceImageFormatInfo2 info = make_struct<VkPhysicalDeviceImageFormatInfo2>();
  info.format = format;
  info.type = type;
  info.tiling = tiling;
  info.usage = usage;
  info.flags = flags;
  return image_format_properties(info, out);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties2(VkPhysicalDevice,
                                                                       const VkPhysicalDeviceImageFormatInfo2* info,
                                                                       VkImageFormatProperties2* out) {
  const auto* asked = find_in_chain<VkPhysicalDeviceExternalImageFormatInfo>(info->pNext);
  VkExternalMemoryProperties shared{};
  if (asked && asked->handleType) {
    shared = external_memory_properties(asked->handleType);
    if (!shared.externalMemoryFeatures) {
      out->imageFormatProperties = {};
      return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
  }
  if (auto* external = find_in_out_chain<VkExternalImageFormatProperties>(out->pNext)) {
    external->externalMemoryProperties = shared;
  }
  if (auto* cubic = find_in_out_chain<VkFilterCubicImageViewImageFormatPropertiesEXT>(out->pNext))
    write_cubic(*info, *cubic);
#ifdef VK_EXT_host_image_copy
  if (auto* access = find_in_out_chain<VkHostImageCopyDevicePerformanceQueryEXT>(out->pNext)) {
    access->optimalDeviceAccess = access->identicalMemoryLayout = VK_TRUE;
  }
#endif
  if (auto* ycbcr = find_in_out_chain<VkSamplerYcbcrConversionImageFormatProperties>(out->pNext)) {
    ycbcr->combinedImageSamplerDescriptorCount = 1;
  }
  VkPhysicalDeviceImageFormatInfo2 all = *info;
  if (const auto* stencil = find_in_chain<VkImageStencilUsageCreateInfo>(info->pNext)) {
    all.usage |= stencil->stencilUsage;  // what the format can do, every aspect of it can
  }
  return image_format_properties(all, &out->imageFormatProperties);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceSparseImageFormatProperties(VkPhysicalDevice, VkFormat, VkImageType,
                                                                        VkSampleCountFlagBits, VkImageUsageFlags,
                                                                        VkImageTiling, std::uint32_t* count,
                                                                        VkSparseImageFormatProperties*) {
  *count = 0;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceSparseImageFormatProperties2(VkPhysicalDevice,
                                                                         const VkPhysicalDeviceSparseImageFormatInfo2*,
                                                                         std::uint32_t* count,
                                                                         VkSparseImageFormatProperties2*) {
  *count = 0;
}

}  // namespace entry
}  // namespace vitrine::icd
