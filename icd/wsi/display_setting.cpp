// Reads VITRINE_DISPLAY.
#include "icd/wsi/display_setting.h"

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "glass/output.h"

namespace vitrine::icd::wsi {
namespace {

/// Takes a number from the front of the text.
template <class T>
bool take_number(std::string_view& text, T& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_sign(std::string_view& text, char sign) {
  if (!text.starts_with(sign)) return false;
  text.remove_prefix(1);
  return true;
}

bool is_side(std::uint32_t pixels) { return pixels >= 1 && pixels <= kGreatestDisplay; }

bool take_refresh(std::string_view& text, std::uint32_t& millihertz) {
  double hertz = 0;
  if (!take_number(text, hertz) || !(hertz >= 1 && hertz <= kFastestRefresh / 1000.0)) return false;
  millihertz = static_cast<std::uint32_t>(std::lround(hertz * 1000));
  return true;
}

}  // namespace

std::optional<DisplaySetting> parse_display(std::string_view text) {
  DisplaySetting out;
  if (!take_number(text, out.extent.width) || !take_sign(text, 'x') || !take_number(text, out.extent.height)) return {};
  if (!is_side(out.extent.width) || !is_side(out.extent.height)) return {};
  if (take_sign(text, '@') && !take_refresh(text, out.millihertz)) return {};
  if (!take_sign(text, ',')) return {};
  out.file = text;
  const bool known = text == "-" || (text.size() > 4 && (text.ends_with(".png") || text.ends_with(".y4m")));
  return known ? std::optional(out) : std::nullopt;
}

std::optional<DisplaySetting> display_setting() {
  const char* const value = std::getenv("VITRINE_DISPLAY");
  if (!value || *value == '\0') return {};
  std::optional<DisplaySetting> out = parse_display(value);
  static std::atomic<bool> told = false;
  if (!out && !told.exchange(true))
    glass::complain(std::string("VITRINE_DISPLAY: '") + value +
                    "' is no display; it looks like 1280x720@60,frames.y4m (or .png, or - for the standard output)");
  return out;
}

}  // namespace vitrine::icd::wsi
