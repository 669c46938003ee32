// What all window backends share, and the window of VK_EXT_headless_surface, which shows nothing.
#include "icd/wsi/window.h"

#include <cstring>

namespace vitrine::icd::wsi {
namespace {

class HeadlessWindow final : public Window {
 public:
  VkResult extent(VkExtent2D& extent) override {
    extent = {0xFFFFFFFF, 0xFFFFFFFF};
    return VK_SUCCESS;
  }
  VkResult present(const Frame&, bool) override { return VK_SUCCESS; }
};

void exchange_red_blue(const std::byte* from, std::byte* to, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t pixel;
    std::memcpy(&pixel, from + i * 4, 4);
    pixel = (pixel & 0xff00ff00u) | ((pixel & 0xff) << 16) | ((pixel >> 16) & 0xff);
    std::memcpy(to + i * 4, &pixel, 4);
  }
}

}  // namespace

std::unique_ptr<Window> open_headless_window() { return std::make_unique<HeadlessWindow>(); }

void copy_to_bgra(const Frame& frame, std::byte* target, std::uint64_t target_pitch) {
  for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
    const std::byte* from = frame.pixels + y * frame.row_pitch;
    std::byte* to = target + y * target_pitch;
    if (frame.red_first) {
      exchange_red_blue(from, to, frame.extent.width);
    } else {
      std::memcpy(to, from, std::size_t{frame.extent.width} * 4);
    }
  }
}

}  // namespace vitrine::icd::wsi
