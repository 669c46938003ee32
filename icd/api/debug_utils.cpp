// VK_EXT_debug_utils: messengers, names, tags and labels (Vulkan 1.3.239, Debugging).
#include <algorithm>
#include <array>

#include "base/log.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/object_notes.h"

namespace vitrine::icd {
namespace {

/// Calls every messenger that listens for the severity and type. The lock is not held during callbacks, which may call
/// Vulkan again.
void send(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
          const VkDebugUtilsMessengerCallbackDataEXT& data) {
  std::array<VkDebugUtilsMessengerCreateInfoEXT, 16> listeners;
  std::size_t count = 0;
  {
    const std::lock_guard lock(instance.messenger_mutex);
    for (const Messenger* messenger : instance.messengers) {
      const VkDebugUtilsMessengerCreateInfoEXT& info = messenger->create_info;
      if ((info.messageSeverity & severity) && (info.messageType & types) && count < listeners.size()) {
        listeners[count++] = info;
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) listeners[i].pfnUserCallback(severity, types, &data, listeners[i].pUserData);
}

/// The name that the application gave, or nothing.
std::string name_of(Instance& instance, ObjectRef object) {
  if (!object.handle) return {};
  const std::lock_guard lock(instance.notes_mutex);
  const ObjectNotes* notes = object_of(object.type, object.handle).notes;
  return notes ? std::string(notes->name.begin(), notes->name.end()) : std::string();
}

}  // namespace

void report(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity, ObjectRef object, const char* id,
            std::string_view message) noexcept {
  try {
    const std::string text(message), own_name = name_of(instance, object);
    base::log(severity == VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? "error" : id,
              own_name.empty() ? text : own_name + ": " + text);
    VkDebugUtilsObjectNameInfoEXT name = make_struct<VkDebugUtilsObjectNameInfoEXT>();
    name.objectType = object.type;
    name.objectHandle = object.handle;
    name.pObjectName = own_name.empty() ? nullptr : own_name.c_str();
    auto data = make_struct<VkDebugUtilsMessengerCallbackDataEXT>();
    data.pMessageIdName = id;
    data.pMessage = text.c_str();
    data.objectCount = object.handle ? 1 : 0;
    data.pObjects = &name;
    send(instance, severity, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, data);
  } catch (...) {
    // No memory for a message: the error code that follows has to do.
  }
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateDebugUtilsMessengerEXT(VkInstance instance,
                                                            const VkDebugUtilsMessengerCreateInfoEXT* info,
                                                            const VkAllocationCallbacks* allocator,
                                                            VkDebugUtilsMessengerEXT* messenger) {
  Instance& owner = from_handle<Instance>(instance);
  Owned<Messenger> object(create_object<Messenger>(owner.memory, allocator, *info));
  const std::lock_guard lock(owner.messenger_mutex);
  owner.messengers.push_back(&*object);
  *messenger = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyDebugUtilsMessengerEXT(VkInstance instance, VkDebugUtilsMessengerEXT messenger,
                                                         const VkAllocationCallbacks*) {
  if (!messenger) return;
  Instance& owner = from_handle<Instance>(instance);
  {
    const std::lock_guard lock(owner.messenger_mutex);
    std::erase(owner.messengers, from_nullable<Messenger>(messenger));
  }
  destroy_handle<Messenger>(messenger);
}

VKAPI_ATTR void VKAPI_CALL SubmitDebugUtilsMessageEXT(VkInstance instance,
                                                      VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                      VkDebugUtilsMessageTypeFlagsEXT types,
                                                      const VkDebugUtilsMessengerCallbackDataEXT* data) {
  send(from_handle<Instance>(instance), severity, types, *data);
}

VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectNameEXT(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
  const std::lock_guard lock(from_handle<Device>(device).physical_device.instance.notes_mutex);
  notes_of(object_of(info->objectType, info->objectHandle)).name = info->pObjectName ? info->pObjectName : "";
  return VK_SUCCESS;
}

// Tags and labels are accepted; tools above the driver keep them.
VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectTagEXT(VkDevice, const VkDebugUtilsObjectTagInfoEXT*) {
  return VK_SUCCESS;
}
VKAPI_ATTR void VKAPI_CALL QueueBeginDebugUtilsLabelEXT(VkQueue, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL QueueEndDebugUtilsLabelEXT(VkQueue) {}
VKAPI_ATTR void VKAPI_CALL QueueInsertDebugUtilsLabelEXT(VkQueue, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer) {}
VKAPI_ATTR void VKAPI_CALL CmdInsertDebugUtilsLabelEXT(VkCommandBuffer, const VkDebugUtilsLabelEXT*) {}

}  // namespace entry
}  // namespace vitrine::icd
