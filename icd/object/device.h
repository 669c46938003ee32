// VkDevice and VkQueue: what every other object is made from.
#pragma once

#include <atomic>
#include <condition_variable>

#include "icd/object/instance.h"
#include "icd/object/labels.h"
#include "icd/object/shader_links.h"
#include "icd/object/shader_table.h"

namespace vitrine::glass {
class Profile;
}

namespace vitrine::icd {

class AddressBook;
struct DescribedObjects;
struct Device;
struct QueueWorker;
struct ReplayState;

/// The one queue of the universal family. What runs on it is the queue chapter's business: it hangs its thread and
/// lists on `worker`.
struct Queue : DispatchableObject<VkQueue, VK_OBJECT_TYPE_QUEUE> {
  Queue(const HostMemory& m, Device& owner) : DispatchableObject(m), device(owner) {}

  Device& device;
  VkDeviceQueueCreateFlags flags = 0;
  QueueWorker* worker = nullptr;
  std::mutex label_mutex;
  LabelStack labels;  ///< open now; guarded by label_mutex
};

/// Why a device was lost (VK_EXT_device_fault).
struct DeviceLoss {
  /// One of the calls that lead to the place of the loss, innermost first.
  struct Call {
    std::string text;        ///< "in function blur at a.comp:12:3"
    std::uint64_t line = 0;  ///< 0: unknown
  };
  std::string reason;
  std::uint32_t spirv_id = 0;  ///< 0: unknown
  std::vector<Call> calls;
  bool of_shader = false;  ///< a shader did not end
};

struct Device : DispatchableObject<VkDevice, VK_OBJECT_TYPE_DEVICE> {
  Device(const HostMemory& m, PhysicalDevice& parent)
      : DispatchableObject(m),
        physical_device(parent),
        queue(m, *this),
        shaders(m),
        shader_links(m),
        memory_reports(m) {}

  PhysicalDevice& physical_device;
  ExtensionSet extensions;  ///< enabled
  FeatureSet features;      ///< enabled
  Queue queue;
  ShaderTable shaders;
  ShaderLinks shader_links;
  std::atomic<std::uint64_t> next_private_data_slot = 1;
  std::shared_ptr<ReplayState> replay;  ///< made with the first command pool; used by whoever runs a batch of the queue

  Vector<VkDeviceDeviceMemoryReportCreateInfoEXT> memory_reports;  ///< who wants to hear of memory; constant

  std::shared_ptr<AddressBook> addresses;       ///< null: nobody observes
  std::shared_ptr<DescribedObjects> described;  ///< null: descriptors do not lie in buffers (VK_EXT_descriptor_buffer)
  std::shared_ptr<glass::Profile> profile;  ///< made with the first pool of performance queries; guarded by sync_mutex

  /// Guards the states of fences, semaphores and events, and `lost` (icd/object/sync.h).
  std::mutex sync_mutex;
  std::condition_variable sync_changed;
  bool lost = false;
  DeviceLoss loss;  ///< constant once `lost` is set
};

/// Defined with the queue (weak until then): called at the end of vkCreateDevice and the start of vkDestroyDevice.
/// start_queue may throw std::bad_alloc.
__attribute__((weak)) void start_queue(Queue& queue);
__attribute__((weak)) void stop_queue(Queue& queue) noexcept;

}  // namespace vitrine::icd
