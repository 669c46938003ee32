// Swapchain images: who has them, and showing them (Vulkan 1.3.239, WSI Swapchain).
#include "icd/wsi/swapchain.h"

#include <algorithm>

#include "glass/pixel/pixels.h"
#include "icd/object/sync.h"

namespace vitrine::icd {
namespace {

wsi::Frame frame_of(const Swapchain& swapchain, const Image& image) {
  const texel::PlaneLayout& plane = image.layout.plane[0];
  wsi::Frame frame;
  frame.pixels = image.data + plane.offset + plane.level[0].offset;
  frame.row_pitch = plane.level[0].row_pitch;
  frame.extent = swapchain.extent;
  frame.red_first = swapchain.red_first;
  return frame;
}

}  // namespace

Swapchain::~Swapchain() {
  for (const Slot& slot : slots) {
    if (slot.image) forget_image(*slot.image);
    destroy_object(slot.image);
    destroy_object(slot.backing);
  }
}

std::byte* swapchain_image_memory(VkSwapchainKHR swapchain, std::uint32_t index) {
  const Swapchain& owner = from_handle<Swapchain>(swapchain);
  return index < owner.slots.size() ? owner.slots[index].image->data : nullptr;
}

namespace {

VkResult hand_to_window(Swapchain& swapchain, const Swapchain::Slot& slot) noexcept {
  try {
    if (glass::pixel::Pixels* const pixels = glass::pixel::pixels()) pixels->presented(slot.image);
    return swapchain.window->present(frame_of(swapchain, *slot.image), slot.in_order);
  } catch (const std::bad_alloc&) {
    return VK_ERROR_OUT_OF_HOST_MEMORY;
  }
}

}  // namespace

void show_image(Swapchain& swapchain, std::uint32_t index) {
  Swapchain::Slot& slot = swapchain.slots[index];
  const VkResult shown = hand_to_window(swapchain, slot);
  // Before the image is free: whoever waits for it may destroy the fence, or acquire the image and present it again.
  if (slot.fence) signal_fence(*swapchain.device, *slot.fence);
  {
    const std::lock_guard lock(swapchain.mutex);
    slot.owner = Swapchain::Owner::kSwapchain;
    slot.released = ++swapchain.release_count;
    swapchain.shown_id = std::max(swapchain.shown_id, slot.present_id);
    if (shown < 0 || swapchain.status == VK_SUCCESS || swapchain.status == VK_SUBOPTIMAL_KHR) swapchain.status = shown;
  }
  swapchain.image_released.notify_all();
}

}  // namespace vitrine::icd
