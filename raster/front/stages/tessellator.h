// The fixed-function tessellator (Vulkan 1.3.239, Tessellation: Tessellation Primitive Generation): levels of a patch
// to domain points and the primitives between them. Points, their bits and their order are the reference's, which
// places them in 16.16 fixed point, ring by ring from the outside, and joins each two rings edge by edge.
#pragma once

#include <cstdint>
#include <vector>

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
  const std::vector<std::uint32_t>& indices() const { return indices_; }

 private:
  /// A closed walk around the domain: `total` steps; of a collapsed ring only the first total / 2 + 1 points exist,
  /// and the walk goes back over them.
  struct Ring {
    std::uint32_t base = 0, total = 0;
    bool collapsed = false, backwards = false;
    std::uint32_t at(std::uint32_t step) const;
  };
  /// An edge of two neighbouring rings: where it starts on each.
  struct Seam {
    Ring outside, inside;
    std::uint32_t outside_start, inside_start;
    std::uint32_t outer(std::uint32_t i) const { return outside.at(outside_start + i); }
    std::uint32_t inner(std::uint32_t i) const { return inside.at(inside_start + i); }
  };

  void add_point(Fixed u, Fixed v);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
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

  // tessellator_seam.cpp
  /// Between sides of any two levels: the outermost ring and the next.
  void join_sides(const Seam& seam, const Side& outside, const Side& inside);
  /// Between rings inside: the outer row has two points more than the inner one's `count`.
  void join_rows(const Seam& seam, std::uint32_t count);
  /// One quad.
  void add_quad(const Seam& seam, std::uint32_t i, bool from_inside);
  /// Rows of equally many points; diagonals all one way, but for the middle one if `except_middle`.
  void join_strip(const Seam& seam, std::uint32_t count, bool except_middle);

  TessModes modes_{};
  std::vector<DomainPoint> points_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace vitrine::raster
