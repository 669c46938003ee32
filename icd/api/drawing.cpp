// Recording draws (Vulkan 1.3.239, Drawing Commands).
#include "icd/entry_points.h"
#include "icd/object/memory.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

// Rough nanoseconds of a draw, a vertex, a shaded pixel: they only decide which thread replays (icd/object/queue.cpp).
constexpr std::uint64_t kDrawCost = 2000;
constexpr std::uint64_t kVertexCost = 10;
constexpr std::uint64_t kIndirectDrawCost = 50000;

void add_cost(CommandBuffer& buffer, std::uint32_t vertices, std::uint32_t instances) {
  buffer.cost += kDrawCost + std::uint64_t{vertices} * instances * kVertexCost + buffer.pass_pixels;
}

/// The application's array, whose elements lie `stride` bytes apart.
template <class T>
std::span<T> copy_strided(CommandBuffer& buffer, const T* source, std::uint32_t count, std::uint32_t stride) {
  const std::span<T> out = buffer.arena.add_array<T>(count);
  const auto* bytes = reinterpret_cast<const std::byte*>(source);
  for (std::uint32_t i = 0; i < count; ++i) std::memcpy(&out[i], bytes + std::size_t{i} * stride, sizeof(T));
  return out;
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

VKAPI_ATTR void VKAPI_CALL CmdDrawMultiEXT(VkCommandBuffer buffer, std::uint32_t count, const VkMultiDrawInfoEXT* draws,
                                           std::uint32_t instances, std::uint32_t first_instance,
                                           std::uint32_t stride) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  const auto copy = copy_strided(b, draws, count, stride);
  record(b, icd::CmdDrawMulti{copy, instances, first_instance});
  for (const VkMultiDrawInfoEXT& d : copy) add_cost(b, d.vertexCount, instances);
}

VKAPI_ATTR void VKAPI_CALL CmdDrawMultiIndexedEXT(VkCommandBuffer buffer, std::uint32_t count,
                                                  const VkMultiDrawIndexedInfoEXT* draws, std::uint32_t instances,
                                                  std::uint32_t first_instance, std::uint32_t stride,
                                                  const std::int32_t* vertex_offset) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  const auto copy = copy_strided(b, draws, count, stride);
  for (VkMultiDrawIndexedInfoEXT& d : copy) {
    if (vertex_offset) d.vertexOffset = *vertex_offset;
    add_cost(b, d.indexCount, instances);
  }
  record(b, icd::CmdDrawMultiIndexed{copy, instances, first_instance});
}

VKAPI_ATTR void VKAPI_CALL CmdBeginConditionalRenderingEXT(VkCommandBuffer buffer,
                                                           const VkConditionalRenderingBeginInfoEXT* info) {
  record(buffer, icd::CmdBeginConditionalRendering{&from_handle<Buffer>(info->buffer), info->offset,
                                                   (info->flags & VK_CONDITIONAL_RENDERING_INVERTED_BIT_EXT) != 0});
}

VKAPI_ATTR void VKAPI_CALL CmdEndConditionalRenderingEXT(VkCommandBuffer buffer) {
  record(buffer, icd::CmdEndConditionalRendering{});
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
