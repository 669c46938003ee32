// VkDescriptorUpdateTemplate: how to read descriptor writes from the application's own structure.
#pragma once

#include "icd/object/object.h"

namespace vitrine::icd {

struct DescriptorUpdateTemplate : Object<VkDescriptorUpdateTemplate, VK_OBJECT_TYPE_DESCRIPTOR_UPDATE_TEMPLATE> {
  explicit DescriptorUpdateTemplate(const HostMemory& m) : Object(m), entries(m) {}
  Vector<VkDescriptorUpdateTemplateEntry> entries;
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;  ///< of push descriptors
};

/// Storage for the infos of one entry while it becomes a VkWriteDescriptorSet.
struct TemplateScratch {
  explicit TemplateScratch(const HostMemory& m) : images(m), buffers(m), texel_buffers(m) {}
  Vector<VkDescriptorImageInfo> images;
  Vector<VkDescriptorBufferInfo> buffers;
  Vector<VkBufferView> texel_buffers;
  VkWriteDescriptorSetInlineUniformBlock inline_block{};
};

/// The write that an entry stands for; its arrays live in `scratch` until the next call. dstSet is left null. Throws
/// std::bad_alloc.
VkWriteDescriptorSet make_write(const VkDescriptorUpdateTemplateEntry& entry, const void* data,
                                TemplateScratch& scratch);

}  // namespace vitrine::icd
