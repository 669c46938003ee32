// Native windows: what a VkSurfaceKHR needs of the window system. Each backend loads its client library when the first
// surface is made, so that a machine without windows needs none of them. Knows nothing of swapchains and images.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "icd/wsi/display_setting.h"

struct xcb_connection_t;
struct wl_display;
struct wl_surface;

namespace vitrine::icd::wsi {

/// A finished picture: 4 bytes per pixel.
struct Frame {
  const std::byte* pixels = nullptr;
  std::uint64_t row_pitch = 0;  ///< bytes
  VkExtent2D extent{};          ///< pixels
  bool red_first = false;       ///< R8G8B8A8 in memory order; false: B8G8R8A8
};

class Window {
 public:
  virtual ~Window() = default;

  /// Current size of the window in pixels. {0xFFFFFFFF, 0xFFFFFFFF}: the swapchain decides (Vulkan 1.3.239,
  /// VkSurfaceCapabilitiesKHR). VK_ERROR_SURFACE_LOST_KHR when the window is gone.
  virtual VkResult extent(VkExtent2D& extent) = 0;

  /// Shows the frame and returns when its memory may be reused. `wait_for_display`: FIFO, do not run ahead of the
  /// window system where it tells. VK_SUCCESS, VK_SUBOPTIMAL_KHR (size differs but could be shown),
  /// VK_ERROR_OUT_OF_DATE_KHR, or VK_ERROR_SURFACE_LOST_KHR.
  virtual VkResult present(const Frame& frame, bool wait_for_display) = 0;
};

/// Null when the client library cannot be loaded.
std::unique_ptr<Window> open_xcb_window(xcb_connection_t* connection, std::uint32_t window);
/// `display` is an Xlib Display*.
std::unique_ptr<Window> open_xlib_window(void* display, std::uint32_t window);
std::unique_ptr<Window> open_wayland_window(wl_display* display, wl_surface* surface);
std::unique_ptr<Window> open_headless_window();

/// How a plane of a display lies over the black behind it.
struct PlaneAlpha {
  VkDisplayPlaneAlphaFlagBitsKHR mode = VK_DISPLAY_PLANE_ALPHA_OPAQUE_BIT_KHR;
  float global = 1;  ///< with VK_DISPLAY_PLANE_ALPHA_GLOBAL_BIT_KHR
};
/// All of a display, whose frames go to the setting's file. A FIFO frame is shown a refresh after the one before.
std::unique_ptr<Window> open_display_window(const DisplaySetting& setting, std::uint32_t millihertz, PlaneAlpha alpha);

/// Whether windows of this visual can be presented to: 24 or 32 bits deep with B8G8R8 channel masks.
bool xcb_presentation_supported(xcb_connection_t* connection, std::uint32_t visual);
bool xlib_presentation_supported(void* display, std::uint32_t visual);
bool wayland_presentation_supported(wl_display* display);

/// Copies rows and, for red_first frames, exchanges red and blue: window systems want B8G8R8X8.
void copy_to_bgra(const Frame& frame, std::byte* target, std::uint64_t target_pitch);

}  // namespace vitrine::icd::wsi
