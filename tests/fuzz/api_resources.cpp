// Buffers, images and descriptors of a run.
#include "tests/fuzz/api_run.h"

#include <algorithm>

namespace vitrine::fuzz {

using icd::make_struct;

namespace {

constexpr VkFormat kTargets[] = {VK_FORMAT_R8G8B8A8_UNORM,          VK_FORMAT_B8G8R8A8_UNORM,
                                 VK_FORMAT_R8G8B8A8_SRGB,           VK_FORMAT_R32G32B32A32_SFLOAT,
                                 VK_FORMAT_R16G16_SFLOAT,           VK_FORMAT_R5G6B5_UNORM_PACK16,
                                 VK_FORMAT_A2B10G10R10_UNORM_PACK32};
constexpr VkFormat kDepths[] = {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT,
                                VK_FORMAT_D32_SFLOAT_S8_UINT};
constexpr VkFormat kPictures[] = {
    VK_FORMAT_R8G8B8A8_UNORM,         VK_FORMAT_BC1_RGBA_UNORM_BLOCK,      VK_FORMAT_BC3_SRGB_BLOCK,
    VK_FORMAT_BC4_SNORM_BLOCK,        VK_FORMAT_BC5_UNORM_BLOCK,           VK_FORMAT_BC6H_SFLOAT_BLOCK,
    VK_FORMAT_BC7_UNORM_BLOCK,        VK_FORMAT_ASTC_4x4_UNORM_BLOCK,      VK_FORMAT_ASTC_10x8_SRGB_BLOCK,
    VK_FORMAT_ASTC_12x12_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, VK_FORMAT_EAC_R11G11_SNORM_BLOCK,
    VK_FORMAT_R32G32B32A32_SFLOAT,    VK_FORMAT_E5B9G9R9_UFLOAT_PACK32,    VK_FORMAT_R16_SNORM,
    VK_FORMAT_B10G11R11_UFLOAT_PACK32};
constexpr VkBufferUsageFlags kAllUsages =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
    VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
    VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
constexpr std::size_t kPage = 4096;

std::size_t whole_pages(VkDeviceSize bytes) { return (static_cast<std::size_t>(bytes) + kPage - 1) / kPage * kPage; }

}  // namespace

VkDeviceMemory Run::import(std::size_t bytes, void*& data) {
  blocks_.emplace_back(std::aligned_alloc(kPage, bytes));
  data = blocks_.back().get();
  auto host = make_struct<VkImportMemoryHostPointerInfoEXT>();
  host.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  host.pHostPointer = data;
  auto info = make_struct<VkMemoryAllocateInfo>(&host);
  info.allocationSize = bytes;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  demand(VK_CALL(AllocateMemory)(w_.device, &info, nullptr, &memory) == VK_SUCCESS, "memory");
  memories_.push_back(memory);
  return memory;
}

Buffer Run::make_buffer() {
  Buffer buffer;
  buffer.size = c_.between(1, 600) * VkDeviceSize{16};
  auto external = make_struct<VkExternalMemoryBufferCreateInfo>();
  external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  auto info = make_struct<VkBufferCreateInfo>(&external);
  info.size = buffer.size;
  info.usage = kAllUsages;
  demand(VK_CALL(CreateBuffer)(w_.device, &info, nullptr, &buffer.handle) == VK_SUCCESS, "a buffer");
  VkMemoryRequirements needs{};
  VK_CALL(GetBufferMemoryRequirements)(w_.device, buffer.handle, &needs);
  const std::size_t bytes = whole_pages(needs.size);
  void* data = nullptr;
  const VkDeviceMemory memory = import(bytes, data);
  const VkDeviceSize offset = (bytes - needs.size) / needs.alignment * needs.alignment;
  c_.fill(data, bytes);
  buffer.words = static_cast<std::uint32_t*>(data) + offset / 4;
  demand(VK_CALL(BindBufferMemory)(w_.device, buffer.handle, memory, offset) == VK_SUCCESS, "a bound buffer");
  return buffer;
}

Picture Run::make_image(VkFormat format, VkExtent3D extent, std::uint32_t levels, std::uint32_t layers,
                        VkImageUsageFlags usage, VkImageAspectFlags aspects, VkSampleCountFlagBits samples) {
  Picture p;
  p.format = format;
  p.extent = extent;
  p.levels = levels;
  p.layers = layers;
  auto external = make_struct<VkExternalMemoryImageCreateInfo>();
  external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  auto info = make_struct<VkImageCreateInfo>(&external);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = extent;
  info.mipLevels = levels;
  info.arrayLayers = layers;
  info.samples = samples;
  info.usage = usage;
  demand(VK_CALL(CreateImage)(w_.device, &info, nullptr, &p.image) == VK_SUCCESS, "an image");
  VkMemoryRequirements needs{};
  VK_CALL(GetImageMemoryRequirements)(w_.device, p.image, &needs);
  const std::size_t bytes = whole_pages(needs.size);
  void* data = nullptr;
  const VkDeviceMemory memory = import(bytes, data);
  c_.fill(data, bytes);
  const VkDeviceSize offset = (bytes - needs.size) / needs.alignment * needs.alignment;
  demand(VK_CALL(BindImageMemory)(w_.device, p.image, memory, offset) == VK_SUCCESS, "a bound image");
  auto view = make_struct<VkImageViewCreateInfo>();
  view.image = p.image;
  view.viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspects, 0, levels, 0, layers};
  demand(VK_CALL(CreateImageView)(w_.device, &view, nullptr, &p.view) == VK_SUCCESS, "a view");
  return p;
}

