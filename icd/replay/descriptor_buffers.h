// Sets whose descriptors lie in buffers (VK_EXT_descriptor_buffer): a draw or dispatch gets sets that are made of the
// bytes as they are then. Small ones are made anew in the arena each time that something may have changed; large ones
// are kept, and what differs of their bytes is read again.
#pragma once

#include <list>

#include "icd/object/descriptors.h"
#include "texel/view.h"

namespace vitrine::icd {

struct BindPoint;
struct ReplayState;

/// A large set as it was read last.
struct KeptSet {
  explicit KeptSet(const HostMemory& m) : bytes(m), texels(m), storage(m) {}

  VkDeviceAddress address = 0;
  std::shared_ptr<const SetShape> shape;
  std::uint64_t forgotten = 0;  ///< of the device's described objects, when it was read
  Vector<std::byte> bytes;
  Vector<texel::BufferTexelView> texels;  ///< by slot; none where there are none in the shape
  Vector<std::uint64_t> storage;          ///< of `set`
  DescriptorSet* set = nullptr;
};

/// The set used last comes first.
using KeptSets = std::list<KeptSet, HostAllocator<KeptSet>>;

/// Gives the bind point, which has a pipeline, its sets that lie in buffers. May flush the pass: nothing that points
/// into the arena may be kept across. Throws std::bad_alloc.
void read_descriptor_buffers(ReplayState& state, BindPoint& point);

}  // namespace vitrine::icd
