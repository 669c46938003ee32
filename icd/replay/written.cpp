// What transfers write (Vulkan 1.3.239, Copy Commands, Clear Commands). Copies run once more on the shadow: what
// nothing has written stays so wherever it is copied to.
#include "icd/replay/written.h"

#include <algorithm>

#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/replay/image_boxes.h"
#include "texel/layout.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

using glass::ByteState;
using glass::Contents;
using glass::ShadowRegion;

std::uintptr_t number_of(const std::byte* address) { return reinterpret_cast<std::uintptr_t>(address); }

void fill_range(const Image& image, const VkImageSubresourceRange& range, ByteState state) {
  for_each_box(image, range,
               [&](const texel::ImageView& view, const glass::TexelBox& box) { glass::fill_shadow(view, box, state); });
}

void fill_region(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& a, const VkOffset3D& b) {
  for_each_box(image, layers, a, b, [&](const texel::ImageView& view, const glass::TexelBox& box) {
    glass::fill_shadow(view, box, ByteState::kWritten);
  });
}

/// The states of an image, as if they were its memory.
class ImageStates {
 public:
  explicit ImageStates(const Image& image) : layout_(image.layout) {
    for (texel::PlaneLayout& plane : layout_.plane) {
      // States have no bits that a depth plane does not keep.
      if (plane.format == VK_FORMAT_X8_D24_UNORM_PACK32) plane.format = VK_FORMAT_R32_UINT;
    }
    const bool disjoint = image.desc().disjoint;
    for (std::uint32_t i = 0; i < (disjoint ? layout_.plane_count : 1u); ++i) {
      const std::byte* const first = disjoint ? image.plane_data[i] : image.data;
      const std::uint64_t whole = layout_.size - std::min<std::uint64_t>(layout_.size, kTailBytes);
      const std::uint64_t bytes = disjoint ? texel::end_of(layout_.plane[i]) : whole;
      const ShadowRegion* region = first ? glass::find_shadow(first) : nullptr;
      known_ = region && region->contains(number_of(first), bytes);
      if (!known_) return;
      region->settle(number_of(first), bytes, Contents::kTexels);
      states_[i] = region->states(number_of(first));
    }
  }
  bool known() const { return known_; }
  texel::ImageMemory memory() const { return {&layout_, states_[0], layout_.desc.disjoint ? &states_ : nullptr}; }

 private:
  texel::ImageLayout layout_;
  std::array<std::byte*, 3> states_{};
  bool known_ = false;
};

/// The states of a buffer; empty: not known.
std::span<std::byte> states_of(const Buffer& buffer) {
  const ShadowRegion* region = buffer.data ? glass::find_shadow(buffer.data) : nullptr;
  if (!region || !region->contains(number_of(buffer.data), buffer.size)) return {};
  return {region->states(number_of(buffer.data)), static_cast<std::size_t>(buffer.size)};
}

/// At most what a region takes of its buffer.
std::uint64_t bytes_of(const Image& image, const VkBufferImageCopy& r) {
  const auto aspect = static_cast<VkImageAspectFlagBits>(r.imageSubresource.aspectMask);
  const VkFormat plane = image.layout.plane[texel::plane_of_aspect(image.layout, aspect)].format;
  const texel::FormatDesc& format = texel::format_desc(plane);
  const auto blocks = [](std::uint32_t texels, std::uint32_t block) { return std::uint64_t{texels} / block + 1; };
  const std::uint64_t columns = blocks(std::max(r.bufferRowLength, r.imageExtent.width), format.block_width);
  const std::uint64_t rows = blocks(std::max(r.bufferImageHeight, r.imageExtent.height), format.block_height);
  const std::uint64_t slices = std::max(r.imageExtent.depth, r.imageSubresource.layerCount);
  return columns * rows * slices * format.block_bytes;
}

}  // namespace

void fill_region(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& offset,
                 const VkExtent3D& extent) {
  fill_region(image, layers, offset, end_of(offset, extent));
}

glass::ByteState discarded_state(const Image& image) {
  return image.tiling == VK_IMAGE_TILING_OPTIMAL ? ByteState::kDiscarded : ByteState::kFresh;
}

void note_written(ReplayState&, const CmdCopyBuffer& command) {
  for (const VkBufferCopy& r : command.regions) {
    const std::uint64_t size = std::min(command.source->resolve_range(r.srcOffset, r.size),
                                        command.target->resolve_range(r.dstOffset, r.size));
    if (!command.source->data || !command.target->data) continue;
    glass::copy_shadow(command.source->data + r.srcOffset, command.target->data + r.dstOffset, size);
  }
}

void note_written(ReplayState&, const CmdUpdateBuffer& command) {
  const std::uint64_t size = command.target->resolve_range(command.offset, command.bytes.size());
  if (command.target->data) glass::fill_shadow(command.target->data + command.offset, size, ByteState::kWritten);
}

