// What a VkComponentMapping selects, resolved for views and for Y'CbCr conversions.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>

namespace vitrine::texel {

/// Per output component: 0..3 = RGBA, 4 = zero, 5 = one.
std::array<std::uint8_t, 4> resolve_swizzle(const VkComponentMapping& mapping);

}  // namespace vitrine::texel
