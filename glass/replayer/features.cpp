// See features.h. A row per extension: with a structure of features, or without.
#include "glass/replayer/features.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "glass/replayer/needs.h"

namespace vitrine::glass::replayer {
namespace {

// Extensions that shaders or pipelines need no feature for.
constexpr const char* kPlain[] = {
    VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME,         VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME,
    VK_EXT_SHADER_STENCIL_EXPORT_EXTENSION_NAME,    VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME,
    VK_GOOGLE_DECORATE_STRING_EXTENSION_NAME,       VK_GOOGLE_HLSL_FUNCTIONALITY_1_EXTENSION_NAME,
    VK_EXT_SHADER_SUBGROUP_BALLOT_EXTENSION_NAME,   VK_EXT_SHADER_SUBGROUP_VOTE_EXTENSION_NAME,
    VK_KHR_SHADER_NON_SEMANTIC_INFO_EXTENSION_NAME,
};

}  // namespace

/// Every member is a structure of the chain of vkGetPhysicalDeviceFeatures2.
struct Features::Structures {
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features core11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features core12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features core13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceRobustness2FeaturesEXT robustness{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
  VkPhysicalDeviceDepthClipEnableFeaturesEXT clip{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_ENABLE_FEATURES_EXT};
  VkPhysicalDeviceDepthClipControlFeaturesEXT control{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_CONTROL_FEATURES_EXT};
  VkPhysicalDeviceProvokingVertexFeaturesEXT provoking{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT};
  VkPhysicalDeviceLineRasterizationFeaturesEXT lines{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT};
  VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT divisor{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VERTEX_ATTRIBUTE_DIVISOR_FEATURES_EXT};
  VkPhysicalDeviceCustomBorderColorFeaturesEXT border{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CUSTOM_BORDER_COLOR_FEATURES_EXT};
  VkPhysicalDeviceNonSeamlessCubeMapFeaturesEXT seams{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_NON_SEAMLESS_CUBE_MAP_FEATURES_EXT};
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomics{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT};
  VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT atomics2{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_2_FEATURES_EXT};
  VkPhysicalDeviceShaderImageAtomicInt64FeaturesEXT wide_atomics{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_IMAGE_ATOMIC_INT64_FEATURES_EXT};
  VkPhysicalDeviceFragmentShaderBarycentricFeaturesKHR barycentric{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_BARYCENTRIC_FEATURES_KHR};
  VkPhysicalDeviceFragmentShadingRateFeaturesKHR rates{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_FEATURES_KHR};
  VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT interlock{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT};
  VkPhysicalDeviceIndexTypeUint8FeaturesEXT indices{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INDEX_TYPE_UINT8_FEATURES_EXT};
  VkPhysicalDeviceMultiDrawFeaturesEXT multi_draw{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTI_DRAW_FEATURES_EXT};
  VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT};
  VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT restart{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PRIMITIVE_TOPOLOGY_LIST_RESTART_FEATURES_EXT};
  VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT order{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT};
  VkPhysicalDeviceShaderClockFeaturesKHR clock{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR};
  VkPhysicalDeviceWorkgroupMemoryExplicitLayoutFeaturesKHR shared{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_WORKGROUP_MEMORY_EXPLICIT_LAYOUT_FEATURES_KHR};
  VkPhysicalDeviceImage2DViewOf3DFeaturesEXT slices{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_2D_VIEW_OF_3D_FEATURES_EXT};
  VkPhysicalDeviceMutableDescriptorTypeFeaturesEXT mutable_types{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MUTABLE_DESCRIPTOR_TYPE_FEATURES_EXT};
  VkPhysicalDeviceFaultFeaturesEXT fault{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FAULT_FEATURES_EXT};
#ifdef VK_KHR_maintenance8
  VkPhysicalDeviceMaintenance8FeaturesKHR eighth{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_8_FEATURES_KHR};
  VkPhysicalDeviceLegacyVertexAttributesFeaturesEXT attributes{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LEGACY_VERTEX_ATTRIBUTES_FEATURES_EXT};
  VkPhysicalDeviceShaderReplicatedCompositesFeaturesEXT replicas{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_REPLICATED_COMPOSITES_FEATURES_EXT};
  VkPhysicalDeviceShaderRelaxedExtendedInstructionFeaturesKHR relaxed{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_RELAXED_EXTENDED_INSTRUCTION_FEATURES_KHR};
#endif

