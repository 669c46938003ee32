// Clipping against the view volume and user planes (Vulkan 1.3.239, Primitive Clipping), with the arithmetic of
// lavapipe-rasterization.md 1.5 and 1.6. Positions are clip coordinates; new vertices get window coordinates too.
#pragma once

#include <cstdint>

#include "raster/arena.h"
#include "raster/front/viewport.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// A vertex as the clipper sees it.
struct ClipVertex {
  float clip[4];
  float distance[kMaxClipDistances];
  const Vertex* record;
  ClipCode code;
  bool edge = true;  ///< polygon mode: the edge that starts here is drawn
};

struct ClipContext {
  const PipelinePlan* plan;
  const ViewportTransform* viewport;
  Arena* arena;             ///< records of new vertices
  bool guard_band = false;  ///< in x and y, of twice the volume: where polygon mode POINT clips
};

/// 3 corners cut by at most 6 + 8 planes, and a repeated first corner.
inline constexpr std::uint32_t kMaxPolygon = 20;

/// A convex polygon; `edge[i]`: the edge from corner i to corner i+1 belongs to the triangle's outline and is drawn.
struct ClipPolygon {
  std::uint32_t count = 0;
  ClipVertex corner[kMaxPolygon];
};

/// Corners 0..2 of `polygon` are the triangle. On return the clipped polygon, whose corner 0 carries the flat values of
/// corner `provoking`; false if nothing is left.
bool clip_triangle(const ClipContext& context, std::uint32_t provoking, ClipPolygon& polygon);

/// Moves the ends onto the planes. False if nothing is left.
bool clip_line(const ClipContext& context, std::uint32_t provoking, ClipVertex line[2]);

}  // namespace vitrine::raster
