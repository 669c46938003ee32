// What transfers, and the fixed stages of draws and dispatches, read and write (Vulkan 1.3.239, Copy Commands, Clear
// Commands; stages: Synchronization, Pipeline Stages).
#include <algorithm>

#include "icd/edge/diagnostics.h"
#include "icd/object/memory.h"
#include "icd/replay/image_boxes.h"
#include "icd/replay/sync_notes.h"

namespace vitrine::icd {
namespace {

using glass::sync::Access;
using glass::sync::Range;
using glass::sync::Stage;
using glass::sync::Use;
using Ranges = std::vector<Range>;

constexpr Use kCopyRead{Stage::kCopy, Access::kTransferRead}, kCopyWrite{Stage::kCopy, Access::kTransferWrite};
constexpr Use kClearWrite{Stage::kClear, Access::kTransferWrite};

std::uintptr_t number_of(const std::byte* address) { return reinterpret_cast<std::uintptr_t>(address); }

void touch(const ReplayState& state, Use use, const Image& image, Ranges ranges, const char* what) {
  auto who = sync_who(state, what, sync_name(state.device, image));
  state.observed->hazards->touch(tag_of(state), {use, 0, std::move(ranges), std::move(who)});
}

void touch(const ReplayState& state, Use use, const Buffer& buffer, Ranges ranges, const char* what) {
  auto who = sync_who(state, what, sync_name(state.device, buffer));
  who->base = number_of(buffer.data);
  state.observed->hazards->touch(tag_of(state), {use, 0, std::move(ranges), std::move(who)});
}

void add_bytes(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size, Ranges& ranges) {
  if (!buffer.data) return;
  const std::uintptr_t first = number_of(buffer.data) + offset;
  append(ranges, first, first + buffer.resolve_range(offset, size));
}

void touch(const ReplayState& state, Use use, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size,
           const char* what) {
  Ranges ranges;
  add_bytes(buffer, offset, size, ranges);
  touch(state, use, buffer, std::move(ranges), what);
}

template <class Region, class F>
Ranges ranges_of(std::span<const Region> regions, F&& add) {
  Ranges ranges;
  for (const Region& r : regions) add(r, ranges);
  return ranges;
}

void add_box(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& a, const VkOffset3D& b,
             Ranges& ranges) {
  for_each_box(image, layers, a, b,
               [&](const texel::ImageView& view, const glass::TexelBox& box) { add_texels(view, box, ranges); });
}

const texel::FormatDesc& copied_format(const Image& image, VkImageAspectFlags aspects) {
  const auto aspect = static_cast<VkImageAspectFlagBits>(aspects & ~(aspects - 1));
  return texel::format_desc(image.layout.plane[texel::plane_of_aspect(image.layout, aspect)].format);
}

/// The extent of a copy in texels of its target: blocks are copied as blocks.
VkExtent3D target_extent(const CmdCopyImage& command, const VkImageCopy& r) {
  const texel::FormatDesc& from = copied_format(*command.source, r.srcSubresource.aspectMask);
  const texel::FormatDesc& to = copied_format(*command.target, r.dstSubresource.aspectMask);
  const auto scale = [](std::uint32_t n, std::uint32_t a, std::uint32_t b) { return (n + a - 1) / a * b; };
  return {scale(r.extent.width, from.block_width, to.block_width),
          scale(r.extent.height, from.block_height, to.block_height), r.extent.depth};
}

/// The rows of a buffer that a region fills or is filled from.
void add_rows(const Buffer& buffer, const Image& image, const VkBufferImageCopy& r, Ranges& ranges) {
  const texel::FormatDesc& format = copied_format(image, r.imageSubresource.aspectMask);
  const auto blocks = [](std::uint32_t texels, std::uint32_t block) { return (texels + block - 1) / block; };
  const std::uint32_t width = blocks(r.imageExtent.width, format.block_width);
  const std::uint32_t height = blocks(r.imageExtent.height, format.block_height);
  const std::uint64_t pitch = r.bufferRowLength ? blocks(r.bufferRowLength, format.block_width) : width;
  const std::uint64_t rows = r.bufferImageHeight ? blocks(r.bufferImageHeight, format.block_height) : height;
  const std::uint32_t slices = std::max(r.imageExtent.depth, r.imageSubresource.layerCount);
  for (std::uint64_t z = 0; z < slices; ++z)
    for (std::uint64_t y = 0; y < height; ++y)
      add_bytes(buffer, r.bufferOffset + (z * rows + y) * pitch * format.block_bytes,
                std::uint64_t{width} * format.block_bytes, ranges);
}

void touch_arguments(const ReplayState& state, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size,
                     std::uint32_t stride, std::uint32_t count, const char* what) {
  Ranges ranges;
  for (std::uint32_t i = 0; i < count; ++i) add_bytes(buffer, offset + VkDeviceSize{i} * stride, size, ranges);
  touch(state, {Stage::kIndirect, Access::kIndirectRead}, buffer, std::move(ranges), what);
}

/// "buffer 'mesh' (", "a buffer (".
std::string named(const char* kind, const std::string& name) {
  std::string text = name.empty() ? (*kind == 'i' ? "an " : "a ") : "";
  text.append(kind);
  if (!name.empty()) text.append(" '").append(name).append("'");
  return text.append(" (");
}

}  // namespace

glass::sync::Tag tag_of(const ReplayState& state, glass::sync::Part part) {
  return glass::sync::make_tag(state.observed->submission, state.observed->command, part);
}

std::shared_ptr<glass::sync::Who> sync_who(const ReplayState& state, std::string what, std::string resource) {
  auto who = std::make_shared<glass::sync::Who>();
  who->address = address_of(*state.observed);
  who->place = who->address.command_name + ":" + what + ":" + resource;
  who->what = std::move(what);
  who->resource = std::move(resource);
  return who;
}

std::string sync_name(Device& device, const Image& image) {
  const std::string name = name_of(device.physical_device.instance, ref(image));
  const texel::Extent& extent = image.desc().extent;
  std::string text = named("image", name);
  text.append(std::to_string(extent.width)).append("x").append(std::to_string(extent.height));
  if (image.desc().type == VK_IMAGE_TYPE_3D) text.append("x").append(std::to_string(extent.depth));
  return text.append(", ").append(texel::format_desc(image.desc().format).name).append(")");
}

std::string sync_name(Device& device, const Buffer& buffer) {
  const std::string name = name_of(device.physical_device.instance, ref(buffer));
  return named("buffer", name).append(std::to_string(buffer.size)).append(" bytes)");
}

void add_texels(const texel::ImageView& view, const glass::TexelBox& box, std::vector<Range>& ranges) {
  // What lies between the rows of a box that is as wide as the level belongs to nobody.
  const bool whole = box.level < view.level_count && box.area.offset.x <= 0 &&
                     std::int64_t{box.area.offset.x} + box.area.extent.width >= view.level[box.level].extent.width;
  const std::uint64_t pitch = whole ? view.level[box.level].row_pitch : 0;
  glass::for_each_row(view, box, [&](const std::byte* first, std::uint64_t bytes) {
    const std::uintptr_t at = number_of(first);
    if (whole && !ranges.empty() && ranges.back().end <= at && at - ranges.back().end < pitch - bytes + 1)
      ranges.back().end = at + bytes;
    else
      append(ranges, at, at + bytes);
  });
}

void add_subresources(const Image& image, const VkImageSubresourceRange& range, std::vector<Range>& ranges) {
  for_each_box(image, range,
               [&](const texel::ImageView& view, const glass::TexelBox& box) { add_texels(view, box, ranges); });
}

void note_sync(ReplayState& state, const CmdCopyBuffer& command) {
  const auto bytes = [&](const Buffer& buffer, VkDeviceSize VkBufferCopy::*offset) {
    return ranges_of(command.regions,
                     [&](const VkBufferCopy& r, Ranges& ranges) { add_bytes(buffer, r.*offset, r.size, ranges); });
  };
  touch(state, kCopyRead, *command.source, bytes(*command.source, &VkBufferCopy::srcOffset), "read by a copy");
  touch(state, kCopyWrite, *command.target, bytes(*command.target, &VkBufferCopy::dstOffset), "write by a copy");
}

void note_sync(ReplayState& state, const CmdUpdateBuffer& command) {
  touch(state, kClearWrite, *command.target, command.offset, command.bytes.size(), "update");
}

void note_sync(ReplayState& state, const CmdFillBuffer& command) {
  touch(state, kClearWrite, *command.target, command.offset, command.size, "fill");
}

void note_sync(ReplayState& state, const CmdCopyImage& command) {
  touch(state, kCopyRead, *command.source,
        ranges_of(command.regions,
                  [&](const VkImageCopy& r, Ranges& ranges) {
                    add_box(*command.source, r.srcSubresource, r.srcOffset, end_of(r.srcOffset, r.extent), ranges);
                  }),
        "read by a copy");
  touch(state, kCopyWrite, *command.target,
        ranges_of(command.regions,
                  [&](const VkImageCopy& r, Ranges& ranges) {
                    add_box(*command.target, r.dstSubresource, r.dstOffset,
                            end_of(r.dstOffset, target_extent(command, r)), ranges);
                  }),
        "write by a copy");
}

void note_sync(ReplayState& state, const CmdBlitImage& command) {
  touch(state, {Stage::kBlit, Access::kTransferRead}, *command.source,
        ranges_of(command.regions,
                  [&](const VkImageBlit& r, Ranges& ranges) {
                    add_box(*command.source, r.srcSubresource, r.srcOffsets[0], r.srcOffsets[1], ranges);
                  }),
        "read by a blit");
  touch(state, {Stage::kBlit, Access::kTransferWrite}, *command.target,
        ranges_of(command.regions,
                  [&](const VkImageBlit& r, Ranges& ranges) {
                    add_box(*command.target, r.dstSubresource, r.dstOffsets[0], r.dstOffsets[1], ranges);
                  }),
        "write by a blit");
}

void note_sync(ReplayState& state, const CmdResolveImage& command) {
  touch(state, {Stage::kResolve, Access::kTransferRead}, *command.source,
        ranges_of(command.regions,
                  [&](const VkImageResolve& r, Ranges& ranges) {
                    add_box(*command.source, r.srcSubresource, r.srcOffset, end_of(r.srcOffset, r.extent), ranges);
                  }),
        "read by a resolve");
  touch(state, {Stage::kResolve, Access::kTransferWrite}, *command.target,
        ranges_of(command.regions,
                  [&](const VkImageResolve& r, Ranges& ranges) {
                    add_box(*command.target, r.dstSubresource, r.dstOffset, end_of(r.dstOffset, r.extent), ranges);
                  }),
        "write by a resolve");
}

void note_sync(ReplayState& state, const CmdCopyBufferToImage& command) {
  touch(state, kCopyRead, *command.source,
        ranges_of(command.regions, [&](const VkBufferImageCopy& r,
                                       Ranges& ranges) { add_rows(*command.source, *command.target, r, ranges); }),
        "read by a copy");
  touch(state, kCopyWrite, *command.target,
        ranges_of(command.regions,
                  [&](const VkBufferImageCopy& r, Ranges& ranges) {
                    add_box(*command.target, r.imageSubresource, r.imageOffset, end_of(r.imageOffset, r.imageExtent),
                            ranges);
                  }),
        "write by a copy");
}

void note_sync(ReplayState& state, const CmdCopyImageToBuffer& command) {
  touch(state, kCopyRead, *command.source,
        ranges_of(command.regions,
                  [&](const VkBufferImageCopy& r, Ranges& ranges) {
                    add_box(*command.source, r.imageSubresource, r.imageOffset, end_of(r.imageOffset, r.imageExtent),
                            ranges);
                  }),
        "read by a copy");
  touch(state, kCopyWrite, *command.target,
        ranges_of(command.regions, [&](const VkBufferImageCopy& r,
                                       Ranges& ranges) { add_rows(*command.target, *command.source, r, ranges); }),
        "write by a copy");
}

void note_sync(ReplayState& state, const CmdClearColorImage& command) {
  Ranges ranges;
  for (const VkImageSubresourceRange& range : command.ranges) add_subresources(*command.image, range, ranges);
  touch(state, kClearWrite, *command.image, std::move(ranges), "clear");
}

void note_sync(ReplayState& state, const CmdClearDepthStencilImage& command) {
  Ranges ranges;
  for (const VkImageSubresourceRange& range : command.ranges) add_subresources(*command.image, range, ranges);
  touch(state, kClearWrite, *command.image, std::move(ranges), "clear");
}

void note_sync(ReplayState& state, const CmdCopyQueryPoolResults& command) {
  if (command.count == 0) return;
  const std::uint64_t word = command.flags & VK_QUERY_RESULT_64_BIT ? 8 : 4;
  Ranges ranges;
  for (std::uint32_t i = 0; i < command.count; ++i)
    add_bytes(*command.target, command.offset + i * command.stride, word, ranges);
  touch(state, kCopyWrite, *command.target, std::move(ranges), "write of query results");
}

void note_sync(ReplayState& state, const CmdDrawIndirect& command) {
  std::uint32_t count = command.draw_count;
  if (command.count_buffer) {
    touch_arguments(state, *command.count_buffer, command.count_offset, sizeof count, 0, 1,
                    "read of the number of draws");
    std::uint32_t stored = 0;
    if (read_counter({const_cast<Buffer*>(command.count_buffer), command.count_offset}, stored))
      count = std::min(count, stored);
  }
  const std::size_t size = command.indexed ? sizeof(VkDrawIndexedIndirectCommand) : sizeof(VkDrawIndirectCommand);
  touch_arguments(state, *command.buffer, command.offset, size, command.stride, count, "read of arguments");
  note_sync(state, CmdDraw{});
}

void note_sync(ReplayState& state, const CmdDispatchIndirect& command) {
  touch_arguments(state, *command.buffer, command.offset, sizeof(VkDispatchIndirectCommand), 0, 1, "read of arguments");
}

void note_sync(ReplayState& state, const CmdDrawByteCount&) { note_sync(state, CmdDraw{}); }

void note_sync(ReplayState& state, const CmdBeginConditionalRendering& command) {
  touch(state, {Stage::kConditional, Access::kConditionalRead}, *command.buffer, command.offset, sizeof(std::uint32_t),
        "read of a condition");
}

}  // namespace vitrine::icd
