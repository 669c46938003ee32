// Finds both drivers through the loader, creates a device of each, and listens to the validation layer.
#include "harness/gpu.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>

#include "harness/claims.h"
#include "harness/options.h"
#include "harness/recorded.h"
#include "harness/reference.h"

namespace vitrine::cts {
namespace {

constexpr char kValidationLayer[] = "VK_LAYER_KHRONOS_validation";

std::mutex g_messages_mutex;
std::vector<std::string> g_messages;
bool g_validation = false;
VkDebugUtilsMessengerEXT g_messenger = VK_NULL_HANDLE;
std::vector<Finding> g_findings;

// The layer's own mistakes, or notes that are no errors of the case; each with its reason.
constexpr const char* kIgnored[] = {
    "UNASSIGNED-CoreValidation-Shader-OutputNotConsumed",  // a note about an unread output, not an error
};

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  const std::string id = data->pMessageIdName ? data->pMessageIdName : "";
  for (const char* ignored : kIgnored)
    if (id == ignored) return VK_FALSE;
  const std::lock_guard lock(g_messages_mutex);
  std::string text = data->pMessage ? data->pMessage : "";
  if (text.find("[vitrine/" + id + "]") != std::string::npos) {
    g_findings.push_back({id, std::move(text)});
    return VK_FALSE;
  }
  if (!g_validation) return VK_FALSE;
  constexpr size_t kEnough = 500;  // the rest quotes the specification
  if (text.size() > kEnough) text = text.substr(0, kEnough) + "...";
  if (std::find(g_messages.begin(), g_messages.end(), text) == g_messages.end() && g_messages.size() < 20)
    g_messages.push_back(std::move(text));
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info() {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = on_message;
  return info;
}

bool layer_present() {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [](const VkLayerProperties& layer) { return !std::strcmp(layer.layerName, kValidationLayer); });
}

/// Whether this driver's tools are on: they tell through messengers.
bool tools_are_on() { return std::getenv("VITRINE_TOOLS") != nullptr; }

VkInstance create_instance(bool validation, uint32_t api_version) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "cts_subset";
  application.apiVersion = api_version;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  const char* layer = kValidationLayer;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info();
  const bool listens = validation || tools_are_on();
  if (validation) {
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &layer;
  }
  if (listens) {
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    info.pNext = &messenger;
  }
  VkInstance instance = VK_NULL_HANDLE;
  CTS_VK(vkCreateInstance(&info, nullptr, &instance));
  if (listens) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    if (create) CTS_VK(create(instance, &messenger, nullptr, &g_messenger));
  }
  return instance;
}

void list_extensions(Gpu& gpu) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(gpu.physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> offered(count);
  vkEnumerateDeviceExtensionProperties(gpu.physical, nullptr, &count, offered.data());
  for (const VkExtensionProperties& extension : offered) gpu.offered.push_back(extension.extensionName);
  keep_wanted_extensions(gpu);
}

/// Links the feature structures that the device has.
void* feature_chain(Gpu& gpu) {
  void* first = nullptr;
  const auto has = [&](const char* extension) { return gpu.has(extension); };
  for_each_structure(gpu.extension_features, has, [&](auto& structure, VkStructureType type, bool is_there) {
    if (!is_there) return;
    structure.sType = type;
    structure.pNext = first;
    first = &structure;
  });
  return first;
}

void create_device(Gpu& gpu) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical, &count, families.data());
  const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  const auto family =
      std::find_if(families.begin(), families.end(), [&](const auto& f) { return (f.queueFlags & wanted) == wanted; });
  if (family == families.end()) throw std::runtime_error(gpu.name + " has no universal queue family");
  gpu.family = static_cast<uint32_t>(family - families.begin());

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = gpu.family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  std::vector<const char*> names;
  for (const std::string& extension : gpu.extensions) names.push_back(extension.c_str());
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, feature_chain(gpu)};
  info.enabledExtensionCount = static_cast<uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.pEnabledFeatures = &gpu.features;
  CTS_VK(vkCreateDevice(gpu.physical, &info, nullptr, &gpu.device));
  vkGetDeviceQueue(gpu.device, gpu.family, 0, &gpu.queue);
}

Gpu open(VkInstance instance, VkPhysicalDevice physical) {
  Gpu gpu;
  gpu.instance = instance;
  gpu.physical = physical;
  vkGetPhysicalDeviceProperties(physical, &gpu.properties);
  list_extensions(gpu);
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, feature_chain(gpu)};
  vkGetPhysicalDeviceFeatures2(physical, &features);
  gpu.features = features.features;
  vkGetPhysicalDeviceMemoryProperties(physical, &gpu.memory);
  gpu.name = gpu.properties.deviceName;
  create_device(gpu);
  return gpu;
}

