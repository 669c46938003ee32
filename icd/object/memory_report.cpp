// See memory_report.h.
#include "icd/object/memory_report.h"

#include <sys/stat.h>

#include "icd/edge/util.h"

namespace vitrine::icd {
namespace {

/// The same for everything that maps the same file; an address has no such bit.
std::uint64_t identity_of(const DeviceMemory& memory) {
  constexpr std::uint64_t kFile = std::uint64_t{1} << 63;
  struct stat status {};
  if (memory.file >= 0 && fstat(memory.file, &status) == 0) return kFile | status.st_ino;
  return reinterpret_cast<std::uintptr_t>(memory.data);
}

void tell(const Device& device, VkDeviceMemoryReportCallbackDataEXT& data) {
  data.objectType = VK_OBJECT_TYPE_DEVICE_MEMORY;
  for (const VkDeviceDeviceMemoryReportCreateInfoEXT& report : device.memory_reports)
    report.pfnUserCallback(&data, report.pUserData);
}

}  // namespace

void report_memory(const Device& device, const DeviceMemory& memory, bool begins) {
  if (device.memory_reports.empty()) return;
  auto data = make_struct<VkDeviceMemoryReportCallbackDataEXT>();
  if (memory.imported) {
    data.type =
        begins ? VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_IMPORT_EXT : VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_UNIMPORT_EXT;
  } else {
    data.type = begins ? VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_ALLOCATE_EXT : VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_FREE_EXT;
  }
  data.memoryObjectId = identity_of(memory);
  data.size = memory.size;
  data.objectHandle = reinterpret_cast<std::uintptr_t>(&memory);
  tell(device, data);
}

void report_failed_allocation(const Device& device, const VkMemoryAllocateInfo& info) {
  auto data = make_struct<VkDeviceMemoryReportCallbackDataEXT>();
  data.type = VK_DEVICE_MEMORY_REPORT_EVENT_TYPE_ALLOCATION_FAILED_EXT;
  data.size = info.allocationSize;
  data.heapIndex = info.memoryTypeIndex;  // each type has a heap of its own
  tell(device, data);
}

}  // namespace vitrine::icd
