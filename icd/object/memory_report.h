// What applications are told of the device's memory (Vulkan 1.3.239, Debugging: Device Memory Report).
#pragma once

#include "icd/object/device.h"
#include "icd/object/memory.h"

namespace vitrine::icd {

/// Memory that is there from now on, or is about to go.
void report_memory(const Device& device, const DeviceMemory& memory, bool begins);
void report_failed_allocation(const Device& device, const VkMemoryAllocateInfo& info);

}  // namespace vitrine::icd
