// Images and image views (Vulkan 1.3.239, Resource Creation: Images, Image Views).
#include "icd/object/image.h"

#include <algorithm>
#include <vector>

#include "glass/pixel/pixels.h"
#include "glass/sync/sync.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/descriptor_bytes.h"
#include "icd/object/device.h"
#include "icd/object/format_properties.h"
#include "icd/properties.h"
#include "texel/layout.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

// As maxResourceSize of image_format_properties.
constexpr VkDeviceSize kMaxImageSize = kClaimedPhysicalDeviceMaintenance3Properties.maxMemoryAllocationSize;

/// The first aspect of a view, as shaders and attachments see it; `second` is stencil where both are there.
VkImageAspectFlagBits first_aspect(VkImageAspectFlags aspects) {
  return static_cast<VkImageAspectFlagBits>(aspects & ~(aspects - 1));
}

texel::ImageViewDesc view_desc(VkImageAspectFlagBits aspect, VkImageViewType type, VkFormat format,
                               const VkImageSubresourceRange& range, const VkComponentMapping& components) {
  texel::ImageViewDesc desc;
  desc.type = type;
  desc.format = format;
  desc.components = components;
  desc.aspect = aspect;
  desc.base_level = range.baseMipLevel;
  desc.level_count = range.levelCount;
  desc.base_layer = range.baseArrayLayer;
  desc.layer_count = range.layerCount;
  return desc;
}

/// Gives a view of a format that requires a conversion the planes that the conversion samples.
void add_sampled_planes(const Image& image, ImageView& view) {
  const texel::FormatDesc& format = texel::format_desc(view.format);
  const texel::FormatDesc& stored = texel::format_desc(image.desc().format);
  if (format.sampled_planes == 0 || format.plane_count != stored.plane_count) return;
  const texel::ImageViewDesc desc = view_desc(VK_IMAGE_ASPECT_COLOR_BIT, view.type, view.format, view.range, {});
  view.planes.reserve(format.sampled_planes);
  for (std::uint32_t i = 0; i < format.sampled_planes; ++i) {
    std::byte* memory = image.memory_of_plane(std::min(i, format.plane_count - 1u));
    view.planes.push_back(texel::make_sampled_plane(image.layout, memory, desc, i));
  }
  view.view.planes = view.planes.data();
}

/// Gives a view of 64-bit texels those of its low and high words.
void add_word_views(ImageView& view) {
  if (view.format != VK_FORMAT_R64_UINT && view.format != VK_FORMAT_R64_SINT) return;
  view.planes.reserve(2);
  for (const bool high : {false, true}) view.planes.push_back(texel::make_word_view(view.view, high));
  view.view.words = view.planes.data();
}

}  // namespace

