// Setup of batches of triangles: facing, bounds and coverage of those that cover no more than a 4x4 window, one
// triangle a lane. The others, and what is left to do for each, go the way of single triangles.
#include "raster/front/setup_batch.h"

#include "base/simd.h"
#include "raster/front/window_coverage.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/front/setup_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"

#ifndef VITRINE_RASTER_SETUP_BATCH_FACTS
#define VITRINE_RASTER_SETUP_BATCH_FACTS
namespace vitrine::raster {

/// What is done with a triangle of a batch.
enum class BatchStep : std::int32_t {
  kDrop,
  kSmallWindow,
  kWindow,  ///< of 8x8 pixels: not yet covered
  kWide,    ///< no window
  kAlone    ///< as setup_triangle() does it
};

/// What a vector knows of its triangles, by lane.
struct BatchFacts {
  alignas(64) BatchStep step[TriangleBatch::kSize];
  alignas(64) std::int32_t area[TriangleBatch::kSize];
  alignas(64) std::int32_t x[3][TriangleBatch::kSize], y[3][TriangleBatch::kSize];  ///< in interpolation order
  alignas(64) std::int32_t x0[TriangleBatch::kSize], y0[TriangleBatch::kSize];      ///< pixels covered, before the cut
  alignas(64) std::int32_t x1[TriangleBatch::kSize], y1[TriangleBatch::kSize];      ///< to the draw region
  alignas(64) std::uint32_t outside[TriangleBatch::kSize];                          ///< of a small window's 16 lanes
};

/// What is the same for all triangles of a draw.
struct BatchConstants {
  PixelRect region;
  bool drops_positive, drops_negative;  ///< culled, by the sign of the area
  bool provoking_last;
};

}  // namespace vitrine::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using I = hn::CappedTag<std::int32_t, TriangleBatch::kSize>;
using V = hn::Vec<I>;

HWY_INLINE V constant(std::int32_t value) { return hn::Set(I(), value); }
HWY_INLINE V constant(BatchStep step) { return constant(static_cast<std::int32_t>(step)); }

/// Value of an edge function (cover_window) at the window's first pixel, and its steps.
struct LaneEdge {
  V value, step_x, step_y;

  HWY_INLINE LaneEdge(V x, V y, V next_x, V next_y, V window_x, V window_y) {
    const V a = hn::Sub(y, next_y), b = hn::Sub(x, next_x), zero = hn::Zero(I());
    const auto owns = hn::Or(hn::Lt(a, zero), hn::And(hn::Eq(a, zero), hn::Gt(b, zero)));
    step_x = hn::Sub(zero, hn::ShiftLeft<8>(a));
    step_y = hn::ShiftLeft<8>(b);
    const V at =
        hn::Sub(hn::Mul(a, hn::Sub(x, hn::ShiftLeft<8>(window_x))), hn::Mul(b, hn::Sub(y, hn::ShiftLeft<8>(window_y))));
    value = hn::Sub(at, hn::IfThenElseZero(hn::Not(owns), constant(1)));
  }
};

/// Lanes of a 4x4 window, in quad order, that are outside.
HWY_INLINE V outside_lanes(LaneEdge (&edge)[3]) {
  V outside = hn::Zero(I());
  for (std::uint32_t row = 0; row < 4; ++row) {
    V at[3] = {edge[0].value, edge[1].value, edge[2].value};
    for (std::uint32_t column = 0; column < 4; ++column) {
      const V sign = hn::Or(at[0], hn::Or(at[1], at[2]));
      const std::uint32_t lane = (row / 2 * 2 + column / 2) * 4 + (row & 1) * 2 + (column & 1);
      outside = hn::Or(outside, hn::And(hn::BroadcastSignBit(sign), constant(1 << lane)));
      for (std::uint32_t e = 0; e < 3; ++e) at[e] = hn::Add(at[e], edge[e].step_x);
    }
    for (LaneEdge& e : edge) e.value = hn::Add(e.value, e.step_y);
  }
  return outside;
}

