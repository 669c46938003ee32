// The generated tables: sorted, complete, gated, and every claim is backed by code.
#include "icd/registry/registry.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "icd/limit_rules.h"
#include "icd/properties.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd {
namespace {

TEST(Registry, EveryClaimedCommandIsImplemented) {
  std::string missing;
  for (const EntryPoint& entry : entry_points()) {
    if (!entry.implementation) missing += std::string(" ") + entry.name;
  }
  EXPECT_EQ(missing, "");
}

TEST(Registry, NamesAreSortedForSearch) {
  const auto by_name = [](const auto& a, const auto& b) { return std::string_view(a.name) < b.name; };
  EXPECT_TRUE(std::is_sorted(entry_points().begin(), entry_points().end(), by_name));
  EXPECT_TRUE(std::is_sorted(extension_infos().begin(), extension_infos().end(), by_name));
  EXPECT_EQ(extension_infos().size(), static_cast<std::size_t>(Extension::kCount));
}

TEST(Registry, PromotedNamesAreTheSameFunction) {
  const EntryPoint* core = find_entry_point("vkGetPhysicalDeviceFeatures2");
  const EntryPoint* promoted = find_entry_point("vkGetPhysicalDeviceFeatures2KHR");
  ASSERT_TRUE(core && promoted);
  EXPECT_EQ(core->implementation, promoted->implementation);
  EXPECT_NE(core->implementation, nullptr);
}

TEST(Registry, UnclaimedAndUnknownCommandsAreAbsent) {
  EXPECT_EQ(find_entry_point("vkCmdDrawMeshTasksNV"), nullptr);
  EXPECT_EQ(find_entry_point("vkNoSuchCommand"), nullptr);
  EXPECT_EQ(find_entry_point(""), nullptr);
}

TEST(Registry, ExtensionCommandsNeedTheirExtension) {
  const EntryPoint* entry = find_entry_point("vkGetPhysicalDeviceFeatures2KHR");
  ASSERT_TRUE(entry);
  ExtensionSet extensions;
  EXPECT_FALSE(is_open(*entry, VK_API_VERSION_1_1, extensions));
  extensions.set(Extension::KHR_get_physical_device_properties2);
  EXPECT_TRUE(is_open(*entry, VK_API_VERSION_1_0, extensions));
}

TEST(Registry, LimitsMeetTheSpecification) {
  EXPECT_GT(std::size(kLimitRules), 80u);
  for (const LimitRule& rule : kLimitRules) {
    const auto value = static_cast<std::int64_t>(rule.value);
    const auto required = static_cast<std::int64_t>(rule.required);
    const bool met = rule.direction == LimitRule::kAtLeast  ? rule.value >= rule.required
                     : rule.direction == LimitRule::kAtMost ? rule.value <= rule.required
                                                            : (value & required) == required;
    EXPECT_TRUE(met) << rule.name << " is " << rule.value << ", required " << rule.required;
  }
}

/// Vulkan 1.4.309, Features: Feature Requirements.
TEST(Registry, TheVersionsFeaturesAreClaimed) {
  struct Requirement {
    std::uint32_t version;
    Feature feature;
    const char* name;
  };
#define VITRINE_REQUIRED(version, name) \
  { version, Feature::name, #name }
  static constexpr Requirement kRequirements[] = {
      VITRINE_REQUIRED(VK_API_VERSION_1_0, robustBufferAccess),
      VITRINE_REQUIRED(VK_API_VERSION_1_1, multiview),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, uniformBufferStandardLayout),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, subgroupBroadcastDynamicId),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, imagelessFramebuffer),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, hostQueryReset),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, timelineSemaphore),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, shaderSubgroupExtendedTypes),
      VITRINE_REQUIRED(VK_API_VERSION_1_2, separateDepthStencilLayouts),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, vulkanMemoryModel),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, vulkanMemoryModelDeviceScope),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, bufferDeviceAddress),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, robustImageAccess),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, inlineUniformBlock),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, descriptorBindingInlineUniformBlockUpdateAfterBind),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, pipelineCreationCacheControl),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, privateData),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, shaderDemoteToHelperInvocation),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, shaderTerminateInvocation),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, subgroupSizeControl),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, computeFullSubgroups),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, synchronization2),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, shaderZeroInitializeWorkgroupMemory),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, dynamicRendering),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, shaderIntegerDotProduct),
      VITRINE_REQUIRED(VK_API_VERSION_1_3, maintenance4),
