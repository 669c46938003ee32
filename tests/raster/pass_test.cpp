// The whole rasterizer with stages written in C++, against a model that walks all pixels of all triangles in order:
// snapping, edge functions, plane equations and depth test of lavapipe-rasterization.md 3 to 5, one pixel at a time.
#include "raster/pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <random>

#include "base/float_mode.h"
#include "base/workers.h"
#include "raster/stage.h"

namespace vitrine::raster {
namespace {

constexpr int kWidth = 151, kHeight = 133;  // odd: quads at the right and bottom stick out

struct Corner {
  float x, y, z, w;
  float color[4];
};

base::LaneMask shade_vertices(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                              base::LaneMask active, base::LaneMask) {
  const auto* corners = static_cast<const Corner*>(user);
  base::for_each_lane(active, [&](std::size_t lane) {
    const Corner& corner = corners[in[0].lane[lane]];
    for (std::size_t c = 0; c < 4; ++c) {
      out[c].lane[lane] = std::bit_cast<std::uint32_t>((&corner.x)[c]);
      out[4 + c].lane[lane] = std::bit_cast<std::uint32_t>(corner.color[c]);
    }
  });
  return active;
}

base::LaneMask pass_colors(const void*, const base::WaveRegister* in, base::WaveRegister* out, base::LaneMask active,
                           base::LaneMask helpers) {
  for (std::size_t c = 0; c < 4; ++c) out[c] = in[c];
  return active & ~helpers;
}

spirv::InterfaceSlot slot(spirv::BuiltIn built_in, std::uint32_t component, std::uint32_t reg) {
  spirv::InterfaceSlot result;
  result.built_in = built_in;
  result.component = static_cast<std::uint8_t>(component);
  result.reg = reg;
  return result;
}

struct Scene {
  std::vector<Corner> corners;
  std::vector<float> color = std::vector<float>(kWidth * kHeight * 4, 0.0f);
  std::vector<float> depth = std::vector<float>(kWidth * kHeight, 0.75f);
  State state;
  NativeShader vertex, fragment;
  bool late = false;
  QueryCounters queries;

  Scene() {
    vertex.interface.inputs = {slot(spirv::BuiltIn::kVertexIndex, 0, 0)};
    vertex.run = shade_vertices;
    fragment.run = pass_colors;
    for (std::uint32_t c = 0; c < 4; ++c) {
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kPosition, c, c));
      vertex.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, 4 + c));
      fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
      fragment.interface.inputs.back().interpolation = c < 2    ? spirv::Interpolation::kPerspective
                                                       : c == 2 ? spirv::Interpolation::kLinear
                                                                : spirv::Interpolation::kFlat;
      fragment.interface.outputs.push_back(slot(spirv::BuiltIn::kNone, c, c));
    }
    state.viewport[0] = {0, 0, kWidth, kHeight, 0, 1};
    state.scissor[0] = {{3, 2}, {kWidth - 9, kHeight - 7}};
    state.depth_test = state.depth_write = true;
    state.depth_compare = VK_COMPARE_OP_LESS;
  }

  static texel::ImageView view(VkFormat format, std::vector<float>& memory, std::uint32_t floats) {
    texel::ImageView result;
    result.base = reinterpret_cast<std::byte*>(memory.data());
    result.format = &texel::format_desc(format);
    result.level[0].extent = {kWidth, kHeight, 1};
    result.level[0].row_pitch = std::uint64_t{kWidth} * floats * 4;
    return result;
  }

  void draw(std::uint32_t pieces = 1) {
    PassDesc desc;
    desc.color[0] = view(VK_FORMAT_R32G32B32A32_SFLOAT, color, 4);
    desc.color_count = 1;
    if (state.depth_test) desc.depth = view(VK_FORMAT_D32_SFLOAT, depth, 1);
    desc.render_area = {{0, 0}, {kWidth, kHeight}};
    vertex.user = corners.data();
    fragment.interface.uses_discard = late;
    Pass pass(desc);
    const auto total = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < pieces; ++i) {
      DrawCall call;
      call.state = &state;
      call.native_vertex = &vertex;
      call.native_fragment = &fragment;
      call.queries = queries;
      call.first = total / 3 * i / pieces * 3;
      call.count = total / 3 * (i + 1) / pieces * 3 - call.first;
      pass.draw(call);
    }
  }
};

