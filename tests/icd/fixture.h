// What the icd tests share: the driver's functions by name, and an instance with a device whose host allocations can be
// made to fail.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <mutex>
#include <span>

#include "tests/icd/calls.h"

namespace vitrine::icd::test {

/// Allocation callbacks that count, fail at will and know what is still alive. Thread-safe: queues allocate too.
class CountingAllocator {
 public:
  CountingAllocator() {
    callbacks_.pUserData = this;
    callbacks_.pfnAllocation = [](void* self, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
      return static_cast<CountingAllocator*>(self)->allocate(size, alignment);
    };
    callbacks_.pfnReallocation = [](void*, void*, std::size_t, std::size_t, VkSystemAllocationScope) -> void* {
      return nullptr;
    };
    callbacks_.pfnFree = [](void* self, void* memory) { static_cast<CountingAllocator*>(self)->release(memory); };
  }

  const VkAllocationCallbacks* callbacks() const { return &callbacks_; }
  /// The n-th allocation from now on fails (0: the next one), and all after it.
  void fail_after(std::size_t n) { remaining_ = n; }
  std::size_t live() const { return live_.size(); }
  bool failed() const { return failed_; }
  void clear_failed() { failed_ = false; }

 private:
  void* allocate(std::size_t size, std::size_t alignment) {
    const std::lock_guard lock(mutex_);
    if (remaining_ == 0) {
      failed_ = true;
      return nullptr;
    }
    if (remaining_ != ~std::size_t{0}) --remaining_;
    void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    live_[memory] = size;
    return memory;
  }
  void release(void* memory) {
    if (!memory) return;
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(live_.erase(memory), 1u) << "freed twice or not ours";
    std::free(memory);
  }

  VkAllocationCallbacks callbacks_{};
  std::mutex mutex_;
  std::map<void*, std::size_t> live_;
  std::size_t remaining_ = ~std::size_t{0};
  bool failed_ = false;
};

inline VkResult create_instance(VkInstance* instance, const VkAllocationCallbacks* allocator = nullptr,
                                std::initializer_list<const char*> extensions = {}) {
  VkApplicationInfo application = make_struct<VkApplicationInfo>();
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo info = make_struct<VkInstanceCreateInfo>();
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.begin();
  return VK_GET(nullptr, CreateInstance)(&info, allocator, instance);
}

/// An instance, its physical device and a device.
class DeviceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(create_instance(&instance, nullptr, {VK_EXT_DEBUG_UTILS_EXTENSION_NAME}), VK_SUCCESS);
    std::uint32_t count = 1;
    ASSERT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &physical_device), VK_SUCCESS);
    make_device();
  }
  virtual void make_device() { ASSERT_EQ(create_device(instance, physical_device, &device), VK_SUCCESS); }
  void TearDown() override {
    if (device) VK_GET(instance, DestroyDevice)(device, nullptr);
    if (instance) VK_GET(instance, DestroyInstance)(instance, nullptr);
  }

  /// What `record` puts into a command buffer, run to its end.
  template <class Record>
  void run(Record record) {
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    VkCommandPool pool;
    ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands;
    ASSERT_EQ(VK_GET(instance, AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    ASSERT_EQ(VK_GET(instance, BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
    record(commands);
    ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(commands), VK_SUCCESS);
    auto submit = make_struct<VkSubmitInfo>();
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    VkQueue queue;
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
    ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
    VK_GET(instance, DestroyCommandPool)(device, pool, nullptr);
  }

  /// One workgroup of a compute pipeline with set 0, run to its end.
  void dispatch(VkPipeline pipeline, VkPipelineLayout layout, VkDescriptorSet set) {
    run([&](VkCommandBuffer commands) {
      VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      const auto bind = VK_GET(instance, CmdBindDescriptorSets);
      bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
      VK_GET(instance, CmdDispatch)(commands, 1, 1, 1);
    });
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
};

}  // namespace vitrine::icd::test
