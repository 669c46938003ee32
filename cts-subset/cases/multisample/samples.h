// The samples of images as words.
#pragma once

#include <string>
#include <vector>

#include "harness/run.h"

namespace vitrine::cts {

/// Every sample of one aspect of an image as four words of texelFetch (floats, or integers where the aspect is of
/// integers), samples after each other.
std::vector<uint32_t> fetch(Run& run, const Image& image, VkImageAspectFlagBits aspect);

/// Puts out four words a pixel. May be blank.
void put(Run& run, const std::string& name, VkExtent2D extent, uint32_t planes, const std::vector<uint32_t>& words);
void put(Run& run, const std::string& name, VkExtent2D extent, uint32_t planes, const std::vector<float>& values);

}  // namespace vitrine::cts
