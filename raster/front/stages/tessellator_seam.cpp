// Triangles between two neighbouring rings of the tessellator. All are given clockwise in a domain whose v points down.
#include "raster/front/stages/tessellator_seam.h"

#include <utility>

namespace vitrine::raster {

std::uint32_t Ring::at(std::uint32_t step) const {
  if (total == 0) return base;
  step %= total;
  if (backwards && step != 0) step = total - step;
  return base + (collapsed && step > total / 2 ? total - step : step);
}

void TriangleList::add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (!clockwise) std::swap(b, c);
  indices.insert(indices.end(), {a, b, c});
}

void TriangleList::join_sides(const Seam& seam, const Side& outside, const Side& inside) {
  const std::uint32_t outer_half = outside.half - (outside.odd ? 1 : 0),
                      inner_half = inside.half - (inside.odd ? 1 : 0);
  std::uint32_t o = 0, i = 0;
  const auto advance_outside = [&](std::uint32_t point) {
    if (ruler_rank(point) >= outer_half) return;
    add(seam.outer(o), seam.outer(o + 1), seam.inner(i));
    ++o;
  };
  const auto advance_inside = [&](std::uint32_t point) {
    if (ruler_rank(point) >= inner_half) return;
    add(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    ++i;
  };
  constexpr std::uint32_t kLast = 32;
  advance_outside(0);
  for (std::uint32_t point = 1; point <= kLast; ++point) {
    advance_inside(point);
    advance_outside(point);
  }
  if (inside.odd && outside.odd) {
    add(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    add(seam.inner(i + 1), seam.outer(o), seam.outer(o + 1));
    ++i;
    ++o;
  } else if (outside.odd) {
    add(seam.inner(i), seam.outer(o), seam.outer(o + 1));
    ++o;
  } else if (inside.odd) {
    add(seam.inner(i), seam.outer(o), seam.inner(i + 1));
    ++i;
  }
  for (std::uint32_t point = kLast; point >= 1; --point) {
    advance_outside(point);
    advance_inside(point);
  }
  advance_outside(0);
}

void TriangleList::add_quad(const Seam& seam, std::uint32_t i, bool from_inside) {
  const std::uint32_t a = seam.inner(i), b = seam.inner(i + 1), c = seam.outer(i), d = seam.outer(i + 1);
  if (from_inside) {  // the diagonal runs from a to d
    add(a, c, d);
    add(a, d, b);
  } else {
    add(c, b, a);
    add(c, d, b);
  }
}

void TriangleList::join_rows(const Seam& seam, std::uint32_t count) {
  add(seam.outer(0), seam.outer(1), seam.inner(0));
  Seam quads = seam;
  ++quads.outside_start;
  for (std::uint32_t i = 0; i + 1 < count; ++i) add_quad(quads, i, i >= count / 2);
  add(seam.outer(count), seam.outer(count + 1), seam.inner(count - 1));
}

void TriangleList::join_strip(const Seam& seam, std::uint32_t count, bool except_middle) {
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    if (except_middle && i != count / 2 - 1) {
      add(seam.outer(i), seam.outer(i + 1), seam.inner(i));
      add(seam.inner(i), seam.outer(i + 1), seam.inner(i + 1));
    } else {
      add_quad(seam, i, !except_middle);
    }
  }
}

}  // namespace vitrine::raster
