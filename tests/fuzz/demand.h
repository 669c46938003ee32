// What fuzzers that call the API need: its functions, and an end where they give what they may not give.
#pragma once

#include <string>

#include "icd/edge/vulkan_api.h"

extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name);

namespace vitrine::fuzz {

/// A function of the driver.
#define FUZZ_CALL(instance, name) reinterpret_cast<PFN_vk##name>(vk_icdGetInstanceProcAddr(instance, "vk" #name))

/// Ends the process with a message where something that must work does not.
void demand(bool condition, const std::string& what);

}  // namespace vitrine::fuzz
