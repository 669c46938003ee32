// Surfaces and swapchains on VK_EXT_headless_surface (windows are tested by the applications of the vkcube tests).
#include <set>
#include <vector>

#include "icd/object/image.h"
#include "icd/wsi/swapchain.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

class SurfaceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(create_instance(&instance, nullptr,
                              {VK_KHR_SURFACE_EXTENSION_NAME, VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME,
                               VK_KHR_GET_SURFACE_CAPABILITIES_2_EXTENSION_NAME}),
              VK_SUCCESS);
    std::uint32_t count = 1;
    ASSERT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &physical_device), VK_SUCCESS);
    const auto info = make_struct<VkHeadlessSurfaceCreateInfoEXT>();
    ASSERT_EQ(VK_GET(instance, CreateHeadlessSurfaceEXT)(instance, &info, nullptr, &surface), VK_SUCCESS);
  }
  void TearDown() override {
    if (surface) VK_GET(instance, DestroySurfaceKHR)(instance, surface, nullptr);
    if (instance) VK_GET(instance, DestroyInstance)(instance, nullptr);
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
};

TEST_F(SurfaceTest, SaysWithoutASurfaceWhatIsTheSameForAll) {
  std::uint32_t with = 0, without = 0;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceFormatsKHR)(physical_device, surface, &with, nullptr), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceFormatsKHR)(physical_device, VK_NULL_HANDLE, &without, nullptr),
            VK_SUCCESS);
  EXPECT_EQ(with, without);
  EXPECT_EQ(
      VK_GET(instance, GetPhysicalDeviceSurfacePresentModesKHR)(physical_device, VK_NULL_HANDLE, &without, nullptr),
      VK_SUCCESS);
  EXPECT_GT(without, 0u);
  auto protection = make_struct<VkSurfaceProtectedCapabilitiesKHR>();
  protection.supportsProtected = VK_TRUE;
  auto capabilities = make_struct<VkSurfaceCapabilities2KHR>(&protection);
  const auto info = make_struct<VkPhysicalDeviceSurfaceInfo2KHR>();
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceCapabilities2KHR)(physical_device, &info, &capabilities),
            VK_SUCCESS);
  EXPECT_EQ(protection.supportsProtected, VK_FALSE);
}

TEST_F(SurfaceTest, EveryModeCanFollowEveryOther) {
  VkPresentModeKHR list[8];
  auto compatible = make_struct<VkSurfacePresentModeCompatibilityEXT>();
  compatible.presentModeCount = 8;
  compatible.pPresentModes = list;
  auto scaling = make_struct<VkSurfacePresentScalingCapabilitiesEXT>(&compatible);
  auto capabilities = make_struct<VkSurfaceCapabilities2KHR>(&scaling);
  auto mode = make_struct<VkSurfacePresentModeEXT>();
  mode.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  auto info = make_struct<VkPhysicalDeviceSurfaceInfo2KHR>(&mode);
  info.surface = surface;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceCapabilities2KHR)(physical_device, &info, &capabilities),
            VK_SUCCESS);
  EXPECT_EQ(compatible.presentModeCount, 4u);
  // A list that is too short has the one that is asked about.
  mode.presentMode = VK_PRESENT_MODE_FIFO_RELAXED_KHR;
  compatible.presentModeCount = 1;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceCapabilities2KHR)(physical_device, &info, &capabilities),
            VK_SUCCESS);
  EXPECT_EQ(compatible.presentModeCount, 1u);
  EXPECT_EQ(list[0], VK_PRESENT_MODE_FIFO_RELAXED_KHR);
  EXPECT_EQ(scaling.supportedPresentScaling, 0u);
  EXPECT_EQ(scaling.maxScaledImageExtent.width, capabilities.surfaceCapabilities.maxImageExtent.width);
}

