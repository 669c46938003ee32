// The window that is all of a display: frames are laid over black and go to a file, in time with the refresh.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "icd/wsi/frame_file.h"
#include "icd/wsi/window.h"

namespace vitrine::icd::wsi {
namespace {

/// round(value * factor / 255), both from 0 to 255.
constexpr std::uint32_t scale(std::uint32_t value, std::uint32_t factor) {
  const std::uint32_t product = value * factor + 128;
  return (product + (product >> 8)) >> 8;
}

/// Pixels of four bytes to red, green and blue: `factor(alpha)` is what colours are multiplied by.
template <class Factor>
void lay_over_black(const Frame& frame, std::byte* to, Factor factor) {
  const std::size_t red = frame.red_first ? 0 : 2, blue = 2 - red;
  for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(frame.pixels + y * frame.row_pitch);
    for (std::uint32_t x = 0; x < frame.extent.width; ++x, from += 4, to += 3) {
      const std::uint32_t f = factor(from[3]);
      to[0] = static_cast<std::byte>(scale(from[red], f));
      to[1] = static_cast<std::byte>(scale(from[1], f));
      to[2] = static_cast<std::byte>(scale(from[blue], f));
    }
  }
}

class DisplayWindow final : public Window {
 public:
  DisplayWindow(const DisplaySetting& setting, std::uint32_t millihertz, PlaneAlpha alpha)
      : extent_(setting.extent),
        alpha_(alpha),
        period_(std::chrono::nanoseconds(1'000'000'000'000ull / millihertz)),
        file_(frame_file_of(setting, millihertz)) {}

  VkResult extent(VkExtent2D& extent) override {
    extent = extent_;
    return VK_SUCCESS;
  }

  VkResult present(const Frame& frame, bool wait_for_display) override {
    if (frame.extent.width != extent_.width || frame.extent.height != extent_.height) return VK_ERROR_OUT_OF_DATE_KHR;
    try {
      record(frame);
    } catch (const std::bad_alloc&) {  // a frame is left out
    }
    if (wait_for_display) wait_for_refresh();
    return VK_SUCCESS;
  }

 private:
  void record(const Frame& frame) {
    rgb_.resize(std::size_t{extent_.width} * extent_.height * 3);
    switch (alpha_.mode) {
      case VK_DISPLAY_PLANE_ALPHA_PER_PIXEL_BIT_KHR:
        lay_over_black(frame, rgb_.data(), [](std::uint32_t alpha) { return alpha; });
        break;
      case VK_DISPLAY_PLANE_ALPHA_GLOBAL_BIT_KHR: {
        const float part = std::clamp(std::isnan(alpha_.global) ? 0.0f : alpha_.global, 0.0f, 1.0f);
        const auto factor = static_cast<std::uint32_t>(std::lround(part * 255));
        lay_over_black(frame, rgb_.data(), [factor](std::uint32_t) { return factor; });
        break;
      }
      default:  // premultiplied colours are what they are over black
        lay_over_black(frame, rgb_.data(), [](std::uint32_t) { return 255u; });
    }
    file_->add(rgb_);
  }

  void wait_for_refresh() {
    std::this_thread::sleep_until(next_);
    next_ = std::max(next_, std::chrono::steady_clock::now()) + period_;
  }

  const VkExtent2D extent_;
  const PlaneAlpha alpha_;
  const std::chrono::steady_clock::duration period_;
  const std::shared_ptr<FrameFile> file_;
  std::chrono::steady_clock::time_point next_{};
  std::vector<std::byte> rgb_;
};

}  // namespace

std::unique_ptr<Window> open_display_window(const DisplaySetting& setting, std::uint32_t millihertz, PlaneAlpha alpha) {
  return std::make_unique<DisplayWindow>(setting, millihertz, alpha);
}

}  // namespace vitrine::icd::wsi
