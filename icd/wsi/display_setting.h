// The display that VITRINE_DISPLAY asks for (docs/recording.md): WIDTHxHEIGHT[@HZ],FILE.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vitrine::icd::wsi {

struct DisplaySetting {
  VkExtent2D extent{};               ///< pixels
  std::uint32_t millihertz = 60000;  ///< refreshes in 1000 seconds
  std::string file;                  ///< what is shown goes there: *.png, *.y4m, or - for the standard output
};

inline constexpr std::uint32_t kGreatestDisplay = 16384;       ///< pixels along a side, as of images
inline constexpr std::uint32_t kFastestRefresh = 1000 * 1000;  ///< millihertz

/// Nothing: the text is no such setting.
std::optional<DisplaySetting> parse_display(std::string_view text);

/// What the environment asks for now. Nothing: no display, or one that nobody can understand, of which stderr tells
/// once.
std::optional<DisplaySetting> display_setting();

}  // namespace vitrine::icd::wsi
