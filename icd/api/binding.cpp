// Recording what draws and dispatches use: pipelines, descriptor sets, push constants, vertex and index buffers (Vulkan
// 1.3.239, Pipelines: Pipeline Binding; Resource Descriptors: Descriptor Set Binding, Push Constant Updates;
// Fixed-Function Vertex Processing; Drawing Commands).
#include "icd/entry_points.h"
#include "icd/object/descriptors.h"
#include "icd/object/memory.h"
#include "icd/object/pipeline.h"
#include "icd/record/command_buffer.h"
#include "icd/record/stage_binding.h"

namespace vitrine::icd::entry {

VKAPI_ATTR void VKAPI_CALL CmdBindPipeline(VkCommandBuffer buffer, VkPipelineBindPoint, VkPipeline pipeline) {
  record(buffer, icd::CmdBindPipeline{&from_handle<Pipeline>(pipeline)});
}

VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorSets(VkCommandBuffer buffer, VkPipelineBindPoint bind_point,
                                                 VkPipelineLayout layout, std::uint32_t first, std::uint32_t count,
                                                 const VkDescriptorSet* sets, std::uint32_t offset_count,
                                                 const std::uint32_t* offsets) {
  CommandArena& arena = from_handle<CommandBuffer>(buffer).arena;
  const PipelineLayoutShape& shape = *from_handle<PipelineLayout>(layout).shape;
  if (first + count > spirv::kMaxSets || first + count > shape.first_dynamic.size()) return;
  const auto recorded = arena.add_array<DescriptorSet*>(count);
  for (std::uint32_t i = 0; i < count; ++i) recorded[i] = from_nullable<DescriptorSet>(sets[i]);
  // The layout may be gone when the command is replayed.
  record(buffer, icd::CmdBindDescriptorSets{bind_point, first, recorded,
                                            arena.copy_array(shape.first_dynamic.data() + first, count),
                                            arena.copy_array(offsets, offset_count)});
}

VKAPI_ATTR void VKAPI_CALL CmdPushConstants(VkCommandBuffer buffer, VkPipelineLayout layout, VkShaderStageFlags,
                                            std::uint32_t offset, std::uint32_t size, const void* values) {
  if (offset > spirv::kMaxPushConstantBytes || size > spirv::kMaxPushConstantBytes - offset) return;
  const auto& ranges = from_handle<PipelineLayout>(layout).shape->push_ranges;
  record(buffer, icd::CmdPushConstants{offset, copy_array(buffer, static_cast<const std::byte*>(values), size),
                                       copy_array(buffer, ranges.data(), ranges.size())});
}

#ifdef VK_KHR_maintenance6
// Vulkan 1.4.309, VK_KHR_maintenance6: the same with structures, for others to extend.
VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorSets2KHR(VkCommandBuffer buffer, const VkBindDescriptorSetsInfoKHR* info) {
  for_each_bind_point(info->stageFlags, [&](VkPipelineBindPoint bind_point) {
    CmdBindDescriptorSets(buffer, bind_point, info->layout, info->firstSet, info->descriptorSetCount,
                          info->pDescriptorSets, info->dynamicOffsetCount, info->pDynamicOffsets);
  });
}

VKAPI_ATTR void VKAPI_CALL CmdPushConstants2KHR(VkCommandBuffer buffer, const VkPushConstantsInfoKHR* info) {
  CmdPushConstants(buffer, info->layout, info->stageFlags, info->offset, info->size, info->pValues);
}
#endif

VKAPI_ATTR void VKAPI_CALL CmdBindVertexBuffers(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                const VkBuffer* buffers, const VkDeviceSize* offsets) {
  CmdBindVertexBuffers2(buffer, first, count, buffers, offsets, nullptr, nullptr);
}

VKAPI_ATTR void VKAPI_CALL CmdBindVertexBuffers2(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                 const VkBuffer* buffers, const VkDeviceSize* offsets,
                                                 const VkDeviceSize* sizes, const VkDeviceSize* strides) {
  if (first > raster::kMaxVertexBindings || count > raster::kMaxVertexBindings - first) return;
  const auto recorded = from_handle<CommandBuffer>(buffer).arena.add_array<const Buffer*>(count);
  for (std::uint32_t i = 0; i < count; ++i) recorded[i] = from_nullable<Buffer>(buffers[i]);
  record(buffer, icd::CmdBindVertexBuffers{first, recorded, copy_array(buffer, offsets, count),
                                           copy_array(buffer, sizes, sizes ? count : 0),
                                           copy_array(buffer, strides, strides ? count : 0)});
}

VKAPI_ATTR void VKAPI_CALL CmdBindIndexBuffer(VkCommandBuffer buffer, VkBuffer index_buffer, VkDeviceSize offset,
                                              VkIndexType type) {
  record(buffer, icd::CmdBindIndexBuffer{from_nullable<Buffer>(index_buffer), offset, VK_WHOLE_SIZE, type});
}

#ifdef VK_KHR_maintenance5
/// Vulkan 1.4.309, vkCmdBindIndexBuffer2: indices end with the range, not with the buffer.
VKAPI_ATTR void VKAPI_CALL CmdBindIndexBuffer2KHR(VkCommandBuffer buffer, VkBuffer index_buffer, VkDeviceSize offset,
                                                  VkDeviceSize size, VkIndexType type) {
  record(buffer, icd::CmdBindIndexBuffer{from_nullable<Buffer>(index_buffer), offset, size, type});
}
#endif

}  // namespace vitrine::icd::entry