struct Window {
  float x, y, z, w;
  std::int64_t sx, sy;
  const Corner* corner;
};

Window to_window(const Corner& c) {
  const float hw = 0.5f * kWidth, hh = 0.5f * kHeight, oow = 1.0f / c.w;
  Window v{std::fma(c.x * oow, hw, hw + 0.0f),
           std::fma(c.y * oow, hh, hh + 0.0f),
           std::fma(c.z * oow, 1.0f, 0.0f),
           oow,
           0,
           0,
           &c};
  v.sx = std::lrintf((v.x - 0.5f) * 256.0f);
  v.sy = std::lrintf((v.y - 0.5f) * 256.0f);
  return v;
}

float plane_value(const Window v[3], const float a[3], float px, float py) {
  const float dx01 = v[0].x - v[1].x, dy01 = v[0].y - v[1].y, dx20 = v[2].x - v[0].x, dy20 = v[2].y - v[0].y;
  const float ooa = 1.0f / (dx01 * dy20 - dy01 * dx20);
  const float d01 = a[0] - a[1], d20 = a[2] - a[0];
  const float dadx = d01 * (dy20 * ooa) - d20 * (dy01 * ooa), dady = d20 * (dx01 * ooa) - d01 * (dx20 * ooa);
  const float a0 = a[0] - (dadx * (v[0].x - 0.5f) + dady * (v[0].y - 0.5f));
  return std::fma(dady, py, std::fma(dadx, px, a0));
}

/// Draws the scene's triangles into its buffers, pixel by pixel.
void model(Scene& scene) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  for (std::size_t i = 0; i + 2 < scene.corners.size(); i += 3) {
    Window v[3] = {to_window(scene.corners[i]), to_window(scene.corners[i + 1]), to_window(scene.corners[i + 2])};
    const float flat = v[0].corner->color[3];
    const std::int64_t area = (v[0].sx - v[1].sx) * (v[2].sy - v[0].sy) - (v[2].sx - v[0].sx) * (v[0].sy - v[1].sy);
    if (area == 0) continue;
    if (area < 0) std::swap(v[1], v[2]);
    const VkRect2D& scissor = scene.state.scissor[0];
    for (int y = scissor.offset.y; y < scissor.offset.y + static_cast<int>(scissor.extent.height); ++y) {
      for (int x = scissor.offset.x; x < scissor.offset.x + static_cast<int>(scissor.extent.width); ++x) {
        bool in = true;
        for (int e = 0; e < 3; ++e) {
          const Window &p = v[e], &q = v[(e + 1) % 3];
          const std::int64_t a = p.sy - q.sy, b = p.sx - q.sx;
          in &= a * (p.sx - 256 * x) - b * (p.sy - 256 * y) + (a < 0 || (a == 0 && b > 0) ? 1 : 0) > 0;
        }
        if (!in) continue;
        const auto px = static_cast<float>(x), py = static_cast<float>(y);
        const float zs[3] = {v[0].z, v[1].z, v[2].z}, ws[3] = {v[0].w, v[1].w, v[2].w};
        const float z = std::fmax(std::fmin(plane_value(v, zs, px, py) + 0.0f, 1.0f), 0.0f);
        const std::size_t at = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        const State& state = scene.state;
        if (state.depth_bounds_test &&
            (scene.depth[at] < state.min_depth_bounds || scene.depth[at] > state.max_depth_bounds))
          continue;
        if (scene.state.depth_test && !(z < scene.depth[at])) continue;
        if (scene.state.depth_test) scene.depth[at] = z;
        const float oow = 1.0f / plane_value(v, ws, px, py);
        for (std::size_t c = 0; c < 3; ++c) {
          float a[3];
          for (int k = 0; k < 3; ++k) a[k] = v[k].corner->color[c] * (c < 2 ? v[k].w : 1.0f);
          scene.color[at * 4 + c] = plane_value(v, a, px, py) * (c < 2 ? oow : 1.0f);
        }
        scene.color[at * 4 + 3] = flat;
      }
    }
  }
}

