// Plane equations and their evaluation, a vector of planes or of lanes at a time.
#include "raster/tile/interpolate.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "base/x86_arithmetic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile/interpolate.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"
#include "raster/lane_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::x86_add;
using base::HWY_NAMESPACE::x86_div;
using base::HWY_NAMESPACE::x86_fma;
using base::HWY_NAMESPACE::x86_mul;
using base::HWY_NAMESPACE::x86_sub;
using F = hn::ScalableTag<float>;
using Quad = hn::FixedTag<float, 4>;
using VF = hn::Vec<F>;
using P = hn::CappedTag<float, 8>;  ///< planes of a primitive: most have no more
using VP = hn::Vec<P>;

/// Places of the lanes of one row of quads.
alignas(64) constexpr float kRowX[16] = {0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7};
alignas(64) constexpr float kRowY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

/// Values of planes [i, i + lanes) at one vertex: perspective ones times its 1/w (a product with 1 changes nothing).
HWY_INLINE VP vertex_values(const Vertex* v, std::size_t i, std::size_t perspective_end) {
  const P f;
  const VP raw = hn::LoadU(f, v + 2 + i);  // z is word 2: planes follow the record's order
  const VP place = hn::Iota(f, static_cast<float>(i));
  const auto perspective =
      hn::And(hn::Ge(place, hn::Set(f, 2.0f)), hn::Lt(place, hn::Set(f, static_cast<float>(perspective_end))));
  return x86_mul(raw, hn::IfThenElse(perspective, hn::Set(f, v[3]), hn::Set(f, 1.0f)));
}

/// PlaneSet::unit_w from the first vector of planes.
HWY_INLINE bool has_unit_w(VP a0, VP dadx, VP dady) {
  static_assert(kReciprocalWPlane < hn::MaxLanes(P()));
  const P f;
  const auto unit =
      hn::And(hn::And(hn::Eq(dadx, hn::Zero(f)), hn::Eq(dady, hn::Zero(f))), hn::Eq(a0, hn::Set(f, 1.0f)));
  return (bits_of_mask(unit) >> kReciprocalWPlane & 1) != 0;
}

/// 4.1, over all planes at once.
void triangle_planes(const Primitive& p, float po, std::size_t count, std::size_t perspective_end, PlaneSet& out) {
  const P f;
  const Vertex *v0 = p.v[0], *v1 = p.v[1], *v2 = p.v[2];
  const auto apart = [&](const Vertex* from, const Vertex* to, int axis) {
    return base::x86_sub(from[axis], to[axis]);
  };
  const float dx01 = apart(v0, v1, 0), dy01 = apart(v0, v1, 1), dx20 = apart(v2, v0, 0), dy20 = apart(v2, v0, 1);
  const float ooa = base::x86_div(1.0f, base::x86_sub(base::x86_mul(dx01, dy20), base::x86_mul(dy01, dx20)));
  const VP x20 = hn::Set(f, base::x86_mul(dx20, ooa)), y20 = hn::Set(f, base::x86_mul(dy20, ooa));
  const VP x01 = hn::Set(f, base::x86_mul(dx01, ooa)), y01 = hn::Set(f, base::x86_mul(dy01, ooa));
  const VP xc = hn::Set(f, base::x86_sub(v0[0], po)), yc = hn::Set(f, base::x86_sub(v0[1], po));
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const VP a0 = vertex_values(v0, i, perspective_end);
    const VP d01 = x86_sub(a0, vertex_values(v1, i, perspective_end));
    const VP d20 = x86_sub(vertex_values(v2, i, perspective_end), a0);
    const VP dadx = x86_sub(x86_mul(d01, y20), x86_mul(d20, y01));
    const VP dady = x86_sub(x86_mul(d20, x01), x86_mul(d01, x20));
    const VP origin = x86_sub(a0, x86_add(x86_mul(dadx, xc), x86_mul(dady, yc)));
    hn::Store(dadx, f, out.dadx + i);
    hn::Store(dady, f, out.dady + i);
    hn::Store(origin, f, out.a0 + i);
    if (i == 0) out.unit_w = has_unit_w(origin, dadx, dady);
  }
}

/// 6.3: `idx`, `idy` are the line's direction, or its deltas of Bresenham mode.
void line_planes(const Primitive& p, float idx, float idy, float ooa, std::size_t count, std::size_t perspective_end,
                 PlaneSet& out) {
  const P f;
  const Vertex *v1 = p.v[0], *v2 = p.v[1];
  const VP xc = hn::Set(f, v1[0] - 0.5f), yc = hn::Set(f, v1[1] - 0.5f);
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const VP a1 = vertex_values(v1, i, perspective_end);
    const VP d = x86_sub(a1, vertex_values(v2, i, perspective_end));
    const VP dadx = x86_mul(x86_mul(d, hn::Set(f, idx)), hn::Set(f, ooa));
    const VP dady = x86_mul(x86_mul(d, hn::Set(f, idy)), hn::Set(f, ooa));
    hn::Store(dadx, f, out.dadx + i);
    hn::Store(dady, f, out.dady + i);
    const VP origin = x86_sub(a1, x86_add(x86_mul(dadx, xc), x86_mul(dady, yc)));
    hn::Store(origin, f, out.a0 + i);
    if (i == 0) out.unit_w = has_unit_w(origin, dadx, dady);
  }
}

