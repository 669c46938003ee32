// Input assembly (Vulkan 1.3.239, Primitive Topologies; Primitive Restart): draws cut into runs, and the positions of a
// run. The order of a primitive's corners is the table's (raster/topology.h). Does not know vertices: what becomes of
// the primitives when those are shaded is primitives.h.
#pragma once

#include <cstdint>

#include "raster/primitive.h"
#include "raster/topology.h"

namespace vitrine::raster {

/// A primitive between assembly and clipping: slots of the last stage's vertices.
struct ListedPrimitive {
  std::uint32_t slot[3];
  std::uint32_t id;            ///< gl_PrimitiveID
  bool continues = false;      ///< a strip: the line stipple pattern goes on
  std::uint32_t instance = 0;  ///< without first_instance
};

/// Positions a run needs: [0] for fans, then [low, high).
struct RunSpan {
  std::uint32_t low, high;
  bool center;
  std::uint32_t count() const { return high - low + (center ? 1 : 0); }
  /// Index of position p among those.
  std::uint32_t entry(std::uint32_t p) const { return center ? (p == 0 ? 0 : p - low + 1) : p - low; }
};
RunSpan run_span(const TopologyShape& shape, const Run& run);

/// Primitives of about `positions` positions: an even number, so that strips which are cut there keep their parity.
std::uint32_t piece_of(const TopologyShape& shape, std::uint32_t positions);

/// Cuts one instance of a draw at restart indices and into stretches of at most `piece` primitives, one after the
/// other: a draw of billions of vertices is never there as a whole.
class RunCutter {
 public:
  /// `numbers_pieces`: gl_PrimitiveID begins anew in each. The draw outlives the cutter.
  RunCutter(const DrawCall& draw, const TopologyShape& shape, std::uint32_t instance, std::uint32_t piece,
            bool numbers_pieces);
  /// The next stretch; false: there is none.
  bool next(Run& run);

 private:
  /// Goes on to the next strip that has a primitive.
  bool open_strip();

  const DrawCall& draw_;
  const TopologyShape shape_;
  const std::uint64_t piece_;
  const bool numbers_pieces_, restarts_;
  Run strip_;
  std::uint64_t at_ = 0;     ///< position where the next strip begins
  std::uint64_t begin_ = 0;  ///< primitives of the strip that have been given
  std::uint64_t total_ = 0;  ///< primitives of the strip
};

/// Index `position` of the bound index buffer; 0 beyond its end.
std::uint32_t read_index(const DrawCall& draw, std::uint64_t position);

}  // namespace vitrine::raster
