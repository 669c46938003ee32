// VkDeviceMemory, VkBuffer, VkBufferView: host memory seen by the device.
#pragma once

#include "icd/object.h"
#include "texel/view.h"

namespace vitrine::icd {

/// A zero-filled private mapping; pages appear when they are touched. 64 readable bytes follow the last one, so that
/// vector loads of a tail need no care.
struct DeviceMemory : Object<VkDeviceMemory, VK_OBJECT_TYPE_DEVICE_MEMORY> {
  DeviceMemory(const HostMemory& m, VkDeviceSize bytes);  ///< data stays null if the system has no memory
  ~DeviceMemory();

  std::byte* data = nullptr;
  VkDeviceSize size = 0;
};

struct Buffer : Object<VkBuffer, VK_OBJECT_TYPE_BUFFER> {
  using Object::Object;

  VkBufferCreateFlags flags = 0;
  VkBufferUsageFlags usage = 0;
  VkDeviceSize size = 0;
  std::byte* data = nullptr;  ///< null until memory is bound

  /// Bytes from `offset` on that `range` (may be VK_WHOLE_SIZE) names, never past the end.
  VkDeviceSize resolve_range(VkDeviceSize offset, VkDeviceSize range) const {
    if (offset >= size) return 0;
    return range < size - offset ? range : size - offset;
  }
};

struct BufferView : Object<VkBufferView, VK_OBJECT_TYPE_BUFFER_VIEW> {
  using Object::Object;

  texel::BufferTexelView view;
};

}  // namespace vitrine::icd
