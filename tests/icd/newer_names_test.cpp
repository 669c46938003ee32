// What only newer headers than Vulkan 1.3.239's know (manifest/pack/newer-headers): later names of extensions that are
// there already, and small additions. With older ones none of it is offered.
#include <algorithm>
#include <string>
#include <vector>

#include "icd/registry/registry.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

class NewerNames : public DeviceTest {
 protected:
  template <class T>
  T features() {
    auto out = make_struct<T>();
    auto whole = make_struct<VkPhysicalDeviceFeatures2>(&out);
    VK_GET(instance, GetPhysicalDeviceFeatures2)(physical_device, &whole);
    return out;
  }
  template <class T>
  T properties() {
    auto out = make_struct<T>();
    auto whole = make_struct<VkPhysicalDeviceProperties2>(&out);
    VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &whole);
    return out;
  }
};

TEST_F(NewerNames, AreOfferedWhereTheHeadersKnowThem) {
  std::uint32_t count = 0;
  const auto enumerate = VK_GET(instance, EnumerateDeviceExtensionProperties);
  ASSERT_EQ(enumerate(physical_device, nullptr, &count, nullptr), VK_SUCCESS);
  std::vector<VkExtensionProperties> offered(count);
  ASSERT_EQ(enumerate(physical_device, nullptr, &count, offered.data()), VK_SUCCESS);
  for (const std::string name : {"VK_KHR_calibrated_timestamps",
                                 "VK_KHR_compute_shader_derivatives",
                                 "VK_KHR_depth_clamp_zero_one",
                                 "VK_KHR_dynamic_rendering_local_read",
                                 "VK_KHR_index_type_uint8",
                                 "VK_KHR_line_rasterization",
                                 "VK_KHR_load_store_op_none",
                                 "VK_KHR_maintenance5",
                                 "VK_KHR_maintenance6",
                                 "VK_KHR_maintenance7",
                                 "VK_KHR_maintenance8",
                                 "VK_KHR_map_memory2",
                                 "VK_KHR_pipeline_binary",
                                 "VK_KHR_shader_expect_assume",
                                 "VK_KHR_shader_float_controls2",
                                 "VK_KHR_shader_maximal_reconvergence",
                                 "VK_KHR_shader_quad_control",
                                 "VK_KHR_shader_relaxed_extended_instruction",
                                 "VK_KHR_shader_subgroup_rotate",
                                 "VK_EXT_legacy_vertex_attributes",
                                 "VK_EXT_shader_object",
                                 "VK_EXT_shader_replicated_composites",
                                 "VK_KHR_vertex_attribute_divisor"}) {
    const bool is_offered = std::any_of(offered.begin(), offered.end(),
                                        [&](const VkExtensionProperties& e) { return name == e.extensionName; });
    EXPECT_EQ(is_offered, VK_HEADER_VERSION >= 309) << name;
    EXPECT_EQ(find_extension(name) != Extension::kCount, VK_HEADER_VERSION >= 309) << name;
  }
}

#if VK_HEADER_VERSION >= 309
TEST_F(NewerNames, CommandsAreThoseOfTheOlderNames) {
  const char* const pairs[][2] = {
      {"vkGetCalibratedTimestampsKHR", "vkGetCalibratedTimestampsEXT"},
      {"vkGetPhysicalDeviceCalibrateableTimeDomainsKHR", "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT"},
      {"vkCmdSetLineStippleKHR", "vkCmdSetLineStippleEXT"}};
  for (const auto& [newer, older] : pairs) {
    const EntryPoint *one = find_entry_point(newer), *other = find_entry_point(older);
    ASSERT_TRUE(one && other) << newer;
    EXPECT_EQ(one->implementation, other->implementation) << newer;
    EXPECT_NE(one->implementation, nullptr) << newer;
  }
}

