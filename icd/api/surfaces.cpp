// Surfaces and queries of what they can do (Vulkan 1.3.239, Window System Integration: WSI Surface, Surface Queries).
#include <algorithm>
#include <array>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/instance.h"
#include "icd/properties.h"
#include "icd/wsi/surface.h"

namespace vitrine::icd {
namespace {

/// B8G8R8A8 first: it is what window systems hold, so presenting it is a copy without exchange of channels.
constexpr std::array kSurfaceFormats{
    VkSurfaceFormatKHR{VK_FORMAT_B8G8R8A8_SRGB, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR},
    VkSurfaceFormatKHR{VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR},
    VkSurfaceFormatKHR{VK_FORMAT_R8G8B8A8_SRGB, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR},
    VkSurfaceFormatKHR{VK_FORMAT_R8G8B8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR},
};

constexpr std::array kPresentModes{VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_FIFO_KHR,
                                   VK_PRESENT_MODE_FIFO_RELAXED_KHR};

/// "If the swapchain decides, width and height are 0xFFFFFFFF": our windows then take any size an image can have.
constexpr std::uint32_t kSwapchainDecides = 0xFFFFFFFF;

VkResult create_surface(VkInstance instance, const VkAllocationCallbacks* allocator,
                        std::unique_ptr<wsi::Window> window, VkSurfaceKHR* surface) {
  // The create functions may only fail for lack of memory; a client library that cannot be loaded is the nearest to it.
  if (!window) return VK_ERROR_OUT_OF_HOST_MEMORY;
  *surface = to_handle(create_object<Surface>(from_handle<Instance>(instance).memory, allocator, std::move(window)));
  return VK_SUCCESS;
}

/// VK_EXT_surface_maintenance1. A swapchain may present in any mode in turn; images have the window's size.
void write_maintenance(const VkPhysicalDeviceSurfaceInfo2KHR& info, VkSurfaceCapabilities2KHR& capabilities) {
  if (auto* scaling = find_in_out_chain<VkSurfacePresentScalingCapabilitiesEXT>(capabilities.pNext)) {
    scaling->supportedPresentScaling = 0;
    scaling->supportedPresentGravityX = scaling->supportedPresentGravityY = 0;
    scaling->minScaledImageExtent = capabilities.surfaceCapabilities.minImageExtent;
    scaling->maxScaledImageExtent = capabilities.surfaceCapabilities.maxImageExtent;
  }
  if (auto* modes = find_in_out_chain<VkSurfacePresentModeCompatibilityEXT>(capabilities.pNext)) {
    // The mode that is asked about is in every list, however short.
    std::array order = kPresentModes;
    if (const auto* asked = find_in_chain<VkSurfacePresentModeEXT>(info.pNext))
      std::stable_partition(order.begin(), order.end(), [&](VkPresentModeKHR m) { return m == asked->presentMode; });
    OutArray<VkPresentModeKHR> array(&modes->presentModeCount, modes->pPresentModes);
    for (const VkPresentModeKHR mode : order) array.push(mode);
    array.result();
  }
}

}  // namespace

VkResult surface_capabilities(Surface& surface, VkSurfaceCapabilitiesKHR& capabilities) {
  VkExtent2D extent{};
  if (const VkResult result = surface.window->extent(extent); result != VK_SUCCESS) return result;
  capabilities = {};
  capabilities.minImageCount = 2;
  capabilities.maxImageCount = 0;  // no limit
  capabilities.currentExtent = extent;
  capabilities.minImageExtent = capabilities.maxImageExtent = extent;
  if (extent.width == kSwapchainDecides) {
    const std::uint32_t largest = kClaimedPhysicalDeviceProperties.limits.maxImageDimension2D;
    capabilities.minImageExtent = {1, 1};
    capabilities.maxImageExtent = {largest, largest};
  }
  capabilities.maxImageArrayLayers = 1;
  capabilities.supportedTransforms = capabilities.currentTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
  capabilities.supportedCompositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR | VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  capabilities.supportedUsageFlags = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  return VK_SUCCESS;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateXcbSurfaceKHR(VkInstance instance, const VkXcbSurfaceCreateInfoKHR* info,
                                                   const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface) {
  return create_surface(instance, allocator, wsi::open_xcb_window(info->connection, info->window), surface);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateXlibSurfaceKHR(VkInstance instance, const VkXlibSurfaceCreateInfoKHR* info,
                                                    const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface) {
  const auto window = static_cast<std::uint32_t>(info->window);
  return create_surface(instance, allocator, wsi::open_xlib_window(info->dpy, window), surface);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateWaylandSurfaceKHR(VkInstance instance, const VkWaylandSurfaceCreateInfoKHR* info,
                                                       const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface) {
  return create_surface(instance, allocator, wsi::open_wayland_window(info->display, info->surface), surface);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateHeadlessSurfaceEXT(VkInstance instance, const VkHeadlessSurfaceCreateInfoEXT*,
                                                        const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface) {
  return create_surface(instance, allocator, wsi::open_headless_window(), surface);
}

VKAPI_ATTR void VKAPI_CALL DestroySurfaceKHR(VkInstance, VkSurfaceKHR surface, const VkAllocationCallbacks*) {
  destroy_handle<Surface>(surface);
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceXcbPresentationSupportKHR(VkPhysicalDevice, std::uint32_t,
                                                                          xcb_connection_t* connection,
                                                                          xcb_visualid_t visual) {
  return wsi::xcb_presentation_supported(connection, visual) ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceXlibPresentationSupportKHR(VkPhysicalDevice, std::uint32_t,
                                                                           Display* display, VisualID visual) {
  return wsi::xlib_presentation_supported(display, static_cast<std::uint32_t>(visual)) ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceWaylandPresentationSupportKHR(VkPhysicalDevice, std::uint32_t,
                                                                              wl_display* display) {
  return wsi::wayland_presentation_supported(display) ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceSupportKHR(VkPhysicalDevice, std::uint32_t, VkSurfaceKHR,
                                                                  VkBool32* supported) {
  *supported = VK_TRUE;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceCapabilitiesKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                       VkSurfaceCapabilitiesKHR* capabilities) {
  return surface_capabilities(from_handle<Surface>(surface), *capabilities);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceCapabilities2KHR(VkPhysicalDevice,
                                                                        const VkPhysicalDeviceSurfaceInfo2KHR* info,
                                                                        VkSurfaceCapabilities2KHR* capabilities) {
  if (auto* protection = find_in_out_chain<VkSurfaceProtectedCapabilitiesKHR>(capabilities->pNext))
    protection->supportsProtected = VK_FALSE;
  // VK_GOOGLE_surfaceless_query: then only what is the same for every surface is asked for.
  if (info->surface == VK_NULL_HANDLE) return VK_SUCCESS;
  const VkResult result = surface_capabilities(from_handle<Surface>(info->surface), capabilities->surfaceCapabilities);
  if (result == VK_SUCCESS) write_maintenance(*info, *capabilities);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceFormats2KHR(VkPhysicalDevice,
                                                                   const VkPhysicalDeviceSurfaceInfo2KHR*,
                                                                   std::uint32_t* count, VkSurfaceFormat2KHR* formats) {
  OutArray<VkSurfaceFormat2KHR> array(count, formats);
  for (const VkSurfaceFormatKHR& format : kSurfaceFormats) {
    if (VkSurfaceFormat2KHR* slot = array.next()) slot->surfaceFormat = format;
  }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceFormatsKHR(VkPhysicalDevice, VkSurfaceKHR, std::uint32_t* count,
                                                                  VkSurfaceFormatKHR* formats) {
  OutArray<VkSurfaceFormatKHR> array(count, formats);
  for (const VkSurfaceFormatKHR& format : kSurfaceFormats) array.push(format);
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfacePresentModesKHR(VkPhysicalDevice, VkSurfaceKHR,
                                                                       std::uint32_t* count, VkPresentModeKHR* modes) {
  OutArray<VkPresentModeKHR> array(count, modes);
  for (const VkPresentModeKHR mode : kPresentModes) array.push(mode);
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDevicePresentRectanglesKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                     std::uint32_t* count, VkRect2D* rectangles) {
  VkSurfaceCapabilitiesKHR capabilities;
  const VkResult result = surface_capabilities(from_handle<Surface>(surface), capabilities);
  if (result != VK_SUCCESS) return result;
  OutArray<VkRect2D> array(count, rectangles);
  array.push({{0, 0}, capabilities.currentExtent});
  return array.result();
}

}  // namespace entry
}  // namespace vitrine::icd
