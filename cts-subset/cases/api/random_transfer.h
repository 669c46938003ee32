// Random images and parts of them, for transfers.
#pragma once

#include "harness/run.h"

namespace vitrine::cts {

/// A part of a level.
struct Region {
  VkOffset3D offset;
  VkExtent3D extent;
};

VkOffset3D to_offset(VkExtent3D e);
bool reference_has(VkFormat format, VkFormatFeatureFlags features);
/// Colour formats in which the reference has all of these features; with compressed ones if `blocks`.
std::vector<VkFormat> formats_with(VkFormatFeatureFlags features, bool blocks = false);
/// A 2D image, array or volume with some levels.
ImageSpec random_spec(Random& random, VkFormat format);
/// In whole blocks, or up to the level's edge.
Region random_region(Random& random, const Image& image, uint32_t level);
VkImageSubresourceLayers random_layers(Random& random, const Image& image, uint32_t level);

}  // namespace vitrine::cts
