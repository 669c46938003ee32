// Commands that answer by themselves: what one device has none of, the older and the newer of two doors to one thing,
// what goes from the application to its own messengers.
#include <string>
#include <vector>

#include "tests/icd/compute_fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using FrontDoors = DeviceTest;

/// Vulkan 1.3.239, Sparse Resources: no feature of them is offered.
TEST_F(FrontDoors, NothingIsSparse) {
  auto image_info = make_struct<VkImageCreateInfo>();
  image_info.imageType = VK_IMAGE_TYPE_2D;
  image_info.format = VK_FORMAT_R8G8B8A8_UNORM;
  image_info.extent = {4, 4, 1};
  image_info.mipLevels = image_info.arrayLayers = 1;
  image_info.samples = VK_SAMPLE_COUNT_1_BIT;
  image_info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  VkImage image = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateImage)(device, &image_info, nullptr, &image), VK_SUCCESS);
  std::uint32_t counts[5] = {7, 7, 7, 7, 7};
  VK_CALL(GetImageSparseMemoryRequirements)(device, image, &counts[0], nullptr);
  auto of_image = make_struct<VkImageSparseMemoryRequirementsInfo2>();
  of_image.image = image;
  VK_CALL(GetImageSparseMemoryRequirements2)(device, &of_image, &counts[1], nullptr);
  auto of_info = make_struct<VkDeviceImageMemoryRequirements>();
  of_info.pCreateInfo = &image_info;
  VK_CALL(GetDeviceImageSparseMemoryRequirements)(device, &of_info, &counts[2], nullptr);
  const auto one = VK_CALL(GetPhysicalDeviceSparseImageFormatProperties);
  one(physical_device, image_info.format, image_info.imageType, image_info.samples, image_info.usage, image_info.tiling,
      &counts[3], nullptr);
  auto of_format = make_struct<VkPhysicalDeviceSparseImageFormatInfo2>();
  of_format.format = image_info.format;
  of_format.type = image_info.imageType;
  of_format.samples = image_info.samples;
  of_format.usage = image_info.usage;
  VK_CALL(GetPhysicalDeviceSparseImageFormatProperties2)(physical_device, &of_format, &counts[4], nullptr);
  for (const std::uint32_t count : counts) EXPECT_EQ(count, 0u);
  VK_CALL(DestroyImage)(device, image, nullptr);
}

TEST_F(FrontDoors, OneDeviceHasNoPeersAndNoLayers) {
  VkPeerMemoryFeatureFlags features = ~0u;
  VK_CALL(GetDeviceGroupPeerMemoryFeatures)(device, 0, 0, 0, &features);
  EXPECT_EQ(features, 0u);
  std::uint32_t layers = 7;
  EXPECT_EQ(VK_CALL(EnumerateDeviceLayerProperties)(physical_device, &layers, nullptr), VK_SUCCESS);
  EXPECT_EQ(layers, 0u);
}

TEST_F(FrontDoors, ABufferNeedsTheSameByAllDoors) {
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 1000;
  buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
  VkMemoryRequirements plain;
  VK_CALL(GetBufferMemoryRequirements)(device, buffer, &plain);
  auto of_buffer = make_struct<VkBufferMemoryRequirementsInfo2>();
  of_buffer.buffer = buffer;
  auto of_info = make_struct<VkDeviceBufferMemoryRequirements>();
  of_info.pCreateInfo = &buffer_info;
  VkMemoryDedicatedRequirements dedicated[2] = {make_struct<VkMemoryDedicatedRequirements>(),
                                                make_struct<VkMemoryDedicatedRequirements>()};
  VkMemoryRequirements2 two[2] = {make_struct<VkMemoryRequirements2>(&dedicated[0]),
                                  make_struct<VkMemoryRequirements2>(&dedicated[1])};
  VK_CALL(GetBufferMemoryRequirements2)(device, &of_buffer, &two[0]);
  VK_CALL(GetDeviceBufferMemoryRequirements)(device, &of_info, &two[1]);
  EXPECT_GE(plain.size, buffer_info.size);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(two[i].memoryRequirements.size, plain.size);
    EXPECT_EQ(two[i].memoryRequirements.alignment, plain.alignment);
    EXPECT_EQ(two[i].memoryRequirements.memoryTypeBits, plain.memoryTypeBits);
    EXPECT_EQ(dedicated[i].requiresDedicatedAllocation, VK_FALSE);
  }
  VK_CALL(DestroyBuffer)(device, buffer, nullptr);
}

TEST_F(FrontDoors, FencesGoByFileDescriptorsAlone) {
  auto info = make_struct<VkPhysicalDeviceExternalFenceInfo>();
  const auto ask = [&](VkExternalFenceHandleTypeFlagBits type) {
    info.handleType = type;
    auto out = make_struct<VkExternalFenceProperties>();
    out.compatibleHandleTypes = out.exportFromImportedHandleTypes = out.externalFenceFeatures = ~0u;
    VK_CALL(GetPhysicalDeviceExternalFenceProperties)(physical_device, &info, &out);
    return out;
  };
  for (const auto type : {VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT, VK_EXTERNAL_FENCE_HANDLE_TYPE_SYNC_FD_BIT}) {
    EXPECT_EQ(ask(type).compatibleHandleTypes, static_cast<VkFlags>(type));
    EXPECT_EQ(ask(type).externalFenceFeatures, static_cast<VkFlags>(VK_EXTERNAL_FENCE_FEATURE_EXPORTABLE_BIT |
                                                                    VK_EXTERNAL_FENCE_FEATURE_IMPORTABLE_BIT));
  }
  const VkExternalFenceProperties foreign = ask(VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_WIN32_BIT);
  EXPECT_EQ(foreign.compatibleHandleTypes | foreign.exportFromImportedHandleTypes | foreign.externalFenceFeatures, 0u);
}