void point_planes(const Primitive& p, std::size_t count, std::size_t perspective_end, PlaneSet& out) {
  const P f;
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const VP origin = vertex_values(p.v[0], i, perspective_end);
    hn::Store(origin, f, out.a0 + i);
    hn::Store(hn::Zero(f), f, out.dadx + i);
    hn::Store(hn::Zero(f), f, out.dady + i);
    if (i == 0) out.unit_w = has_unit_w(origin, hn::Zero(f), hn::Zero(f));
  }
}

void evaluate(const WavePlanes& wave, std::uint32_t plane, const WavePoints& points, const float* scale, float* out) {
  if (wave.slots == 1) {
    const F f;
    const PlaneSet& set = *wave.set[0];
    const VF a0 = hn::Set(f, set.a0[plane]), dadx = hn::Set(f, set.dadx[plane]), dady = hn::Set(f, set.dady[plane]);
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(f)) {
      VF v = x86_fma(dady, hn::Load(f, points.y + i), x86_fma(dadx, hn::Load(f, points.x + i), a0));
      if (scale) v = x86_mul(v, hn::Load(f, scale + i));
      hn::Store(v, f, out + i);
    }
    return;
  }
  // Vectors may reach into the quads of the next primitives, which come after and write theirs again.
  std::size_t lane = 0;
  for (std::uint32_t slot = 0; slot < wave.slots; ++slot) {
    const PlaneSet& set = *wave.set[slot];
    const std::size_t end = std::size_t{4} * wave.end[slot];
    const auto step = [&](auto d) {
      const auto inner = x86_fma(hn::Set(d, set.dadx[plane]), hn::LoadU(d, points.x + lane), hn::Set(d, set.a0[plane]));
      auto v = x86_fma(hn::Set(d, set.dady[plane]), hn::LoadU(d, points.y + lane), inner);
      if (scale) v = x86_mul(v, hn::LoadU(d, scale + lane));
      hn::StoreU(v, d, out + lane);
      lane += hn::Lanes(d);
    };
    const hn::CappedTag<float, 16> wide;
    const std::size_t last = base::kWaveWidth - hn::Lanes(wide);
    while (lane < end && lane <= last) step(wide);
    while (lane < end) step(Quad());
    lane = end;
  }
}

/// Each group of four lanes gets one quad's value: lanes i of vector j take quad j * (lanes / 4) + i / 4.
template <class Offset>
HWY_INLINE void spread_quads(const std::uint16_t* quads, const float* steps, Offset offset, float* out) {
  const F f;
  const hn::Rebind<std::int32_t, F> i32;
  const hn::Rebind<std::uint16_t, F> u16;
  const std::size_t n = hn::Lanes(f);
  const VF step = hn::Load(f, steps);
  const auto group = hn::ShiftRight<2>(hn::Iota(i32, 0));
  for (std::size_t g = 0; g < base::kQuadsPerWave; g += n) {
    const VF values = hn::ConvertTo(f, hn::PromoteTo(i32, hn::LoadU(u16, quads + g)));
    for (std::size_t j = 0; j < 4; ++j) {
      const auto place = hn::Add(group, hn::Set(i32, static_cast<std::int32_t>(j * n / 4)));
      const VF v = hn::TableLookupLanes(values, hn::IndicesFromVec(f, place));
      hn::Store(hn::Add(hn::Add(v, step), offset), f, out + 4 * g + j * n);
    }
  }
}

/// Places of the lanes of a quad, for any vector length.
alignas(64) constexpr float kQuadX[16] = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
alignas(64) constexpr float kQuadY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

void points_of_quads(const QuadPositions& quads, float dx, float dy, WavePoints& out) {
  const F f;
  spread_quads(quads.x, kQuadX, hn::Set(f, dx), out.x);
  spread_quads(quads.y, kQuadY, hn::Set(f, dy), out.y);
}

void reciprocals(const float* in, float* out) {
  const F f;
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(f))
    hn::Store(x86_div(hn::Set(f, 1.0f), hn::Load(f, in + i)), f, out + i);
}