void note_written(ReplayState&, const CmdFillBuffer& command) {
  const std::uint64_t size = command.target->resolve_range(command.offset, command.size) & ~std::uint64_t{3};
  if (command.target->data) glass::fill_shadow(command.target->data + command.offset, size, ByteState::kWritten);
}

void note_written(ReplayState&, const CmdCopyImage& command) {
  const ImageStates source(*command.source), target(*command.target);
  if (!target.known()) return;
  for (const VkImageCopy& region : command.regions) {
    if (source.known()) {
      texel::copy_image(source.memory(), target.memory(), region);
    } else {
      fill_region(*command.target, region.dstSubresource, region.dstOffset,
                  VkExtent3D{INT16_MAX, INT16_MAX, INT16_MAX});
    }
  }
}

void note_written(ReplayState&, const CmdBlitImage& command) {
  for (const VkImageBlit& region : command.regions)
    fill_region(*command.target, region.dstSubresource, region.dstOffsets[0], region.dstOffsets[1]);
}

void note_written(ReplayState&, const CmdResolveImage& command) {
  for (const VkImageResolve& region : command.regions)
    fill_region(*command.target, region.dstSubresource, region.dstOffset, region.extent);
}

void note_written(ReplayState&, const CmdCopyBufferToImage& command) {
  const ImageStates target(*command.target);
  if (!target.known()) return;
  const std::span<std::byte> source = states_of(*command.source);
  const ShadowRegion* region = source.empty() ? nullptr : glass::find_shadow(command.source->data);
  for (const VkBufferImageCopy& r : command.regions) {
    const std::byte* const first = command.source->data + r.bufferOffset;
    const std::uint64_t bytes = command.source->resolve_range(r.bufferOffset, bytes_of(*command.target, r));
    if (!region || region->is_mapped(number_of(first), bytes)) {
      fill_region(*command.target, r.imageSubresource, r.imageOffset, r.imageExtent);
    } else {
      region->settle(number_of(first), bytes, Contents::kBytes);
      texel::copy_buffer_to_image(source, target.memory(), r);
    }
  }
}

void note_written(ReplayState&, const CmdCopyImageToBuffer& command) {
  const std::span<std::byte> target = states_of(*command.target);
  if (target.empty()) return;
  const ImageStates source(*command.source);
  for (const VkBufferImageCopy& r : command.regions) {
    if (source.known()) {
      texel::copy_image_to_buffer(source.memory(), target, r);
    } else if (r.bufferOffset < target.size()) {
      std::ranges::fill(target.subspan(r.bufferOffset), static_cast<std::byte>(ByteState::kWritten));
    }
  }
}

void note_written(ReplayState&, const CmdClearColorImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges) fill_range(*command.image, range, ByteState::kWritten);
}

void note_written(ReplayState&, const CmdClearDepthStencilImage& command) {
  for (const VkImageSubresourceRange& range : command.ranges) fill_range(*command.image, range, ByteState::kWritten);
}

void note_written(ReplayState&, const CmdCopyQueryPoolResults& command) {
  // Values of queries that are not available are left out: those bytes count as written, too.
  const Buffer& target = *command.target;
  if (!target.data || command.offset >= target.size || command.count == 0) return;
  constexpr std::uint64_t kMostBytes = (kStatisticsCounters + 1) * sizeof(std::uint64_t);
  const std::uint64_t bytes = (command.count - 1) * command.stride + std::max(kMostBytes, command.stride);
  glass::fill_shadow(target.data + command.offset, std::min(bytes, target.size - command.offset), ByteState::kWritten);
}

void note_written(ReplayState&, const CmdBindTransformFeedbackBuffers& command) {
  // All of what is bound: how much of it draws fill is known only later.
  for (const FeedbackBinding& binding : command.bindings) {
    if (!binding.buffer || !binding.buffer->data) continue;
    const std::uint64_t size = binding.buffer->resolve_range(binding.offset, binding.size);
    if (size) glass::fill_shadow(binding.buffer->data + binding.offset, size, ByteState::kWritten);
  }
}

void note_written(ReplayState&, const CmdEndTransformFeedback& command) {
  for (const CounterBuffer& counter : command.counters) {
    if (!counter.buffer || !counter.buffer->data) continue;
    const std::uint64_t size = counter.buffer->resolve_range(counter.offset, sizeof(std::uint32_t));
    if (size) glass::fill_shadow(counter.buffer->data + counter.offset, size, ByteState::kWritten);
  }
}

void execute(ReplayState&, const CmdDiscardImages&) {}

void note_written(ReplayState&, const CmdDiscardImages& command) {
  for (const DiscardedImage& discarded : command.images) {
    const Image& image = *discarded.image;
    fill_range(image, discarded.range, discarded_state(image));
  }
}

}  // namespace vitrine::icd
