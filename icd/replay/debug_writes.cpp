// See debug_writes.h (Vulkan 1.3.239, Copy Commands, Clear Commands).
#include "icd/replay/debug_writes.h"

#include "glass/debug/command_watch.h"
#include "icd/object/memory.h"

namespace vitrine::icd {
namespace {

void tell(const ReplayState& state, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size) {
  if (buffer.data && offset < buffer.size)
    state.observed->debugger->wrote(buffer.data + offset, buffer.resolve_range(offset, size),
                                    address_of(*state.observed));
}

}  // namespace

void note_debug(ReplayState& state, const CmdCopyBuffer& command) {
  for (const VkBufferCopy& r : command.regions) tell(state, *command.target, r.dstOffset, r.size);
}

void note_debug(ReplayState& state, const CmdUpdateBuffer& command) {
  tell(state, *command.target, command.offset, command.bytes.size());
}

void note_debug(ReplayState& state, const CmdFillBuffer& command) {
  tell(state, *command.target, command.offset, command.size);
}

}  // namespace vitrine::icd