#ifdef VK_API_VERSION_1_4
      VITRINE_REQUIRED(VK_API_VERSION_1_4, fullDrawIndexUint32),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, imageCubeArray),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, independentBlend),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, sampleRateShading),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, drawIndirectFirstInstance),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, depthClamp),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, depthBiasClamp),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, samplerAnisotropy),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, fragmentStoresAndAtomics),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderStorageImageExtendedFormats),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderUniformBufferArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderSampledImageArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderStorageBufferArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderStorageImageArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderImageGatherExtended),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderInt16),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, largePoints),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, samplerYcbcrConversion),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, storageBuffer16BitAccess),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, variablePointers),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, variablePointersStorageBuffer),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, samplerMirrorClampToEdge),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, scalarBlockLayout),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderUniformTexelBufferArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderStorageTexelBufferArrayDynamicIndexing),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderInt8),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, storageBuffer8BitAccess),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, globalPriorityQuery),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderSubgroupRotate),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderSubgroupRotateClustered),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderFloatControls2),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, shaderExpectAssume),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, bresenhamLines),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, vertexAttributeInstanceRateDivisor),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, indexTypeUint8),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, dynamicRenderingLocalRead),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, maintenance5),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, maintenance6),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, pipelineRobustness),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, hostImageCopy),
      VITRINE_REQUIRED(VK_API_VERSION_1_4, pushDescriptor),
#endif
  };
#undef VITRINE_REQUIRED
  const std::span<const Feature> claimed = claimed_features();
  for (const Requirement& r : kRequirements) {
    if (kClaimedPhysicalDeviceProperties.apiVersion < r.version) continue;
    EXPECT_NE(std::find(claimed.begin(), claimed.end(), r.feature), claimed.end()) << r.name;
  }
}

TEST(Registry, FeatureChainIsAnsweredFromOneList) {
  FeatureSet features;
  features.set(Feature::multiview);
  features.set(Feature::robustBufferAccess);
  auto multiview = make_struct<VkPhysicalDeviceMultiviewFeatures>();
  multiview.multiviewGeometryShader = VK_TRUE;
  auto chain = make_struct<VkPhysicalDeviceFeatures2>(&multiview);
  write_feature_chain(&chain, features);
  EXPECT_EQ(multiview.multiview, VK_TRUE);
  EXPECT_EQ(multiview.multiviewGeometryShader, VK_FALSE);
  EXPECT_EQ(chain.features.robustBufferAccess, VK_TRUE);
  EXPECT_EQ(chain.features.geometryShader, VK_FALSE);

  FeatureSet enabled;
  read_feature_chain(&chain, enabled);
  EXPECT_TRUE(enabled.test(Feature::multiview));
  EXPECT_TRUE(enabled.test(Feature::robustBufferAccess));
  EXPECT_FALSE(enabled.test(Feature::geometryShader));
}

TEST(Registry, UnknownStructuresInChainsAreLeftAlone) {
  auto unknown = make_struct<VkPhysicalDeviceMeshShaderPropertiesNV>();
  unknown.maxDrawMeshTasksCount = 1234;
  auto subgroup = make_struct<VkPhysicalDeviceSubgroupProperties>();
  unknown.pNext = &subgroup;
  write_property_chain(&unknown);
  EXPECT_EQ(unknown.maxDrawMeshTasksCount, 1234u);
  EXPECT_EQ(subgroup.subgroupSize, 64u);
  EXPECT_EQ(subgroup.pNext, nullptr);
}

}  // namespace
}  // namespace vitrine::icd
