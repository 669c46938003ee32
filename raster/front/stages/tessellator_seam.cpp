// Triangles between two neighbouring rings of the tessellator. All are given clockwise in a domain whose v points down.
#include "raster/front/stages/tessellator.h"

namespace vitrine::raster {

void Tessellator::join_sides(const Seam& seam, const Side& outside, const Side& inside) {
  const std::uint32_t outer_half = outside.half - (outside.odd ? 1 : 0),
                      inner_half = inside.half - (inside.odd ? 1 : 0);
  std::uint32_t o = 0, i = 0;
  const auto advance_outside = [&](std::uint32_t point) {
    if (ruler_rank(point) >= outer_half) return;
    add_triangle(seam.outer(o), seam.outer(o + 1), seam.inner(i));
    ++o;
  };
  const auto advance_inside = [&](std::uint32_t point) {
    if (ruler_rank(point) >= inner_half) return;
    add_triangle(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    ++i;
  };
  constexpr std::uint32_t kLast = 32;
  advance_outside(0);
  for (std::uint32_t point = 1; point <= kLast; ++point) {
    advance_inside(point);
    advance_outside(point);
  }
  if (inside.odd && outside.odd) {
    add_triangle(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    add_triangle(seam.inner(i + 1), seam.outer(o), seam.outer(o + 1));
    ++i;
    ++o;
  } else if (outside.odd) {
    add_triangle(seam.inner(i), seam.outer(o), seam.outer(o + 1));
    ++o;
  } else if (inside.odd) {
    add_triangle(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    ++i;
  }
  for (std::uint32_t point = kLast; point >= 1; --point) {
    advance_outside(point);
    advance_inside(point);
  }
  advance_outside(0);
}

void Tessellator::add_quad(const Seam& seam, std::uint32_t i, bool from_inside) {
  const std::uint32_t a = seam.inner(i), b = seam.inner(i + 1), c = seam.outer(i), d = seam.outer(i + 1);
  if (from_inside) {  // the diagonal runs from a to d
    add_triangle(a, c, d);
    add_triangle(a, d, b);
  } else {
    add_triangle(c, b, a);
    add_triangle(c, d, b);
  }
}

void Tessellator::join_rows(const Seam& seam, std::uint32_t count) {
  add_triangle(seam.outer(0), seam.outer(1), seam.inner(0));
  Seam quads = seam;
  ++quads.outside_start;
  for (std::uint32_t i = 0; i + 1 < count; ++i) add_quad(quads, i, i >= count / 2);
  add_triangle(seam.outer(count), seam.outer(count + 1), seam.inner(count - 1));
}

void Tessellator::join_strip(const Seam& seam, std::uint32_t count, bool except_middle) {
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    if (except_middle && i != count / 2 - 1) {
      add_triangle(seam.outer(i), seam.outer(i + 1), seam.inner(i));
      add_triangle(seam.inner(i), seam.outer(i + 1), seam.inner(i + 1));
    } else {
      add_quad(seam, i, !except_middle);
    }
  }
}

}  // namespace vitrine::raster