TEST_F(SurfaceTest, SaysWhatItCanDo) {
  VkBool32 supported = VK_FALSE;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceSupportKHR)(physical_device, 0, surface, &supported), VK_SUCCESS);
  EXPECT_TRUE(supported);

  auto info = make_struct<VkPhysicalDeviceSurfaceInfo2KHR>();
  info.surface = surface;
  auto capabilities = make_struct<VkSurfaceCapabilities2KHR>();
  ASSERT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceCapabilities2KHR)(physical_device, &info, &capabilities),
            VK_SUCCESS);
  EXPECT_EQ(capabilities.surfaceCapabilities.currentExtent.width, 0xFFFFFFFFu);
  EXPECT_TRUE(capabilities.surfaceCapabilities.supportedUsageFlags & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  EXPECT_TRUE(capabilities.surfaceCapabilities.supportedUsageFlags & VK_IMAGE_USAGE_STORAGE_BIT);

  std::uint32_t count = 0;
  ASSERT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceFormatsKHR)(physical_device, surface, &count, nullptr),
            VK_SUCCESS);
  std::vector<VkSurfaceFormatKHR> formats(count);
  ASSERT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceFormatsKHR)(physical_device, surface, &count, formats.data()),
            VK_SUCCESS);
  std::set<VkFormat> found;
  for (const VkSurfaceFormatKHR& format : formats) found.insert(format.format);
  EXPECT_EQ(found, (std::set<VkFormat>{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM,
                                       VK_FORMAT_R8G8B8A8_SRGB}));

  VkPresentModeKHR modes[8];
  count = 8;
  ASSERT_EQ(VK_GET(instance, GetPhysicalDeviceSurfacePresentModesKHR)(physical_device, surface, &count, modes),
            VK_SUCCESS);
  EXPECT_EQ((std::set<VkPresentModeKHR>(modes, modes + count)),
            (std::set<VkPresentModeKHR>{VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                        VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_FIFO_RELAXED_KHR}));
  count = 1;
  VkPresentModeKHR mode;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfacePresentModesKHR)(physical_device, surface, &count, &mode),
            VK_INCOMPLETE);
}

TEST_F(SurfaceTest, FormatsAreTheSameByBothDoors) {
  auto info = make_struct<VkPhysicalDeviceSurfaceInfo2KHR>();
  info.surface = surface;
  VkSurfaceFormatKHR formats[8];
  VkSurfaceFormat2KHR formats2[8];
  for (VkSurfaceFormat2KHR& format : formats2) format = make_struct<VkSurfaceFormat2KHR>();
  std::uint32_t count = 8, count2 = 8;
  const auto two = VK_GET(instance, GetPhysicalDeviceSurfaceFormats2KHR);
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceSurfaceFormatsKHR)(physical_device, surface, &count, formats),
            VK_SUCCESS);
  EXPECT_EQ(two(physical_device, &info, &count2, formats2), VK_SUCCESS);
  ASSERT_EQ(count2, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(formats2[i].surfaceFormat.format, formats[i].format);
    EXPECT_EQ(formats2[i].surfaceFormat.colorSpace, formats[i].colorSpace);
  }
  count2 = 1;
  EXPECT_EQ(two(physical_device, &info, &count2, formats2), VK_INCOMPLETE);
  EXPECT_EQ(count2, 1u);
}

TEST_F(SurfaceTest, OneDevicePresentsToTheWholeSurface) {
  std::uint32_t count = 0;
  const auto ask = VK_GET(instance, GetPhysicalDevicePresentRectanglesKHR);
  EXPECT_EQ(ask(physical_device, surface, &count, nullptr), VK_SUCCESS);
  ASSERT_EQ(count, 1u);
  VkRect2D rectangle{{1, 1}, {}};
  EXPECT_EQ(ask(physical_device, surface, &count, &rectangle), VK_SUCCESS);
  EXPECT_EQ(rectangle.offset.x, 0);
  EXPECT_EQ(rectangle.extent.width, 0xFFFFFFFFu) << "headless surfaces take their size from the swapchain";
}