/// Triangles inside the volume, from less than a pixel to half the picture.
void add_triangles(Scene& scene, std::uint32_t count, float size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float cx = unit(random) * 2 - 1, cy = unit(random) * 2 - 1;
    for (int k = 0; k < 3; ++k) {
      Corner c;
      c.w = 0.5f + unit(random) * 2;
      c.x = std::fmin(std::fmax(cx + (unit(random) - 0.5f) * size, -0.99f), 0.99f) * c.w;
      c.y = std::fmin(std::fmax(cy + (unit(random) - 0.5f) * size, -0.99f), 0.99f) * c.w;
      c.z = unit(random) * c.w * 0.99f;
      for (float& value : c.color) value = unit(random);
      scene.corners.push_back(c);
    }
  }
}

class PassModel : public testing::TestWithParam<bool> {};

TEST_P(PassModel, EveryPixelHasTheModelsBits) {
  for (const float size : {0.03f, 0.2f, 1.6f}) {
    Scene drawn, expected;
    drawn.late = GetParam();
    add_triangles(drawn, size < 0.1f ? 3000 : 120, size, 5);
    expected.corners = drawn.corners;
    drawn.draw(3);
    model(expected);
    EXPECT_EQ(expected.depth, drawn.depth) << size;
    EXPECT_EQ(expected.color, drawn.color) << size;
  }
}

/// Stored depth starts at 0.75 and shrinks: triangles below the bounds are no longer drawn over.
TEST_P(PassModel, DepthBounds) {
  for (const float size : {0.2f, 1.6f}) {
    Scene drawn;
    drawn.late = GetParam();
    drawn.state.depth_bounds_test = true;
    drawn.state.min_depth_bounds = 0.4f;
    drawn.state.max_depth_bounds = 0.75f;
    add_triangles(drawn, 150, size, 6);
    Scene expected = drawn;
    drawn.draw(3);
    model(expected);
    EXPECT_EQ(expected.depth, drawn.depth) << size;
    EXPECT_EQ(expected.color, drawn.color) << size;
  }
}

TEST(Pass, DepthBoundsAboveWhatIsStoredDrawNothing) {
  Scene scene;
  add_triangles(scene, 50, 1.0f, 3);
  scene.state.depth_bounds_test = true;
  scene.state.min_depth_bounds = 0.8f;
  const Scene untouched = scene;
  scene.draw();
  EXPECT_EQ(scene.color, untouched.color);
  EXPECT_EQ(scene.depth, untouched.depth);
}

INSTANTIATE_TEST_SUITE_P(EarlyAndLate, PassModel, testing::Bool());

/// Triangles that cover whole tiles drop what lies under them; the picture is the same.
TEST(Pass, HiddenPrimitivesLeaveNoTrace) {
  Scene drawn, expected;
  drawn.state.depth_test = expected.state.depth_test = false;
  drawn.state.scissor[0] = expected.state.scissor[0] = {{0, 0}, {kWidth, kHeight}};
  std::mt19937 random(9);
  for (int layer = 0; layer < 4; ++layer) {
    add_triangles(drawn, 40, 0.7f, random());
    for (int k = 0; k < 3; ++k) {  // reaches over most of the picture
      const float w = 1.0f + static_cast<float>(k);
      drawn.corners.push_back({(k == 1 ? 0.999f : -0.999f) * w,
                               (k == 2 ? 0.999f : -0.999f) * w,
                               0.5f,
                               w,
                               {0.1f * static_cast<float>(k), 0.5f, 0.25f, static_cast<float>(layer)}});
    }
  }
  expected.corners = drawn.corners;
  drawn.draw(5);
  model(expected);
  EXPECT_EQ(expected.color, drawn.color);
}

TEST(Pass, DrawsNothingForEmptyScissorsAndMasks) {
  Scene scene;
  add_triangles(scene, 50, 1.0f, 3);
  add_triangles(scene, 50, 0.1f, 4);
  scene.state.scissor[0].extent = {0, 0};
  scene.draw();
  scene.state.scissor[0].extent = {100, 100};
  scene.state.sample_mask = 0;
  scene.draw();
  EXPECT_EQ(std::vector<float>(kWidth * kHeight * 4, 0.0f), scene.color);
}

