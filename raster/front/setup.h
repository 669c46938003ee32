// Setup of triangles (Vulkan 1.3.239, Rasterization): window-space vertices to Primitive records: facing and culling,
// depth bias, snapped corners, pixel bounds. lavapipe-rasterization.md 2, 3.1, 3.3, 5.1. Batches of them:
// setup_batch.h; lines and points: setup_wide.h.
#pragma once

#include <cstdint>
#include <optional>

#include "raster/front/primitive_list.h"
#include "raster/observe.h"
#include "raster/pass_desc.h"
#include "raster/pixel_rect.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// A vertex on its way into setup: its record, and its snapped position for triangles.
struct SetupVertex {
  const Vertex* record;
  std::int32_t x, y;
};

/// What setup needs besides vertices: constant over a chunk but for the members with defaults.
struct SetupContext {
  const PipelinePlan* plan;
  const PassDesc* pass;
  PrimitiveList* out;
  std::uint32_t id = 0;
  std::optional<std::uint32_t> instance = std::nullopt;  ///< what the watch is told
  std::uint16_t layer = 0;
  std::uint8_t viewport = 0;
  FragmentRate rate = 0;
  bool of_line = false;  ///< the triangle is half of a smooth line: never culled or biased, faces as `line_front` says
  bool line_front = true;
  DrawWatch* watch = nullptr;  ///< null: nobody observes

  /// A primitive ends here.
  void tell(PrimitiveFate fate) const {
    if (watch) watch->primitive(id, instance, fate);
  }
};

/// Snapped coordinate of triangles: nearest even (3.1).
std::int32_t snap_coordinate(float window, float pixel_offset);

/// The pixels that a triangle between these coordinates can cover, in 24.8: those of which a sample lies inside, or,
/// with conservative rasterization, whatever has a part inside.
PixelRect pixels_between(const PipelinePlan& plan, std::int32_t left, std::int32_t top, std::int32_t right,
                         std::int32_t bottom);

/// Twice the signed area of window positions as the float cull computes it (2.2); negative is counter-clockwise.
float window_determinant(const Vertex* v0, const Vertex* v1, const Vertex* v2);

/// 2.2: culling by the float determinant.
bool culled_by_determinant(const State& state, float determinant);

/// Filled triangle in API order (provoking vertex first or last as the state says).
void setup_triangle(const SetupContext& context, const SetupVertex& v0, const SetupVertex& v1, const SetupVertex& v2);

/// What is known of a triangle before it becomes a primitive.
struct TriangleFacts {
  bool front;
  PixelRect visible;
  base::LaneMask window;  ///< Primitive::window
};
/// Fills in everything but the corners.
void complete_triangle(const SetupContext& context, const TriangleFacts& facts, Primitive& p);

/// 5.1, second form: depth of the three corners biased in place (polygon modes LINE and POINT).
float vertex_depth_bias(const PipelinePlan& plan, const PassDesc& pass, const Vertex* v0, const Vertex* v1,
                        const Vertex* v2);

}  // namespace vitrine::raster
