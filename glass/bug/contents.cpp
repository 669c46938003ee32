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

}  // namespace vitrine::glass::bug
