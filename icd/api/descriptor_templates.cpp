// Descriptor update templates and layout support (Vulkan 1.3.239, Resource Descriptors: Descriptor Update Templates;
// Descriptor Set Layouts).
#include "icd/descriptor_template.h"

#include <cstring>

#include "icd/device.h"
#include "icd/entry_points.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

/// Array elements lie `stride` bytes apart in the application's data.
template <class Info>
const Info* gather(const VkDescriptorUpdateTemplateEntry& entry, const void* data, Vector<Info>& out) {
  out.resize(entry.descriptorCount);
  const std::byte* source = static_cast<const std::byte*>(data) + entry.offset;
  for (Info& info : out) {
    std::memcpy(&info, source, sizeof info);
    source += entry.stride;
  }
  return out.data();
}

}  // namespace

VkWriteDescriptorSet make_write(const VkDescriptorUpdateTemplateEntry& entry, const void* data,
                                TemplateScratch& scratch) {
  VkWriteDescriptorSet write = make_struct<VkWriteDescriptorSet>();
  write.dstBinding = entry.dstBinding;
  write.dstArrayElement = entry.dstArrayElement;
  write.descriptorCount = entry.descriptorCount;
  write.descriptorType = entry.descriptorType;
  switch (entry.descriptorType) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      write.pTexelBufferView = gather(entry, data, scratch.texel_buffers);
      break;
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      write.pBufferInfo = gather(entry, data, scratch.buffers);
      break;
    default:
      write.pImageInfo = gather(entry, data, scratch.images);
      break;
  }
  return write;
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorUpdateTemplate(VkDevice device,
                                                              const VkDescriptorUpdateTemplateCreateInfo* info,
                                                              const VkAllocationCallbacks* allocator,
                                                              VkDescriptorUpdateTemplate* update_template) {
  Owned<DescriptorUpdateTemplate> object(
      create_object<DescriptorUpdateTemplate>(from_handle<Device>(device).memory, allocator));
  object->entries.assign(info->pDescriptorUpdateEntries,
                         info->pDescriptorUpdateEntries + info->descriptorUpdateEntryCount);
  *update_template = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorUpdateTemplate(VkDevice, VkDescriptorUpdateTemplate update_template,
                                                           const VkAllocationCallbacks*) {
  destroy_handle<DescriptorUpdateTemplate>(update_template);
}

VKAPI_ATTR void VKAPI_CALL UpdateDescriptorSetWithTemplate(VkDevice device, VkDescriptorSet set,
                                                           VkDescriptorUpdateTemplate update_template,
                                                           const void* data) {
  TemplateScratch scratch(from_handle<Device>(device).memory);
  for (const VkDescriptorUpdateTemplateEntry& e : from_handle<DescriptorUpdateTemplate>(update_template).entries) {
    VkWriteDescriptorSet write = make_write(e, data, scratch);
    write.dstSet = set;
    UpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }
}

VKAPI_ATTR void VKAPI_CALL GetDescriptorSetLayoutSupport(VkDevice, const VkDescriptorSetLayoutCreateInfo* info,
                                                         VkDescriptorSetLayoutSupport* support) {
  // Descriptors are host memory: only the count of one set is bounded (maxPerSetDescriptors).
  std::uint64_t descriptors = 0;
  for (std::uint32_t i = 0; i < info->bindingCount; ++i) descriptors += info->pBindings[i].descriptorCount;
  support->supported = descriptors <= (1u << 20) ? VK_TRUE : VK_FALSE;
}

}  // namespace entry
}  // namespace vitrine::icd
