// Lost devices: what a shader that does not end leaves behind, what can be asked of it, and that everything else lives
// on. Reports of addresses.
#include <cstring>
#include <string>

#include "tests/icd/endless_shaders.h"
#include "tests/icd/resources_fixture.h"

namespace vitrine::icd::test {
namespace {

class DeviceFault : public ResourceTest {
 protected:
  void make_device() override {
    auto features = make_struct<VkPhysicalDeviceFaultFeaturesEXT>();
    features.deviceFault = features.deviceFaultVendorBinary = VK_TRUE;
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features), VK_SUCCESS);
  }

  /// Runs a shader that does not end; what the host is told.
  VkResult lose() {
    const VkPipelineLayout layout = make_layout(make_set_layout_of(kTypes));
    const VkPipeline pipeline = make_compute_of(layout, kSpinWords);
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 1, 1, &output, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    VK_CALL(QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
    return VK_CALL(QueueWaitIdle)(queue);
  }

  /// Whether a device runs commands.
  bool works(VkDevice other) {
    const auto event_info = make_struct<VkEventCreateInfo>();
    VkEvent event;
    EXPECT_EQ(VK_CALL(CreateEvent)(other, &event_info, nullptr, &event), VK_SUCCESS);
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    VkCommandPool pool;
    EXPECT_EQ(VK_CALL(CreateCommandPool)(other, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands;
    EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(other, &allocate, &commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
    VK_CALL(CmdSetEvent)(commands, event, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
    VkQueue other_queue;
    VK_CALL(GetDeviceQueue)(other, 0, 0, &other_queue);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    VK_CALL(QueueSubmit)(other_queue, 1, &info, VK_NULL_HANDLE);
    const bool done = VK_CALL(QueueWaitIdle)(other_queue) == VK_SUCCESS;
    const bool set = VK_CALL(GetEventStatus)(other, event) == VK_EVENT_SET;
    VK_CALL(DestroyCommandPool)(other, pool, nullptr);
    VK_CALL(DestroyEvent)(other, event, nullptr);
    return done && set;
  }
};

TEST_F(DeviceFault, NamesTheLoopAndTheCallsThatLeadThere) {
  auto counts = make_struct<VkDeviceFaultCountsEXT>();
  EXPECT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, nullptr), VK_SUCCESS);
  EXPECT_EQ(counts.vendorInfoCount, 0u) << "nothing has happened";
  EXPECT_EQ(counts.vendorBinarySize, 0u);
  ASSERT_EQ(lose(), VK_ERROR_DEVICE_LOST);
  ASSERT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, nullptr), VK_SUCCESS);
  EXPECT_EQ(counts.addressInfoCount, 0u);
  ASSERT_GE(counts.vendorInfoCount, 1u);
  std::vector<VkDeviceFaultVendorInfoEXT> calls(counts.vendorInfoCount);
  auto info = make_struct<VkDeviceFaultInfoEXT>();
  info.pVendorInfos = calls.data();
  ASSERT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, &info), VK_SUCCESS);
  const std::string text = info.description;
  EXPECT_NE(text.find("did not end within its budget of 268435456 instructions"), std::string::npos) << text;
  EXPECT_NE(text.find("63 of 64 invocations"), std::string::npos) << "one ends at once: " << text;
  EXPECT_NE(text.find("spin.comp:5"), std::string::npos) << text;
  EXPECT_NE(std::string(calls[0].description).find("spin.comp:5"), std::string::npos) << calls[0].description;
  EXPECT_EQ(calls[0].vendorFaultData, 5u);
  counts.vendorInfoCount = 0;
  EXPECT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, &info), VK_INCOMPLETE);
}

