// Buffers, images, views and samplers of a bug file on a device, with what their memory held before the command.
#pragma once

#include <vector>

#include "glass/bug/bug.h"
#include "glass/replayer/device.h"

namespace vitrine::glass::replayer {

/// A buffer that the host sees, for copies. Mapped as long as it lives.
struct Staging {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::byte* bytes = nullptr;
};
Staging make_staging(const Device& device, std::uint64_t size);
void destroy(const Device& device, const Staging& staging);

/// By the numbers of the Bug's lists.
struct Resources {
  std::vector<VkDeviceMemory> memories;
  std::vector<VkBuffer> buffers;
  std::vector<VkImage> images;
  std::vector<VkDeviceMemory> image_memories;
  std::vector<VkImageView> views;
  std::vector<VkBufferView> buffer_views;
  std::vector<VkSampler> samplers;
};

/// Memories and buffers, bound.
void make_buffers(const Device& device, const bug::Bug& bug, Resources& out);

/// Makes them all and fills them. What the bug does not know stays as the device allocates it.
Resources make_resources(const Device& device, const bug::Bug& bug);

/// Destroys what was gone when the command ran: everything is bound by now.
void destroy_gone(const Device& device, const bug::Bug& bug, const Resources& resources);

/// Checks that texels have as many bytes as a copy of them takes. Throws Failure.
void check_texels(const bug::Bug& bug);

/// Calls f(piece or texels, its place in `staging`) for everything that was captured, in one order; the size of all.
template <class B, class F>
std::uint64_t for_each_content(B& bug, F&& f) {
  std::uint64_t at = 0;
  const auto next = [&](auto& content) {
    f(content, at);
    at = (at + content.before->size() + 15) / 16 * 16;  // a multiple of all texels' sizes that are powers of two
  };
  for (auto& memory : bug.memories)
    for (auto& piece : memory.pieces) next(piece);
  for (auto& image : bug.images)
    for (auto& texels : image.texels) next(texels);
  return at;
}

/// Copies all that was captured from `staging` to where it belongs, or back.
void copy_contents(const Device& device, const bug::Bug& bug, const Resources& resources, const Staging& staging,
                   bool back);

}  // namespace vitrine::glass::replayer
