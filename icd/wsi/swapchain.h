// VkSwapchainKHR: images that take turns between the application and a window.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "icd/object/device.h"
#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/wsi/surface.h"

namespace vitrine::icd {

struct Fence;

struct Swapchain : Object<VkSwapchainKHR, VK_OBJECT_TYPE_SWAPCHAIN_KHR> {
  explicit Swapchain(const HostMemory& m) : Object(m), slots(m) {}
  ~Swapchain();

  enum class Owner : std::uint8_t { kSwapchain, kApplication, kQueue };
  struct Slot {
    Image* image = nullptr;
    DeviceMemory* backing = nullptr;
    Owner owner = Owner::kSwapchain;
    std::uint64_t released = 0;  ///< order in which images came back: the one waiting longest is acquired first
    // Of the present on the queue:
    std::uint64_t present_id = 0;  ///< 0: none
    Fence* fence = nullptr;        ///< signalled when it is shown; null: none
    bool in_order = true;          ///< behind what was presented before
  };

  Device* device = nullptr;
  std::shared_ptr<wsi::Window> window;  ///< the surface's
  VkExtent2D extent{};
  VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
  bool red_first = false;  ///< R8G8B8A8 memory order
  std::optional<VkHdrMetadataEXT>
      hdr_metadata;  ///< as last set, without its chain: no window here shows more than sRGB

  std::mutex mutex;
  std::condition_variable image_released;
  Vector<Slot> slots;  ///< guarded by mutex, but for the pointers
  std::uint64_t release_count = 0;
  std::uint64_t shown_id = 0;    ///< greatest present id that has been shown
  bool retired = false;          ///< replaced by a newer swapchain
  VkResult status = VK_SUCCESS;  ///< worst outcome of a present so far: OUT_OF_DATE and SURFACE_LOST stay
};

/// Shows an image that the application presented and gives it back to the swapchain. Runs on the queue, after the
/// present's semaphores; once per present.
void show_image(Swapchain& swapchain, std::uint32_t index);

}  // namespace vitrine::icd
