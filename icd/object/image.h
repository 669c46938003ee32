// VkImage, VkImageView, VkSampler: texels as objects.
#pragma once

#include <optional>

#include "icd/object/object.h"
#include "texel/sampler.h"
#include "texel/view.h"

namespace vitrine::texel {
struct ImageMemory;
}

namespace vitrine::icd {

struct Device;

struct Image : Object<VkImage, VK_OBJECT_TYPE_IMAGE> {
  using Object::Object;

  VkImageCreateFlags flags = 0;
  VkImageUsageFlags usage = 0;
  VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL;
  texel::ImageLayout layout;               ///< layout.desc has type, format, extent, levels, layers, samples
  std::byte* data = nullptr;               ///< null until memory is bound
  std::array<std::byte*, 3> plane_data{};  ///< of a disjoint image; the first is `data`

  const texel::ImageDesc& desc() const { return layout.desc; }
  /// The memory that a plane's offset counts in.
  std::byte* memory_of_plane(std::uint32_t plane) const { return layout.desc.disjoint ? plane_data[plane] : data; }
};

struct ImageView : Object<VkImageView, VK_OBJECT_TYPE_IMAGE_VIEW> {
  explicit ImageView(const HostMemory& m) : Object(m), planes(m) {}

  Image* image = nullptr;
  VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageUsageFlags usage = 0;
  VkImageSubresourceRange range{};  ///< counts resolved
  /// What shaders, colour and depth attachments see: the colour aspect, or depth, or stencil where it is alone.
  texel::ImageView view;
  /// What descriptors of storage images see if it is only some slices of `view` (VkImageViewSlicedCreateInfoEXT).
  std::optional<texel::ImageView> slices;
  /// The stencil plane of a view that has both aspects; else equal to `view`.
  texel::ImageView stencil;
  Vector<texel::ImageView> planes;  ///< what `view.planes` or `view.words` points to
  std::uint64_t described = 0;      ///< its name in descriptors of buffers (icd/object/descriptor_bytes.h)

  const texel::ImageView& stored() const { return slices ? *slices : view; }
};

struct SamplerYcbcrConversion : Object<VkSamplerYcbcrConversion, VK_OBJECT_TYPE_SAMPLER_YCBCR_CONVERSION> {
  using Object::Object;

  texel::YcbcrConversion state;
};

struct Sampler : Object<VkSampler, VK_OBJECT_TYPE_SAMPLER> {
  using Object::Object;

  texel::Sampler state;
  std::uint64_t described = 0;  ///< as ImageView's
};

/// Fills `image.layout` and the rest from the create info. VK_ERROR_OUT_OF_DEVICE_MEMORY for sizes beyond what one
/// allocation can be. Swapchain images use it too.
VkResult init_image(Image& image, const VkImageCreateInfo& info);

/// What copies, blits, resolves and clears of a whole image work on (texel/transfer.h).
texel::ImageMemory memory_of(const Image& image);

/// A range with VK_REMAINING_* replaced by numbers.
VkImageSubresourceRange resolve_range(const Image& image, const VkImageSubresourceRange& range);

/// A view of one aspect of an image: what transfers work on. Levels and layers as in `range` (resolved).
texel::ImageView view_of_aspect(const Image& image, VkImageAspectFlagBits aspect, VkImageViewType type, VkFormat format,
                                const VkImageSubresourceRange& range, const VkComponentMapping& components = {});

/// Tells messengers that the image gives up its addresses (icd/edge/diagnostics.h: report_binding). Defined with
/// memory.
void report_unbinding(Device& device, const Image& image);

/// The image exists, or ends: told to those who watch texels (glass/pixel/pixels.h).
void watch_image(const Image& image, bool in_swapchain);
void forget_image(const Image& image);

/// Memory of a swapchain's image, for vkBindImageMemory2 with VkBindImageMemorySwapchainInfoKHR; null if there is no
/// such image. Defined with the swapchain.
std::byte* swapchain_image_memory(VkSwapchainKHR swapchain, std::uint32_t index);

}  // namespace vitrine::icd
