// VkDeviceMemory, VkBuffer, VkBufferView: host memory seen by the device.
#pragma once

#include <atomic>

#include "icd/object/object.h"
#include "texel/view.h"

namespace vitrine::icd {

/// Readable bytes behind the last one of every allocation, so that vector loads of a tail need no care.
inline constexpr VkDeviceSize kTailBytes = 64;

/// Where an allocation lies in the address space, since device addresses are host addresses.
struct Placement {
  std::uintptr_t address = 0;  ///< of its first byte; 0: anywhere
  bool comes_again = false;    ///< where another process can have it at the same address
};

/// Bytes of the live DeviceMemory of all instances of the process: a heap is the machine's, not an instance's.
std::atomic<VkDeviceSize>& allocated_bytes();

/// A zero-filled mapping; pages appear when they are touched. kTailBytes follow the last one. It is private, or of a
/// file that other devices and processes can map, or the application's.
struct DeviceMemory : Object<VkDeviceMemory, VK_OBJECT_TYPE_DEVICE_MEMORY> {
  /// data stays null if the system has no memory, or not there. `total` counts the bytes while the object lives.
  DeviceMemory(const HostMemory& m, VkDeviceSize bytes, std::atomic<VkDeviceSize>& total, Placement placement = {});
  /// Nothing yet: one of the functions below follows.
  DeviceMemory(const HostMemory& m, VkDeviceSize bytes) : Object(m), size(bytes) {}
  ~DeviceMemory();

  /// Maps `size` bytes of the file and owns the descriptor. False: not that many bytes, or not for good
  /// (icd/object/shared_file.h), or no memory; the descriptor is the caller's again.
  bool map_file(int descriptor);
  /// Makes a file and maps it. False: the system has no memory.
  bool map_new_file();
  /// Uses the application's pages. False if what follows them cannot be read.
  bool use_host_pages(void* pages);

  std::byte* data = nullptr;
  VkDeviceSize size = 0;
  int file = -1;
  bool imported = false;  ///< somebody else's pages

 private:
  void* mapping_ = nullptr;  ///< what ends with the object; null: nothing
  std::size_t mapping_bytes_ = 0;
  std::atomic<VkDeviceSize>* counted_ = nullptr;
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
