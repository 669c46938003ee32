// See contents.h.
#include "glass/bug/contents.h"

#include <algorithm>

namespace vitrine::glass::bug {

Bytes contents_of(const Bug& bug, const Buffer& buffer, bool after) {
  Bytes out(buffer.size);
  for (const Piece& piece : bug.memories[buffer.memory].pieces) {
    const Bytes& bytes = after && piece.after ? *piece.after : *piece.before;
    const std::uint64_t first = std::max(piece.offset, buffer.offset);
    const std::uint64_t end = std::min(piece.offset + bytes.size(), buffer.offset + buffer.size);
    if (first < end)
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(first - piece.offset), end - first,
                  out.begin() + static_cast<std::ptrdiff_t>(first - buffer.offset));
  }
  return out;
}

VkDescriptorType plain_type(const Bug& bug, std::uint32_t set, const Binding& binding) {
  if (binding.type != VK_DESCRIPTOR_TYPE_MUTABLE_EXT) return binding.type;
  const Descriptor* first = nullptr;
  for (const Descriptor& d : bug.descriptors) {
    if (d.set != set || d.binding != binding.binding) continue;
    if (first && first->type != d.type) return VK_DESCRIPTOR_TYPE_MUTABLE_EXT;
    first = &d;
  }
  return first ? first->type : binding.types.at(0);
}

}  // namespace vitrine::glass::bug