/// Vulkan 1.3.239, VkQueryPipelineStatisticFlagBits: what has a vertex in the clipping volume counts behind the
/// clipper.
TEST(Pass, WhatTheClipperKeepsCountsWhateverIsCulledLater) {
  Scene scene;
  const auto add = [&](float x0, float y0, float x1, float y1, float x2, float y2) {
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y1}, {x2, y2}})
      scene.corners.push_back({x, y, 0.5f, 1.0f, {1, 1, 1, 1}});
  };
  add(0.0f, -0.5f, 0.5f, 0.5f, -0.5f, 0.5f);        // one face
  add(0.0f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f);        // the other
  add(0.25f, -0.5f, 0.25f, 0.0f, 0.25f, 0.5f);      // no area
  add(2.0f, 2.0f, 3.0f, 2.0f, 2.0f, 3.0f);          // outside
  add(0.501f, 0.5f, 0.502f, 0.5f, 0.501f, 0.501f);  // between samples
  for (const VkCullModeFlags mode : {VK_CULL_MODE_NONE, VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_BACK_BIT}) {
    std::array<std::atomic<std::uint64_t>, 11> counters{};
    scene.queries.statistics = counters.data();
    scene.state.cull_mode = mode;
    scene.draw();
    EXPECT_EQ(counters[static_cast<std::size_t>(Statistic::kClippingPrimitives)], 4u) << "cull mode " << mode;
  }
}

struct Begun {
  std::mutex mutex;
  std::vector<std::uint32_t> tiles;  ///< 3 columns of them
};

base::LaneMask note_tiles(const void* user, const base::WaveRegister* in, base::WaveRegister* out,
                          base::LaneMask active, base::LaneMask helpers) {
  auto& begun = *static_cast<Begun*>(const_cast<void*>(user));
  const std::lock_guard lock(begun.mutex);
  base::for_each_lane(active & ~helpers, [&](std::size_t lane) {
    const auto place = [&](std::size_t c) {
      return static_cast<std::uint32_t>(std::bit_cast<float>(in[4 + c].lane[lane]));
    };
    const std::uint32_t tile = place(1) / 64 * 3 + place(0) / 64;
    if (std::ranges::find(begun.tiles, tile) == begun.tiles.end()) begun.tiles.push_back(tile);
  });
  return pass_colors(nullptr, in, out, active, helpers);
}

/// Else the last tile keeps one thread busy when the others have nothing left.
TEST(Pass, TilesWithMostPrimitivesAreBegunFirst) {
  if (base::worker_count() == 1) GTEST_SKIP() << "one thread has no others to wait for";
  Scene scene;
  const auto add = [&](float x0, float y0, float x1, float y1, float x2, float y2) {
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y1}, {x2, y2}})
      scene.corners.push_back({x, y, 0.5f, 1.0f, {1, 1, 1, 1}});
  };
  add(-1, -1, 3, -1, -1, 3);
  for (int i = 0; i < 100; ++i) add(0.8f, 0.8f, 0.9f, 0.8f, 0.8f, 0.9f);
  scene.state.depth_test = false;
  scene.state.scissor[0] = {{0, 0}, {kWidth, kHeight}};
  for (std::uint32_t c = 0; c < 2; ++c)
    scene.fragment.interface.inputs.push_back(slot(spirv::BuiltIn::kFragCoord, c, 4 + c));
  Begun begun;
  scene.fragment.run = note_tiles;
  scene.fragment.user = &begun;
  scene.draw();
  ASSERT_EQ(begun.tiles.size(), 9u);
  const auto heavy = std::ranges::find(begun.tiles, 5u) - begun.tiles.begin();
  EXPECT_LT(static_cast<std::size_t>(heavy), base::worker_count());
}

TEST(Pass, SurvivesPositionsThatAreNotNumbers) {
  Scene scene;
  add_triangles(scene, 60, 2.0f, 3);
  const float odd[] = {std::nanf(""), HUGE_VALF, -HUGE_VALF, 3e38f, -3e38f, 0.0f, 1e-40f};
  std::mt19937 random(1);
  for (Corner& corner : scene.corners) (&corner.x)[random() % 4] = odd[random() % std::size(odd)];
  for (const VkPolygonMode mode : {VK_POLYGON_MODE_FILL, VK_POLYGON_MODE_LINE, VK_POLYGON_MODE_POINT}) {
    scene.state.polygon_mode = mode;
    scene.draw();
  }
}

}  // namespace
}  // namespace vitrine::raster
