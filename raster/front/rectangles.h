// Pairs of triangles that form an axis-aligned rectangle, drawn as one (lavapipe-rasterization.md 9.2, 9.3): which they
// are, their setup, and the batches in which triangles leave the clipper, since pairs are counted within those.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/front/collected.h"
#include "raster/front/setup.h"

namespace vitrine::raster {

/// The corners of one triangle, or of two, one behind the other.
using TriangleCorners = std::array<const Vertex*, 3>;
using PairCorners = std::array<const Vertex*, 6>;

/// What becomes of two triangles.
struct TrianglePair {
  enum class Kind : std::uint8_t {
    kApart,      ///< both are set up, one after the other
    kFirst,      ///< the first alone: the other is culled
    kSecond,     ///< the second alone
    kNothing,    ///< both are culled
    kRectangle,  ///< the rectangle
  } kind = Kind::kApart;
  TriangleCorners corner{};  ///< rectangle: three of its corners, from which its inputs are interpolated
  bool front = false;        ///< rectangle: its facing
};

/// 9.2: window coordinates and varyings decide.
TrianglePair pair_triangles(const PipelinePlan& plan, const PairCorners& v);

/// 9.3: appends the rectangle unless nothing of it is visible.
void setup_rectangle(const SetupContext& context, const TrianglePair& pair);

struct ClippedTriangle {
  TriangleCorners v;
  std::uint32_t id;            ///< gl_PrimitiveID
  std::uint32_t instance = 0;  ///< without first_instance
};

/// Triangles that have been through the clipper and wait for the others of their batch.
class ClippedBatch {
 public:
  void begin(const PipelinePlan& plan);
  /// Whether the batch has to be worked off before another triangle comes: it is full, whatever the triangle's corners
  /// are; or the batch before it was, behind which a triangle is a batch of its own.
  bool is_complete() const { return alone_ || collected_.is_full(3, plan_->rectangles.batch_vertices); }
  /// The triangles that come are of another segment: it has vertices of its own.
  void begin_segment() { collected_.begin_segment(); }
  void add(const ClippedTriangle& triangle);
  std::span<const ClippedTriangle> triangles() const { return triangles_; }
  /// The batch has been worked off: because another triangle comes, or because none does.
  void clear(bool another);

 private:
  const PipelinePlan* plan_ = nullptr;
  std::vector<ClippedTriangle> triangles_;
  CollectedVertices collected_;
  bool alone_ = false;  ///< the next triangle, or the one that is there, is a batch of its own
};

}  // namespace vitrine::raster
