// What memory can be shared as.
#pragma once

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {

/// All zero: not supported.
VkExternalMemoryProperties external_memory_properties(VkExternalMemoryHandleTypeFlagBits type);

}  // namespace vitrine::icd
