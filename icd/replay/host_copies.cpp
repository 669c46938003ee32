// See host_copies.h.
#include "icd/replay/host_copies.h"

#include <limits>

#include "glass/sync/sync.h"
#include "icd/replay/image_boxes.h"
#include "icd/replay/sync_notes.h"
#include "icd/replay/texel_events.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

/// How much of the host's memory there is nobody tells.
constexpr std::size_t kUnknownSize = std::numeric_limits<std::ptrdiff_t>::max();

struct Texels {
  const Image& image;
  const VkImageSubresourceLayers& layers;
  const VkOffset3D& offset;
  const VkExtent3D& extent;

  template <class F>
  void for_each_box(F&& f) const {
    icd::for_each_box(image, layers, offset, end_of(offset, extent), f);
  }
};

/// To the tool sync: the device must be done with them, and what it wrote be there for the host.
void note_access(Device& device, const Texels& texels, bool write, const char* command) {
  glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device);
  if (!hazards) return;
  const std::shared_ptr<const glass::sync::Who> who =
      glass::sync::host(write, command, sync_name(device, texels.image));
  std::vector<glass::sync::Range> ranges;
  texels.for_each_box([&](const texel::ImageView& view, const glass::TexelBox& box) { add_texels(view, box, ranges); });
  for (const glass::sync::Range& range : ranges) hazards->host_access(range, write, who);
}

Texels texels_of(const Image& image, const VkBufferImageCopy& r) {
  return {image, r.imageSubresource, r.imageOffset, r.imageExtent};
}

}  // namespace

void copy_from_host(Device& device, const std::byte* source, const Image& target, const VkBufferImageCopy& region) {
  const Texels written = texels_of(target, region);
  constexpr char kCommand[] = "vkCopyMemoryToImage";
  note_access(device, written, true, kCommand);
  texel::copy_buffer_to_image({source, kUnknownSize}, memory_of(target), region);
  fill_region(target, written.layers, written.offset, written.extent);
  note_host_upload(target, region, kCommand);
}

void copy_to_host(Device& device, const Image& source, std::byte* target, const VkBufferImageCopy& region) {
  note_access(device, texels_of(source, region), false, "vkCopyImageToMemory");
  texel::copy_image_to_buffer(memory_of(source), {target, kUnknownSize}, region);
}

void copy_by_host(Device& device, const Image& source, const Image& target, const VkImageCopy& region) {
  // Images of the same parameters: an extent is the same in both.
  const Texels written{target, region.dstSubresource, region.dstOffset, region.extent};
  constexpr char kCommand[] = "vkCopyImageToImage";
  note_access(device, {source, region.srcSubresource, region.srcOffset, region.extent}, false, kCommand);
  note_access(device, written, true, kCommand);
  texel::copy_image(memory_of(source), memory_of(target), region);
  fill_region(target, written.layers, written.offset, written.extent);
  note_host_copy(source, target, region, kCommand);
}

void transition_by_host(Device& device, const Image& image, const VkImageSubresourceRange& range,
                        VkImageLayout layout) {
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device))
    hazards->layouts().set(part_of(image, range), layout);
}

}  // namespace vitrine::icd