class SwapchainTest : public SurfaceTest {
 protected:
  void SetUp() override {
    SurfaceTest::SetUp();
    const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, nullptr, {&extension, 1}), VK_SUCCESS);
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
  }
  void TearDown() override {
    if (device) VK_GET(instance, DestroyDevice)(device, nullptr);
    SurfaceTest::TearDown();
  }

  VkSwapchainKHR create(VkSwapchainKHR old = VK_NULL_HANDLE, std::uint32_t images = 3) {
    auto info = make_struct<VkSwapchainCreateInfoKHR>();
    info.surface = surface;
    info.minImageCount = images;
    info.imageFormat = VK_FORMAT_B8G8R8A8_UNORM;
    info.imageExtent = {32, 16};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.oldSwapchain = old;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateSwapchainKHR)(device, &info, nullptr, &swapchain), VK_SUCCESS);
    return swapchain;
  }
  void destroy(VkSwapchainKHR swapchain) { VK_GET(instance, DestroySwapchainKHR)(device, swapchain, nullptr); }
  VkResult acquire(VkSwapchainKHR swapchain, std::uint32_t& index, VkSemaphore semaphore, VkFence fence,
                   std::uint64_t timeout = 0) {
    return VK_GET(instance, AcquireNextImageKHR)(device, swapchain, timeout, semaphore, fence, &index);
  }
  VkResult present(VkSwapchainKHR swapchain, std::uint32_t index, VkSemaphore semaphore, std::uint64_t id = 0) {
    auto ids = make_struct<VkPresentIdKHR>();
    ids.swapchainCount = 1;
    ids.pPresentIds = &id;
    auto info = make_struct<VkPresentInfoKHR>(&ids);
    info.waitSemaphoreCount = semaphore ? 1 : 0;
    info.pWaitSemaphores = &semaphore;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    return VK_GET(instance, QueuePresentKHR)(queue, &info);
  }
  VkSemaphore semaphore() {
    const auto info = make_struct<VkSemaphoreCreateInfo>();
    VkSemaphore result = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateSemaphore)(device, &info, nullptr, &result), VK_SUCCESS);
    return result;
  }

  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
};

