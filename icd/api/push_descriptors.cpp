// Recording push descriptors (VK_KHR_push_descriptor): each push makes a set of its own in the command buffer, a copy
// of the one before with the writes applied, and binds it. So replay knows nothing of them, and draws already recorded
// keep what they saw.
#include <algorithm>

#include "icd/entry_points.h"
#include "icd/object/descriptor_template.h"
#include "icd/record/own_sets.h"
#include "icd/record/stage_binding.h"

namespace vitrine::icd {
namespace {

/// A new set for `number`; it begins as a copy of what was pushed before to a set of the same shape.
DescriptorSet& push_set(CommandBuffer& buffer, VkPipelineBindPoint bind_point, const PipelineLayoutShape& layout,
                        std::uint32_t number) {
  DescriptorSet& set = add_own_set(buffer, layout, number);
  DescriptorSet*& current = buffer.current_push[bind_point == VK_PIPELINE_BIND_POINT_COMPUTE][number];
  if (current && current->shape == set.shape) {
    std::copy_n(current->slots, set.slot_count, set.slots);
    if (set.written && current->written) std::copy_n(current->written, set.slot_count, set.written);
  }
  current = &set;
  return set;
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSetKHR(VkCommandBuffer handle, VkPipelineBindPoint bind_point,
                                                   VkPipelineLayout layout_handle, std::uint32_t number,
                                                   std::uint32_t count, const VkWriteDescriptorSet* writes) {
  CommandBuffer& buffer = from_handle<CommandBuffer>(handle);
  const PipelineLayoutShape& layout = *from_handle<PipelineLayout>(layout_handle).shape;
  if (!has_set(layout, number)) return;
  DescriptorSet& set = push_set(buffer, bind_point, layout, number);
  for (std::uint32_t i = 0; i < count; ++i) write_descriptors(writes[i], set);
  bind_own_set(buffer, bind_point, layout, number, set);
}

VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSetWithTemplateKHR(VkCommandBuffer handle,
                                                               VkDescriptorUpdateTemplate template_handle,
                                                               VkPipelineLayout layout_handle, std::uint32_t number,
                                                               const void* data) {
  CommandBuffer& buffer = from_handle<CommandBuffer>(handle);
  const auto& update_template = from_handle<DescriptorUpdateTemplate>(template_handle);
  const PipelineLayoutShape& layout = *from_handle<PipelineLayout>(layout_handle).shape;
  if (!has_set(layout, number)) return;
  DescriptorSet& set = push_set(buffer, update_template.bind_point, layout, number);
  TemplateScratch scratch(buffer.memory);
  for (const VkDescriptorUpdateTemplateEntry& e : update_template.entries) {
    write_descriptors(make_write(e, data, scratch), set);
  }
  bind_own_set(buffer, update_template.bind_point, layout, number, set);
}

#ifdef VK_KHR_maintenance6
// Vulkan 1.4.309, VK_KHR_maintenance6: the same with structures, for others to extend.
VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSet2KHR(VkCommandBuffer buffer, const VkPushDescriptorSetInfoKHR* info) {
  for_each_bind_point(info->stageFlags, [&](VkPipelineBindPoint bind_point) {
    CmdPushDescriptorSetKHR(buffer, bind_point, info->layout, info->set, info->descriptorWriteCount,
                            info->pDescriptorWrites);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSetWithTemplate2KHR(VkCommandBuffer buffer,
                                                                const VkPushDescriptorSetWithTemplateInfoKHR* info) {
  CmdPushDescriptorSetWithTemplateKHR(buffer, info->descriptorUpdateTemplate, info->layout, info->set, info->pData);
}
#endif

}  // namespace entry
}  // namespace vitrine::icd