void Run::make_images() {
  const VkExtent3D extent{side(), side(), 1};
  samples_ = c_.one_in(3) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  layers_ = c_.one_in(3) ? 3 : 1;
  target_ = make_image(
      c_.of(kTargets), extent, 1, layers_,
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
      VK_IMAGE_ASPECT_COLOR_BIT, samples_);
  const VkFormat depth = c_.of(kDepths);
  const bool stencil = depth == VK_FORMAT_D24_UNORM_S8_UINT || depth == VK_FORMAT_D32_SFLOAT_S8_UINT;
  depth_ = make_image(
      depth, extent, 1, layers_, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
      stencil ? VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT : VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT},
      samples_);
  const VkExtent3D of_picture{side(), side(), 1};
  const std::uint32_t levels =
      c_.between(1, 32 - static_cast<std::uint32_t>(__builtin_clz(std::max(of_picture.width, of_picture.height))));
  picture_ = make_image(c_.of(kPictures), of_picture, levels, 1,
                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT, VK_SAMPLE_COUNT_1_BIT);
  canvas_ = make_image(VK_FORMAT_R8G8B8A8_UNORM, {side(), side(), 1}, 1, 1,
                       VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                       VK_IMAGE_ASPECT_COLOR_BIT, VK_SAMPLE_COUNT_1_BIT);
}

VkDeviceSize Run::offset_in(const Buffer& buffer, VkDeviceSize bytes, VkDeviceSize step) {
  if (bytes >= buffer.size) return 0;
  return c_.below(static_cast<std::uint32_t>((buffer.size - bytes) / step + 1)) * step;
}

void Run::make_set() {
  const VkDescriptorPoolSize sizes[] = {{kBindings[0], 1}, {kBindings[1], 1}, {kBindings[2], 1},
                                        {kBindings[3], 1}, {kBindings[4], 1}, {kBindings[5], 1}};
  auto pool = make_struct<VkDescriptorPoolCreateInfo>();
  pool.maxSets = 1;
  pool.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes));
  pool.pPoolSizes = sizes;
  demand(VK_CALL(CreateDescriptorPool)(w_.device, &pool, nullptr, &descriptors_) == VK_SUCCESS, "a descriptor pool");
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = descriptors_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &w_.set_layout;
  demand(VK_CALL(AllocateDescriptorSets)(w_.device, &allocate, &set_) == VK_SUCCESS, "a set");
  make_sampler();
  constexpr VkFormat kFormats[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_UINT};
  for (std::size_t i = 0; i < 2; ++i) {
    const Buffer& buffer = some_buffer();
    auto info = make_struct<VkBufferViewCreateInfo>();
    info.buffer = buffer.handle;
    info.format = kFormats[i];
    info.offset = offset_in(buffer, 16, 16);
    info.range = c_.one_in(2) ? VK_WHOLE_SIZE : 16;
    demand(VK_CALL(CreateBufferView)(w_.device, &info, nullptr, &texels_[i]) == VK_SUCCESS, "a buffer view");
  }
  for (std::uint32_t i = 0; i < kBindings.size(); ++i) write_descriptor(i);
}

void Run::make_sampler() {
  auto info = make_struct<VkSamplerCreateInfo>();
  info.magFilter = static_cast<VkFilter>(c_.below(2));
  info.minFilter = static_cast<VkFilter>(c_.below(2));
  info.mipmapMode = static_cast<VkSamplerMipmapMode>(c_.below(2));
  info.addressModeU = static_cast<VkSamplerAddressMode>(c_.below(5));
  info.addressModeV = static_cast<VkSamplerAddressMode>(c_.below(5));
  info.mipLodBias = static_cast<float>(c_.below(31)) - 15;
  // Without anisotropy, which takes up to 16 million texels a lookup where derivatives mean nothing.
  info.maxLod = static_cast<float>(c_.below(20));
  info.borderColor = static_cast<VkBorderColor>(c_.below(6));
  demand(VK_CALL(CreateSampler)(w_.device, &info, nullptr, &sampler_) == VK_SUCCESS, "a sampler");
}

void Run::write_descriptor(std::uint32_t binding) {
  const bool null = c_.one_in(9);
  const Buffer& buffer = some_buffer();
  const VkDeviceSize step = 256, offset = offset_in(buffer, 16, step);
  const VkDescriptorBufferInfo of_buffer{null ? VK_NULL_HANDLE : buffer.handle, null ? 0 : offset, VK_WHOLE_SIZE};
  const Picture& p = binding == 2 ? picture_ : canvas_;
  const VkDescriptorImageInfo of_image{sampler_, null ? VK_NULL_HANDLE : p.view, VK_IMAGE_LAYOUT_GENERAL};
  const VkBufferView texels = null ? VK_NULL_HANDLE : texels_[binding & 1];
  auto write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = set_;
  write.dstBinding = binding;
  write.descriptorCount = 1;
  write.descriptorType = kBindings[binding];
  write.pBufferInfo = &of_buffer;
  write.pImageInfo = &of_image;
  write.pTexelBufferView = &texels;
  VK_CALL(UpdateDescriptorSets)(w_.device, 1, &write, 0, nullptr);
}

}  // namespace vitrine::fuzz
