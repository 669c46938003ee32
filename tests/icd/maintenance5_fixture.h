// A device with what newer headers than Vulkan 1.3.239's know: VK_KHR_maintenance5 and 6 and some more, and images and
// buffers that the host sees into.
#pragma once

#include <iterator>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include "tests/glsl/compile.h"
#include "tests/icd/fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {

class Maintenance5Device : public DeviceTest {
 protected:
  void make_device() override {
    auto maintenance = make_struct<VkPhysicalDeviceMaintenance5FeaturesKHR>();
    maintenance.maintenance5 = VK_TRUE;
    auto next = make_struct<VkPhysicalDeviceMaintenance6FeaturesKHR>(&maintenance);
    next.maintenance6 = VK_TRUE;
    auto copies = make_struct<VkPhysicalDeviceHostImageCopyFeaturesEXT>(&next);
    copies.hostImageCopy = VK_TRUE;
    auto biases = make_struct<VkPhysicalDeviceDepthBiasControlFeaturesEXT>(&copies);
    biases.depthBiasControl = biases.leastRepresentableValueForceUnormRepresentation = VK_TRUE;
    biases.floatRepresentation = biases.depthBiasExact = VK_TRUE;
    auto slices = make_struct<VkPhysicalDeviceImageSlicedViewOf3DFeaturesEXT>(&biases);
    slices.imageSlicedViewOf3D = VK_TRUE;
    auto nested = make_struct<VkPhysicalDeviceNestedCommandBufferFeaturesEXT>(&slices);
    nested.nestedCommandBuffer = nested.nestedCommandBufferRendering = VK_TRUE;
    nested.nestedCommandBufferSimultaneousUse = VK_TRUE;
    auto loops = make_struct<VkPhysicalDeviceAttachmentFeedbackLoopDynamicStateFeaturesEXT>(&nested);
    loops.attachmentFeedbackLoopDynamicState = VK_TRUE;
    auto unused = make_struct<VkPhysicalDeviceDynamicRenderingUnusedAttachmentsFeaturesEXT>(&loops);
    unused.dynamicRenderingUnusedAttachments = VK_TRUE;
    auto eighth = make_struct<VkPhysicalDeviceMaintenance8FeaturesKHR>(&unused);
    eighth.maintenance8 = VK_TRUE;
    auto attributes = make_struct<VkPhysicalDeviceLegacyVertexAttributesFeaturesEXT>(&eighth);
    attributes.legacyVertexAttributes = VK_TRUE;
    auto inputs = make_struct<VkPhysicalDeviceVertexInputDynamicStateFeaturesEXT>(&attributes);
    inputs.vertexInputDynamicState = VK_TRUE;
    auto descriptors = make_struct<VkPhysicalDeviceDescriptorBufferFeaturesEXT>(&inputs);
    descriptors.descriptorBuffer = VK_TRUE;
    auto robustness = make_struct<VkPhysicalDeviceRobustness2FeaturesEXT>(&descriptors);
    robustness.nullDescriptor = VK_TRUE;
    auto rendering = make_struct<VkPhysicalDeviceDynamicRenderingFeatures>(&robustness);
    rendering.dynamicRendering = VK_TRUE;
    auto features = make_struct<VkPhysicalDeviceFeatures2>(&rendering);
    features.features.fillModeNonSolid = features.features.vertexPipelineStoresAndAtomics = VK_TRUE;
    features.features.largePoints = features.features.occlusionQueryPrecise = VK_TRUE;
    const char* const names[] = {VK_KHR_MAINTENANCE_5_EXTENSION_NAME,
                                 VK_KHR_MAINTENANCE_6_EXTENSION_NAME,
                                 VK_KHR_MAINTENANCE_8_EXTENSION_NAME,
                                 VK_EXT_LEGACY_VERTEX_ATTRIBUTES_EXTENSION_NAME,
                                 VK_EXT_VERTEX_INPUT_DYNAMIC_STATE_EXTENSION_NAME,
                                 VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
                                 VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME,
                                 VK_EXT_DESCRIPTOR_BUFFER_EXTENSION_NAME,
                                 VK_EXT_ROBUSTNESS_2_EXTENSION_NAME,
                                 VK_EXT_HOST_IMAGE_COPY_EXTENSION_NAME,
                                 VK_EXT_DEPTH_BIAS_CONTROL_EXTENSION_NAME,
                                 VK_EXT_IMAGE_SLICED_VIEW_OF_3D_EXTENSION_NAME,
                                 VK_EXT_NESTED_COMMAND_BUFFER_EXTENSION_NAME,
                                 VK_EXT_DYNAMIC_RENDERING_UNUSED_ATTACHMENTS_EXTENSION_NAME,
                                 VK_EXT_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_EXTENSION_NAME,
                                 VK_EXT_ATTACHMENT_FEEDBACK_LOOP_DYNAMIC_STATE_EXTENSION_NAME};
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features, names), VK_SUCCESS);
  }

  void TearDown() override {
    for (const Picture& p : std::exchange(pictures, {})) {
      VK_GET(instance, DestroyImageView)(device, p.view, nullptr);
      VK_GET(instance, DestroyImage)(device, p.image, nullptr);
      VK_GET(instance, FreeMemory)(device, p.memory, nullptr);
    }
    for (const Bytes& b : std::exchange(buffers, {})) {
      VK_GET(instance, DestroyBuffer)(device, b.buffer, nullptr);
      VK_GET(instance, FreeMemory)(device, b.memory, nullptr);
    }
    DeviceTest::TearDown();
  }

  struct Picture {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::byte* data = nullptr;  ///< of all its memory
    std::size_t size = 0;
    VkSubresourceLayout layout{};
    bool flat = true;  ///< not a 3D image

    /// The first row of a layer, or of a slice.
    std::byte* row(std::uint32_t slice, std::uint32_t y = 0) const {
      return data + layout.offset + slice * (flat ? layout.arrayPitch : layout.depthPitch) + y * layout.rowPitch;
    }
  };
  struct Bytes {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::byte* data = nullptr;
    std::size_t size = 0;
  };

  static VkImageCreateInfo image_info(VkImageType type, VkFormat format, VkExtent3D extent, std::uint32_t layers,
                                      VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) {
    auto info = make_struct<VkImageCreateInfo>();
    info.imageType = type;
    info.format = format;
    info.extent = extent;
    info.mipLevels = 1;
    info.arrayLayers = layers;
    info.samples = samples;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return info;
  }

  Picture make_picture(VkImageType type, VkFormat format, VkExtent3D extent, std::uint32_t layers,
                       VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT,
                       VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT, VkComponentMapping components = {}) {
    Picture p;
    VkImageCreateInfo info = image_info(type, format, extent, layers, samples);
    info.usage |= aspect == VK_IMAGE_ASPECT_COLOR_BIT ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT
                                                      : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &p.image), VK_SUCCESS);
    VkMemoryRequirements needed;
    VK_GET(instance, GetImageMemoryRequirements)(device, p.image, &needed);
    p.memory = map(needed.size, p.data);
    p.size = needed.size;
    p.flat = type != VK_IMAGE_TYPE_3D;
    EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, p.image, p.memory, 0), VK_SUCCESS);
    const VkImageSubresource first{aspect, 0, 0};
    VK_GET(instance, GetImageSubresourceLayout)(device, p.image, &first, &p.layout);
    auto view = make_struct<VkImageViewCreateInfo>();
    view.image = p.image;
    view.viewType = type == VK_IMAGE_TYPE_1D   ? VK_IMAGE_VIEW_TYPE_1D_ARRAY
                    : type == VK_IMAGE_TYPE_3D ? VK_IMAGE_VIEW_TYPE_3D
                                               : VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.components = components;
    view.subresourceRange = {aspect, 0, 1, 0, type == VK_IMAGE_TYPE_2D ? 1 : layers};
    EXPECT_EQ(VK_GET(instance, CreateImageView)(device, &view, nullptr, &p.view), VK_SUCCESS);
    return pictures.emplace_back(p);
  }

  Bytes make_bytes(std::size_t size) {
    Bytes b;
    b.size = size;
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &b.buffer), VK_SUCCESS);
    b.memory = map(size, b.data);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, b.buffer, b.memory, 0), VK_SUCCESS);
    return buffers.emplace_back(b);
  }

  VkDeviceMemory map(VkDeviceSize size, std::byte*& data) {
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    void* mapped = nullptr;
    EXPECT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    data = static_cast<std::byte*>(mapped);
    return memory;
  }

  static void fill(const Picture& picture, std::uint32_t seed) {
    for (std::size_t i = 0; i < picture.size; ++i)
      picture.data[i] = static_cast<std::byte>((i + seed) * 2654435761u >> 13);
  }

  static std::vector<std::uint32_t> compile(VkShaderStageFlagBits stage, const std::string& glsl) {
    std::string log;
    std::string text = "#version 450\n";
    text += glsl;
    auto words = vitrine::test::compile_glsl(stage, text, vitrine::test::VulkanVersion::k11, log);
    EXPECT_FALSE(words.empty()) << log;
    return words;
  }

  static VkShaderModuleCreateInfo module_info(const std::vector<std::uint32_t>& words) {
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = words.size() * sizeof(std::uint32_t);
    info.pCode = words.data();
    return info;
  }

  std::list<Picture> pictures;
  std::list<Bytes> buffers;
};

}  // namespace vitrine::icd::test
#endif
