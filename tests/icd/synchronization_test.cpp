// Fences and events on the host; messengers.
#include <string>
#include <thread>

#include "icd/diagnostics.h"
#include "icd/sync.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

using Synchronization = DeviceTest;
using DebugUtils = DeviceTest;

TEST_F(Synchronization, FencesWaitForAnyOrAll) {
  VkFenceCreateInfo info = make_struct<VkFenceCreateInfo>();
  VkFence fences[2];
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &info, nullptr, &fences[0]), VK_SUCCESS);
  info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &info, nullptr, &fences[1]), VK_SUCCESS);
  const auto wait = VK_GET(instance, WaitForFences);
  EXPECT_EQ(wait(device, 2, fences, VK_FALSE, 0), VK_SUCCESS);
  EXPECT_EQ(wait(device, 2, fences, VK_TRUE, 1000), VK_TIMEOUT);
  EXPECT_EQ(VK_GET(instance, GetFenceStatus)(device, fences[0]), VK_NOT_READY);
  std::thread signaller([&] { signal_fence(from_handle<icd::Device>(device), from_handle<Fence>(fences[0])); });
  EXPECT_EQ(wait(device, 2, fences, VK_TRUE, ~std::uint64_t{0}), VK_SUCCESS);
  signaller.join();
  EXPECT_EQ(VK_GET(instance, ResetFences)(device, 2, fences), VK_SUCCESS);
  EXPECT_EQ(wait(device, 1, &fences[1], VK_TRUE, 0), VK_TIMEOUT);
  for (const VkFence fence : fences) VK_GET(instance, DestroyFence)(device, fence, nullptr);
}

TEST_F(Synchronization, EventsAreSetAndReset) {
  const VkEventCreateInfo info = make_struct<VkEventCreateInfo>();
  VkEvent event;
  ASSERT_EQ(VK_GET(instance, CreateEvent)(device, &info, nullptr, &event), VK_SUCCESS);
  const auto status = VK_GET(instance, GetEventStatus);
  EXPECT_EQ(status(device, event), VK_EVENT_RESET);
  EXPECT_EQ(VK_GET(instance, SetEvent)(device, event), VK_SUCCESS);
  EXPECT_EQ(status(device, event), VK_EVENT_SET);
  EXPECT_TRUE(wait_events(from_handle<icd::Device>(device), &event, 1));
  EXPECT_EQ(VK_GET(instance, ResetEvent)(device, event), VK_SUCCESS);
  EXPECT_EQ(status(device, event), VK_EVENT_RESET);
  VK_GET(instance, DestroyEvent)(device, event, nullptr);
}

TEST_F(Synchronization, LosingTheDeviceEndsEveryWait) {
  const VkFenceCreateInfo info = make_struct<VkFenceCreateInfo>();
  VkFence fence;
  ASSERT_EQ(VK_GET(instance, CreateFence)(device, &info, nullptr, &fence), VK_SUCCESS);
  std::thread loser([&] { lose_device(from_handle<icd::Device>(device), "a test"); });
  EXPECT_EQ(VK_GET(instance, WaitForFences)(device, 1, &fence, VK_TRUE, ~std::uint64_t{0}), VK_ERROR_DEVICE_LOST);
  loser.join();
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
}

VKAPI_ATTR VkBool32 VKAPI_CALL remember(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  *static_cast<std::string*>(user) += data->pMessage;
  return VK_FALSE;
}

TEST_F(DebugUtils, MessengersHearWhatTheyAskedFor) {
  std::string heard;
  VkDebugUtilsMessengerCreateInfoEXT info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = &remember;
  info.pUserData = &heard;
  VkDebugUtilsMessengerEXT messenger;
  ASSERT_EQ(VK_GET(instance, CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  icd::Device& d = from_handle<icd::Device>(device);
  report(d, VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT, ref(d), "test", "quiet");
  report_error(d, ref(d), "test", "loud");
  EXPECT_EQ(heard, "loud");
  VK_GET(instance, DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
  report_error(d, ref(d), "test", "gone");
  EXPECT_EQ(heard, "loud");
}

}  // namespace
}  // namespace vitrine::icd::test
