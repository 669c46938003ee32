// What the front end leaves for the back end: vertices in window coordinates, primitives with snapped positions, and
// per chunk the list of primitives of every tile. Sections cited are of lavapipe-rasterization.md.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// A vertex after the viewport transform: words [x, y, z, 1/w] as floats, then the varyings in plan order. Lies in the
/// chunk's arena; `PipelinePlan::vertex_stride` words long.
using Vertex = float;

/// Rectangles are two triangles drawn as one (9.3): all pixels of their bounds, interpolated as the triangle `v`.
enum class PrimitiveKind : std::uint8_t { kTriangle, kRectangle, kLine, kPoint };
/// Of polygons.
constexpr bool is_area(PrimitiveKind kind) { return kind <= PrimitiveKind::kRectangle; }

/// Positions are 24.8 fixed point relative to the sample grid of 3.1 (pixel centres at multiples of 256 when
/// single-sampled, pixel corners when multisampled).
struct Primitive {
  Primitive() = default;
  struct Unset {};
  explicit Primitive(Unset) {}  ///< for those who fill in everything: zeros first would take longer than that

  std::int32_t x[4],
      y[4];  ///< triangle: 3 corners with positive area; line: 4 corners; point, rectangle: x0, y0, x1, y1 in [0], [1]
  const Vertex* v[3];  ///< triangle: interpolation order (2.1); line: both ends; point: one
  /// Nonzero: covered pixels, in quad order, of the 8x8 window at the even pixel at or before (x0, y0), of a primitive
  /// that covers nothing outside of it.
  base::LaneMask window;
  float depth_offset;            ///< depth bias (5.1)
  std::uint32_t id;              ///< gl_PrimitiveID
  std::uint16_t x0, y0, x1, y1;  ///< pixels that can be covered, inclusive, cut to the draw region
  std::uint16_t layer;
  std::uint8_t viewport;
  PrimitiveKind kind;
  bool front;
  std::uint8_t provoking;  ///< index in v whose flat values hold
  FragmentRate rate;       ///< FragmentRates::with_primitive; counts where FragmentRates::any
};

/// The fill rule (lavapipe-rasterization.md 3.2) for an edge from one corner to the next: whether samples on it are
/// inside. `a` = y - next y, `b` = x - next x.
template <class T>
constexpr bool owns_edge(T a, T b) {
  return a < 0 || (a == 0 && b > 0);
}

/// An edge function of samples q in 24.8: inside where c - a*qx + b*qy > 0, the fill rule's unit included.
struct PrimitiveEdge {
  std::int64_t a, b, c;
};
struct PrimitiveEdges {
  std::uint32_t count;
  PrimitiveEdge edge[4];
};

inline PrimitiveEdge edge_between(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
  const std::int64_t a = y0 - y1, b = x0 - x1;
  return {a, b, a * x0 - b * y0 + (owns_edge(a, b) ? 1 : 0)};
}

inline PrimitiveEdges edges_of(const Primitive& p) {
  if (p.kind == PrimitiveKind::kPoint || p.kind == PrimitiveKind::kRectangle)  // X0 <= qx < X1, Y0 <= qy < Y1
    return {4, {{-1, 0, std::int64_t{1} - p.x[0]}, {1, 0, p.x[1]}, {0, 1, std::int64_t{1} - p.y[0]}, {0, -1, p.y[1]}}};
  PrimitiveEdges edges{p.kind == PrimitiveKind::kTriangle ? 3u : 4u, {}};
  for (std::uint32_t e = 0; e < edges.count; ++e) {
    const std::uint32_t n = e + 1 == edges.count ? 0 : e + 1;
    edges.edge[e] = edge_between(p.x[e], p.y[e], p.x[n], p.y[n]);
  }
  return edges;
}

/// Primitives of one tile in one chunk: index[0..count) into primitives, in API order.
struct TileRange {
  std::uint32_t tile;
  std::uint32_t count;
  const std::uint32_t* index;
};

struct ChunkOutput {
  const Primitive* primitives = nullptr;
  const TileRange* ranges = nullptr;
  std::uint32_t range_count = 0;
  const struct CaptureOutput* capture = nullptr;  ///< transform feedback
  /// Rectangles: the first and the last of the chunk's segments went through the clipper, so that a batch of clipped
  /// triangles reaches over the ends of the chunk.
  bool begins_clipped = false, ends_clipped = false;
};

/// Tiles of a pass: 64x64 pixels, layer after layer, rows from the top.
struct TileGrid {
  std::uint32_t columns = 0, rows = 0, layers = 1;
  std::uint32_t count() const { return columns * rows * layers; }
  std::uint32_t index(std::uint32_t column, std::uint32_t row, std::uint32_t layer) const {
    return (layer * rows + row) * columns + column;
  }
};

/// A stretch of a strip, list or fan of one instance, at most a chunk long: primitives [begin, end) counted from the
/// vertex or index position `start` where the strip begins.
struct Run {
  std::uint32_t start;
  std::uint32_t begin, end;
  std::uint32_t instance;  ///< without first_instance
  std::uint32_t first_id;  ///< gl_PrimitiveID of primitive 0 of the strip
  bool ends = true;        ///< the strip's last primitive is in here
};

class PrimitiveInstances;  // raster/primitive_instances.h

/// A draw of the pass with everything derived from it; lives until the flush.
struct DrawRecord {
  DrawCall call;
  const PipelinePlan* plan = nullptr;
  Stage vertex, control, evaluation, geometry, fragment;
  PrimitiveInstances* instances = nullptr;  ///< null: nobody watches pixels of it
};

}  // namespace vitrine::raster
