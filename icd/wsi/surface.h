// VkSurfaceKHR: a native window and what can be presented to it.
#pragma once

#include <memory>

#include "icd/object/object.h"
#include "icd/wsi/window.h"

namespace vitrine::icd {

struct Surface : Object<VkSurfaceKHR, VK_OBJECT_TYPE_SURFACE_KHR> {
  Surface(const HostMemory& m, std::unique_ptr<wsi::Window> native) : Object(m), window(std::move(native)) {}

  std::shared_ptr<wsi::Window> window;  ///< its swapchains have it, too: vkcube destroys a lost surface before them
};

/// The capabilities of a surface now. VK_ERROR_SURFACE_LOST_KHR when its window is gone.
VkResult surface_capabilities(Surface& surface, VkSurfaceCapabilitiesKHR& capabilities);

}  // namespace vitrine::icd