TEST_F(SwapchainTest, ImagesTakeTurns) {
  const VkSwapchainKHR swapchain = create();
  const VkSemaphore acquired = semaphore();
  std::vector<std::uint32_t> order;
  for (int frame = 0; frame < 6; ++frame) {
    std::uint32_t index = 99;
    ASSERT_EQ(acquire(swapchain, index, acquired, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
    order.push_back(index);
    ASSERT_EQ(present(swapchain, index, acquired), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  }
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  VK_GET(instance, DestroySemaphore)(device, acquired, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, TheDeviceIsAGroupOfOne) {
  auto capabilities = make_struct<VkDeviceGroupPresentCapabilitiesKHR>();
  ASSERT_EQ(VK_GET(instance, GetDeviceGroupPresentCapabilitiesKHR)(device, &capabilities), VK_SUCCESS);
  EXPECT_EQ(capabilities.presentMask[0], 1u);
  EXPECT_EQ(capabilities.presentMask[1], 0u);
  VkDeviceGroupPresentModeFlagsKHR modes = 0;
  ASSERT_EQ(VK_GET(instance, GetDeviceGroupSurfacePresentModesKHR)(device, surface, &modes), VK_SUCCESS);
  EXPECT_EQ(modes, capabilities.modes);
  EXPECT_EQ(modes, static_cast<VkFlags>(VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR));
  const VkSwapchainKHR swapchain = create();
  auto info = make_struct<VkAcquireNextImageInfoKHR>();
  info.swapchain = swapchain;
  info.timeout = UINT64_MAX;
  info.semaphore = semaphore();
  info.deviceMask = 1;
  std::uint32_t index = 99;
  ASSERT_EQ(VK_GET(instance, AcquireNextImage2KHR)(device, &info, &index), VK_SUCCESS);
  EXPECT_EQ(index, 0u);
  EXPECT_EQ(present(swapchain, index, info.semaphore), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  VK_GET(instance, DestroySemaphore)(device, info.semaphore, nullptr);
  destroy(swapchain);
}

/// Programs whose display server has died destroy the lost surface first (vkcube does), though Vulkan 1.3.239,
/// vkDestroySurfaceKHR, wants its swapchains gone before.
TEST_F(SwapchainTest, TheWindowLastsAsLongAsTheSwapchain) {
  const VkSwapchainKHR swapchain = create();
  const VkSemaphore acquired = semaphore();
  std::uint32_t index = 99;
  ASSERT_EQ(acquire(swapchain, index, acquired, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
  VK_GET(instance, DestroySurfaceKHR)(instance, surface, nullptr);
  surface = VK_NULL_HANDLE;
  EXPECT_EQ(present(swapchain, index, acquired), VK_SUCCESS);
  EXPECT_EQ(acquire(swapchain, index, acquired, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
  EXPECT_EQ(present(swapchain, index, acquired), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  VK_GET(instance, DestroySemaphore)(device, acquired, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, ImagesShareTheMemoryOfTheSwapchains) {
  const VkSwapchainKHR swapchain = create();
  std::uint32_t count = 3;
  VkImage owned[3];
  ASSERT_EQ(VK_GET(instance, GetSwapchainImagesKHR)(device, swapchain, &count, owned), VK_SUCCESS);
  auto of_swapchain = make_struct<VkImageSwapchainCreateInfoKHR>();
  of_swapchain.swapchain = swapchain;
  auto info = make_struct<VkImageCreateInfo>(&of_swapchain);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_B8G8R8A8_UNORM;
  info.extent = {32, 16, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  VkImage image = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  auto where = make_struct<VkBindImageMemorySwapchainInfoKHR>();
  where.swapchain = swapchain;
  where.imageIndex = 2;
  auto bind = make_struct<VkBindImageMemoryInfo>(&where);
  bind.image = image;
  EXPECT_EQ(VK_GET(instance, BindImageMemory2)(device, 1, &bind), VK_SUCCESS);
  EXPECT_EQ(from_handle<Image>(image).data, from_handle<Image>(owned[2]).data);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, AcquiringWithASemaphoreWhoseWaitIsPendingLosesNoSignal) {
  const VkSwapchainKHR swapchain = create();
  const VkSemaphore acquired = semaphore();
  auto type = make_struct<VkSemaphoreTypeCreateInfo>();
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const auto gate_info = make_struct<VkSemaphoreCreateInfo>(&type);
  VkSemaphore gate = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateSemaphore)(device, &gate_info, nullptr, &gate), VK_SUCCESS);
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);

  // The first batch holds the queue, so its wait for `acquired` is pending while the second image is acquired.
  const std::uint64_t gate_values[2] = {1, 0};
  auto values = make_struct<VkTimelineSemaphoreSubmitInfo>();
  values.waitSemaphoreValueCount = 2;
  values.pWaitSemaphoreValues = gate_values;
  const VkSemaphore both[2] = {gate, acquired};
  const VkPipelineStageFlags stages[2] = {VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT};
  auto first = make_struct<VkSubmitInfo>(&values), second = make_struct<VkSubmitInfo>();
  first.waitSemaphoreCount = 2;
  first.pWaitSemaphores = both;
  second.waitSemaphoreCount = 1;
  second.pWaitSemaphores = &acquired;
  first.pWaitDstStageMask = second.pWaitDstStageMask = stages;
  std::uint32_t index = 99;
  ASSERT_EQ(acquire(swapchain, index, acquired, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
  ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &first, VK_NULL_HANDLE), VK_SUCCESS);
  ASSERT_EQ(acquire(swapchain, index, acquired, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
  ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &second, fence), VK_SUCCESS);
  auto open = make_struct<VkSemaphoreSignalInfo>();
  open.semaphore = gate;
  open.value = 1;
  ASSERT_EQ(VK_GET(instance, SignalSemaphoreKHR)(device, &open), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, WaitForFences)(device, 1, &fence, VK_TRUE, 5'000'000'000), VK_SUCCESS);
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
  VK_GET(instance, DestroySemaphore)(device, gate, nullptr);
  VK_GET(instance, DestroySemaphore)(device, acquired, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, PresentsAreWaitedForByTheirNumbers) {
  const VkSwapchainKHR swapchain = create();
  const auto wait = VK_GET(instance, WaitForPresentKHR);
  EXPECT_EQ(wait(device, swapchain, 1, 0), VK_TIMEOUT);
  std::uint32_t index = 99;
  for (const std::uint64_t id : {5, 0, 9}) {
    ASSERT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, VK_NULL_HANDLE, UINT64_MAX), VK_SUCCESS);
    ASSERT_EQ(present(swapchain, index, VK_NULL_HANDLE, id), VK_SUCCESS);
    EXPECT_EQ(id ? wait(device, swapchain, id, UINT64_MAX) : VK_SUCCESS, VK_SUCCESS);
  }
  EXPECT_EQ(wait(device, swapchain, 7, 0), VK_SUCCESS);
  EXPECT_EQ(wait(device, swapchain, 10, 1000), VK_TIMEOUT);
  destroy(swapchain);
}

TEST_F(SwapchainTest, PresentsSignalTheirFencesAndChangeTheMode) {
  const VkSwapchainKHR swapchain = create();
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR}) {
    std::uint32_t index = 99;
    ASSERT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence, UINT64_MAX), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, ResetFences)(device, 1, &fence), VK_SUCCESS);
    auto modes = make_struct<VkSwapchainPresentModeInfoEXT>();
    modes.swapchainCount = 1;
    modes.pPresentModes = &mode;
    auto fences = make_struct<VkSwapchainPresentFenceInfoEXT>(&modes);
    fences.swapchainCount = 1;
    fences.pFences = &fence;
    auto info = make_struct<VkPresentInfoKHR>(&fences);
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    ASSERT_EQ(VK_GET(instance, QueuePresentKHR)(queue, &info), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, WaitForFences)(device, 1, &fence, VK_TRUE, 5'000'000'000), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, ResetFences)(device, 1, &fence), VK_SUCCESS);
    EXPECT_EQ(from_handle<Swapchain>(swapchain).mode, mode);
  }
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, KeepsMetadataOfHighDynamicRange) {
  const VkSwapchainKHR swapchains[2] = {create(), create()};
  EXPECT_FALSE(from_handle<Swapchain>(swapchains[0]).hdr_metadata.has_value());
  VkHdrMetadataEXT metadata[2] = {make_struct<VkHdrMetadataEXT>(), make_struct<VkHdrMetadataEXT>()};
  metadata[0].maxLuminance = 1000;
  metadata[1].maxLuminance = 400;
  metadata[1].pNext = metadata;
  VK_GET(instance, SetHdrMetadataEXT)(device, 2, swapchains, metadata);
  EXPECT_EQ(from_handle<Swapchain>(swapchains[0]).hdr_metadata->maxLuminance, 1000);
  EXPECT_EQ(from_handle<Swapchain>(swapchains[1]).hdr_metadata->maxLuminance, 400);
  EXPECT_EQ(from_handle<Swapchain>(swapchains[1]).hdr_metadata->pNext, nullptr) << "it belongs to the application";
  for (const VkSwapchainKHR swapchain : swapchains) destroy(swapchain);
}

TEST_F(SwapchainTest, ImagesComeBackUnshown) {
  const VkSwapchainKHR swapchain = create(VK_NULL_HANDLE, 2);
  std::uint32_t indices[2] = {99, 99}, third = 99;
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  for (std::uint32_t& index : indices) {
    ASSERT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, ResetFences)(device, 1, &fence), VK_SUCCESS);
  }
  EXPECT_EQ(acquire(swapchain, third, VK_NULL_HANDLE, fence), VK_NOT_READY);
  auto info = make_struct<VkReleaseSwapchainImagesInfoEXT>();
  info.swapchain = swapchain;
  info.imageIndexCount = 1;
  info.pImageIndices = &indices[1];
  EXPECT_EQ(VK_GET(instance, ReleaseSwapchainImagesEXT)(device, &info), VK_SUCCESS);
  EXPECT_EQ(acquire(swapchain, third, VK_NULL_HANDLE, fence), VK_SUCCESS);
  EXPECT_EQ(third, indices[1]);
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, AcquiringMoreThanThereAreTimesOut) {
  const VkSwapchainKHR swapchain = create(VK_NULL_HANDLE, 2);
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  std::uint32_t index = 0;
  ASSERT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, GetFenceStatus)(device, fence), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, ResetFences)(device, 1, &fence), VK_SUCCESS);
  ASSERT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, ResetFences)(device, 1, &fence), VK_SUCCESS);
  EXPECT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence), VK_NOT_READY);
  EXPECT_EQ(acquire(swapchain, index, VK_NULL_HANDLE, fence, 1000000), VK_TIMEOUT);
  EXPECT_EQ(VK_GET(instance, GetFenceStatus)(device, fence), VK_NOT_READY);
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
  destroy(swapchain);
}