Gpus create_gpus() {
  Gpus result;
  g_validation = options().validation && layer_present();
  result.api_version = VK_API_VERSION_1_1;
  result.instance = create_instance(g_validation, result.api_version);
  uint32_t count = 0;
  CTS_VK(vkEnumeratePhysicalDevices(result.instance, &count, nullptr));
  std::vector<VkPhysicalDevice> list(count);
  CTS_VK(vkEnumeratePhysicalDevices(result.instance, &count, list.data()));

  VkPhysicalDevice reference = VK_NULL_HANDLE, device = VK_NULL_HANDLE;
  std::string seen;
  result.same_driver = options().icd == options().reference_icd && !recorded_reference();
  for (VkPhysicalDevice physical : list) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    seen += std::string(" '") + properties.deviceName + "'";
    const bool is_reference = result.same_driver || std::strncmp(properties.deviceName, "llvmpipe", 8) == 0;
    (is_reference ? reference : device) = physical;
    result.api_version = std::min(result.api_version, properties.apiVersion & ~0xfffu);
  }
  if (result.same_driver) device = reference;
  if (!device || (!reference && !recorded_reference()))
    throw std::runtime_error("the loader found" + (seen.empty() ? " no device" : seen) + "; wanted one of " +
                             options().icd +
                             (recorded_reference() ? "" : " and llvmpipe from " + options().reference_icd));
  result.reference = recorded_reference() ? gpu_of_claims(recorded_reference()->device, recorded_reference()->claims)
                                          : open(result.instance, reference);
  result.device = open(result.instance, device);
  if (const std::vector<std::string> errors = take_validation_errors(); !errors.empty())
    throw std::runtime_error("creating the devices is invalid: " + errors.front());
  return result;
}

}  // namespace

VulkanError::VulkanError(VkResult code, const char* call)
    : std::runtime_error(std::string(call) + " returned " + std::to_string(code)), code(code) {}

void check(VkResult result, const char* call) {
  if (result < 0) throw VulkanError(result, call);
}

VkFormatProperties Gpu::format_properties(VkFormat format) const {
  VkFormatProperties found{};
  if (physical)
    vkGetPhysicalDeviceFormatProperties(physical, format, &found);
  else if (const auto row = recorded_formats.find(format); row != recorded_formats.end())
    found = row->second;
  return found;
}

VkFormatFeatureFlags Gpu::features_of(VkFormat format, VkImageTiling tiling) const {
  const VkFormatProperties found = format_properties(format);
  return tiling == VK_IMAGE_TILING_LINEAR ? found.linearTilingFeatures : found.optimalTilingFeatures;
}

uint32_t Gpu::memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
    if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw std::runtime_error(name + ": no memory type fits");
}

bool Gpu::has(const char* extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

PFN_vkVoidFunction Gpu::command(const char* name) const { return vkGetDeviceProcAddr(device, name); }

Gpus& gpus() {
  static Gpus both = create_gpus();
  return both;
}

void keep_wanted_extensions(Gpu& gpu) {
  for (const std::string& name : gpu.offered)
    if (std::find(std::begin(kWantedExtensions), std::end(kWantedExtensions), name) != std::end(kWantedExtensions))
      gpu.extensions.push_back(name);
}

std::string driver_info(const Gpu& gpu) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
  vkGetPhysicalDeviceProperties2(gpu.physical, &properties);
  return driver.driverInfo;
}

void recreate(Gpu& gpu) {
  vkDestroyDevice(gpu.device, nullptr);
  gpu.device = VK_NULL_HANDLE;
  create_device(gpu);
}

void destroy_gpus() {
  Gpus& both = gpus();
  for (Gpu* gpu : {&both.device, &both.reference}) {
    if (!gpu->device) continue;
    vkDeviceWaitIdle(gpu->device);
    vkDestroyDevice(gpu->device, nullptr);
  }
  if (g_messenger) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(both.instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(both.instance, g_messenger, nullptr);
  }
  vkDestroyInstance(both.instance, nullptr);
}

std::vector<std::string> take_validation_errors() {
  const std::lock_guard lock(g_messages_mutex);
  return std::exchange(g_messages, {});
}

std::vector<Finding> take_findings() {
  const std::lock_guard lock(g_messages_mutex);
  return std::exchange(g_findings, {});
}

bool validation_is_on() { return g_validation; }

}  // namespace vitrine::cts
