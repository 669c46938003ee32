// Recording dispatches (Vulkan 1.3.239, Dispatching Commands).
#include "icd/entry_points.h"
#include "icd/object/memory.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

// Rough nanoseconds: they only decide which thread replays (icd/object/queue.cpp).
constexpr std::uint64_t kDispatchCost = 500;
constexpr std::uint64_t kWorkgroupCost = 2000;
constexpr std::uint64_t kIndirectDispatchCost = 50000;

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdDispatch(VkCommandBuffer buffer, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  CmdDispatchBase(buffer, 0, 0, 0, x, y, z);
}

VKAPI_ATTR void VKAPI_CALL CmdDispatchBase(VkCommandBuffer buffer, std::uint32_t base_x, std::uint32_t base_y,
                                           std::uint32_t base_z, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdDispatch{{base_x, base_y, base_z}, {x, y, z}});
  b.cost += kDispatchCost + kWorkgroupCost * x * y * z;
}

VKAPI_ATTR void VKAPI_CALL CmdDispatchIndirect(VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  record(b, icd::CmdDispatchIndirect{&from_handle<Buffer>(arguments), offset});
  b.cost += kIndirectDispatchCost;
}

}  // namespace entry
}  // namespace vitrine::icd
