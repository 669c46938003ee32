// The table of the vertices that are in the buffer.
#include "raster/front/collected.h"

namespace vitrine::raster {

void CollectedVertices::add(std::span<const Vertex* const> corners) {
  indices_ += static_cast<std::uint32_t>(corners.size());
  for (const Vertex* corner : corners) {
    auto at = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(corner) >> 4) * 0x9e3779b1u >> 22;
    while (known_[at] != nullptr && known_[at] != corner) at = (at + 1) % kTable;
    if (known_[at] == corner) continue;
    known_[at] = corner;
    ++vertices_;
  }
}

void CollectedVertices::clear() {
  known_.assign(kTable, nullptr);
  indices_ = 0;
  vertices_ = 0;
}

void ViewLayer::add(std::uint32_t view, std::span<const Vertex* const> corners, std::uint32_t most) {
  if (alone || collected.is_full(static_cast<std::uint32_t>(corners.size()), most)) {
    if (alone) layer = view;
    alone = !alone;
    collected.clear();
  }
  collected.add(corners);
}

}  // namespace vitrine::raster
