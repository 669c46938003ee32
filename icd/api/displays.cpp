// Displays, their planes and modes, and surfaces of them (Vulkan 1.3.239, Window System Integration: Presenting
// Directly to Display Devices): one display at most, with one plane (docs/recording.md).
#include <algorithm>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/instance.h"
#include "icd/wsi/display.h"
#include "icd/wsi/surface.h"

namespace vitrine::icd {
namespace {

constexpr VkDisplayPlaneAlphaFlagsKHR kAlphas =
    VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR | VK_DISPLAY_PLANE_ALPHA_GLOBAL_BIT_KHR |
    VK_DISPLAY_PLANE_ALPHA_PER_PIXEL_BIT_KHR | VK_DISPLAY_PLANE_ALPHA_PER_PIXEL_PREMULTIPLIED_BIT_KHR;

/// The displays of all instances: there are few, and objects know nothing of window systems.
std::mutex displays_mutex;
Display* displays = nullptr;

Display* display_of(VkPhysicalDevice device) { return display_of(from_handle<PhysicalDevice>(device).instance); }

/// Of 96 pixels an inch, as nothing has this size.
std::uint32_t millimetres(std::uint32_t pixels) { return (pixels * 254 + 480) / 960; }

VkDisplayPropertiesKHR properties_of(Display& display) {
  const VkExtent2D& pixels = display.setting.extent;
  VkDisplayPropertiesKHR out{};
  out.display = to_handle(&display);
  out.displayName = "VITRINE_DISPLAY";
  out.physicalDimensions = {millimetres(pixels.width), millimetres(pixels.height)};
  out.physicalResolution = pixels;
  out.supportedTransforms = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
  return out;
}

VkDisplayModePropertiesKHR properties_of(DisplayMode& mode) {
  return {to_handle(&mode), {mode.display.setting.extent, mode.millihertz}};
}

/// Of the one mode that is built in. Those that applications create are for who created them, and are not listed.
VkDisplayModePropertiesKHR built_in_mode(VkDisplayKHR handle) {
  return properties_of(from_handle<Display>(handle).native);
}

/// Planes show all of their image on all of the display.
VkDisplayPlaneCapabilitiesKHR capabilities_of(const DisplayMode& mode) {
  const VkExtent2D& whole = mode.display.setting.extent;
  VkDisplayPlaneCapabilitiesKHR out{};
  out.supportedAlpha = kAlphas;
  out.minSrcExtent = out.maxSrcExtent = out.minDstExtent = out.maxDstExtent = whole;
  return out;
}

}  // namespace

void make_display(const Instance& instance) {
  std::optional<wsi::DisplaySetting> setting = wsi::display_setting();
  if (!setting) return;
  Display* const display = create_object<Display>(instance.memory, nullptr, std::move(*setting));
  display->instance = &instance;
  const std::lock_guard lock(displays_mutex);
  display->next = displays;
  displays = display;
}

Display* display_of(const Instance& instance) {
  const std::lock_guard lock(displays_mutex);
  Display* display = displays;
  while (display && display->instance != &instance) display = display->next;
  return display;
}

void destroy_display(const Instance& instance) {
  Display* display = nullptr;
  {
    const std::lock_guard lock(displays_mutex);
    Display** link = &displays;
    while (*link && (*link)->instance != &instance) link = &(*link)->next;
    if (*link) display = std::exchange(*link, (*link)->next);
  }
  destroy_object(display);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceDisplayPropertiesKHR(VkPhysicalDevice device, std::uint32_t* count,
                                                                     VkDisplayPropertiesKHR* properties) {
  OutArray<VkDisplayPropertiesKHR> array(count, properties);
  if (Display* display = display_of(device)) array.push(properties_of(*display));
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceDisplayProperties2KHR(VkPhysicalDevice device, std::uint32_t* count,
                                                                      VkDisplayProperties2KHR* properties) {
  OutArray<VkDisplayProperties2KHR> array(count, properties);
  if (Display* display = display_of(device)) {
    if (VkDisplayProperties2KHR* slot = array.next()) slot->displayProperties = properties_of(*display);
  }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceDisplayPlanePropertiesKHR(VkPhysicalDevice device, std::uint32_t* count,
                                                                          VkDisplayPlanePropertiesKHR* properties) {
  OutArray<VkDisplayPlanePropertiesKHR> array(count, properties);
  if (Display* display = display_of(device)) array.push({to_handle(display), 0});
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceDisplayPlaneProperties2KHR(VkPhysicalDevice device,
                                                                           std::uint32_t* count,
                                                                           VkDisplayPlaneProperties2KHR* properties) {
  OutArray<VkDisplayPlaneProperties2KHR> array(count, properties);
  if (Display* display = display_of(device)) {
    if (VkDisplayPlaneProperties2KHR* slot = array.next()) slot->displayPlaneProperties = {to_handle(display), 0};
  }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetDisplayPlaneSupportedDisplaysKHR(VkPhysicalDevice device, std::uint32_t,
                                                                   std::uint32_t* count, VkDisplayKHR* displays) {
  OutArray<VkDisplayKHR> array(count, displays);
  if (Display* display = display_of(device)) array.push(to_handle(display));
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetDisplayModePropertiesKHR(VkPhysicalDevice, VkDisplayKHR display, std::uint32_t* count,
                                                           VkDisplayModePropertiesKHR* properties) {
  OutArray<VkDisplayModePropertiesKHR> array(count, properties);
  array.push(built_in_mode(display));
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetDisplayModeProperties2KHR(VkPhysicalDevice, VkDisplayKHR display,
                                                            std::uint32_t* count,
                                                            VkDisplayModeProperties2KHR* properties) {
  OutArray<VkDisplayModeProperties2KHR> array(count, properties);
  if (VkDisplayModeProperties2KHR* slot = array.next()) slot->displayModeProperties = built_in_mode(display);
  return array.result();
}

/// Any refresh rate will do; the size is the display's.
VKAPI_ATTR VkResult VKAPI_CALL CreateDisplayModeKHR(VkPhysicalDevice, VkDisplayKHR handle,
                                                    const VkDisplayModeCreateInfoKHR* info,
                                                    const VkAllocationCallbacks* allocator, VkDisplayModeKHR* mode) {
  Display& display = from_handle<Display>(handle);
  const VkDisplayModeParametersKHR& wanted = info->parameters;
  const VkExtent2D& whole = display.setting.extent;
  const bool possible = wanted.visibleRegion.width == whole.width && wanted.visibleRegion.height == whole.height &&
                        wanted.refreshRate >= 1 && wanted.refreshRate <= wsi::kFastestRefresh;
  if (!possible) return VK_ERROR_INITIALIZATION_FAILED;
  Owned<DisplayMode> object(create_object<DisplayMode>(display.memory, allocator, display, wanted.refreshRate));
  const std::lock_guard lock(display.mutex);
  display.made.push_back(&*object);
  *mode = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetDisplayPlaneCapabilitiesKHR(VkPhysicalDevice, VkDisplayModeKHR mode, std::uint32_t,
                                                              VkDisplayPlaneCapabilitiesKHR* capabilities) {
  *capabilities = capabilities_of(from_handle<DisplayMode>(mode));
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetDisplayPlaneCapabilities2KHR(VkPhysicalDevice, const VkDisplayPlaneInfo2KHR* info,
                                                               VkDisplayPlaneCapabilities2KHR* capabilities) {
  capabilities->capabilities = capabilities_of(from_handle<DisplayMode>(info->mode));
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDisplayPlaneSurfaceKHR(VkInstance instance,
                                                            const VkDisplaySurfaceCreateInfoKHR* info,
                                                            const VkAllocationCallbacks* allocator,
                                                            VkSurfaceKHR* surface) {
  const DisplayMode& mode = from_handle<DisplayMode>(info->displayMode);
  auto window = wsi::open_display_window(mode.display.setting, mode.millihertz, {info->alphaMode, info->globalAlpha});
  *surface = to_handle(create_object<Surface>(from_handle<Instance>(instance).memory, allocator, std::move(window)));
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
