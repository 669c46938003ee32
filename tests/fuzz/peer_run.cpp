// An application that shows frames in the windows of a peer.
#include <wayland-client.h>
#include <xcb/xcb.h>

#include <string_view>

#include "icd/edge/util.h"
#include "tests/fuzz/driver.h"
#include "tests/fuzz/target.h"
#include "tests/fuzz/wayland_peer.h"
#include "tests/fuzz/x11_peer.h"

namespace vitrine::fuzz {
namespace {

using icd::make_struct;

struct Screen : Driver {
  VkFence fence = VK_NULL_HANDLE;
};

/// A function of the driver, of the instance that all runs share.
#define SCREEN_CALL(name) VK_GET(screen().instance, name)

Screen make_screen() {
  Screen s;
  const char* const of_instance[] = {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_XCB_SURFACE_EXTENSION_NAME,
                                     VK_KHR_WAYLAND_SURFACE_EXTENSION_NAME};
  make_instance(s, of_instance);
  const char* const of_device[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  make_device(s, of_device, nullptr);
  const auto fence = make_struct<VkFenceCreateInfo>();
  demand(VK_GET(s.instance, CreateFence)(s.device, &fence, nullptr, &s.fence) == VK_SUCCESS, "a fence");
  return s;
}

Screen& screen() {
  static Screen& s = *new Screen(make_screen());
  return s;
}

/// What acquiring and presenting may say where the window system fails.
bool is_of_windows(VkResult result) {
  return result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR ||
         result == VK_ERROR_SURFACE_LOST_KHR || result == VK_NOT_READY || result == VK_TIMEOUT;
}

bool is_of_memory(VkResult result) {
  return result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

/// False: the swapchain is of no use any more.
bool show_frame(VkSwapchainKHR swapchain, Choices& c) {
  Screen& s = screen();
  std::uint32_t index = 0;
  const std::uint64_t timeout = c.one_in(4) ? 0 : 2'000'000'000;
  const VkResult acquired =
      SCREEN_CALL(AcquireNextImageKHR)(s.device, swapchain, timeout, VK_NULL_HANDLE, s.fence, &index);
  demand(is_of_windows(acquired), "an image");
  if (acquired != VK_SUCCESS && acquired != VK_SUBOPTIMAL_KHR) return acquired == VK_NOT_READY;
  demand(SCREEN_CALL(WaitForFences)(s.device, 1, &s.fence, VK_TRUE, UINT64_MAX) == VK_SUCCESS, "the fence of an image");
  SCREEN_CALL(ResetFences)(s.device, 1, &s.fence);
  auto info = make_struct<VkPresentInfoKHR>();
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain;
  info.pImageIndices = &index;
  const VkResult presented = SCREEN_CALL(QueuePresentKHR)(s.queue, &info);
  demand(is_of_windows(presented), "a present");
  return presented == VK_SUCCESS || presented == VK_SUBOPTIMAL_KHR;
}

/// What is asked for is valid for the window as it was just now, and small.
VkSwapchainKHR make_swapchain(VkSurfaceKHR surface, VkSwapchainKHR old, Choices& c) {
  Screen& s = screen();
  VkSurfaceCapabilitiesKHR capabilities{};
  const VkResult asked =
      SCREEN_CALL(GetPhysicalDeviceSurfaceCapabilitiesKHR)(s.physical_device, surface, &capabilities);
  demand(asked == VK_SUCCESS || asked == VK_ERROR_SURFACE_LOST_KHR, "capabilities");
  if (asked != VK_SUCCESS) return VK_NULL_HANDLE;
  constexpr VkPresentModeKHR kModes[] = {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                         VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_FIFO_RELAXED_KHR};
  constexpr VkFormat kFormats[] = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB};
  auto info = make_struct<VkSwapchainCreateInfoKHR>();
  info.surface = surface;
  info.minImageCount = c.between(2, 6);
  info.imageFormat = c.of(kFormats);
  info.imageExtent = capabilities.currentExtent;
  if (info.imageExtent.width == 0xffffffff) info.imageExtent = {c.between(1, 90), c.between(1, 90)};
  if (info.imageExtent.width == 0 || info.imageExtent.height == 0) return VK_NULL_HANDLE;
  const bool huge = info.imageExtent.width > 512 || info.imageExtent.height > 512;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = c.of(kModes);
  info.oldSwapchain = old;
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  const VkResult made = SCREEN_CALL(CreateSwapchainKHR)(s.device, &info, nullptr, &swapchain);
  demand(made == VK_SUCCESS || is_of_memory(made) || made == VK_ERROR_SURFACE_LOST_KHR, "a swapchain");
  if (made != VK_SUCCESS) return VK_NULL_HANDLE;
  if (!huge) return swapchain;
  SCREEN_CALL(DestroySwapchainKHR)(s.device, swapchain, nullptr);
  return VK_NULL_HANDLE;
}

void show_frames(VkSurfaceKHR surface, Choices& c) {
  Screen& s = screen();
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  for (std::uint32_t i = c.between(1, 4); i > 0; --i) {
    const VkSwapchainKHR old = swapchain;
    swapchain = make_swapchain(surface, old, c);
    SCREEN_CALL(QueueWaitIdle)(s.queue);
    SCREEN_CALL(DestroySwapchainKHR)(s.device, old, nullptr);
    if (!swapchain) continue;
    for (std::uint32_t frames = c.between(1, 12); frames > 0 && show_frame(swapchain, c); --frames) {
    }
  }
  SCREEN_CALL(QueueWaitIdle)(s.queue);
  SCREEN_CALL(DestroySwapchainKHR)(s.device, swapchain, nullptr);
  SCREEN_CALL(DestroySurfaceKHR)(s.instance, surface, nullptr);
}

void show_by_x11(xcb_connection_t* connection, Choices& c) {
  Screen& s = screen();
  SCREEN_CALL(GetPhysicalDeviceXcbPresentationSupportKHR)(s.physical_device, 0, connection, c.between(32, 36));
  auto info = make_struct<VkXcbSurfaceCreateInfoKHR>();
  info.connection = connection;
  info.window = 77;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  demand(SCREEN_CALL(CreateXcbSurfaceKHR)(s.instance, &info, nullptr, &surface) == VK_SUCCESS, "a surface of X11");
  show_frames(surface, c);
}

void run_x11(Choices& c, std::span<const std::uint8_t> answers) {
  X11Peer peer(answers);
  peer.start();
  xcb_connection_t* const connection = xcb_connect_to_fd(peer.client_end(), nullptr);
  if (!xcb_connection_has_error(connection)) show_by_x11(connection, c);
  xcb_disconnect(connection);
  peer.join();
}

void on_global(void* compositor, wl_registry* registry, std::uint32_t name, const char* interface, std::uint32_t) {
  if (std::string_view(interface) != "wl_compositor") return;
  *static_cast<void**>(compositor) = wl_registry_bind(registry, name, &wl_compositor_interface, 4);
}
void on_global_remove(void*, wl_registry*, std::uint32_t) {}
constexpr wl_registry_listener kListener{on_global, on_global_remove};

void show_by_wayland(wl_display* display, wl_surface* window, Choices& c) {
  Screen& s = screen();
  demand(SCREEN_CALL(GetPhysicalDeviceWaylandPresentationSupportKHR)(s.physical_device, 0, display), "Wayland");
  auto info = make_struct<VkWaylandSurfaceCreateInfoKHR>();
  info.display = display;
  info.surface = window;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult made = SCREEN_CALL(CreateWaylandSurfaceKHR)(s.instance, &info, nullptr, &surface);
  demand(made == VK_SUCCESS || is_of_memory(made), "a surface of Wayland");
  if (made == VK_SUCCESS) show_frames(surface, c);
}

void run_wayland(Choices& c, std::span<const std::uint8_t> answers) {
  WaylandPeer peer(answers);
  peer.start();
  wl_display* const display = wl_display_connect_to_fd(peer.client_end());
  demand(display != nullptr, "a display of Wayland");
  wl_registry* const registry = wl_display_get_registry(display);
  void* compositor = nullptr;
  wl_registry_add_listener(registry, &kListener, &compositor);
  wl_display_roundtrip(display);
  demand(compositor != nullptr, "a compositor");
  wl_surface* const window = wl_compositor_create_surface(static_cast<wl_compositor*>(compositor));
  show_by_wayland(display, window, c);
  wl_surface_destroy(window);
  wl_compositor_destroy(static_cast<wl_compositor*>(compositor));
  wl_registry_destroy(registry);
  wl_display_disconnect(display);
  peer.join();
}

}  // namespace
}  // namespace vitrine::fuzz

/// The first half of the bytes says what the application does, the second what the window system does.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  vitrine::fuzz::Choices c(bytes.first(size / 2));
  const std::span<const std::uint8_t> answers = bytes.subspan(size / 2);
  c.one_in(2) ? vitrine::fuzz::run_x11(c, answers) : vitrine::fuzz::run_wayland(c, answers);
  return 0;
}
