// Fences and events on the host; messengers.
#include <string>
#include <thread>

#include "icd/edge/diagnostics.h"
#include "icd/object/sync.h"
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
  std::thread loser([&] { lose_device(from_handle<icd::Device>(device), {"a test", 0, {}}); });
  EXPECT_EQ(VK_GET(instance, WaitForFences)(device, 1, &fence, VK_TRUE, ~std::uint64_t{0}), VK_ERROR_DEVICE_LOST);
  loser.join();
  VK_GET(instance, DestroyFence)(device, fence, nullptr);
}

class TimelineSemaphore : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
  }
  void TearDown() override {
    for (const VkSemaphore semaphore : semaphores) VK_GET(instance, DestroySemaphore)(device, semaphore, nullptr);
    DeviceTest::TearDown();
  }
  VkSemaphore make(std::uint64_t value) {
    auto type = make_struct<VkSemaphoreTypeCreateInfo>();
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    type.initialValue = value;
    const auto info = make_struct<VkSemaphoreCreateInfo>(&type);
    VkSemaphore out;
    EXPECT_EQ(VK_GET(instance, CreateSemaphore)(device, &info, nullptr, &out), VK_SUCCESS);
    semaphores.push_back(out);
    return out;
  }
  std::uint64_t value_of(VkSemaphore semaphore) {
    std::uint64_t value = 0;
    EXPECT_EQ(VK_GET(instance, GetSemaphoreCounterValueKHR)(device, semaphore, &value), VK_SUCCESS);
    return value;
  }
  VkResult signal(VkSemaphore semaphore, std::uint64_t value) {
    auto info = make_struct<VkSemaphoreSignalInfo>();
    info.semaphore = semaphore;
    info.value = value;
    return VK_GET(instance, SignalSemaphoreKHR)(device, &info);
  }
  VkResult wait(std::initializer_list<VkSemaphore> list, std::initializer_list<std::uint64_t> values,
                std::uint64_t timeout, VkSemaphoreWaitFlags flags = 0) {
    auto info = make_struct<VkSemaphoreWaitInfo>();
    info.flags = flags;
    info.semaphoreCount = static_cast<std::uint32_t>(list.size());
    info.pSemaphores = list.begin();
    info.pValues = values.begin();
    return VK_GET(instance, WaitSemaphoresKHR)(device, &info, timeout);
  }
  /// A batch without commands that waits and then signals.
  VkResult submit(VkSemaphore waits, std::uint64_t wait_value, VkSemaphore signals, std::uint64_t signal_value) {
    auto values = make_struct<VkTimelineSemaphoreSubmitInfo>();
    values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
    values.pWaitSemaphoreValues = &wait_value;
    values.pSignalSemaphoreValues = &signal_value;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    auto info = make_struct<VkSubmitInfo>(&values);
    info.waitSemaphoreCount = info.signalSemaphoreCount = 1;
    info.pWaitSemaphores = &waits;
    info.pSignalSemaphores = &signals;
    info.pWaitDstStageMask = &stage;
    return VK_GET(instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
  }

  static constexpr std::uint64_t kForever = ~std::uint64_t{0};
  VkQueue queue = VK_NULL_HANDLE;
  std::vector<VkSemaphore> semaphores;
};

TEST_F(TimelineSemaphore, CountsOnTheHost) {
  const VkSemaphore a = make(7), b = make(0);
  EXPECT_EQ(value_of(a), 7u);
  EXPECT_EQ(wait({a, b}, {7, 1}, 0), VK_TIMEOUT);
  EXPECT_EQ(wait({a, b}, {7, 1}, 0, VK_SEMAPHORE_WAIT_ANY_BIT), VK_SUCCESS);
  EXPECT_EQ(signal(b, kForever - 1), VK_SUCCESS);
  EXPECT_EQ(wait({a, b}, {7, 1}, 0), VK_SUCCESS);
  EXPECT_EQ(value_of(b), kForever - 1);
}

TEST_F(TimelineSemaphore, ABatchMayWaitForWhatIsSignalledLater) {
  const VkSemaphore a = make(0), b = make(0);
  ASSERT_EQ(submit(a, 3, b, 1), VK_SUCCESS) << "must not block";
  ASSERT_EQ(submit(a, 5, b, 2), VK_SUCCESS);
  EXPECT_EQ(wait({b}, {1}, 1000), VK_TIMEOUT);
  std::thread signaller([&] {
    signal(a, 4);
    wait({b}, {1}, kForever);
    signal(a, 5);
  });
  EXPECT_EQ(wait({b}, {2}, kForever), VK_SUCCESS);
  signaller.join();
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  EXPECT_EQ(value_of(b), 2u);
}

/// What the queue keeps of batches that stood in a row for the next ones does not hold on to that row.
TEST_F(TimelineSemaphore, RowsOfBatchesComeOneAfterTheOther) {
  const VkSemaphore a = make(0), b = make(0);
  std::uint64_t done = 0;
  for (std::uint64_t row = 1; row <= 20; ++row) {
    for (int i = 0; i < 3; ++i, ++done) ASSERT_EQ(submit(a, row, b, done + 1), VK_SUCCESS);
    ASSERT_EQ(signal(a, row), VK_SUCCESS);
    ASSERT_EQ(wait({b}, {done}, kForever), VK_SUCCESS);
    ASSERT_EQ(submit(a, row, b, ++done), VK_SUCCESS) << "one that need not wait";
  }
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  EXPECT_EQ(value_of(b), done);
}

TEST_F(TimelineSemaphore, TwoThreadsPassABatonThroughTheQueue) {
  const VkSemaphore a = make(0), b = make(0);
  constexpr std::uint64_t kRounds = 200;
  std::thread other([&] {
    for (std::uint64_t i = 1; i <= kRounds; ++i) {
      EXPECT_EQ(wait({b}, {i}, kForever), VK_SUCCESS);
      if (i < kRounds) signal(a, i + 1);
    }
  });
  for (std::uint64_t i = 1; i <= kRounds; ++i) ASSERT_EQ(submit(a, i, b, i), VK_SUCCESS);
  EXPECT_EQ(signal(a, 1), VK_SUCCESS);
  other.join();
  EXPECT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
}

TEST_F(TimelineSemaphore, LosingTheDeviceEndsWaits) {
  const VkSemaphore a = make(0), b = make(0), c = make(0);
  ASSERT_EQ(submit(a, 1, b, 1), VK_SUCCESS);
  ASSERT_EQ(submit(c, 1, c, 2), VK_SUCCESS) << "its turn comes when the semaphores may be gone";
  std::thread loser([&] { lose_device(from_handle<icd::Device>(device), {"a test", 0, {}}); });
  EXPECT_EQ(wait({b}, {1}, kForever), VK_ERROR_DEVICE_LOST);
  loser.join();
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