void find_facts(const TriangleBatch& batch, const BatchConstants& constants, BatchFacts& out) {
  const I d;
  for (std::uint32_t i = 0; i < batch.count; i += hn::Lanes(d)) {
    const V x0 = hn::Load(d, batch.x[0] + i), x1 = hn::Load(d, batch.x[1] + i), x2 = hn::Load(d, batch.x[2] + i);
    const V y0 = hn::Load(d, batch.y[0] + i), y1 = hn::Load(d, batch.y[1] + i), y2 = hn::Load(d, batch.y[2] + i);
    const V left = hn::Min(x0, hn::Min(x1, x2)), right = hn::Max(x0, hn::Max(x1, x2));
    const V top = hn::Min(y0, hn::Min(y1, y2)), bottom = hn::Max(y0, hn::Max(y1, y2));
    // Near each other and inside of what setup_triangle() takes: the area fits 32 bits, of small triangles the edges,
    // too. Lanes where they do not do not matter.
    constexpr std::int32_t kLimit = 1 << 23, kReach = 8 * 256, kFarReach = 64 * 256;
    const auto wild = hn::Or(hn::Or(hn::Lt(left, constant(-kLimit)), hn::Lt(top, constant(-kLimit))),
                             hn::Or(hn::Gt(right, constant(kLimit)), hn::Gt(bottom, constant(kLimit))));
    const V extent = hn::Max(hn::Sub(right, left), hn::Sub(bottom, top));
    const auto near = hn::Not(hn::Or(wild, hn::Gt(extent, constant(kFarReach))));
    const auto small = hn::Lt(extent, constant(kReach + 1));
    const V area = hn::Sub(hn::Mul(hn::Sub(x0, x1), hn::Sub(y2, y0)), hn::Mul(hn::Sub(x2, x0), hn::Sub(y0, y1)));
    const V zero = hn::Zero(d);
    auto dropped = hn::Eq(area, zero);
    if (constants.drops_positive) dropped = hn::Or(dropped, hn::Gt(area, zero));
    if (constants.drops_negative) dropped = hn::Or(dropped, hn::Lt(area, zero));
    // Pixel centres are whole: windows are for single-sampled draws.
    const V px0 = hn::ShiftRight<8>(hn::Add(left, constant(255))), py0 = hn::ShiftRight<8>(hn::Add(top, constant(255)));
    const V px1 = hn::ShiftRight<8>(hn::Sub(right, constant(1))), py1 = hn::ShiftRight<8>(hn::Sub(bottom, constant(1)));
    const PixelRect& region = constants.region;
    const V cut_x0 = hn::Max(px0, constant(region.x0)), cut_y0 = hn::Max(py0, constant(region.y0));
    dropped = hn::Or(dropped, hn::Lt(hn::Min(px1, constant(region.x1)), cut_x0));
    dropped = hn::Or(dropped, hn::Lt(hn::Min(py1, constant(region.y1)), cut_y0));
    const V window_x = hn::And(cut_x0, constant(~1)), window_y = hn::And(cut_y0, constant(~1));
    const V beyond_x = hn::Sub(px1, window_x), beyond_y = hn::Sub(py1, window_y);
    const auto tiny = hn::And(hn::Lt(beyond_x, constant(4)), hn::Lt(beyond_y, constant(4)));
    const auto fits = hn::And(hn::Lt(beyond_x, constant(8)), hn::Lt(beyond_y, constant(8)));
    const V seen_x = hn::Sub(hn::Min(px1, constant(region.x1)), window_x);
    const V seen_y = hn::Sub(hn::Min(py1, constant(region.y1)), window_y);
    const auto wide = hn::Gt(hn::Max(seen_x, seen_y), constant(7));
    V step = hn::IfThenElse(wide, constant(BatchStep::kWide), constant(BatchStep::kAlone));
    step = hn::IfThenElse(hn::And(fits, small), constant(BatchStep::kWindow), step);
    step = hn::IfThenElse(hn::And(tiny, small), constant(BatchStep::kSmallWindow), step);
    step = hn::IfThenElse(dropped, constant(BatchStep::kDrop), step);
    step = hn::IfThenElse(near, step, constant(BatchStep::kAlone));
    hn::Store(step, d, reinterpret_cast<std::int32_t*>(out.step) + i);
    // 2.1: the provoking vertex keeps its place.
    const auto negative = hn::Lt(area, zero);
    const bool last = constants.provoking_last;
    const V ax = last ? hn::IfThenElse(negative, x1, x0) : x0, ay = last ? hn::IfThenElse(negative, y1, y0) : y0;
    const V bx = hn::IfThenElse(negative, last ? x0 : x2, x1), by = hn::IfThenElse(negative, last ? y0 : y2, y1);
    const V cx = last ? x2 : hn::IfThenElse(negative, x1, x2), cy = last ? y2 : hn::IfThenElse(negative, y1, y2);
    const V corner_x[3] = {ax, bx, cx}, corner_y[3] = {ay, by, cy};
    for (std::size_t c = 0; c < 3; ++c) {
      hn::Store(corner_x[c], d, out.x[c] + i);
      hn::Store(corner_y[c], d, out.y[c] + i);
    }
    hn::Store(area, d, out.area + i);
    hn::Store(px0, d, out.x0 + i);
    hn::Store(py0, d, out.y0 + i);
    hn::Store(px1, d, out.x1 + i);
    hn::Store(py1, d, out.y1 + i);
    if (hn::AllFalse(d, hn::Eq(step, constant(BatchStep::kSmallWindow)))) continue;
    LaneEdge edge[3] = {{ax, ay, bx, by, window_x, window_y},
                        {bx, by, cx, cy, window_x, window_y},
                        {cx, cy, ax, ay, window_x, window_y}};
    hn::Store(outside_lanes(edge), d, reinterpret_cast<std::int32_t*>(out.outside) + i);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(find_facts);

namespace {

/// Coverage of a triangle's window, cut to the draw region.
base::LaneMask window_of(const BatchFacts& facts, std::uint32_t i, const PixelRect& bounds, const PixelRect& visible) {
  const int x = visible.x0 & ~1, y = visible.y0 & ~1;
  base::LaneMask window;
  if (facts.step[i] == BatchStep::kSmallWindow) {
    window = block_of_small_window(~facts.outside[i] & 0xffffu);
  } else {
    const std::int32_t corner_x[3] = {facts.x[0][i], facts.x[1][i], facts.x[2][i]};
    const std::int32_t corner_y[3] = {facts.y[0][i], facts.y[1][i], facts.y[2][i]};
    window = cover_window(corner_x, corner_y, x, y, false);
  }
  return cut_window(window, x, y, bounds, visible);
}

}  // namespace

void setup_triangles(SetupContext context, TriangleBatch& batch) {
  const PipelinePlan& plan = *context.plan;
  const State& state = *plan.state;
  const bool counter_clockwise = state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE;
  const bool drops_front = (state.cull_mode & VK_CULL_MODE_FRONT_BIT) != 0;
  const bool drops_back = (state.cull_mode & VK_CULL_MODE_BACK_BIT) != 0;
  const bool last = state.provoking_vertex_last;
  const BatchConstants constants{plan.region[context.viewport], counter_clockwise ? drops_front : drops_back,
                                 counter_clockwise ? drops_back : drops_front, last};
  BatchFacts facts;
  HWY_DYNAMIC_DISPATCH(find_facts)(batch, constants, facts);
  const std::uint32_t count = batch.count;
  batch.count = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (facts.step[i] == BatchStep::kDrop) continue;
    context.id = batch.id[i];
    if (facts.step[i] == BatchStep::kAlone) {
      const auto corner = [&](int c) { return SetupVertex{batch.record[c][i], batch.x[c][i], batch.y[c][i]}; };
      setup_triangle(context, corner(0), corner(1), corner(2));
      continue;
    }
    const PixelRect bounds{facts.x0[i], facts.y0[i], facts.x1[i], facts.y1[i]};
    const PixelRect visible = intersect(bounds, constants.region);
    base::LaneMask window = 0;
    if (facts.step[i] != BatchStep::kWide) {
      window = window_of(facts, i, bounds, visible);
      if (window == 0) continue;
    }
    const bool positive = facts.area[i] > 0;
    Primitive& p = context.out->append();
    for (int c = 0; c < 3; ++c) {
      p.x[c] = facts.x[c][i];
      p.y[c] = facts.y[c][i];
    }
    p.v[0] = batch.record[!positive && last ? 1 : 0][i];
    p.v[1] = batch.record[positive ? 1 : last ? 0 : 2][i];
    p.v[2] = batch.record[positive || last ? 2 : 1][i];
    complete_triangle(context, {positive == counter_clockwise, visible, window}, p);
  }
}

}  // namespace vitrine::raster
#endif
