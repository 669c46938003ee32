// Descriptors in buffers of the application's (Vulkan 1.3.239, Resource Descriptors: Descriptor Buffers).
#include "icd/entry_points.h"
#include "icd/object/descriptor_bytes.h"
#include "icd/record/own_sets.h"
#include "icd/record/stage_binding.h"

namespace vitrine::icd::entry {

VKAPI_ATTR void VKAPI_CALL GetDescriptorEXT(VkDevice device, const VkDescriptorGetInfoEXT* info, std::size_t size,
                                            void* descriptor) {
  const Device& d = from_handle<Device>(device);
  if (d.described) write_descriptor_bytes(*d.described, *info, size, descriptor);
}

VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorBuffersEXT(VkCommandBuffer buffer, std::uint32_t count,
                                                       const VkDescriptorBufferBindingInfoEXT* infos) {
  const auto addresses = from_handle<CommandBuffer>(buffer).arena.add_array<VkDeviceAddress>(
      std::min<std::uint32_t>(count, kMaxDescriptorBuffers));
  for (std::size_t i = 0; i < addresses.size(); ++i) addresses[i] = infos[i].address;
  record(buffer, icd::CmdBindDescriptorBuffers{addresses});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDescriptorBufferOffsetsEXT(VkCommandBuffer buffer, VkPipelineBindPoint bind_point,
                                                            VkPipelineLayout, std::uint32_t first, std::uint32_t count,
                                                            const std::uint32_t* buffers, const VkDeviceSize* offsets) {
  if (first > spirv::kMaxSets || count > spirv::kMaxSets - first) return;
  record(buffer, icd::CmdSetDescriptorBufferOffsets{bind_point, first, copy_array(buffer, buffers, count),
                                                    copy_array(buffer, offsets, count)});
}

VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorBufferEmbeddedSamplersEXT(VkCommandBuffer handle,
                                                                      VkPipelineBindPoint bind_point,
                                                                      VkPipelineLayout layout_handle,
                                                                      std::uint32_t number) {
  CommandBuffer& buffer = from_handle<CommandBuffer>(handle);
  const PipelineLayoutShape& layout = *from_handle<PipelineLayout>(layout_handle).shape;
  if (has_set(layout, number)) bind_own_set(buffer, bind_point, layout, number, add_own_set(buffer, layout, number));
}

#ifdef VK_KHR_maintenance6
// Vulkan 1.4.309, VK_KHR_maintenance6: the same with structures, for others to extend.
VKAPI_ATTR void VKAPI_CALL CmdSetDescriptorBufferOffsets2EXT(VkCommandBuffer buffer,
                                                             const VkSetDescriptorBufferOffsetsInfoEXT* info) {
  for_each_bind_point(info->stageFlags, [&](VkPipelineBindPoint bind_point) {
    CmdSetDescriptorBufferOffsetsEXT(buffer, bind_point, info->layout, info->firstSet, info->setCount,
                                     info->pBufferIndices, info->pOffsets);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorBufferEmbeddedSamplers2EXT(
    VkCommandBuffer buffer, const VkBindDescriptorBufferEmbeddedSamplersInfoEXT* info) {
  for_each_bind_point(info->stageFlags, [&](VkPipelineBindPoint bind_point) {
    CmdBindDescriptorBufferEmbeddedSamplersEXT(buffer, bind_point, info->layout, info->set);
  });
}
#endif

// Nothing is to be captured for another run: descriptorBufferCaptureReplay is not offered.
VKAPI_ATTR VkResult VKAPI_CALL GetBufferOpaqueCaptureDescriptorDataEXT(VkDevice,
                                                                       const VkBufferCaptureDescriptorDataInfoEXT*,
                                                                       void*) {
  return VK_SUCCESS;
}
VKAPI_ATTR VkResult VKAPI_CALL GetImageOpaqueCaptureDescriptorDataEXT(VkDevice,
                                                                      const VkImageCaptureDescriptorDataInfoEXT*,
                                                                      void*) {
  return VK_SUCCESS;
}
VKAPI_ATTR VkResult VKAPI_CALL
GetImageViewOpaqueCaptureDescriptorDataEXT(VkDevice, const VkImageViewCaptureDescriptorDataInfoEXT*, void*) {
  return VK_SUCCESS;
}
VKAPI_ATTR VkResult VKAPI_CALL GetSamplerOpaqueCaptureDescriptorDataEXT(VkDevice,
                                                                        const VkSamplerCaptureDescriptorDataInfoEXT*,
                                                                        void*) {
  return VK_SUCCESS;
}
VKAPI_ATTR VkResult VKAPI_CALL GetAccelerationStructureOpaqueCaptureDescriptorDataEXT(
    VkDevice, const VkAccelerationStructureCaptureDescriptorDataInfoEXT*, void*) {
  return VK_SUCCESS;
}

}  // namespace vitrine::icd::entry
