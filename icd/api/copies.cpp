// Recording copies, blits and resolves (Vulkan 1.3.239, Copy Commands). The commands of VK_KHR_copy_commands2 are the
// implementation; the older ones call them.
#include <algorithm>
#include <bit>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/image.h"
#include "icd/object/memory.h"
#include "icd/record/command_buffer.h"
#include "icd/record/dependencies.h"
#include "icd/replay/host_copies.h"

namespace vitrine::icd {
namespace {

constexpr std::uint64_t kBytesPerNanosecond = 8;
constexpr std::uint64_t kCopyCost = 300;

/// A region of the second form is one of the first behind sType and pNext.
template <class Old, class New>
Old downgrade(const New& region) {
  static_assert(sizeof(New) >= sizeof(Old) + 16);
  Old out;
  std::memcpy(&out, reinterpret_cast<const std::byte*>(&region) + offsetof(New, pNext) + sizeof(void*), sizeof out);
  return out;
}

std::span<const VkBufferCopy> copy_regions(VkCommandBuffer buffer, const VkBufferCopy2* regions, std::uint32_t count) {
  const auto out = from_handle<CommandBuffer>(buffer).arena.add_array<VkBufferCopy>(count);
  std::transform(regions, regions + count, out.begin(), downgrade<VkBufferCopy, VkBufferCopy2>);
  return out;
}

/// VK_REMAINING_ARRAY_LAYERS as a number (Vulkan 1.4.309, VkImageSubresourceLayers).
void resolve_layers(const Image& image, VkImageSubresourceLayers& layers) {
  const std::uint32_t all = image.desc().layers;
  if (layers.layerCount == VK_REMAINING_ARRAY_LAYERS) layers.layerCount = all - std::min(all, layers.baseArrayLayer);
}

/// Regions of an image and a buffer.
template <class New>
std::span<const VkBufferImageCopy> copy_regions(VkCommandBuffer buffer, const New* regions, std::uint32_t count,
                                                const Image& image) {
  const auto out = from_handle<CommandBuffer>(buffer).arena.add_array<VkBufferImageCopy>(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    out[i] = downgrade<VkBufferImageCopy>(regions[i]);
    resolve_layers(image, out[i].imageSubresource);
  }
  return out;
}

/// Regions of two images.
template <class Old, class New>
std::span<const Old> copy_regions(VkCommandBuffer buffer, const New* regions, std::uint32_t count, const Image& source,
                                  const Image& target) {
  const auto out = from_handle<CommandBuffer>(buffer).arena.add_array<Old>(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    out[i] = downgrade<Old>(regions[i]);
    resolve_layers(source, out[i].srcSubresource);
    resolve_layers(target, out[i].dstSubresource);
  }
  return out;
}

/// Calls `command` with the regions of the first form dressed as the second.
template <class New, class Old, class Command>
void with_upgraded(VkCommandBuffer buffer, const Old* regions, std::uint32_t count, Command command) {
  Vector<New> out(from_handle<CommandBuffer>(buffer).memory);
  out.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    New region = make_struct<New>();
    std::memcpy(reinterpret_cast<std::byte*>(&region) + offsetof(New, pNext) + sizeof(void*), &regions[i], sizeof(Old));
    out.push_back(region);
  }
  command(out.data());
}

std::uint64_t texels(const VkExtent3D& extent) { return std::uint64_t{extent.width} * extent.height * extent.depth; }

void add_cost(VkCommandBuffer buffer, std::uint64_t bytes) {
  from_handle<CommandBuffer>(buffer).cost += kCopyCost + bytes / kBytesPerNanosecond;
}

template <class Region>
void add_texel_cost(VkCommandBuffer buffer, const Image& image, std::span<const Region> regions) {
  const std::uint64_t bytes = texel::format_desc(image.desc().format).block_bytes;
  for (const Region& r : regions) {
    if constexpr (requires { r.extent; }) {
      add_cost(buffer, texels(r.extent) * bytes);
    } else {
      add_cost(buffer, texels(r.imageExtent) * bytes);
    }
  }
}

#ifdef VK_EXT_host_image_copy
/// A region of an image and host memory: as one of a buffer that begins at the host's pointer. The two structures are
/// laid out alike, pointer for offset.
template <class New>
VkBufferImageCopy host_region(const New& region, const Image& image) {
  static_assert(sizeof(New) == sizeof(VkBufferImageCopy2) &&
                offsetof(New, imageSubresource) == offsetof(VkBufferImageCopy2, imageSubresource));
  auto out = downgrade<VkBufferImageCopy>(region);
  out.bufferOffset = 0;
  resolve_layers(image, out.imageSubresource);
  return out;
}
#endif

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdCopyBuffer(VkCommandBuffer buffer, VkBuffer source, VkBuffer target, std::uint32_t count,
                                         const VkBufferCopy* regions) {
  with_upgraded<VkBufferCopy2>(buffer, regions, count, [&](const VkBufferCopy2* upgraded) {
    VkCopyBufferInfo2 info = make_struct<VkCopyBufferInfo2>();
    info.srcBuffer = source;
    info.dstBuffer = target;
    info.regionCount = count;
    info.pRegions = upgraded;
    CmdCopyBuffer2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyBuffer2(VkCommandBuffer buffer, const VkCopyBufferInfo2* info) {
  const auto regions = copy_regions(buffer, info->pRegions, info->regionCount);
  record(buffer,
         icd::CmdCopyBuffer{&from_handle<Buffer>(info->srcBuffer), &from_handle<Buffer>(info->dstBuffer), regions});
  for (const VkBufferCopy& r : regions) add_cost(buffer, r.size);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImage(VkCommandBuffer buffer, VkImage source, VkImageLayout source_layout,
                                        VkImage target, VkImageLayout target_layout, std::uint32_t count,
                                        const VkImageCopy* regions) {
  with_upgraded<VkImageCopy2>(buffer, regions, count, [&](const VkImageCopy2* upgraded) {
    VkCopyImageInfo2 info = make_struct<VkCopyImageInfo2>();
    info.srcImage = source;
    info.srcImageLayout = source_layout;
    info.dstImage = target;
    info.dstImageLayout = target_layout;
    info.regionCount = count;
    info.pRegions = upgraded;
    CmdCopyImage2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImage2(VkCommandBuffer buffer, const VkCopyImageInfo2* info) {
  const Image &source = from_handle<Image>(info->srcImage), &target = from_handle<Image>(info->dstImage);
  const auto regions = copy_regions<VkImageCopy>(buffer, info->pRegions, info->regionCount, source, target);
  record(buffer, icd::CmdCopyImage{&source, &target, regions});
  record_layouts(buffer, source, info->srcImageLayout, regions, &VkImageCopy::srcSubresource);
  record_layouts(buffer, target, info->dstImageLayout, regions, &VkImageCopy::dstSubresource);
  add_texel_cost(buffer, source, regions);
}

VKAPI_ATTR void VKAPI_CALL CmdBlitImage(VkCommandBuffer buffer, VkImage source, VkImageLayout source_layout,
                                        VkImage target, VkImageLayout target_layout, std::uint32_t count,
                                        const VkImageBlit* regions, VkFilter filter) {
  with_upgraded<VkImageBlit2>(buffer, regions, count, [&](const VkImageBlit2* upgraded) {
    VkBlitImageInfo2 info = make_struct<VkBlitImageInfo2>();
    info.srcImage = source;
    info.srcImageLayout = source_layout;
    info.dstImage = target;
    info.dstImageLayout = target_layout;
    info.regionCount = count;
    info.pRegions = upgraded;
    info.filter = filter;
    CmdBlitImage2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdBlitImage2(VkCommandBuffer buffer, const VkBlitImageInfo2* info) {
  const Image &source = from_handle<Image>(info->srcImage), &target = from_handle<Image>(info->dstImage);
  const auto regions = copy_regions<VkImageBlit>(buffer, info->pRegions, info->regionCount, source, target);
  record(buffer, icd::CmdBlitImage{&source, &target, regions, info->filter});
  record_layouts(buffer, source, info->srcImageLayout, regions, &VkImageBlit::srcSubresource);
  record_layouts(buffer, target, info->dstImageLayout, regions, &VkImageBlit::dstSubresource);
  for (const VkImageBlit& r : regions) {
    const std::int64_t width = std::abs(std::int64_t{r.dstOffsets[1].x} - r.dstOffsets[0].x);
    const std::int64_t height = std::abs(std::int64_t{r.dstOffsets[1].y} - r.dstOffsets[0].y);
    add_cost(buffer, static_cast<std::uint64_t>(width * height) * 16);
  }
}

VKAPI_ATTR void VKAPI_CALL CmdCopyBufferToImage(VkCommandBuffer buffer, VkBuffer source, VkImage target,
                                                VkImageLayout target_layout, std::uint32_t count,
                                                const VkBufferImageCopy* regions) {
  with_upgraded<VkBufferImageCopy2>(buffer, regions, count, [&](const VkBufferImageCopy2* upgraded) {
    VkCopyBufferToImageInfo2 info = make_struct<VkCopyBufferToImageInfo2>();
    info.srcBuffer = source;
    info.dstImage = target;
    info.dstImageLayout = target_layout;
    info.regionCount = count;
    info.pRegions = upgraded;
    CmdCopyBufferToImage2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyBufferToImage2(VkCommandBuffer buffer, const VkCopyBufferToImageInfo2* info) {
  const Image& target = from_handle<Image>(info->dstImage);
  const auto regions = copy_regions(buffer, info->pRegions, info->regionCount, target);
  record(buffer, icd::CmdCopyBufferToImage{&from_handle<Buffer>(info->srcBuffer), &target, regions});
  record_layouts(buffer, target, info->dstImageLayout, regions, &VkBufferImageCopy::imageSubresource);
  add_texel_cost(buffer, target, regions);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImageToBuffer(VkCommandBuffer buffer, VkImage source, VkImageLayout source_layout,
                                                VkBuffer target, std::uint32_t count,
                                                const VkBufferImageCopy* regions) {
  with_upgraded<VkBufferImageCopy2>(buffer, regions, count, [&](const VkBufferImageCopy2* upgraded) {
    VkCopyImageToBufferInfo2 info = make_struct<VkCopyImageToBufferInfo2>();
    info.srcImage = source;
    info.srcImageLayout = source_layout;
    info.dstBuffer = target;
    info.regionCount = count;
    info.pRegions = upgraded;
    CmdCopyImageToBuffer2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImageToBuffer2(VkCommandBuffer buffer, const VkCopyImageToBufferInfo2* info) {
  const Image& source = from_handle<Image>(info->srcImage);
  const auto regions = copy_regions(buffer, info->pRegions, info->regionCount, source);
  record(buffer, icd::CmdCopyImageToBuffer{&source, &from_handle<Buffer>(info->dstBuffer), regions});
  record_layouts(buffer, source, info->srcImageLayout, regions, &VkBufferImageCopy::imageSubresource);
  add_texel_cost(buffer, source, regions);
}

VKAPI_ATTR void VKAPI_CALL CmdResolveImage(VkCommandBuffer buffer, VkImage source, VkImageLayout source_layout,
                                           VkImage target, VkImageLayout target_layout, std::uint32_t count,
                                           const VkImageResolve* regions) {
  with_upgraded<VkImageResolve2>(buffer, regions, count, [&](const VkImageResolve2* upgraded) {
    VkResolveImageInfo2 info = make_struct<VkResolveImageInfo2>();
    info.srcImage = source;
    info.srcImageLayout = source_layout;
    info.dstImage = target;
    info.dstImageLayout = target_layout;
    info.regionCount = count;
    info.pRegions = upgraded;
    CmdResolveImage2(buffer, &info);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdResolveImage2(VkCommandBuffer buffer, const VkResolveImageInfo2* info) {
  const Image &source = from_handle<Image>(info->srcImage), &target = from_handle<Image>(info->dstImage);
  const auto regions = copy_regions<VkImageResolve>(buffer, info->pRegions, info->regionCount, source, target);
  record(buffer, icd::CmdResolveImage{&source, &target, regions});
  record_layouts(buffer, source, info->srcImageLayout, regions, &VkImageResolve::srcSubresource);
  record_layouts(buffer, target, info->dstImageLayout, regions, &VkImageResolve::dstSubresource);
  add_texel_cost(buffer, source, regions);
}

VKAPI_ATTR void VKAPI_CALL CmdUpdateBuffer(VkCommandBuffer buffer, VkBuffer target, VkDeviceSize offset,
                                           VkDeviceSize size, const void* data) {
  record(buffer, icd::CmdUpdateBuffer{&from_handle<Buffer>(target), offset,
                                      copy_array(buffer, static_cast<const std::byte*>(data), size)});
  add_cost(buffer, size);
}

VKAPI_ATTR void VKAPI_CALL CmdFillBuffer(VkCommandBuffer buffer, VkBuffer target, VkDeviceSize offset,
                                         VkDeviceSize size, std::uint32_t value) {
  const Buffer& t = from_handle<Buffer>(target);
  record(buffer, icd::CmdFillBuffer{&t, offset, size, value});
  add_cost(buffer, t.resolve_range(offset, size));
}

#ifdef VK_EXT_host_image_copy
// Vulkan 1.4.309, Copy Commands, Copying Data Between Host Memory and Images: what commands do, by the thread that
// calls, at once. VK_HOST_IMAGE_COPY_MEMCPY asks for the device's own arrangement of texels, whose packed form is the
// plain one.
VKAPI_ATTR VkResult VKAPI_CALL CopyMemoryToImageEXT(VkDevice device, const VkCopyMemoryToImageInfoEXT* info) {
  const Image& target = from_handle<Image>(info->dstImage);
  for (const auto& region : std::span(info->pRegions, info->regionCount)) {
    const auto* const source = static_cast<const std::byte*>(region.pHostPointer);
    copy_from_host(from_handle<Device>(device), source, target, host_region(region, target));
  }
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CopyImageToMemoryEXT(VkDevice device, const VkCopyImageToMemoryInfoEXT* info) {
  const Image& source = from_handle<Image>(info->srcImage);
  for (const auto& region : std::span(info->pRegions, info->regionCount)) {
    copy_to_host(from_handle<Device>(device), source, static_cast<std::byte*>(region.pHostPointer),
                 host_region(region, source));
  }
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CopyImageToImageEXT(VkDevice device, const VkCopyImageToImageInfoEXT* info) {
  const Image &source = from_handle<Image>(info->srcImage), &target = from_handle<Image>(info->dstImage);
  for (const VkImageCopy2& region : std::span(info->pRegions, info->regionCount)) {
    auto out = downgrade<VkImageCopy>(region);
    resolve_layers(source, out.srcSubresource);
    resolve_layers(target, out.dstSubresource);
    copy_by_host(from_handle<Device>(device), source, target, out);
  }
  return VK_SUCCESS;
}

/// Layouts are all the same here: those who watch them are told.
VKAPI_ATTR VkResult VKAPI_CALL TransitionImageLayoutEXT(VkDevice device, std::uint32_t count,
                                                        const VkHostImageLayoutTransitionInfoEXT* transitions) {
  for (const auto& t : std::span(transitions, count)) {
    const Image& image = from_handle<Image>(t.image);
    transition_by_host(from_handle<Device>(device), image, resolve_range(image, t.subresourceRange), t.newLayout);
  }
  return VK_SUCCESS;
}
#endif

}  // namespace entry
}  // namespace vitrine::icd
