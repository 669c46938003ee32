// VkDisplayKHR and VkDisplayModeKHR: the one display of an instance that VITRINE_DISPLAY asks for (docs/recording.md).
#pragma once

#include <mutex>

#include "icd/object/object.h"
#include "icd/wsi/display_setting.h"
#include "icd/wsi/window.h"

namespace vitrine::icd {

struct Display;

struct DisplayMode : Object<VkDisplayModeKHR, VK_OBJECT_TYPE_DISPLAY_MODE_KHR> {
  DisplayMode(const HostMemory& m, Display& owner, std::uint32_t refresh)
      : Object(m), display(owner), millihertz(refresh) {}

  Display& display;
  const std::uint32_t millihertz;  ///< the size is the display's
};

struct Display : Object<VkDisplayKHR, VK_OBJECT_TYPE_DISPLAY_KHR> {
  Display(const HostMemory& m, wsi::DisplaySetting what)
      : Object(m), setting(std::move(what)), native(m, *this, setting.millihertz), made(m) {}
  ~Display() {
    for (DisplayMode* mode : made) destroy_object(mode);
  }

  const Instance* instance = nullptr;
  Display* next = nullptr;  ///< of another instance
  const wsi::DisplaySetting setting;
  DisplayMode native;  ///< what the setting says
  std::mutex mutex;
  Vector<DisplayMode*> made;  ///< by applications; they last as long as the display. Guarded by mutex
};

struct Instance;

/// Gives an instance the display that the environment asks for, if it does. Throws std::bad_alloc.
void make_display(const Instance& instance);
/// Null: there is none.
Display* display_of(const Instance& instance);
void destroy_display(const Instance& instance);

}  // namespace vitrine::icd
