// The tessellator: domains are covered once, at every level and spacing; levels out of range; order of simple patches.
#include "raster/front/stages/tessellator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace vitrine::raster {
namespace {

using spirv::TessDomain;
using spirv::TessSpacing;

constexpr TessSpacing kSpacings[] = {TessSpacing::kEqual, TessSpacing::kFractionalOdd, TessSpacing::kFractionalEven};

/// Sum of the areas of all triangles; each must be turned the way that was asked for.
double covered_area(const Tessellator& tessellator, bool clockwise) {
  double area = 0;
  const auto& points = tessellator.points();
  const auto& indices = tessellator.indices();
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    const DomainPoint a = points.at(indices[i]), b = points.at(indices[i + 1]), c = points.at(indices[i + 2]);
    const double ux = double{b.u} - a.u, uy = double{b.v} - a.v, vx = double{c.u} - a.u, vy = double{c.v} - a.v;
    const double doubled = (ux * vy - uy * vx) * (clockwise ? 1 : -1);
    EXPECT_GE(doubled, -1e-4) << i / 3;
    area += doubled / 2;
  }
  return area;
}

TEST(Tessellator, TrianglesCoverTheDomainOnce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> level(0.5f, 66.0f);
  Tessellator tessellator;
  for (int i = 0; i < 300; ++i) {
    for (const TessSpacing spacing : kSpacings) {
      TessLevels levels{};
      for (float& value : levels.outer) value = i % 3 == 0 ? std::ceil(level(random) / 8) : level(random);
      for (float& value : levels.inner) value = level(random) / (i % 5 == 0 ? 60.0f : 1.0f);
      const bool clockwise = i % 2 == 0;
      tessellator.run({TessDomain::kTriangles, spacing, clockwise, false}, levels);
      EXPECT_NEAR(covered_area(tessellator, clockwise), 0.5, 1e-6);
      tessellator.run({TessDomain::kQuads, spacing, clockwise, false}, levels);
      EXPECT_NEAR(covered_area(tessellator, clockwise), 1.0, 1e-6);
    }
  }
}

TEST(Tessellator, LevelOneIsThePatchItself) {
  Tessellator tessellator;
  const TessLevels ones{{1, 1, 1, 1}, {1, 1}};
  tessellator.run({TessDomain::kTriangles, TessSpacing::kEqual, true, false}, ones);
  EXPECT_EQ(tessellator.points().size(), 3u);
  EXPECT_EQ(tessellator.indices(), (std::vector<std::uint32_t>{0, 1, 2}));
  tessellator.run({TessDomain::kQuads, TessSpacing::kFractionalOdd, false, false}, ones);
  EXPECT_EQ(tessellator.points().size(), 4u);
  EXPECT_EQ(tessellator.indices(), (std::vector<std::uint32_t>{0, 3, 1, 1, 3, 2}));
}

TEST(Tessellator, IsolinesAreRowsWithoutTheLast) {
  Tessellator tessellator;
  tessellator.run({TessDomain::kIsolines, TessSpacing::kEqual, true, false}, {{3, 4, 0, 0}, {0, 0}});
  ASSERT_EQ(tessellator.points().size(), 3u * 5u);
  EXPECT_EQ(tessellator.indices().size(), 3u * 4u * 2u);
  EXPECT_EQ(tessellator.points()[4].u, 1.0f);
  EXPECT_EQ(tessellator.points()[14].v, tessellator.points()[10].v);
  EXPECT_LT(tessellator.points()[14].v, 0.67f);
}

TEST(Tessellator, PointModeGivesEveryPointOnce) {
  Tessellator tessellator;
  tessellator.run({TessDomain::kTriangles, TessSpacing::kFractionalEven, true, true}, {{5, 6, 7, 0}, {4.5f, 0}});
  ASSERT_EQ(tessellator.indices().size(), tessellator.points().size());
  for (std::uint32_t i = 0; i < tessellator.indices().size(); ++i) EXPECT_EQ(tessellator.indices()[i], i);
}

TEST(Tessellator, CullsAndClampsLevels) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Tessellator tessellator;
  for (const float bad : {0.0f, -1.0f, nan}) {
    for (const TessDomain domain : {TessDomain::kTriangles, TessDomain::kQuads, TessDomain::kIsolines}) {
      tessellator.run({domain, TessSpacing::kEqual, true, false}, {{2, bad, 2, 2}, {2, 2}});
      EXPECT_TRUE(tessellator.points().empty());
      EXPECT_TRUE(tessellator.indices().empty());
    }
  }
  tessellator.run({TessDomain::kQuads, TessSpacing::kEqual, true, false}, {{infinity, 1e9f, 64, 64}, {nan, infinity}});
  EXPECT_NEAR(covered_area(tessellator, true), 1.0, 1e-6);
}

}  // namespace
}  // namespace vitrine::raster