TEST_F(NewerNames, FeaturesAndPropertiesAreTold) {
  const auto lines = features<VkPhysicalDeviceLineRasterizationFeaturesKHR>();
  EXPECT_TRUE(lines.rectangularLines && lines.bresenhamLines && lines.smoothLines);
  EXPECT_TRUE(lines.stippledRectangularLines && lines.stippledBresenhamLines && lines.stippledSmoothLines);
  EXPECT_TRUE(features<VkPhysicalDeviceIndexTypeUint8FeaturesKHR>().indexTypeUint8);
  EXPECT_TRUE(features<VkPhysicalDeviceDepthClampZeroOneFeaturesKHR>().depthClampZeroOne);
  const auto divisors = features<VkPhysicalDeviceVertexAttributeDivisorFeaturesKHR>();
  EXPECT_TRUE(divisors.vertexAttributeInstanceRateDivisor && divisors.vertexAttributeInstanceRateZeroDivisor);
  const auto rotations = features<VkPhysicalDeviceShaderSubgroupRotateFeaturesKHR>();
  EXPECT_TRUE(rotations.shaderSubgroupRotate && rotations.shaderSubgroupRotateClustered);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderExpectAssumeFeaturesKHR>().shaderExpectAssume);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderFloatControls2FeaturesKHR>().shaderFloatControls2);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderMaximalReconvergenceFeaturesKHR>().shaderMaximalReconvergence);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderQuadControlFeaturesKHR>().shaderQuadControl);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderRelaxedExtendedInstructionFeaturesKHR>().shaderRelaxedExtendedInstruction);
  EXPECT_TRUE(features<VkPhysicalDeviceShaderReplicatedCompositesFeaturesEXT>().shaderReplicatedComposites);
  const auto derivatives = features<VkPhysicalDeviceComputeShaderDerivativesFeaturesKHR>();
  EXPECT_TRUE(derivatives.computeDerivativeGroupQuads && derivatives.computeDerivativeGroupLinear);
  EXPECT_FALSE(properties<VkPhysicalDeviceComputeShaderDerivativesPropertiesKHR>().meshAndTaskShaderDerivatives);
  EXPECT_EQ(properties<VkPhysicalDeviceLineRasterizationPropertiesKHR>().lineSubPixelPrecisionBits, 8u);
  const auto divisor = properties<VkPhysicalDeviceVertexAttributeDivisorPropertiesKHR>();
  EXPECT_EQ(divisor.maxVertexAttribDivisor,
            properties<VkPhysicalDeviceVertexAttributeDivisorPropertiesEXT>().maxVertexAttribDivisor);
  EXPECT_TRUE(divisor.supportsNonZeroFirstInstance);
  const VkSubgroupFeatureFlags rotate =
      VK_SUBGROUP_FEATURE_ROTATE_BIT_KHR | VK_SUBGROUP_FEATURE_ROTATE_CLUSTERED_BIT_KHR;
  EXPECT_EQ(properties<VkPhysicalDeviceSubgroupProperties>().supportedOperations & rotate, rotate);
}

/// Vulkan 1.4.309, Host Access to Device Memory Objects: as vkMapMemory, with structures.
TEST_F(NewerNames, MemoryIsMappedWhereItWas) {
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = 4096;
  VkDeviceMemory memory;
  ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
  void *whole = nullptr, *part = nullptr;
  ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &whole), VK_SUCCESS);
  auto unmap = make_struct<VkMemoryUnmapInfoKHR>();
  unmap.memory = memory;
  ASSERT_EQ(VK_GET(instance, UnmapMemory2KHR)(device, &unmap), VK_SUCCESS);
  auto map = make_struct<VkMemoryMapInfoKHR>();
  map.memory = memory;
  map.offset = 256;
  map.size = VK_WHOLE_SIZE;
  ASSERT_EQ(VK_GET(instance, MapMemory2KHR)(device, &map, &part), VK_SUCCESS);
  EXPECT_EQ(part, static_cast<std::byte*>(whole) + 256);
  EXPECT_EQ(VK_GET(instance, UnmapMemory2KHR)(device, &unmap), VK_SUCCESS);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
}
#endif

}  // namespace
}  // namespace vitrine::icd::test
