// Which pairs of triangles become rectangles, and where batches end (lavapipe-rasterization.md 9.2).
#include "raster/front/rectangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace vitrine::raster {
namespace {

using Kind = TrianglePair::Kind;

/// Corners (0, 0), (8, 0), (8, 4), (0, 4), with one varying that is a plane.
struct Quad {
  float corner[4][8] = {{0, 0, 0.5f, 1, 1}, {8, 0, 0.5f, 1, 2}, {8, 4, 0.5f, 1, 4}, {0, 4, 0.5f, 1, 3}};
  PairCorners pair(const std::array<int, 6>& order) const {
    PairCorners out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = corner[order[i]];
    return out;
  }
};

struct Draw {
  State state;
  PipelinePlan plan;
  explicit Draw(VkCullModeFlags cull = VK_CULL_MODE_NONE) {
    state.cull_mode = cull;
    state.front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    plan.state = &state;
    plan.perspective_count = 1;
    plan.vertex_stride = 8;
    plan.frag.frag_coord.fill(kNoReg);
    plan.rectangles = {true, 1365, 128};
  }
};

/// (0, 0), (8, 0), (8, 4) has a positive determinant: clockwise for those who draw rectangles.
constexpr std::array<int, 6> kClockwise{0, 1, 2, 0, 2, 3}, kCounterClockwise{0, 2, 1, 0, 3, 2},
    kMixed{0, 1, 2, 0, 3, 2};

TEST(Rectangles, JoinsTrianglesInEveryRotation) {
  const Quad quad;
  const Draw draw;
  for (int first = 0; first < 3; ++first)
    for (int second = 0; second < 3; ++second)
      for (std::array<int, 6> order : {kClockwise, kCounterClockwise}) {
        std::rotate(order.begin(), order.begin() + first, order.begin() + 3);
        std::rotate(order.begin() + 3, order.begin() + 3 + second, order.end());
        EXPECT_EQ(pair_triangles(draw.plan, quad.pair(order)).kind, Kind::kRectangle) << first << second;
      }
  EXPECT_TRUE(pair_triangles(draw.plan, quad.pair(kCounterClockwise)).front);
  EXPECT_FALSE(pair_triangles(draw.plan, quad.pair(kClockwise)).front);
}

TEST(Rectangles, LeavesApartWhatIsNone) {
  const Draw draw;
  const auto kind_with = [&](int corner, int word, float value) {
    Quad quad;
    quad.corner[corner][word] = value;
    return pair_triangles(draw.plan, quad.pair(kClockwise)).kind;
  };
  EXPECT_EQ(kind_with(2, 0, 9), Kind::kApart);          // not axis-aligned
  EXPECT_EQ(kind_with(1, 3, 0.5f), Kind::kApart);       // another w
  EXPECT_EQ(kind_with(3, 4, 3.5f), Kind::kApart);       // a varying that is no plane
  EXPECT_EQ(kind_with(3, 2, 0.75f), Kind::kRectangle);  // the depth is none: nobody reads it
  EXPECT_EQ(pair_triangles(draw.plan, Quad().pair(kMixed)).kind, Kind::kApart);
}

TEST(Rectangles, ReadsDepthOnlyForFragCoord) {
  Draw draw;
  draw.plan.frag.frag_coord[2] = 0;
  Quad quad;
  EXPECT_EQ(pair_triangles(draw.plan, quad.pair(kClockwise)).kind, Kind::kRectangle);
  quad.corner[3][2] = 0.75f;
  EXPECT_EQ(pair_triangles(draw.plan, quad.pair(kClockwise)).kind, Kind::kApart);
}

TEST(Rectangles, CullsByThePair) {
  const Quad quad;
  const Draw back(VK_CULL_MODE_BACK_BIT), front(VK_CULL_MODE_FRONT_BIT);
  EXPECT_EQ(pair_triangles(back.plan, quad.pair(kCounterClockwise)).kind, Kind::kRectangle);
  EXPECT_EQ(pair_triangles(back.plan, quad.pair(kClockwise)).kind, Kind::kNothing);
  EXPECT_EQ(pair_triangles(front.plan, quad.pair(kClockwise)).kind, Kind::kRectangle);
  EXPECT_EQ(pair_triangles(front.plan, quad.pair(kMixed)).kind, Kind::kFirst);
  EXPECT_EQ(pair_triangles(back.plan, quad.pair(kMixed)).kind, Kind::kApart);  // the reference draws both, and culls
}

/// Batches of triangles without common corners: 42 of them have 126 vertices, and the one for which a batch ended is
/// alone.
TEST(Rectangles, EndsBatchesWhenVerticesAreFull) {
  const Draw draw;
  std::vector<float> vertices(8 * 600);
  ClippedBatch batch;
  batch.begin(draw.plan);
  std::vector<std::size_t> sizes;
  for (std::size_t i = 0; i < 100; ++i) {
    if (batch.is_complete()) {
      sizes.push_back(batch.triangles().size());
      batch.clear(true);
    }
    const float* first = vertices.data() + 8 * 3 * i;
    batch.add({{first, first + 8, first + 16}, 0});
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{42, 1, 42, 1}));
}

/// Shared corners count once in a segment: then the number of indices ends a batch.
TEST(Rectangles, EndsBatchesWhenIndicesAreFull) {
  const Draw draw;
  const Quad quad;
  ClippedBatch batch;
  batch.begin(draw.plan);
  std::size_t count = 0;
  for (; !batch.is_complete(); ++count) batch.add({{quad.corner[0], quad.corner[1], quad.corner[2]}, 0});
  EXPECT_EQ(count, 340u);
}

}  // namespace
}  // namespace vitrine::raster