TEST_F(FrontDoors, MessagesOfTheApplicationReachTheMessengersThatWantThem) {
  std::vector<std::string> heard;
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pUserData = &heard;
  info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) -> VkBool32 {
    static_cast<std::vector<std::string>*>(user)->push_back(data->pMessage);
    return VK_FALSE;
  };
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  const auto say = [&](const char* text, VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                       VkDebugUtilsMessageTypeFlagsEXT types) {
    auto data = make_struct<VkDebugUtilsMessengerCallbackDataEXT>();
    data.pMessage = text;
    VK_CALL(SubmitDebugUtilsMessageEXT)(instance, severity, types, &data);
  };
  const auto warning = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  say("heard", warning, VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT);
  say("of another kind", warning, VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT);
  say("less than that", VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT);
  VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
  say("too late", warning, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT);
  EXPECT_EQ(heard, std::vector<std::string>{"heard"});
}

TEST_F(FrontDoors, LabelsOfQueuesAndTagsAreTaken) {
  VkQueue queue;
  VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
  auto label = make_struct<VkDebugUtilsLabelEXT>();
  label.pLabelName = "frame";
  VK_CALL(QueueBeginDebugUtilsLabelEXT)(queue, &label);
  VK_CALL(QueueInsertDebugUtilsLabelEXT)(queue, &label);
  VK_CALL(QueueEndDebugUtilsLabelEXT)(queue);
  auto tag = make_struct<VkDebugUtilsObjectTagInfoEXT>();
  tag.objectType = VK_OBJECT_TYPE_QUEUE;
  tag.objectHandle = reinterpret_cast<std::uint64_t>(queue);
  tag.tagSize = 5;
  tag.pTag = "queue";
  EXPECT_EQ(VK_CALL(SetDebugUtilsObjectTagEXT)(device, &tag), VK_SUCCESS);
}

TEST_F(FrontDoors, CommandBuffersAreFreedOneByOne) {
  CountingAllocator allocator;
  const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, allocator.callbacks(), &pool), VK_SUCCESS);
  const std::size_t empty = allocator.live();
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = pool;
  allocate.commandBufferCount = 3;
  VkCommandBuffer buffers[3] = {};
  ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, buffers), VK_SUCCESS);
  const auto begin = make_struct<VkCommandBufferBeginInfo>();
  for (const VkCommandBuffer buffer : buffers) {
    ASSERT_EQ(VK_CALL(BeginCommandBuffer)(buffer, &begin), VK_SUCCESS);
    VK_CALL(CmdDispatch)(buffer, 0, 0, 0);
    ASSERT_EQ(VK_CALL(EndCommandBuffer)(buffer), VK_SUCCESS);
  }
  EXPECT_GT(allocator.live(), empty);
  const VkCommandBuffer some[] = {buffers[2], VK_NULL_HANDLE, buffers[0]};
  VK_CALL(FreeCommandBuffers)(device, pool, 3, some);
  VK_CALL(FreeCommandBuffers)(device, pool, 1, &buffers[1]);
  VK_CALL(TrimCommandPool)(device, pool, 0);  // what the pool keeps for others
  EXPECT_EQ(allocator.live(), empty);
  VK_CALL(DestroyCommandPool)(device, pool, allocator.callbacks());
  EXPECT_EQ(allocator.live(), 0u);
}

/// A compute shader's buffer, given by a template whose data have other things between.
TEST_F(ComputeTest, SetsAreWrittenByTemplates) {
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 256;
  buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
  VkMemoryRequirements needs;
  VK_CALL(GetBufferMemoryRequirements)(device, buffer, &needs);
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = needs.size;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
  void* data = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = pool_info.poolSizeCount = 1;
  pool_info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto set_info = make_struct<VkDescriptorSetAllocateInfo>();
  set_info.descriptorPool = pool;
  set_info.descriptorSetCount = 1;
  set_info.pSetLayouts = &set_layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &set_info, &set), VK_SUCCESS);

  struct Data {
    std::uint64_t other = 1;
    VkDescriptorBufferInfo info;
  } const given{.info = {buffer, 0, VK_WHOLE_SIZE}};
  const VkDescriptorUpdateTemplateEntry entry{0, 0, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, offsetof(Data, info), 0};
  auto shape = make_struct<VkDescriptorUpdateTemplateCreateInfo>();
  shape.descriptorUpdateEntryCount = 1;
  shape.pDescriptorUpdateEntries = &entry;
  shape.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_DESCRIPTOR_SET;
  shape.descriptorSetLayout = set_layout;
  VkDescriptorUpdateTemplate update = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateDescriptorUpdateTemplate)(device, &shape, nullptr, &update), VK_SUCCESS);
  VK_CALL(UpdateDescriptorSetWithTemplate)(device, set, update, &given);

  auto pipeline_info = make_struct<VkComputePipelineCreateInfo>();
  pipeline_info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
  pipeline_info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateComputePipelines)(device, cache, 1, &pipeline_info, nullptr, &pipeline), VK_SUCCESS);
  dispatch(pipeline, layout, set);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(static_cast<const std::uint32_t*>(data)[i], 3 * i + 1);
  VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
  VK_CALL(DestroyDescriptorUpdateTemplate)(device, update, nullptr);
  VK_CALL(DestroyDescriptorPool)(device, pool, nullptr);
  VK_CALL(DestroyBuffer)(device, buffer, nullptr);
  VK_CALL(FreeMemory)(device, memory, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
