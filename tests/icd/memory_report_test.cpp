// What applications hear of device memory, and what they may say of its importance.
#include <vector>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

using Events = std::vector<VkDeviceMemoryReportCallbackDataEXT>;

VKAPI_ATTR void VKAPI_CALL remember_event(const VkDeviceMemoryReportCallbackDataEXT* data, void* user) {
  static_cast<Events*>(user)->push_back(*data);
}

class MemoryReport : public DeviceTest {
 protected:
  void make_device() override {
    auto second = make_struct<VkDeviceDeviceMemoryReportCreateInfoEXT>();
    second.pfnUserCallback = remember_event;
    second.pUserData = &others;
    auto report = make_struct<VkDeviceDeviceMemoryReportCreateInfoEXT>(&second);
    report.pfnUserCallback = remember_event;
    report.pUserData = &events;
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &report), VK_SUCCESS);
  }
  VkResult allocate(VkDeviceSize size, VkDeviceMemory* memory, void* next = nullptr) {
    auto info = make_struct<VkMemoryAllocateInfo>(next);
    info.allocationSize = size;
    return VK_GET(instance, AllocateMemory)(device, &info, nullptr, memory);
  }

  Events events, others;
};

TEST_F(MemoryReport, TellsOfTheLifeOfAnAllocation) {
  VkDeviceMemory memory;
  auto priority = make_struct<VkMemoryPriorityAllocateInfoEXT>();
  priority.priority = 0.25F;
  ASSERT_EQ(allocate(5000, &memory, &priority), VK_SUCCESS);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].type, VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_ALLOCATE_EXT);
  EXPECT_EQ(events[0].size, 5000u);
  EXPECT_EQ(events[0].objectType, VK_OBJECT_TYPE_DEVICE_MEMORY);
  EXPECT_EQ(events[0].objectHandle, reinterpret_cast<std::uint64_t>(memory));
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].type, VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_FREE_EXT);
  EXPECT_EQ(events[1].memoryObjectId, events[0].memoryObjectId);
  EXPECT_EQ(others.size(), 2u);
}

TEST_F(MemoryReport, TellsOfFailures) {
  VkDeviceMemory memory;
  EXPECT_EQ(allocate(VkDeviceSize{1} << 62, &memory), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].type, VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_ALLOCATION_FAILED_EXT);
  EXPECT_EQ(events[0].size, VkDeviceSize{1} << 62);
}

TEST_F(MemoryReport, KnowsSharedMemoryByOneNumber) {
  auto exported = make_struct<VkExportMemoryAllocateInfo>();
  exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  VkDeviceMemory first, second;
  ASSERT_EQ(allocate(4096, &first, &exported), VK_SUCCESS);
  auto get = make_struct<VkMemoryGetFdInfoKHR>();
  get.memory = first;
  get.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  auto import = make_struct<VkImportMemoryFdInfoKHR>();
  import.handleType = get.handleType;
  ASSERT_EQ(VK_GET(instance, GetMemoryFdKHR)(device, &get, &import.fd), VK_SUCCESS);
  ASSERT_EQ(allocate(4096, &second, &import), VK_SUCCESS);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].type, VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_IMPORT_EXT);
  EXPECT_EQ(events[1].memoryObjectId, events[0].memoryObjectId);
  VK_GET(instance, FreeMemory)(device, second, nullptr);
  EXPECT_EQ(events.back().type, VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_UNIMPORT_EXT);
  VK_GET(instance, FreeMemory)(device, first, nullptr);
}

TEST_F(MemoryReport, PrioritiesChangeNothing) {
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(4096, &memory), VK_SUCCESS);
  VK_GET(instance, SetDeviceMemoryPriorityEXT)(device, memory, 1.0F);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
  EXPECT_EQ(events.size(), 2u);
}

}  // namespace
}  // namespace vitrine::icd::test
