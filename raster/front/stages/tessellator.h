// The fixed-function tessellator (Vulkan 1.3.239, Tessellation: Tessellation Primitive Generation): levels of a patch
// to domain points and the primitives between them. Points, their bits and their order are the reference's, which
// places them in 16.16 fixed point, ring by ring from the outside, and joins each two rings edge by edge.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/front/stages/tessellator_seam.h"
#include "raster/front/stages/tessellator_side.h"
#include "spirv/shader.h"

namespace vitrine::raster {

struct TessModes {
  spirv::TessDomain domain;
  spirv::TessSpacing spacing;
  bool clockwise;
  bool point_mode;
};

struct TessLevels {
  float outer[4];
  float inner[2];
};

struct DomainPoint {
  float u, v;
};

class Tessellator {
 public:
  /// Replaces points() and indices(). A patch that is culled has none.
  void run(const TessModes& modes, const TessLevels& levels);

  const std::vector<DomainPoint>& points() const { return points_; }
  /// 3 (triangles), 2 (isolines) or 1 (point mode) per primitive, in order.
  const std::vector<std::uint32_t>& indices() const { return triangles_.indices; }

 private:
  void add_point(Fixed u, Fixed v);
  void list_points();
  Side inside_side(float level) const;
  Side outside_side(float level) const;
  float clamp_level(float level, bool picture_frame) const;

  void triangles(const TessLevels& levels);
  void triangle_points(const Side outer[3], const Side& inner, std::uint32_t count);
  void triangle_rings(const Side outer[3], const Side& inner, std::uint32_t count);
  void quads(const TessLevels& levels);
  void quad_points(const Side outer[4], const Side inner[2], const std::uint32_t count[2]);
  void quad_rings(const Side outer[4], const Side inner[2], const std::uint32_t count[2]);
  void quad_center(const Ring& ring, const Side inner[2], const std::uint32_t count[2]);
  void isolines(const TessLevels& levels);

  TessModes modes_{};
  std::vector<DomainPoint> points_;
  TriangleList triangles_;
};

}  // namespace vitrine::raster
