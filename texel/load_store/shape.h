// Which coordinates name a texel of a view.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace vitrine::texel {

/// How many coordinates address a texel, and whether the array layer (or face) is the one after them.
struct Shape {
  std::uint32_t dims = 2;
  bool layered = false;
};

constexpr Shape shape_of(VkImageViewType type) {
  switch (type) {
    case VK_IMAGE_VIEW_TYPE_1D:
      return {1, false};
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
      return {1, true};
    case VK_IMAGE_VIEW_TYPE_3D:
      return {3, false};
    case VK_IMAGE_VIEW_TYPE_2D:
      return {2, false};
    default:
      return {2, true};
  }
}

}  // namespace vitrine::texel
