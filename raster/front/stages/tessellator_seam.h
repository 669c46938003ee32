// Triangles between two neighbouring rings of domain points. Internal to the tessellator.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/front/stages/tessellator_side.h"

namespace vitrine::raster {

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

/// Triangles in their order, three indices each.
struct TriangleList {
  bool clockwise = false;
  std::vector<std::uint32_t> indices;

  /// Given clockwise in a domain whose v points down.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /// Between sides of any two levels: the outermost ring and the next.
  void join_sides(const Seam& seam, const Side& outside, const Side& inside);
  /// Between rings inside: the outer row has two points more than the inner one's `count`.
  void join_rows(const Seam& seam, std::uint32_t count);
  /// One quad.
  void add_quad(const Seam& seam, std::uint32_t i, bool from_inside);
  /// Rows of equally many points; diagonals all one way, but for the middle one if `except_middle`.
  void join_strip(const Seam& seam, std::uint32_t count, bool except_middle);
};

}  // namespace vitrine::raster