namespace {

/// The places of the planes that a create info for VK_EXT_image_drm_format_modifier demands; none: the device's choice.
/// False if no modifier of the device is asked for.
bool read_modifier(const VkImageCreateInfo& info, std::vector<texel::PlanePlace>& places) {
  if (const auto* list = find_in_chain<VkImageDrmFormatModifierListCreateInfoEXT>(info.pNext)) {
    const std::uint64_t* const end = list->pDrmFormatModifiers + list->drmFormatModifierCount;
    return std::find(list->pDrmFormatModifiers, end, kLinearModifier) != end;
  }
  const auto* exact = find_in_chain<VkImageDrmFormatModifierExplicitCreateInfoEXT>(info.pNext);
  if (!exact || exact->drmFormatModifier != kLinearModifier || exact->drmFormatModifierPlaneCount > 3) return false;
  for (std::uint32_t i = 0; i < exact->drmFormatModifierPlaneCount; ++i) {
    const VkSubresourceLayout& plane = exact->pPlaneLayouts[i];
    places.push_back({plane.offset, plane.rowPitch, plane.arrayPitch});
  }
  return !places.empty();
}

/// The layout of an image of the linear modifier. Whoever sent the places of its planes is not trusted.
VkResult make_shared_layout(const VkImageCreateInfo& info, const texel::ImageDesc& desc, texel::ImageLayout& layout) {
  std::vector<texel::PlanePlace> places;
  const bool known = modifier_features(info.format) != 0 && desc.type == VK_IMAGE_TYPE_2D && desc.levels == 1 &&
                     desc.samples == 1 && read_modifier(info, places);
  if (!known) return VK_ERROR_INVALID_DRM_FORMAT_MODIFIER_PLANE_LAYOUT_EXT;
  if (places.empty()) return texel::make_image_layout(desc, layout) ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return texel::make_image_layout(desc, places, layout) ? VK_SUCCESS
                                                        : VK_ERROR_INVALID_DRM_FORMAT_MODIFIER_PLANE_LAYOUT_EXT;
}

/// The layout that the tiling wants.
VkResult make_layout(const VkImageCreateInfo& info, const texel::ImageDesc& desc, texel::ImageLayout& layout) {
  if (info.tiling == VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT) return make_shared_layout(info, desc, layout);
  return texel::make_image_layout(desc, layout) ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

}  // namespace

VkResult init_image(Image& image, const VkImageCreateInfo& info) {
  image.flags = info.flags;
  image.usage = info.usage;
  image.tiling = info.tiling;
  texel::ImageDesc desc;
  desc.type = info.imageType;
  desc.format = info.format;
  desc.extent = {info.extent.width, info.extent.height, info.extent.depth};
  desc.levels = info.mipLevels;
  desc.layers = info.arrayLayers;
  desc.samples = static_cast<std::uint32_t>(info.samples);
  desc.linear_tiling = info.tiling != VK_IMAGE_TILING_OPTIMAL;
  desc.disjoint = (info.flags & VK_IMAGE_CREATE_DISJOINT_BIT) && texel::format_desc(info.format).plane_count > 1;
  const bool representable = info.mipLevels <= texel::kMaxLevels && info.samples <= VK_SAMPLE_COUNT_64_BIT;
  if (!representable || texel::format_desc(info.format).block_bytes == 0) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  if (const VkResult result = make_layout(info, desc, image.layout); result != VK_SUCCESS) return result;
  return image.layout.size > kMaxImageSize ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_SUCCESS;
}

VkImageSubresourceRange resolve_range(const Image& image, const VkImageSubresourceRange& range) {
  VkImageSubresourceRange out = range;
  // Slices of a 3D image count as layers where a 2D array view may show them.
  const bool slices = image.desc().type == VK_IMAGE_TYPE_3D && (image.flags & VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT);
  const std::uint32_t layers =
      slices ? image.layout.plane[0].level[range.baseMipLevel].extent.depth : image.desc().layers;
  if (out.levelCount == VK_REMAINING_MIP_LEVELS) out.levelCount = image.desc().levels - out.baseMipLevel;
  if (out.layerCount == VK_REMAINING_ARRAY_LAYERS) out.layerCount = layers - out.baseArrayLayer;
  return out;
}

texel::ImageMemory memory_of(const Image& image) {
  return {&image.layout, image.data, image.desc().disjoint ? &image.plane_data : nullptr};
}

texel::ImageView view_of_aspect(const Image& image, VkImageAspectFlagBits aspect, VkImageViewType type, VkFormat format,
                                const VkImageSubresourceRange& range, const VkComponentMapping& components) {
  std::byte* memory = image.memory_of_plane(texel::plane_of_aspect(image.layout, aspect));
  return texel::make_image_view(image.layout, memory, view_desc(aspect, type, format, range, components));
}

namespace {

VkSubresourceLayout layout_of(const texel::ImageLayout& layout, const VkImageSubresource& subresource) {
  const auto aspect = static_cast<VkImageAspectFlagBits>(subresource.aspectMask);
  const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, aspect)];
  const texel::LevelLayout& level = plane.level[subresource.mipLevel];
  VkSubresourceLayout out;
  out.offset = plane.offset + level.offset + subresource.arrayLayer * plane.layer_stride;
  out.size = level.slice_pitch * level.extent.depth;
  out.rowPitch = level.row_pitch;
  out.arrayPitch = plane.layer_stride;
  out.depthPitch = level.slice_pitch;
  return out;
}

#ifdef VK_KHR_maintenance5
/// With what the host needs for all of it with VK_HOST_IMAGE_COPY_MEMCPY: the same texels without gaps.
void write_layout(const texel::ImageLayout& layout, const VkImageSubresource& subresource,
                  VkSubresourceLayout2KHR& out) {
  out.subresourceLayout = layout_of(layout, subresource);
  if (auto* packed = find_in_out_chain<VkSubresourceHostMemcpySizeEXT>(out.pNext)) {
    const auto aspect = first_aspect(subresource.aspectMask);
    const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, aspect)];
    const texel::LevelLayout& level = plane.level[subresource.mipLevel];
    const texel::FormatDesc& format = texel::format_desc(plane.format);
    const auto blocks = [](std::uint32_t texels, std::uint32_t block) { return (texels + block - 1) / block; };
    packed->size = VkDeviceSize{blocks(level.extent.width, format.block_width)} *
                   blocks(level.extent.height, format.block_height) * level.extent.depth * format.block_bytes;
  }
}
#endif

/// VkImageViewMinLodCreateInfoEXT.
void set_min_lod(texel::ImageView& view, float min_lod) {
  view.min_lod = std::max(min_lod - static_cast<float>(view.base_level), 0.0f);
  view.min_level = static_cast<std::uint32_t>(view.min_lod);
}

#ifdef VK_EXT_image_sliced_view_of_3d
/// Of a view of one level: what lies outside of the level is nobody's.
void set_slices(texel::ImageView& view, std::uint32_t offset, std::uint32_t count) {
  texel::LevelLayout& level = view.level[0];
  const std::uint32_t first = std::min(offset, level.extent.depth - 1);
  view.base += first * level.slice_pitch;
  level.extent.depth = std::min(count, level.extent.depth - first);
}
#endif

}  // namespace

