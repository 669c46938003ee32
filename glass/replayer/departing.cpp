// See departing.h. Nobody reads it: any size and format will do.
#include "glass/replayer/departing.h"

namespace vitrine::glass::replayer {

Departing::Departing(const Device& d, VkDescriptorType type) : d_(d) {
  switch (bug::kind_of(type)) {
    case bug::ResourceKind::kBuffer:
    case bug::ResourceKind::kTexels:
      make_buffer();
      break;
    case bug::ResourceKind::kImage:
      make_image();
      break;
    default:
      break;
  }
  if (type != VK_DESCRIPTOR_TYPE_SAMPLER && type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) return;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  must(vkCreateSampler(d.device, &info, nullptr, &sampler_), "vkCreateSampler");
}

Departing::~Departing() {
  vkDestroyBufferView(d_.device, texels_, nullptr);
  vkDestroyBuffer(d_.device, buffer_, nullptr);
  vkDestroyImageView(d_.device, view_, nullptr);
  vkDestroyImage(d_.device, image_, nullptr);
  vkDestroySampler(d_.device, sampler_, nullptr);
  vkFreeMemory(d_.device, memory_, nullptr);
}

void Departing::make_buffer() {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = kSize;
  info.usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  must(vkCreateBuffer(d_.device, &info, nullptr, &buffer_), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(d_.device, buffer_, &needs);
  memory_ = allocate(d_, needs, false);
  must(vkBindBufferMemory(d_.device, buffer_, memory_, 0), "vkBindBufferMemory");
  VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  view.buffer = buffer_;
  view.format = VK_FORMAT_R32_UINT;
  view.range = VK_WHOLE_SIZE;
  must(vkCreateBufferView(d_.device, &view, nullptr, &texels_), "vkCreateBufferView");
}

void Departing::make_image() {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {4, 4, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
               VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  must(vkCreateImage(d_.device, &info, nullptr, &image_), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(d_.device, image_, &needs);
  memory_ = allocate(d_, needs, false);
  must(vkBindImageMemory(d_.device, image_, memory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = image_;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = info.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  must(vkCreateImageView(d_.device, &view, nullptr, &view_), "vkCreateImageView");
}

void Departing::fill(VkDescriptorBufferInfo& buffer, VkDescriptorImageInfo& image, VkWriteDescriptorSet& write) const {
  buffer = {buffer_, 0, VK_WHOLE_SIZE};
  image = {sampler_, view_, VK_IMAGE_LAYOUT_GENERAL};
  write.pTexelBufferView = &texels_;
}

}  // namespace vitrine::glass::replayer
