// See catalogue_scene.h.
#include "tests/glass/app/catalogue_scene.h"

namespace catalogue {
namespace {

constexpr VkDescriptorType kTypes[kBindings] = {
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,         VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,   VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

std::uint32_t count_of(std::uint32_t binding) { return binding == 6 ? 3 : binding == 7 ? 4 : 1; }

VkDeviceMemory allocate(VkDevice device, const VkMemoryRequirements& needs) {
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.pNext = &flags;
  info.allocationSize = needs.size;
  VkDeviceMemory memory;
  must(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
  return memory;
}

VkBuffer make_plain(VkDevice device, VkBufferUsageFlags usage) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = kBytes;
  info.usage = usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  VkBuffer buffer;
  must(vkCreateBuffer(device, &info, nullptr, &buffer), "vkCreateBuffer");
  return buffer;
}

void barrier(VkCommandBuffer commands) {
  VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0,
                       nullptr, 0, nullptr);
}

}  // namespace

Buffer Scene::make_buffer(VkBufferUsageFlags usage, VkDeviceSize room) {
  Buffer b;
  b.buffer = make_plain(d_.device, usage);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(d_.device, b.buffer, &needs);
  if (needs.size < room) needs.size = room;
  b.memory = allocate(d_.device, needs);
  must(vkBindBufferMemory(d_.device, b.buffer, b.memory, 0), "vkBindBufferMemory");
  buffers_.push_back(b);
  return b;
}

Image Scene::make_image(VkFormat format, VkImageViewType type, std::uint32_t levels, std::uint32_t layers,
                        VkImageUsageFlags usage, VkExtent2D extent) {
  Image out;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = levels;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  must(vkCreateImage(d_.device, &info, nullptr, &out.image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(d_.device, out.image, &needs);
  out.memory = allocate(d_.device, needs);
  must(vkBindImageMemory(d_.device, out.image, out.memory, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = out.image;
  view.viewType = type;
  view.format = format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, layers};
  must(vkCreateImageView(d_.device, &view, nullptr, &out.view), "vkCreateImageView");
  images_.push_back(out);
  return out;
}

void Scene::make_layouts() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < kBindings; ++i)
    bindings.push_back({i, kTypes[i], count_of(i), VK_SHADER_STAGE_ALL, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.bindingCount = kBindings;
  set.pBindings = bindings.data();
  must(vkCreateDescriptorSetLayout(d_.device, &set, nullptr, &set_layout_), "vkCreateDescriptorSetLayout");
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, sizeof push_};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &set_layout_;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  must(vkCreatePipelineLayout(d_.device, &info, nullptr, &layout), "vkCreatePipelineLayout");
}

void Scene::make_set() {
  std::vector<VkDescriptorPoolSize> sizes;
  for (std::uint32_t i = 0; i < kBindings; ++i) sizes.push_back({kTypes[i], count_of(i)});
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = 1;
  info.poolSizeCount = kBindings;
  info.pPoolSizes = sizes.data();
  must(vkCreateDescriptorPool(d_.device, &info, nullptr, &pool_), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = pool_;
  allocation.descriptorSetCount = 1;
  allocation.pSetLayouts = &set_layout_;
  must(vkAllocateDescriptorSets(d_.device, &allocation, &set_), "vkAllocateDescriptorSets");
}

void Scene::write(std::uint32_t binding, VkDescriptorType type, const std::vector<VkDescriptorImageInfo>& images,
                  const std::vector<VkDescriptorBufferInfo>& buffers) {
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set_;
  write.dstBinding = binding;
  write.descriptorCount = static_cast<std::uint32_t>(images.size() + buffers.size());
  write.descriptorType = type;
  write.pImageInfo = images.data();
  write.pBufferInfo = buffers.data();
  if (write.descriptorCount == 0) {
    write.descriptorCount = 1;
    write.pTexelBufferView = &texel_view_;
  }
  vkUpdateDescriptorSets(d_.device, 1, &write, 0, nullptr);
}

void Scene::write_buffers(VkBuffer gone) {
  const auto whole = [](VkBuffer buffer) { return VkDescriptorBufferInfo{buffer, 0, VK_WHOLE_SIZE}; };
  write(0, kTypes[0], {}, {whole(words_.buffer)});
  write(4, kTypes[4], {}, {});
  write(7, kTypes[7], {}, std::vector(4, whole(other_.buffer)));
  write(9, kTypes[9], {}, {whole(fresh_.buffer)});
  write(12, kTypes[12], {}, {whole(gone)});
}

void Scene::write_images() {
  const auto info = [&](const Image& image) {
    return VkDescriptorImageInfo{sampler_, image.view, VK_IMAGE_LAYOUT_GENERAL};
  };
  write(1, kTypes[1], {info(flat_)}, {});
  write(2, kTypes[2], {info(flat_)}, {});
  write(3, kTypes[3], {info(layered_)}, {});
  write(6, kTypes[6], {info(flat_), info(flat_)}, {});
  write(8, kTypes[8], {info(floats_)}, {});
  write(10, kTypes[10], {info(fresh_image_)}, {});
  write(11, kTypes[11], {info(fresh_image_)}, {});
}

/// 64 words, and the place of a buffer that is gone 512 bytes behind them.
void Scene::make_addresses() {
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  memory_ = make_buffer(kUsage, 1024);
  const VkBuffer gone = make_plain(d_.device, kUsage);
  must(vkBindBufferMemory(d_.device, gone, memory_.memory, 512), "vkBindBufferMemory");
  vkDestroyBuffer(d_.device, gone, nullptr);
  VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  info.buffer = memory_.buffer;
  const VkDeviceAddress address = vkGetBufferDeviceAddress(d_.device, &info);
  push_ = {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32), 1, 2, 3};
}

Scene::Scene(const Device& device) : d_(device) {
  constexpr VkImageUsageFlags kBoth = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  words_ = make_buffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  other_ = make_buffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  fresh_ = make_buffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  texels_ = make_buffer(VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  rows_ = make_buffer(0);
  make_addresses();
  flat_ = make_image(VK_FORMAT_R32_UINT, VK_IMAGE_VIEW_TYPE_2D, 2, 1, kBoth);
  layered_ = make_image(VK_FORMAT_R32_UINT, VK_IMAGE_VIEW_TYPE_2D_ARRAY, 1, 2, kBoth);
  floats_ = make_image(VK_FORMAT_R32_SFLOAT, VK_IMAGE_VIEW_TYPE_2D, 1, 1, kBoth);
  fresh_image_ = make_image(VK_FORMAT_R32_UINT, VK_IMAGE_VIEW_TYPE_2D, 1, 1, kBoth);
  target_ = make_image(VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_VIEW_TYPE_2D, 1, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                       {kPixels, 1});
  VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  view.buffer = texels_.buffer;
  view.format = VK_FORMAT_R32_UINT;
  view.range = 8 * 4;
  must(vkCreateBufferView(d_.device, &view, nullptr, &texel_view_), "vkCreateBufferView");
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  must(vkCreateSampler(d_.device, &sampler, nullptr, &sampler_), "vkCreateSampler");
  make_layouts();
  make_set();
  const Buffer gone = make_buffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  write_buffers(gone.buffer);
  write_images();
  buffers_.pop_back();
  vkDestroyBuffer(d_.device, gone.buffer, nullptr);
  vkFreeMemory(d_.device, gone.memory, nullptr);
}

Scene::~Scene() {
  vkDestroyDescriptorPool(d_.device, pool_, nullptr);
  vkDestroyPipelineLayout(d_.device, layout, nullptr);
  vkDestroyDescriptorSetLayout(d_.device, set_layout_, nullptr);
  vkDestroySampler(d_.device, sampler_, nullptr);
  vkDestroyBufferView(d_.device, texel_view_, nullptr);
  for (const Image& image : images_) {
    vkDestroyImageView(d_.device, image.view, nullptr);
    vkDestroyImage(d_.device, image.image, nullptr);
    vkFreeMemory(d_.device, image.memory, nullptr);
  }
  for (const Buffer& buffer : buffers_) {
    vkDestroyBuffer(d_.device, buffer.buffer, nullptr);
    vkFreeMemory(d_.device, buffer.memory, nullptr);
  }
}

void Scene::fill(VkCommandBuffer commands) const {
  std::array<std::uint32_t, 64> words;
  for (std::uint32_t i = 0; i < 64; ++i) words[i] = i;
  vkCmdUpdateBuffer(commands, words_.buffer, 0, sizeof words, words.data());
  for (const Buffer& buffer : {other_, texels_, rows_, memory_}) vkCmdFillBuffer(commands, buffer.buffer, 0, kBytes, 0);
  vkCmdFillBuffer(commands, fresh_.buffer, 0, kBytes / 2, 0);
  barrier(commands);
  for (const Image& image : images_) {
    VkImageMemoryBarrier to{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    to.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    to.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    to.srcQueueFamilyIndex = to.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    to.image = image.image;
    to.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &to);
    const VkClearColorValue zero{};
    if (image.image != fresh_image_.image)
      vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &to.subresourceRange);
  }
  VkBufferImageCopy row{};
  row.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  row.imageExtent = {4, 1, 1};
  vkCmdCopyBufferToImage(commands, rows_.buffer, fresh_image_.image, VK_IMAGE_LAYOUT_GENERAL, 1, &row);
  barrier(commands);
}

void Scene::bind(VkCommandBuffer commands, VkPipelineBindPoint point) const {
  vkCmdBindDescriptorSets(commands, point, layout, 0, 1, &set_, 0, nullptr);
  // The fifth word is in the layout, and nothing sets it.
  vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_ALL, 0, 4 * sizeof push_[0], push_.data());
}

}  // namespace catalogue