void block_depth(const DepthPlane& plane, float x, float y, bool restricted, float* out) {
  const hn::CappedTag<float, 16> f;
  const auto a0 = hn::Set(f, plane.a0), dadx = hn::Set(f, plane.dadx), dady = hn::Set(f, plane.dady);
  const auto offset = hn::Set(f, plane.offset);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    // Both sums are exact: whole numbers, or a sample's eighths on top of them.
    const auto fx = hn::Add(hn::Set(f, x), hn::Load(f, kRowX + i));
    const auto inner = x86_fma(dadx, fx, a0);
    for (std::size_t r = 0; r < 4; ++r) {
      const auto fy = hn::Add(hn::Set(f, y + static_cast<float>(2 * r)), hn::Load(f, kRowY + i));
      auto z = x86_add(x86_fma(dady, fy, inner), offset);
      if (restricted) {
        const auto low = base::HWY_NAMESPACE::lanes_min_second(z, hn::Set(f, 1.0f));
        z = base::HWY_NAMESPACE::lanes_max_second(low, hn::Zero(f));
      }
      hn::Store(z, f, out + r * 16 + i);
    }
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {
namespace {

HWY_EXPORT(triangle_planes);
HWY_EXPORT(line_planes);
HWY_EXPORT(point_planes);
HWY_EXPORT(evaluate);
HWY_EXPORT(reciprocals);
HWY_EXPORT(points_of_quads);
HWY_EXPORT(block_depth);

struct LineDeltas {
  float idx, idy, ooa;
};
LineDeltas line_deltas(const State& state, const Primitive& p) {
  const Vertex *v1 = p.v[0], *v2 = p.v[1];
  const float dx = v1[0] - v2[0], dy = v1[1] - v2[1];
  LineDeltas deltas{dx, dy, 1.0f / (dx * dx + dy * dy)};
  if (state.line_mode != VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) return deltas;
  if (std::fabs(dx) >= std::fabs(dy)) {
    const float m = dy / dx;
    deltas.idx = dx * (1 + m * m);
    deltas.idy = 0;
  } else {
    const float m = dx / dy;
    deltas.idx = 0;
    deltas.idy = dy * (1 + m * m);
  }
  return deltas;
}

/// 7.2: gl_PointCoord, as a perspective input.
void point_coord_planes(const Primitive& p, std::uint32_t plane, PlaneSet& out) {
  const float w = p.v[0][3];
  const float d = 256 / static_cast<float>(p.x[1] - p.x[0]);
  const float ax = p.v[0][0] - 0.5f, ay = p.v[0][1] - 0.5f;
  const float x0 = static_cast<float>(0.5 - static_cast<double>(d * ax + 0 * ay));
  const float y0 = static_cast<float>(0.5 - static_cast<double>(0 * ax + d * ay));
  out.a0[plane] = base::x86_mul(x0, w);
  out.dadx[plane] = base::x86_mul(d, w);
  out.dady[plane] = base::x86_mul(0, w);
  out.a0[plane + 1] = base::x86_mul(y0, w);
  out.dadx[plane + 1] = base::x86_mul(0, w);
  out.dady[plane + 1] = base::x86_mul(d, w);
}

}  // namespace

void compute_planes(const PipelinePlan& plan, const Primitive& p, PlaneSet& out) {
  const std::size_t perspective_end = kFirstVaryingPlane + plan.perspective_count;
  const std::size_t count = perspective_end + plan.linear_count;
  if (is_area(p.kind)) {
    HWY_DYNAMIC_DISPATCH(triangle_planes)(p, plan.pixel_offset, count, perspective_end, out);
  } else if (p.kind == PrimitiveKind::kLine) {
    const LineDeltas d = line_deltas(*plan.state, p);
    HWY_DYNAMIC_DISPATCH(line_planes)(p, d.idx, d.idy, d.ooa, count, perspective_end, out);
  } else {
    HWY_DYNAMIC_DISPATCH(point_planes)(p, count, perspective_end, out);
  }
  if (plan.frag.point_coord[0] == kNoReg && plan.frag.point_coord[1] == kNoReg) return;
  const auto plane = static_cast<std::uint32_t>(count);
  if (p.kind == PrimitiveKind::kPoint) {
    point_coord_planes(p, plane, out);
  } else {
    for (std::uint32_t i = plane; i < plane + 2; ++i) out.a0[i] = out.dadx[i] = out.dady[i] = 0;
  }
}

void evaluate_plane(const WavePlanes& wave, std::uint32_t plane, const WavePoints& points, const float* scale,
                    float* out) {
  HWY_DYNAMIC_DISPATCH(evaluate)(wave, plane, points, scale, out);
}

void place_points(const QuadPositions& quads, float dx, float dy, WavePoints& out) {
  HWY_DYNAMIC_DISPATCH(points_of_quads)(quads, dx, dy, out);
}

void place_fragments(const QuadPositions& quads, FragmentRate rate, float dx, float dy, WavePoints& out) {
  const auto width = static_cast<float>(width_of(rate)), height = static_cast<float>(height_of(rate));
  // All sums are exact: halves, or a sample's sixteenths.
  const float x = (width - 1) / 2 + dx, y = (height - 1) / 2 + dy;
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const std::size_t quad = lane / 4;
    out.x[lane] = static_cast<float>(quads.x[quad]) + ((lane & 1) != 0 ? width : 0) + x;
    out.y[lane] = static_cast<float>(quads.y[quad]) + ((lane & 2) != 0 ? height : 0) + y;
  }
}

void reciprocal(const float* in, float* out) { HWY_DYNAMIC_DISPATCH(reciprocals)(in, out); }

void evaluate_block_depth(const DepthPlane& plane, float x, float y, bool restricted, float* out) {
  HWY_DYNAMIC_DISPATCH(block_depth)(plane, x, y, restricted, out);
}

}  // namespace vitrine::raster
#endif
