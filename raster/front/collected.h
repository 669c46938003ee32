// What the reference collects behind its clipper before it is set up, in a buffer of few bytes
// (lavapipe-rasterization.md 9.2): when the buffer is full, and to which layer of several views its contents go.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/primitive.h"

namespace vitrine::raster {

class CollectedVertices {
 public:
  /// Whether `corners` more find no place, wherever they are: `most` is how many vertices the buffer holds.
  bool is_full(std::uint32_t corners, std::uint32_t most) const {
    return indices_ + corners > kIndices || vertices_ + corners > most;
  }
  void add(std::span<const Vertex* const> corners);
  /// What comes is of another segment: it has vertices of its own.
  void begin_segment() { known_.assign(kTable, nullptr); }
  /// Before the first, too.
  void clear();

 private:
  static constexpr std::uint32_t kIndices = 1020;
  static constexpr std::uint32_t kTable = 1024;  ///< more than twice as many as the buffer holds

  std::vector<const Vertex*> known_;
  std::uint32_t indices_ = 0;
  std::uint32_t vertices_ = 0;  ///< distinct ones
};

/// What waits behind the reference's clipper, of all views of a draw (deviations.md, multiview-layers).
struct ViewLayer {
  bool any = false;
  bool alone = false;  ///< what waits came when the buffer was full: with the next the buffer begins anew
  std::uint32_t layer = 0;
  CollectedVertices collected;

  /// A primitive of `view` joins what waits: it goes to `layer` then.
  void add(std::uint32_t view, std::span<const Vertex* const> corners, std::uint32_t most);
};

}  // namespace vitrine::raster
