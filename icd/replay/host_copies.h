// Copies that the host makes by itself, without commands (Vulkan 1.4.309, Copying Data Between Host Memory and Images).
// The application sees to it that no command uses the texels meanwhile; tools that watch memory are told.
#pragma once

#include "icd/object/device.h"
#include "icd/object/image.h"

namespace vitrine::icd {

/// The region's offset counts from `source`, or `target`; its layers are resolved.
void copy_from_host(Device& device, const std::byte* source, const Image& target, const VkBufferImageCopy& region);
void copy_to_host(Device& device, const Image& source, std::byte* target, const VkBufferImageCopy& region);
void copy_by_host(Device& device, const Image& source, const Image& target, const VkImageCopy& region);
/// A part of an image has another layout from now on. Texels keep their values, also from VK_IMAGE_LAYOUT_UNDEFINED.
void transition_by_host(Device& device, const Image& image, const VkImageSubresourceRange& range, VkImageLayout layout);

}  // namespace vitrine::icd
