// See resources.h.
#include "glass/replayer/resources.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass::replayer {
namespace {

constexpr VkImageCreateFlags kKeptFlags =
    VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT | VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT |
    VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT |
    VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT | VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
constexpr VkImageUsageFlags kKeptImageUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
constexpr VkImageUsageFlags kTransfer = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Without what the device does not know: where nothing needs it, it was taken out or is not drawn with.
VkImageUsageFlags usage_here(const Device& d, VkImageUsageFlags usage) {
  const bool rates = d.has(VK_KHR_FRAGMENT_SHADING_RATE_EXTENSION_NAME);
  return usage & kKeptImageUsage &
         ~(rates ? VkImageUsageFlags{0} : VkImageUsageFlags{VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR});
}

/// What no command fills is filled through the host.
bool is_filled_by_host(const bug::Image& image) { return image.samples != 1 && !image.texels.empty(); }

VkImage make_image(const Device& d, const bug::Image& source, VkDeviceMemory& memory) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.flags = source.flags & kKeptFlags;
  info.imageType = source.type;
  info.format = source.format;
  info.extent = {source.extent.width, source.extent.height, source.extent.depth};
  info.mipLevels = source.levels;
  info.arrayLayers = source.layers;
  info.samples = static_cast<VkSampleCountFlagBits>(source.samples);
  info.tiling = source.tiling;
  info.usage = usage_here(d, source.usage) | kTransfer;
  VkImage image = VK_NULL_HANDLE;
  must(vkCreateImage(d.device, &info, nullptr, &image), "vkCreateImage");
  set_name(d, VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image), source.name);
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(d.device, image, &needs);
  memory = allocate(d, needs, is_filled_by_host(source));
  must(vkBindImageMemory(d.device, image, memory, 0), "vkBindImageMemory");
  return image;
}

VkComponentSwizzle component(std::uint8_t selected) {
  constexpr VkComponentSwizzle kOthers[] = {VK_COMPONENT_SWIZZLE_R,    VK_COMPONENT_SWIZZLE_G,
                                            VK_COMPONENT_SWIZZLE_B,    VK_COMPONENT_SWIZZLE_A,
                                            VK_COMPONENT_SWIZZLE_ZERO, VK_COMPONENT_SWIZZLE_ONE};
  return kOthers[selected];
}

VkImageView make_view(const Device& d, const bug::View& source, VkImage image) {
  VkImageViewUsageCreateInfo usage{VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO};
  usage.usage = usage_here(d, source.usage);
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  if (usage.usage != 0) info.pNext = &usage;
  info.image = image;
  info.viewType = source.type;
  info.format = source.format;
  info.components = {component(source.swizzle[0]), component(source.swizzle[1]), component(source.swizzle[2]),
                     component(source.swizzle[3])};
  info.subresourceRange = source.range;
  VkImageView view = VK_NULL_HANDLE;
  must(vkCreateImageView(d.device, &info, nullptr, &view), "vkCreateImageView");
  set_name(d, VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<std::uint64_t>(view), source.name);
  return view;
}

/// The border colour among those that every driver has; MAX_ENUM: it is none of them.
VkBorderColor plain_border(const std::array<std::uint32_t, 4>& bits) {
  constexpr std::uint32_t kOneF = 0x3f800000;
  constexpr std::pair<std::array<std::uint32_t, 4>, VkBorderColor> kColors[] = {
      {{0, 0, 0, 0}, VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK},
      {{0, 0, 0, kOneF}, VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK},
      {{kOneF, kOneF, kOneF, kOneF}, VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE},
      {{0, 0, 0, 1}, VK_BORDER_COLOR_INT_OPAQUE_BLACK},
      {{1, 1, 1, 1}, VK_BORDER_COLOR_INT_OPAQUE_WHITE}};
  for (const auto& [color, name] : kColors)
    if (color == bits) return name;
  return VK_BORDER_COLOR_MAX_ENUM;
}