void watch_image(const Image& image, bool in_swapchain) {
  glass::pixel::Pixels* const pixels = glass::pixel::pixels();
  if (pixels)
    pixels->image_made(&image, {&image.layout, &image.data, image.desc().disjoint ? &image.plane_data : nullptr},
                       in_swapchain);
}

void forget_image(const Image& image) {
  if (glass::pixel::Pixels* const pixels = glass::pixel::pixels()) pixels->image_gone(&image);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateImage(VkDevice device, const VkImageCreateInfo* info,
                                           const VkAllocationCallbacks* allocator, VkImage* image) {
  Owned<Image> object(create_object<Image>(from_handle<Device>(device).memory, allocator));
  const VkResult result = init_image(*object, *info);
  if (result != VK_SUCCESS) return result;
  watch_image(*object, false);
  *image = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyImage(VkDevice device, VkImage image, const VkAllocationCallbacks*) {
  if (const Image* object = from_nullable<Image>(image)) {
    leave_address(from_handle<Device>(device), object);
    report_unbinding(from_handle<Device>(device), *object);
    forget_image(*object);
    glass::sync::forget_image(&from_handle<Device>(device), object);
  }
  destroy_handle<Image>(image);
}

VKAPI_ATTR VkResult VKAPI_CALL GetImageDrmFormatModifierPropertiesEXT(VkDevice, VkImage,
                                                                      VkImageDrmFormatModifierPropertiesEXT* out) {
  out->drmFormatModifier = kLinearModifier;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetImageSubresourceLayout(VkDevice, VkImage image, const VkImageSubresource* subresource,
                                                     VkSubresourceLayout* out) {
  *out = layout_of(from_handle<Image>(image).layout, *subresource);
}

#ifdef VK_KHR_maintenance5
VKAPI_ATTR void VKAPI_CALL GetImageSubresourceLayout2KHR(VkDevice, VkImage image,
                                                         const VkImageSubresource2KHR* subresource,
                                                         VkSubresourceLayout2KHR* out) {
  write_layout(from_handle<Image>(image).layout, subresource->imageSubresource, *out);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceImageSubresourceLayoutKHR(VkDevice device,
                                                              const VkDeviceImageSubresourceInfoKHR* info,
                                                              VkSubresourceLayout2KHR* out) {
  Image image(from_handle<Device>(device).memory);
  init_image(image, *info->pCreateInfo);
  write_layout(image.layout, info->pSubresource->imageSubresource, *out);
}
#endif

VKAPI_ATTR VkResult VKAPI_CALL CreateImageView(VkDevice device, const VkImageViewCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkImageView* view) {
  Image& image = from_handle<Image>(info->image);
  if (!image.data) return VK_ERROR_OUT_OF_DEVICE_MEMORY;  // views of unbound images are invalid
  Owned<ImageView> object(create_object<ImageView>(from_handle<Device>(device).memory, allocator));
  object->image = &image;
  object->type = info->viewType;
  object->format = info->format;
  object->usage = image.usage;
  if (const auto* usage = find_in_chain<VkImageViewUsageCreateInfo>(info->pNext)) object->usage = usage->usage;
  object->range = resolve_range(image, info->subresourceRange);
  const VkImageAspectFlags aspects = info->subresourceRange.aspectMask;
  object->view =
      view_of_aspect(image, first_aspect(aspects), info->viewType, info->format, object->range, info->components);
  add_sampled_planes(image, *object);
  object->stencil = object->view;
  constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
  if ((aspects & kBoth) == kBoth) {
    object->stencil = view_of_aspect(image, VK_IMAGE_ASPECT_STENCIL_BIT, info->viewType, info->format, object->range);
  }
  if (const auto* min_lod = find_in_chain<VkImageViewMinLodCreateInfoEXT>(info->pNext)) {
    set_min_lod(object->view, min_lod->minLod);
    set_min_lod(object->stencil, min_lod->minLod);
  }
#ifdef VK_EXT_image_sliced_view_of_3d
  if (const auto* slices = find_in_chain<VkImageViewSlicedCreateInfoEXT>(info->pNext))
    set_slices(object->slices.emplace(object->view), slices->sliceOffset, slices->sliceCount);
#endif
  add_word_views(*object);
  const auto seen = static_cast<std::uint64_t>(reinterpret_cast<std::byte*>(&object->slices + 1) -
                                               reinterpret_cast<std::byte*>(&object->view));
  enter_address(from_handle<Device>(device), {&object->view, seen, image.data, ref(image)}, *object);
  *view = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyImageView(VkDevice device, VkImageView view, const VkAllocationCallbacks*) {
  const Device& d = from_handle<Device>(device);
  leave_address(d, from_nullable<ImageView>(view));
  if (d.described && view) d.described->views.forget(from_handle<ImageView>(view));
  destroy_handle<ImageView>(view);
}

}  // namespace entry
}  // namespace vitrine::icd
