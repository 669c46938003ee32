// Recording draws (Vulkan 1.3.239, Drawing Commands).
#include "icd/command_buffer.h"
#include "icd/entry_points.h"
#include "icd/memory.h"

namespace vitrine::icd {
namespace {

// Rough nanoseconds of a draw, a vertex, a shaded pixel: they only decide which thread replays (icd/queue.cpp).
constexpr std::uint64_t kDrawCost = 2000;
constexpr std::uint64_t kVertexCost = 10;
constexpr std::uint64_t kIndirectDrawCost = 50000;

void add_cost(CommandBuffer& buffer, std::uint32_t vertices, std::uint32_t instances) {
  buffer.cost += kDrawCost + std::uint64_t{vertices} * instances * kVertexCost + buffer.pass_pixels;
}

void record_indirect(VkCommandBuffer buffer, const icd::CmdDrawIndirect& command) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, command);
  b.cost += kIndirectDrawCost + b.pass_pixels;
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdDraw(VkCommandBuffer buffer, std::uint32_t vertices, std::uint32_t instances,
                                   std::uint32_t first_vertex, std::uint32_t first_instance) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdDraw{vertices, instances, first_vertex, first_instance});
  add_cost(b, vertices, instances);
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexed(VkCommandBuffer buffer, std::uint32_t indices, std::uint32_t instances,
                                          std::uint32_t first_index, std::int32_t vertex_offset,
                                          std::uint32_t first_instance) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdDrawIndexed{indices, instances, first_index, vertex_offset, first_instance});
  add_cost(b, indices, instances);
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirect(VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset,
                                           std::uint32_t count, std::uint32_t stride) {
  record_indirect(buffer, {&from_handle<Buffer>(arguments), offset, nullptr, 0, count, stride, false});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexedIndirect(VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset,
                                                  std::uint32_t count, std::uint32_t stride) {
  record_indirect(buffer, {&from_handle<Buffer>(arguments), offset, nullptr, 0, count, stride, true});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirectCount(VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset,
                                                VkBuffer count_buffer, VkDeviceSize count_offset,
                                                std::uint32_t max_count, std::uint32_t stride) {
  record_indirect(buffer, {&from_handle<Buffer>(arguments), offset, &from_handle<Buffer>(count_buffer), count_offset,
                           max_count, stride, false});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexedIndirectCount(VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset,
                                                       VkBuffer count_buffer, VkDeviceSize count_offset,
                                                       std::uint32_t max_count, std::uint32_t stride) {
  record_indirect(buffer, {&from_handle<Buffer>(arguments), offset, &from_handle<Buffer>(count_buffer), count_offset,
                           max_count, stride, true});
}

}  // namespace entry
}  // namespace vitrine::icd
