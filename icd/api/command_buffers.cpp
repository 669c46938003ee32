// Command pools and command buffers (Vulkan 1.3.239, Command Buffers).
#include "icd/edge/edge.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {
namespace {

// maxCommandBufferNestingLevel of manifest/limits.
constexpr std::uint32_t kMaxNesting = 64;

CommandBuffer* allocate_buffer(CommandPool& pool, VkCommandBufferLevel level) {
  CommandBuffer* buffer = create_object<CommandBuffer>(pool.memory, nullptr, pool);
  buffer->level = level;
  buffer->next = pool.buffers;
  if (pool.buffers) pool.buffers->previous = buffer;
  pool.buffers = buffer;
  return buffer;
}

void free_buffer(CommandBuffer* buffer) {
  (buffer->previous ? buffer->previous->next : buffer->pool.buffers) = buffer->next;
  if (buffer->next) buffer->next->previous = buffer->previous;
  destroy_object(buffer);
}

}  // namespace

void stick_record_error(VkCommandBuffer command_buffer, VkResult error) {
  CommandBuffer& buffer = from_handle<CommandBuffer>(command_buffer);
  if (buffer.error == VK_SUCCESS) buffer.error = error;
}

void mark_command(VkCommandBuffer command_buffer, const char* name) { record(command_buffer, CmdMark{name}); }

void CommandBuffer::reset() noexcept {
  for (DescriptorSet* set : own_sets) set->~DescriptorSet();
  own_sets.clear();
  current_push = {};
  arena.release();
  state = RecordState::kInitial;
  error = VK_SUCCESS;
  cost = 0;
  pass_pixels = 0;
  waits_for_host = false;
  nesting = 0;
}

CommandPool::~CommandPool() {
  while (buffers) free_buffer(buffers);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateCommandPool(VkDevice device, const VkCommandPoolCreateInfo* info,
                                                 const VkAllocationCallbacks* allocator, VkCommandPool* pool) {
  Device& d = from_handle<Device>(device);
  prepare_replay(d);
  CommandPool* object = create_object<CommandPool>(d.memory, allocator);
  object->flags = info->flags;
  *pool = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyCommandPool(VkDevice, VkCommandPool pool, const VkAllocationCallbacks*) {
  destroy_handle<CommandPool>(pool);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandPool(VkDevice, VkCommandPool pool, VkCommandPoolResetFlags flags) {
  CommandPool& p = from_handle<CommandPool>(pool);
  for (CommandBuffer* b = p.buffers; b; b = b->next) b->reset();
  if (flags & VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT) p.blocks.trim();
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL TrimCommandPool(VkDevice, VkCommandPool pool, VkCommandPoolTrimFlags) {
  from_handle<CommandPool>(pool).blocks.trim();
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateCommandBuffers(VkDevice device, const VkCommandBufferAllocateInfo* info,
                                                      VkCommandBuffer* buffers) {
  CommandPool& pool = from_handle<CommandPool>(info->commandPool);
  for (std::uint32_t i = 0; i < info->commandBufferCount; ++i) {
    try {
      buffers[i] = to_handle(allocate_buffer(pool, info->level));
    } catch (const std::bad_alloc&) {
      FreeCommandBuffers(device, info->commandPool, i, buffers);
      for (std::uint32_t k = 0; k < info->commandBufferCount; ++k) buffers[k] = VK_NULL_HANDLE;
      return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL FreeCommandBuffers(VkDevice, VkCommandPool, std::uint32_t count,
                                              const VkCommandBuffer* buffers) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (buffers[i]) free_buffer(from_nullable<CommandBuffer>(buffers[i]));
  }
}

VKAPI_ATTR VkResult VKAPI_CALL BeginCommandBuffer(VkCommandBuffer buffer, const VkCommandBufferBeginInfo* info) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  b.reset();
  b.state = RecordState::kRecording;
  const bool continues =
      b.level == VK_COMMAND_BUFFER_LEVEL_SECONDARY && (info->flags & VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT);
  // Draws of a secondary command buffer: the size of what they draw to is not known here.
  if (continues) b.pass_pixels = std::uint64_t{1} << 16;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL EndCommandBuffer(VkCommandBuffer buffer) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  b.state = b.error == VK_SUCCESS ? RecordState::kExecutable : RecordState::kInvalid;
  return b.error;
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandBuffer(VkCommandBuffer buffer, VkCommandBufferResetFlags flags) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  b.reset();
  if (flags & VK_COMMAND_BUFFER_RESET_RELEASE_RESOURCES_BIT) b.pool.blocks.trim();
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL CmdExecuteCommands(VkCommandBuffer buffer, std::uint32_t count,
                                              const VkCommandBuffer* secondaries) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  const auto buffers = b.arena.add_array<const CommandBuffer*>(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const CommandBuffer& secondary = from_handle<CommandBuffer>(secondaries[i]);
    buffers[i] = &secondary;
    b.cost += secondary.cost;
    b.waits_for_host |= secondary.waits_for_host;
    b.nesting = std::max(b.nesting, secondary.nesting + 1);
  }
  // Replay goes down into them, each on the stack.
  if (b.nesting > kMaxNesting) {
    stick_record_error(buffer, VK_ERROR_OUT_OF_HOST_MEMORY);
    return;
  }
  record(b, icd::CmdExecuteCommands{buffers});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDeviceMask(VkCommandBuffer, std::uint32_t) {}

}  // namespace entry
}  // namespace vitrine::icd