TEST_F(SwapchainTest, ARetiredSwapchainGivesNoMoreImages) {
  const VkSwapchainKHR first = create();
  const VkSemaphore acquired = semaphore();
  std::uint32_t held = 0, index = 0;
  ASSERT_EQ(acquire(first, held, acquired, VK_NULL_HANDLE), VK_SUCCESS);
  const VkSwapchainKHR second = create(first);
  EXPECT_EQ(acquire(first, index, VK_NULL_HANDLE, VK_NULL_HANDLE), VK_ERROR_OUT_OF_DATE_KHR);
  EXPECT_EQ(present(first, held, acquired), VK_SUCCESS) << "an image acquired before may be presented yet";
  EXPECT_EQ(acquire(second, index, acquired, VK_NULL_HANDLE), VK_SUCCESS);
  EXPECT_EQ(present(second, index, acquired), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, DeviceWaitIdle)(device), VK_SUCCESS);
  VK_GET(instance, DestroySemaphore)(device, acquired, nullptr);
  destroy(first);
  destroy(second);
}

TEST_F(SwapchainTest, CreationSurvivesEveryFailedAllocation) {
  auto info = make_struct<VkSwapchainCreateInfoKHR>();
  info.surface = surface;
  info.minImageCount = 3;
  info.imageFormat = VK_FORMAT_R8G8B8A8_SRGB;
  info.imageExtent = {8, 8};
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  info.presentMode = VK_PRESENT_MODE_MAILBOX_KHR;
  CountingAllocator allocator;
  for (std::size_t n = 0;; ++n) {
    allocator.fail_after(n);
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    const VkResult result = VK_GET(instance, CreateSwapchainKHR)(device, &info, allocator.callbacks(), &swapchain);
    if (result == VK_SUCCESS) {
      VK_GET(instance, DestroySwapchainKHR)(device, swapchain, allocator.callbacks());
      EXPECT_GT(n, 3u);
      break;
    }
    ASSERT_EQ(result, VK_ERROR_OUT_OF_HOST_MEMORY);
    ASSERT_EQ(allocator.live(), 0u) << "leak when allocation " << n << " fails";
  }
  EXPECT_EQ(allocator.live(), 0u);
}

}  // namespace
}  // namespace vitrine::icd::test