VkSampler make_sampler(const Device& d, const bug::Sampler& source) {
  const texel::Sampler& s = source.state;
  VkSamplerReductionModeCreateInfo reduction{VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO};
  reduction.reductionMode = s.reduction;
  VkSamplerCustomBorderColorCreateInfoEXT custom{VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT};
  std::memcpy(&custom.customBorderColor, s.border.data(), sizeof s.border);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.flags = s.seams ? VkFlags{VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT} : VkFlags{0};
  info.magFilter = s.mag_filter;
  info.minFilter = s.min_filter;
  info.mipmapMode = s.mip_mode;
  info.addressModeU = s.address[0];
  info.addressModeV = s.address[1];
  info.addressModeW = s.address[2];
  info.mipLodBias = s.mip_lod_bias;
  info.anisotropyEnable = s.max_anisotropy > 1;
  info.maxAnisotropy = s.max_anisotropy;
  info.compareEnable = s.compare;
  info.compareOp = s.compare_op;
  info.minLod = s.min_lod;
  info.maxLod = s.max_lod;
  info.unnormalizedCoordinates = s.unnormalized;
  info.borderColor = plain_border(s.border);
  if (info.borderColor == VK_BORDER_COLOR_MAX_ENUM) {
    info.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
    info.pNext = &custom;
  }
  if (s.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
    reduction.pNext = info.pNext;
    info.pNext = &reduction;
  }
  VkSampler sampler = VK_NULL_HANDLE;
  must(vkCreateSampler(d.device, &info, nullptr, &sampler), "vkCreateSampler");
  set_name(d, VK_OBJECT_TYPE_SAMPLER, reinterpret_cast<std::uint64_t>(sampler), source.name);
  return sampler;
}

VkBufferView make_buffer_view(const Device& d, const bug::BufferView& source, VkBuffer buffer) {
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer;
  info.format = source.format;
  info.offset = source.offset;
  info.range = source.range;
  VkBufferView view = VK_NULL_HANDLE;
  must(vkCreateBufferView(d.device, &info, nullptr, &view), "vkCreateBufferView");
  set_name(d, VK_OBJECT_TYPE_BUFFER_VIEW, reinterpret_cast<std::uint64_t>(view), source.name);
  return view;
}

/// All images to the one layout that everything here uses.
void make_general(VkCommandBuffer commands, const bug::Bug& bug, const Resources& resources) {
  for (std::size_t i = 0; i < resources.images.size(); ++i) {
    VkImageMemoryBarrier to{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    to.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    to.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    to.srcQueueFamilyIndex = to.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    to.image = resources.images[i];
    to.subresourceRange = {texel::format_desc(bug.images[i].format).aspects, 0, VK_REMAINING_MIP_LEVELS, 0,
                           VK_REMAINING_ARRAY_LAYERS};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &to);
  }
}

}  // namespace

Resources make_resources(const Device& d, const bug::Bug& bug) {
  check_texels(bug);
  Resources out;
  make_buffers(d, bug, out);
  const bool foreign = bug.device != d.properties.deviceName;
  if (foreign && std::ranges::any_of(bug.images, is_filled_by_host))
    throw Failure("images of several samples can be filled on the device alone that they were captured on");
  for (const bug::Image& image : bug.images)
    out.images.push_back(make_image(d, image, out.image_memories.emplace_back()));
  for (const bug::View& view : bug.views) out.views.push_back(make_view(d, view, out.images[view.image]));
  for (const bug::BufferView& view : bug.buffer_views)
    out.buffer_views.push_back(make_buffer_view(d, view, out.buffers[view.buffer]));
  for (const bug::Sampler& sampler : bug.samplers) out.samplers.push_back(make_sampler(d, sampler));
  submit(d, [&](VkCommandBuffer commands) { make_general(commands, bug, out); });
  const std::uint64_t size = for_each_content(bug, [](const auto&, std::uint64_t) {});
  const Staging staging = make_staging(d, size);
  for_each_content(bug, [&](const auto& content, std::uint64_t at) {
    std::copy(content.before->begin(), content.before->end(), staging.bytes + at);
  });
  copy_contents(d, bug, out, staging, false);
  destroy(d, staging);
  return out;
}

}  // namespace vitrine::glass::replayer