/// Vulkan 1.4.309, Lost Device: once a command has told of the loss, "all device commands for which
/// VK_ERROR_DEVICE_LOST is a valid return value" do, also of what was signalled before.
TEST_F(DeviceFault, EveryCommandTellsOfTheLoss) {
  auto fence_info = make_struct<VkFenceCreateInfo>();
  fence_info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  VkFence fence;
  ASSERT_EQ(VK_CALL(CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  auto type = make_struct<VkSemaphoreTypeCreateInfo>();
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  type.initialValue = 5;
  const auto semaphore_info = make_struct<VkSemaphoreCreateInfo>(&type);
  VkSemaphore semaphore;
  ASSERT_EQ(VK_CALL(CreateSemaphore)(device, &semaphore_info, nullptr, &semaphore), VK_SUCCESS);
  const auto event_info = make_struct<VkEventCreateInfo>();
  VkEvent event;
  ASSERT_EQ(VK_CALL(CreateEvent)(device, &event_info, nullptr, &event), VK_SUCCESS);
  auto pool_info = make_struct<VkQueryPoolCreateInfo>();
  pool_info.queryType = VK_QUERY_TYPE_OCCLUSION;
  pool_info.queryCount = 1;
  VkQueryPool pool;
  ASSERT_EQ(VK_CALL(CreateQueryPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto wait = make_struct<VkSemaphoreWaitInfo>();
  const std::uint64_t reached = 5;
  wait.semaphoreCount = 1;
  wait.pSemaphores = &semaphore;
  wait.pValues = &reached;
  std::uint64_t value = 0;
  EXPECT_EQ(VK_CALL(WaitForFences)(device, 1, &fence, VK_TRUE, 0), VK_SUCCESS);
  EXPECT_EQ(VK_CALL(WaitSemaphores)(device, &wait, 0), VK_SUCCESS);
  ASSERT_EQ(lose(), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(GetFenceStatus)(device, fence), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(WaitForFences)(device, 1, &fence, VK_TRUE, 0), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(WaitSemaphores)(device, &wait, 0), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(GetSemaphoreCounterValue)(device, semaphore, &value), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(GetEventStatus)(device, event), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(GetQueryPoolResults)(device, pool, 0, 1, 8, &value, 8, 0), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(QueueSubmit)(queue, 0, nullptr, VK_NULL_HANDLE), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(QueueBindSparse)(queue, 0, nullptr, VK_NULL_HANDLE), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(VK_CALL(DeviceWaitIdle)(device), VK_ERROR_DEVICE_LOST);
  VK_CALL(DestroyQueryPool)(device, pool, nullptr);
  VK_CALL(DestroyEvent)(device, event, nullptr);
  VK_CALL(DestroySemaphore)(device, semaphore, nullptr);
  VK_CALL(DestroyFence)(device, fence, nullptr);
}

TEST_F(DeviceFault, TheVendorBinaryIsAHeaderAndAReport) {
  ASSERT_EQ(lose(), VK_ERROR_DEVICE_LOST);
  auto counts = make_struct<VkDeviceFaultCountsEXT>();
  ASSERT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, nullptr), VK_SUCCESS);
  const auto size = static_cast<std::size_t>(counts.vendorBinarySize);
  ASSERT_GT(size, sizeof(VkDeviceFaultVendorBinaryHeaderVersionOneEXT));
  std::vector<char> binary(size + 1, '#');
  auto info = make_struct<VkDeviceFaultInfoEXT>();
  info.pVendorBinaryData = binary.data();
  counts.vendorBinarySize = size - 1;
  EXPECT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, &info), VK_INCOMPLETE);
  EXPECT_EQ(counts.vendorBinarySize, size - 1);
  EXPECT_EQ(binary[size - 1], '#') << "no byte more than there is room for";
  counts.vendorBinarySize = size + 1;
  ASSERT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, &info), VK_SUCCESS);
  EXPECT_EQ(counts.vendorBinarySize, size);
  VkDeviceFaultVendorBinaryHeaderVersionOneEXT header;
  std::memcpy(&header, binary.data(), sizeof header);
  VkPhysicalDeviceProperties properties;
  VK_CALL(GetPhysicalDeviceProperties)(physical_device, &properties);
  EXPECT_EQ(header.headerSize, sizeof header);
  EXPECT_EQ(header.headerVersion, VK_DEVICE_FAULT_VENDOR_BINARY_HEADER_VERSION_ONE_EXT);
  EXPECT_EQ(header.vendorID, properties.vendorID);
  EXPECT_EQ(header.deviceID, properties.deviceID);
  EXPECT_EQ(header.driverVersion, properties.driverVersion);
  EXPECT_EQ(std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE), 0);
  const std::string report(binary.data() + sizeof header, binary.data() + size);
  EXPECT_EQ(report.find("{\"format\":\"vitrine-findings\""), 0u) << report;
  EXPECT_NE(report.find("endless-shader"), std::string::npos) << report;
  EXPECT_NE(report.find("called from function main at spin.comp:10"), std::string::npos) << report;
}

TEST_F(DeviceFault, OtherDevicesLiveOnAndNewOnesCanBeMade) {
  VkDevice other = VK_NULL_HANDLE;
  ASSERT_EQ(create_device(instance, physical_device, &other), VK_SUCCESS);
  ASSERT_EQ(lose(), VK_ERROR_DEVICE_LOST);
  EXPECT_FALSE(works(device));
  EXPECT_TRUE(works(other));
  VkDevice next = VK_NULL_HANDLE;
  ASSERT_EQ(create_device(instance, physical_device, &next), VK_SUCCESS);
  EXPECT_TRUE(works(next));
  for (const VkDevice d : {next, other}) VK_CALL(DestroyDevice)(d, nullptr);
}

