// Replay of copies, blits, resolves, fills and clears. Images are texel's work; buffers are bytes.
#include <algorithm>
#include <cstring>

#include "base/as_reference.h"
#include "base/workers.h"
#include "icd/object/memory.h"
#include "icd/replay/replay.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

// Copies from here on are worth a second thread.
constexpr std::uint64_t kParallelBytes = std::uint64_t{1} << 20;
constexpr std::uint64_t kChunkBytes = std::uint64_t{256} << 10;

std::span<std::byte> bytes_of(const Buffer& buffer) {
  return {buffer.data, buffer.data ? static_cast<std::size_t>(buffer.size) : 0};
}

/// Calls work(first byte, bytes) for all of [0, size), in parallel where it is large.
template <class Work>
void for_each_chunk(std::uint64_t size, Work work) {
  if (size < kParallelBytes) {
    work(0, size);
    return;
  }
  const std::size_t chunks = (size + kChunkBytes - 1) / kChunkBytes;
  base::parallel_for(chunks, [&](std::size_t i, std::size_t) {
    work(i * kChunkBytes, std::min(kChunkBytes, size - i * kChunkBytes));
  });
}

}  // namespace

void execute(ReplayState&, const CmdCopyBuffer& command) {
  for (const VkBufferCopy& r : command.regions) {
    const std::uint64_t size = std::min(command.source->resolve_range(r.srcOffset, r.size),
                                        command.target->resolve_range(r.dstOffset, r.size));
    if (!command.source->data || !command.target->data) continue;
    const std::byte* source = command.source->data + r.srcOffset;
    std::byte* target = command.target->data + r.dstOffset;
    for_each_chunk(
        size, [&](std::uint64_t first, std::uint64_t bytes) { std::memmove(target + first, source + first, bytes); });
  }
}

void execute(ReplayState&, const CmdUpdateBuffer& command) {
  const std::uint64_t size = command.target->resolve_range(command.offset, command.bytes.size());
  if (command.target->data) std::copy_n(command.bytes.data(), size, command.target->data + command.offset);
}

void execute(ReplayState&, const CmdFillBuffer& command) {
  if (!command.target->data) return;
  const std::uint64_t size = command.target->resolve_range(command.offset, command.size) & ~std::uint64_t{3};
  auto* words = reinterpret_cast<std::uint32_t*>(command.target->data + command.offset);
  for_each_chunk(size, [&](std::uint64_t first, std::uint64_t bytes) {
    std::fill_n(words + first / 4, bytes / 4, command.value);
  });
}

void execute(ReplayState&, const CmdCopyImage& command) {
  for (const VkImageCopy& region : command.regions) {
    texel::copy_image(memory_of(*command.source), memory_of(*command.target), region);
  }
}

void execute(ReplayState&, const CmdBlitImage& command) {
  // (This device alone: the other aspect, too; deviations.md, blit-other-aspect.)
  const bool both = base::as_reference(base::Deviation::kBlitOtherAspect);
  constexpr VkImageAspectFlags kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
  for (VkImageBlit region : command.regions) {
    if (both && (region.srcSubresource.aspectMask & kDepthStencil) != 0)
      region.srcSubresource.aspectMask = region.dstSubresource.aspectMask =
          texel::format_desc(command.source->desc().format).aspects & kDepthStencil;
    texel::blit_image(memory_of(*command.source), memory_of(*command.target), region, command.filter);
  }
}

void execute(ReplayState&, const CmdResolveImage& command) {
  for (const VkImageResolve& region : command.regions) {
    texel::resolve_image(memory_of(*command.source), memory_of(*command.target), region);
  }
}

void execute(ReplayState&, const CmdCopyBufferToImage& command) {
  for (const VkBufferImageCopy& region : command.regions) {
    texel::copy_buffer_to_image(bytes_of(*command.source), memory_of(*command.target), region);
  }
}

void execute(ReplayState&, const CmdCopyImageToBuffer& command) {
  for (const VkBufferImageCopy& region : command.regions) {
    texel::copy_image_to_buffer(memory_of(*command.source), bytes_of(*command.target), region);
  }
}

void execute(ReplayState&, const CmdClearColorImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges) {
    texel::clear_color_image(memory_of(*command.image), command.value, resolve_range(*command.image, range));
  }
}

void execute(ReplayState&, const CmdClearDepthStencilImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges) {
    texel::clear_depth_stencil_image(memory_of(*command.image), command.value, resolve_range(*command.image, range));
  }
}

}  // namespace vitrine::icd