  /// Calls f(extension, structure) for those of extensions.
  template <class F>
  void for_each(F&& f) {
    f(VK_EXT_ROBUSTNESS_2_EXTENSION_NAME, robustness);
    f(VK_EXT_DEPTH_CLIP_ENABLE_EXTENSION_NAME, clip);
    f(VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME, control);
    f(VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME, provoking);
    f(VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME, lines);
    f(VK_EXT_VERTEX_ATTRIBUTE_DIVISOR_EXTENSION_NAME, divisor);
    f(VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME, border);
    f(VK_EXT_NON_SEAMLESS_CUBE_MAP_EXTENSION_NAME, seams);
    f(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, atomics);
    f(VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME, atomics2);
    f(VK_EXT_SHADER_IMAGE_ATOMIC_INT64_EXTENSION_NAME, wide_atomics);
    f(VK_KHR_FRAGMENT_SHADER_BARYCENTRIC_EXTENSION_NAME, barycentric);
    f(VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME, rates);
    f(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME, interlock);
    f(VK_EXT_INDEX_TYPE_UINT8_EXTENSION_NAME, indices);
    f(VK_EXT_MULTI_DRAW_EXTENSION_NAME, multi_draw);
    f(VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME, feedback);
    f(VK_EXT_PRIMITIVE_TOPOLOGY_LIST_RESTART_EXTENSION_NAME, restart);
    f(VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME, order);
    f(VK_KHR_SHADER_CLOCK_EXTENSION_NAME, clock);
    f(VK_KHR_WORKGROUP_MEMORY_EXPLICIT_LAYOUT_EXTENSION_NAME, shared);
    f(VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME, slices);
    f(VK_EXT_MUTABLE_DESCRIPTOR_TYPE_EXTENSION_NAME, mutable_types);
    f(VK_EXT_DEVICE_FAULT_EXTENSION_NAME, fault);
#ifdef VK_KHR_maintenance8
    f(VK_KHR_MAINTENANCE_8_EXTENSION_NAME, eighth);
    f(VK_EXT_LEGACY_VERTEX_ATTRIBUTES_EXTENSION_NAME, attributes);
    f(VK_EXT_SHADER_REPLICATED_COMPOSITES_EXTENSION_NAME, replicas);
    f(VK_KHR_SHADER_RELAXED_EXTENDED_INSTRUCTION_EXTENSION_NAME, relaxed);
#endif
  }
};

Features::Features(VkPhysicalDevice device, const bug::Bug& bug) : structures_(std::make_unique<Structures>()) {
  Structures& s = *structures_;
  s.core.pNext = &s.core11;
  s.core11.pNext = &s.core12;
  s.core12.pNext = &s.core13;
  add_extensions(device, bug);
  vkGetPhysicalDeviceFeatures2(device, &s.core);
  s.robustness.robustBufferAccess2 &= VkBool32{bug.robust_access2};
  s.robustness.robustImageAccess2 &= VkBool32{bug.robust_access2};
  s.robustness.nullDescriptor &= VkBool32{bug.null_descriptors};
  s.core13.privateData = VK_FALSE;
}

const char* Features::missing(const bug::Bug& bug) const {
  if (const char* const feature = missing_feature(bug, structures_->core.features)) return feature;
  const char* const extension = missing_extension(bug, [&](const char* name) {
    return std::ranges::any_of(extensions_, [&](const char* e) { return std::strcmp(e, name) == 0; });
  });
  if (extension) return extension;
  const bool has_rates = bug.rendering.rate == bug::kNone || structures_->rates.attachmentFragmentShadingRate;
  return has_rates ? nullptr : "attachmentFragmentShadingRate";
}

Features::~Features() = default;

const void* Features::chain() const { return &structures_->core; }

bool Features::addresses_again() const { return structures_->core12.bufferDeviceAddressCaptureReplay; }

void Features::add_extensions(VkPhysicalDevice device, const bug::Bug& bug) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> there(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, there.data());
  const auto has = [&](const char* name) {
    return std::any_of(there.begin(), there.end(),
                       [&](const VkExtensionProperties& p) { return std::strcmp(p.extensionName, name) == 0; });
  };
  void** end = &structures_->core13.pNext;
  structures_->for_each([&](const char* name, auto& features) {
    if (!has(name)) return;
    extensions_.push_back(name);
    *end = &features;
    end = &features.pNext;
  });
  for (const char* const name : kPlain)
    if (has(name)) extensions_.push_back(name);
  // It changes what depth is.
  if (bug.state.unrestricted_depth) extensions_.push_back(VK_EXT_DEPTH_RANGE_UNRESTRICTED_EXTENSION_NAME);
}

}  // namespace vitrine::glass::replayer