struct Report {
  VkObjectType type;
  VkDeviceAddress address;
  VkDeviceSize bytes;
  VkDeviceAddressBindingTypeEXT binding;
};

VKAPI_ATTR VkBool32 VKAPI_CALL remember_binding(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  const auto* binding = find_in_chain<VkDeviceAddressBindingCallbackDataEXT>(data->pNext);
  EXPECT_TRUE(binding && data->objectCount == 1);
  if (!binding || data->objectCount != 1) return VK_FALSE;
  static_cast<std::vector<Report>*>(user)->push_back(
      {data->pObjects[0].objectType, binding->baseAddress, binding->size, binding->bindingType});
  return VK_FALSE;
}

class AddressBinding : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_DEVICE_ADDRESS_BINDING_BIT_EXT;
    info.pfnUserCallback = &remember_binding;
    info.pUserData = &reports;
    ASSERT_EQ(VK_GET(instance, CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  }
  void TearDown() override {
    VK_GET(instance, DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    DeviceTest::TearDown();
  }

  /// A buffer at offset 256 and an image, bound and destroyed; the address of the memory.
  VkDeviceAddress bind_and_destroy(VkDevice d) {
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = 65536;
    VkDeviceMemory memory;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(d, &allocate, nullptr, &memory), VK_SUCCESS);
    void* data = nullptr;
    EXPECT_EQ(VK_GET(instance, MapMemory)(d, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    auto buffer_info = make_struct<VkBufferCreateInfo>();
    buffer_info.size = 1000;
    buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VkBuffer buffer;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(d, &buffer_info, nullptr, &buffer), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(d, buffer, memory, 256), VK_SUCCESS);
    auto image_info = make_struct<VkImageCreateInfo>();
    image_info.imageType = VK_IMAGE_TYPE_2D;
    image_info.format = VK_FORMAT_R8G8B8A8_UNORM;
    image_info.extent = {16, 16, 1};
    image_info.mipLevels = image_info.arrayLayers = 1;
    image_info.samples = VK_SAMPLE_COUNT_1_BIT;
    image_info.tiling = VK_IMAGE_TILING_LINEAR;
    image_info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    VkImage image;
    EXPECT_EQ(VK_GET(instance, CreateImage)(d, &image_info, nullptr, &image), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindImageMemory)(d, image, memory, 4096), VK_SUCCESS);
    VK_GET(instance, DestroyImage)(d, image, nullptr);
    VK_GET(instance, DestroyBuffer)(d, buffer, nullptr);
    VK_GET(instance, FreeMemory)(d, memory, nullptr);
    return reinterpret_cast<VkDeviceAddress>(data);
  }

  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  std::vector<Report> reports;
};

TEST_F(AddressBinding, TellsWhatObjectsGetAndGiveUpWhereItIsEnabled) {
  bind_and_destroy(device);
  EXPECT_TRUE(reports.empty()) << "the feature is off";
  auto feature = make_struct<VkPhysicalDeviceAddressBindingReportFeaturesEXT>();
  feature.reportAddressBinding = VK_TRUE;
  VkDevice reporting = VK_NULL_HANDLE;
  ASSERT_EQ(create_device(instance, physical_device, &reporting, nullptr, &feature), VK_SUCCESS);
  const VkDeviceAddress base = bind_and_destroy(reporting);
  VK_GET(instance, DestroyDevice)(reporting, nullptr);
  ASSERT_EQ(reports.size(), 4u);
  const VkObjectType types[] = {VK_OBJECT_TYPE_BUFFER, VK_OBJECT_TYPE_IMAGE, VK_OBJECT_TYPE_IMAGE,
                                VK_OBJECT_TYPE_BUFFER};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(reports[i].type, types[i]) << i;
    EXPECT_EQ(reports[i].binding,
              i < 2 ? VK_DEVICE_ADDRESS_BINDING_TYPE_BIND_EXT : VK_DEVICE_ADDRESS_BINDING_TYPE_UNBIND_EXT);
  }
  for (const std::size_t i : {0, 3}) {
    EXPECT_EQ(reports[i].address, base + 256);
    EXPECT_EQ(reports[i].bytes, 1000u);
  }
  EXPECT_EQ(reports[1].address, base + 4096);
  EXPECT_GE(reports[1].bytes, 16u * 16 * 4);
  EXPECT_EQ(reports[2].address, reports[1].address);
  EXPECT_EQ(reports[2].bytes, reports[1].bytes);
}

}  // namespace
}  // namespace vitrine::icd::test
