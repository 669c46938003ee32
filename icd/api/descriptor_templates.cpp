// Descriptor update templates and layout support (Vulkan 1.3.239, Resource Descriptors: Descriptor Update Templates;
// Descriptor Set Layouts).
#include "icd/object/descriptor_template.h"

#include <algorithm>
#include <cstring>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/descriptors.h"
#include "icd/properties.h"

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

/// Whether the types of all mutable bindings are among those that one may have.
bool has_mutable_types(const VkDescriptorSetLayoutCreateInfo& info) {
  const auto* lists = find_in_chain<VkMutableDescriptorTypeCreateInfoEXT>(info.pNext);
  for (std::uint32_t i = 0; lists && i < std::min(info.bindingCount, lists->mutableDescriptorTypeListCount); ++i) {
    if (!is_mutable(info.pBindings[i].descriptorType)) continue;
    const VkMutableDescriptorTypeListEXT& list = lists->pMutableDescriptorTypeLists[i];
    for (std::uint32_t k = 0; k < list.descriptorTypeCount; ++k)
      if (!takes_type(VK_DESCRIPTOR_TYPE_MUTABLE_EXT, list.pDescriptorTypes[k])) return false;
  }
  return true;
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
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      scratch.inline_block = make_struct<VkWriteDescriptorSetInlineUniformBlock>();
      scratch.inline_block.dataSize = entry.descriptorCount;
      scratch.inline_block.pData = static_cast<const std::byte*>(data) + entry.offset;
      write.pNext = &scratch.inline_block;
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
  object->bind_point = info->pipelineBindPoint;
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
  // Descriptors are host memory: only the count of one set is bounded.
  constexpr std::uint32_t kMaxDescriptors = kClaimedPhysicalDeviceMaintenance3Properties.maxPerSetDescriptors;
  std::uint64_t descriptors = 0;
  const VkDescriptorSetLayoutBinding* last = nullptr;
  for (std::uint32_t i = 0; i < info->bindingCount; ++i) {
    descriptors += info->pBindings[i].descriptorCount;
    if (!last || info->pBindings[i].binding > last->binding) last = &info->pBindings[i];
  }
  support->supported = descriptors <= kMaxDescriptors && has_mutable_types(*info) ? VK_TRUE : VK_FALSE;
  auto* variable = find_in_out_chain<VkDescriptorSetVariableDescriptorCountLayoutSupport>(support->pNext);
  if (!variable) return;
  const auto* flags = find_in_chain<VkDescriptorSetLayoutBindingFlagsCreateInfo>(info->pNext);
  const bool has_variable =
      last && flags && flags->bindingCount > last - info->pBindings &&
      (flags->pBindingFlags[last - info->pBindings] & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT);
  variable->maxVariableDescriptorCount = 0;
  if (!has_variable) return;
  const std::uint64_t others = descriptors - last->descriptorCount;
  const std::uint64_t room = others < kMaxDescriptors ? kMaxDescriptors - others : 0;
  variable->maxVariableDescriptorCount =
      is_inline_block(last->descriptorType)
          ? kClaimedPhysicalDeviceInlineUniformBlockProperties.maxInlineUniformBlockSize
          : static_cast<std::uint32_t>(room);
}

}  // namespace entry
}  // namespace vitrine::icd
