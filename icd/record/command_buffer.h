// VkCommandPool and VkCommandBuffer, and how commands get into one.
#pragma once

#include "icd/object/descriptors.h"
#include "icd/record/command_arena.h"
#include "icd/record/commands.h"

namespace vitrine::icd {

struct CommandBuffer;

struct CommandPool : Object<VkCommandPool, VK_OBJECT_TYPE_COMMAND_POOL> {
  explicit CommandPool(const HostMemory& m) : Object(m), blocks(m) {}
  ~CommandPool();

  VkCommandPoolCreateFlags flags = 0;
  BlockStore blocks;
  CommandBuffer* buffers = nullptr;  ///< list of all that were allocated
};

enum class RecordState : std::uint8_t { kInitial, kRecording, kExecutable, kInvalid };

struct CommandBuffer : DispatchableObject<VkCommandBuffer, VK_OBJECT_TYPE_COMMAND_BUFFER> {
  CommandBuffer(const HostMemory& m, CommandPool& owner)
      : DispatchableObject(m), pool(owner), arena(owner.blocks), own_sets(m) {}
  ~CommandBuffer() { reset(); }

  CommandPool& pool;
  CommandBuffer* previous = nullptr;
  CommandBuffer* next = nullptr;
  VkCommandBufferLevel level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  RecordState state = RecordState::kInitial;
  VkResult error = VK_SUCCESS;  ///< first error of the recording
  CommandArena arena;
  /// Rough nanoseconds of work, from what recording knows: the queue keeps small work on the submitting thread.
  std::uint64_t cost = 0;
  std::uint64_t pass_pixels = 0;  ///< of the render pass being recorded; cost of its draws
  std::uint32_t nesting = 0;      ///< command buffers within command buffers, at most
  bool waits_for_host = false;    ///< holds vkCmdWaitEvents: whoever replays it may have to wait
  /// Sets in the arena (icd/record/own_sets.h): one for each time that descriptors were pushed or samplers bound.
  Vector<DescriptorSet*> own_sets;
  /// The last that was pushed, by bind point (compute last) and set number; null: nothing pushed.
  std::array<std::array<DescriptorSet*, spirv::kMaxSets>, 2> current_push{};

  /// Back to the initial state; blocks return to the pool.
  void reset() noexcept;
};

/// Appends a command. Throws std::bad_alloc, which the API edge makes stick in the command buffer.
template <class T>
T& record(CommandBuffer& buffer, const T& command) {
  static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= 8);
  return *::new (buffer.arena.add_command(static_cast<std::uint32_t>(kCommandType<T>), sizeof(T))) T(command);
}

/// Appends a command to the buffer behind the handle.
template <class T>
T& record(VkCommandBuffer buffer, const T& command) {
  return record(from_handle<CommandBuffer>(buffer), command);
}

/// Copies an array of the application's into the command buffer.
template <class T>
std::span<const T> copy_array(VkCommandBuffer buffer, const T* source, std::size_t count) {
  return from_handle<CommandBuffer>(buffer).arena.copy_array(source, count);
}

}  // namespace vitrine::icd
