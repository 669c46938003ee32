// VK_EXT_debug_utils: messengers, names, tags and labels (Vulkan 1.3.239, Debugging).
#include <algorithm>
#include <array>
#include <cstring>

#include "base/log.h"
#include "glass/pixel/pixels.h"
#include "glass/session.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/image.h"
#include "icd/object/object_notes.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {

// The lock is not held during callbacks, which may call Vulkan again.
void send_message(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                  VkDebugUtilsMessageTypeFlagsEXT types, const VkDebugUtilsMessengerCallbackDataEXT& data) {
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

std::string name_of(Instance& instance, ObjectRef object) {
  if (!object.handle) return {};
  const std::lock_guard lock(instance.notes_mutex);
  const ObjectNotes* notes = object_of(object.type, object.handle).notes;
  return notes ? std::string(notes->name.begin(), notes->name.end()) : std::string();
}

std::string names_of(Instance& instance, std::span<const ObjectRef> objects) {
  std::string names;
  for (const ObjectRef& object : objects) {
    const std::string name = name_of(instance, object);
    if (!name.empty()) names.append(names.empty() ? "" : " + ").append(name);
  }
  return names;
}

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
    send_message(instance, severity, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, data);
  } catch (...) {
    // No memory for a message: the error code that follows has to do.
  }
}

namespace {

bool keeps_labels() { return !glass::session().idle(); }

template <class Change>
void change_labels(VkQueue handle, Change change) {
  if (!keeps_labels()) return;
  Queue& queue = from_handle<Queue>(handle);
  const std::lock_guard lock(queue.label_mutex);
  change(queue.labels);
}

std::span<const char> copy_name(VkCommandBuffer buffer, const VkDebugUtilsLabelEXT& label) {
  return copy_array(buffer, label.pLabelName, std::strlen(label.pLabelName));
}

}  // namespace

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
  send_message(from_handle<Instance>(instance), severity, types, *data);
}

VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectNameEXT(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
  const std::lock_guard lock(from_handle<Device>(device).physical_device.instance.notes_mutex);
  const char* const name = info->pObjectName ? info->pObjectName : "";
  ObjectBase& object = object_of(info->objectType, info->objectHandle);
  notes_of(object).name = name;
  glass::pixel::Pixels* const pixels = glass::pixel::pixels();
  if (pixels && info->objectType == VK_OBJECT_TYPE_IMAGE)
    pixels->image_named(reinterpret_cast<const Image*>(info->objectHandle), name);
  return VK_SUCCESS;
}

// Tags are accepted; tools above the driver keep them.
VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectTagEXT(VkDevice, const VkDebugUtilsObjectTagInfoEXT*) {
  return VK_SUCCESS;
}

// Labels are kept where tools are on.
VKAPI_ATTR void VKAPI_CALL QueueBeginDebugUtilsLabelEXT(VkQueue queue, const VkDebugUtilsLabelEXT* label) {
  change_labels(queue, [&](LabelStack& labels) { labels.begin(label->pLabelName); });
}
VKAPI_ATTR void VKAPI_CALL QueueEndDebugUtilsLabelEXT(VkQueue queue) {
  change_labels(queue, [](LabelStack& labels) { labels.end(); });
}
VKAPI_ATTR void VKAPI_CALL QueueInsertDebugUtilsLabelEXT(VkQueue queue, const VkDebugUtilsLabelEXT* label) {
  change_labels(queue, [&](LabelStack& labels) { labels.insert(label->pLabelName); });
}
VKAPI_ATTR void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer buffer, const VkDebugUtilsLabelEXT* label) {
  if (keeps_labels()) record(buffer, CmdBeginLabel{copy_name(buffer, *label)});
}
VKAPI_ATTR void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer buffer) {
  if (keeps_labels()) record(buffer, CmdEndLabel{});
}
VKAPI_ATTR void VKAPI_CALL CmdInsertDebugUtilsLabelEXT(VkCommandBuffer buffer, const VkDebugUtilsLabelEXT* label) {
  if (keeps_labels()) record(buffer, CmdInsertLabel{copy_name(buffer, *label)});
}

}  // namespace entry
}  // namespace vitrine::icd
