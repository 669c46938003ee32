// Recording of transform feedback (VK_EXT_transform_feedback; Vulkan 1.3.239, Transform Feedback).
#include <algorithm>

#include "icd/entry_points.h"
#include "icd/object/memory.h"
#include "icd/object/query_pool.h"
#include "icd/record/command_buffer.h"
#include "spirv/shader.h"

namespace vitrine::icd {
namespace {

/// Counter buffers of a begin or end; missing ones are null.
std::span<const CounterBuffer> copy_counters(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                             const VkBuffer* buffers, const VkDeviceSize* offsets) {
  if (!buffers || first >= spirv::kMaxXfbBuffers) return {};
  count = std::min(count, spirv::kMaxXfbBuffers - first);
  const auto recorded = from_handle<CommandBuffer>(buffer).arena.add_array<CounterBuffer>(count);
  for (std::uint32_t i = 0; i < count; ++i) recorded[i] = {from_nullable<Buffer>(buffers[i]), offsets ? offsets[i] : 0};
  return recorded;
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdBindTransformFeedbackBuffersEXT(VkCommandBuffer buffer, std::uint32_t first,
                                                              std::uint32_t count, const VkBuffer* buffers,
                                                              const VkDeviceSize* offsets, const VkDeviceSize* sizes) {
  if (first >= spirv::kMaxXfbBuffers) return;
  count = std::min(count, spirv::kMaxXfbBuffers - first);
  const auto recorded = from_handle<CommandBuffer>(buffer).arena.add_array<FeedbackBinding>(count);
  for (std::uint32_t i = 0; i < count; ++i)
    recorded[i] = {from_nullable<Buffer>(buffers[i]), offsets[i], sizes ? sizes[i] : VK_WHOLE_SIZE};
  record(buffer, CmdBindTransformFeedbackBuffers{first, recorded});
}

VKAPI_ATTR void VKAPI_CALL CmdBeginTransformFeedbackEXT(VkCommandBuffer buffer, std::uint32_t first,
                                                        std::uint32_t count, const VkBuffer* counters,
                                                        const VkDeviceSize* offsets) {
  record(buffer, CmdBeginTransformFeedback{first, copy_counters(buffer, first, count, counters, offsets)});
}

VKAPI_ATTR void VKAPI_CALL CmdEndTransformFeedbackEXT(VkCommandBuffer buffer, std::uint32_t first, std::uint32_t count,
                                                      const VkBuffer* counters, const VkDeviceSize* offsets) {
  record(buffer, CmdEndTransformFeedback{first, copy_counters(buffer, first, count, counters, offsets)});
}

VKAPI_ATTR void VKAPI_CALL CmdBeginQueryIndexedEXT(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t query,
                                                   VkQueryControlFlags flags, std::uint32_t index) {
  record(buffer, icd::CmdBeginQuery{&from_handle<QueryPool>(pool), query, flags, index});
}

VKAPI_ATTR void VKAPI_CALL CmdEndQueryIndexedEXT(VkCommandBuffer buffer, VkQueryPool pool, std::uint32_t query,
                                                 std::uint32_t index) {
  record(buffer, icd::CmdEndQuery{&from_handle<QueryPool>(pool), query, index});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirectByteCountEXT(VkCommandBuffer buffer, std::uint32_t instances,
                                                       std::uint32_t first_instance, VkBuffer counter,
                                                       VkDeviceSize counter_offset, std::uint32_t subtracted,
                                                       std::uint32_t stride) {
  record(buffer, CmdDrawByteCount{
                     {from_nullable<Buffer>(counter), counter_offset}, instances, first_instance, subtracted, stride});
}

}  // namespace entry
}  // namespace vitrine::icd
