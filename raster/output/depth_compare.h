// Comparison of depths: what an operator says of two values, and on which side of the stored one those lie that pass.
#pragma once

#include <vulkan/vulkan_core.h>

namespace vitrine::raster {

template <class T>
bool compare_values(VkCompareOp op, T value, T stored) {
  switch (op) {
    case VK_COMPARE_OP_NEVER:
      return false;
    case VK_COMPARE_OP_LESS:
      return value < stored;
    case VK_COMPARE_OP_EQUAL:
      return value == stored;
    case VK_COMPARE_OP_LESS_OR_EQUAL:
      return value <= stored;
    case VK_COMPARE_OP_GREATER:
      return value > stored;
    case VK_COMPARE_OP_NOT_EQUAL:
      return value != stored;
    case VK_COMPARE_OP_GREATER_OR_EQUAL:
      return value >= stored;
    default:
      return true;
  }
}

inline bool passes_nearer(VkCompareOp compare) {
  return compare == VK_COMPARE_OP_LESS || compare == VK_COMPARE_OP_LESS_OR_EQUAL;
}
inline bool passes_farther(VkCompareOp compare) {
  return compare == VK_COMPARE_OP_GREATER || compare == VK_COMPARE_OP_GREATER_OR_EQUAL;
}

/// Whether depths that pass are all on one side of the stored one, so that a limit of stored depths tells who cannot
/// pass.
inline bool has_limit(VkCompareOp compare) { return passes_nearer(compare) || passes_farther(compare); }

}  // namespace vitrine::raster
