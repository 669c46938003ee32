// Setup of triangles: culling, facing, interpolation order, depth bias, bounds. Lines and points: setup_wide.cpp.
#include "raster/front/setup.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/numeric.h"
#include "raster/front/window_coverage.h"
#include "texel/format.h"

namespace vitrine::raster {
namespace {

/// 5.1: the constant term in the units of the format, plus the slope term, clamped.
float bias_offset(const State& state, const PassDesc& pass, float slope_term, float largest_z) {
  const texel::FormatDesc* format = pass.depth.format;
  const bool floats = format && format->channel[0].numeric == texel::Numeric::kSfloat;
  const DepthBiasUnit unit_kind = state.depth_bias_unit;
  const bool exact = unit_kind == DepthBiasUnit::kExactFormat || unit_kind == DepthBiasUnit::kExactUnorm;
  const bool unorm = unit_kind == DepthBiasUnit::kUnorm || unit_kind == DepthBiasUnit::kExactUnorm;
  float offset;
  if (unit_kind == DepthBiasUnit::kOne) {
    offset = state.depth_bias_constant + slope_term;
  } else if (floats && !unorm) {
    const auto exponent = static_cast<std::int32_t>(base::bits_of(largest_z) & 0x7f800000u) - (23 << 23);
    const float unit = base::float_of(static_cast<std::uint32_t>(std::max(exponent, 0)));
    offset = unit * state.depth_bias_constant + slope_term;
  } else {
    // Of floats the mantissa's bits and one.
    const int bits = format && format->channel[0].bits == 16 ? 16 : 24;
    // Vulkan 1.4.309, Depth Bias: "must be at most r = 2 x 2^-n"; of units that are asked for the reference knows
    // nothing.
    const double unit = exact || unorm ? std::ldexp(1.0, -bits) : 1.0 / static_cast<double>((1 << bits) - 1) * 2;
    offset = static_cast<float>(static_cast<double>(state.depth_bias_constant) * unit) + slope_term;
  }
  const float clamp = state.depth_bias_clamp;
  if (clamp > 0) offset = std::min(clamp, offset);
  if (clamp < 0) offset = std::max(clamp, offset);
  return offset;
}

float largest_depth(const Vertex* v0, const Vertex* v1, const Vertex* v2) {
  return std::max({std::fabs(v0[2]), std::fabs(v1[2]), std::fabs(v2[2])});
}

/// First form, for filled triangles: `v` in interpolation order.
float triangle_bias(const SetupContext& context, const Vertex* const v[3]) {
  const float dx01 = v[0][0] - v[1][0], dy01 = v[0][1] - v[1][1], dz01 = v[0][2] - v[1][2];
  const float dx20 = v[2][0] - v[0][0], dy20 = v[2][1] - v[0][1], dz20 = v[2][2] - v[0][2];
  const float ooa = 1.0f / (dx01 * dy20 - dy01 * dx20);
  const float r0 = dz20 * dy01 - dy20 * dz01;
  const float r1 = dx20 * dz01 - dz20 * dx01;
  const float a = std::fabs(r0 * ooa), b = std::fabs(r1 * ooa);
  const float slope = (b > a ? b : a) * context.plan->state->depth_bias_slope;
  return bias_offset(*context.plan->state, *context.pass, slope, largest_depth(v[0], v[1], v[2]));
}

bool cull_facing(const State& state, bool front) {
  return (state.cull_mode & (front ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT)) != 0;
}

/// deviations.md, multisample-scissor: a pixel further, but not into another tile.
void leak(PixelRect& region) {
  region.x0 -= region.x0 % kTileSize != 0 ? 1 : 0;
  region.y0 -= region.y0 % kTileSize != 0 ? 1 : 0;
}

/// Extent up to which edge functions near the triangle fit 32 bits with ease: 16 pixels.
constexpr std::int32_t kWindowReach = 16 * 256;

}  // namespace

PixelRect pixels_between(const PipelinePlan& plan, std::int32_t left, std::int32_t top, std::int32_t right,
                         std::int32_t bottom) {
  const int first = plan.raster_samples > 1 ? 0 : plan.overestimates ? 128 : 255;
  const int last = plan.overestimates ? first - 1 : -1;
  return {(left + first) >> 8, (top + first) >> 8, (right + last) >> 8, (bottom + last) >> 8};
}

std::int32_t snap_coordinate(float window, float pixel_offset) {
  const float scaled = (window - pixel_offset) * 256.0f;
  if (!(scaled >= -2147483648.0f && scaled < 2147483648.0f)) return INT32_MIN;
  return static_cast<std::int32_t>(std::lrintf(scaled));
}

float window_determinant(const Vertex* v0, const Vertex* v1, const Vertex* v2) {
  const float ex = v0[0] - v2[0], ey = v0[1] - v2[1], fx = v1[0] - v2[0], fy = v1[1] - v2[1];
  return ex * fy - ey * fx;
}

bool culled_by_determinant(const State& state, float determinant) {
  if (state.cull_mode == VK_CULL_MODE_NONE) return false;
  if (determinant == 0) return (state.cull_mode & VK_CULL_MODE_BACK_BIT) != 0;
  return cull_facing(state, (determinant < 0) == (state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE));
}

float vertex_depth_bias(const PipelinePlan& plan, const PassDesc& pass, const Vertex* v0, const Vertex* v1,
                        const Vertex* v2) {
  const float ex = v0[0] - v2[0], ey = v0[1] - v2[1], ez = v0[2] - v2[2];
  const float fx = v1[0] - v2[0], fy = v1[1] - v2[1], fz = v1[2] - v2[2];
  const float inverse = 1.0f / (ex * fy - ey * fx);
  const float a = std::fabs((ey * fz - ez * fy) * inverse), b = std::fabs((ez * fx - ex * fz) * inverse);
  const float slope = base::max_second(a, b) * plan.state->depth_bias_slope;  // zero area: NaN, if b is
  return bias_offset(*plan.state, pass, slope, largest_depth(v0, v1, v2));
}

void complete_triangle(const SetupContext& context, const TriangleFacts& facts, Primitive& p) {
  const PipelinePlan& plan = *context.plan;
  p.depth_offset = plan.depth_bias && !context.of_line && !plan.bias_in_vertices ? triangle_bias(context, p.v) : 0.0f;
  p.id = context.id;
  p.x0 = static_cast<std::uint16_t>(facts.visible.x0);
  p.y0 = static_cast<std::uint16_t>(facts.visible.y0);
  p.x1 = static_cast<std::uint16_t>(facts.visible.x1);
  p.y1 = static_cast<std::uint16_t>(facts.visible.y1);
  p.window = facts.window;
  p.layer = context.layer;
  p.viewport = context.viewport;
  p.rate = context.rate;
  p.kind = PrimitiveKind::kTriangle;
  p.front = facts.front;
  p.provoking = context.of_line || plan.state->provoking_vertex_last ? 2 : 0;
}

void setup_triangle(const SetupContext& context, const SetupVertex& v0, const SetupVertex& v1, const SetupVertex& v2) {
  const PipelinePlan& plan = *context.plan;
  const State& state = *plan.state;
  // Differences wrap like the reference's 32-bit subtraction; such triangles are dropped below.
  const auto minus = [](std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
  };
  const std::int64_t area =
      std::int64_t{minus(v0.x, v1.x)} * minus(v2.y, v0.y) - std::int64_t{minus(v2.x, v0.x)} * minus(v0.y, v1.y);
  if (area == 0) return context.tell(PrimitiveFate::kZeroArea);
  const bool faces = (area > 0) == (state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE);
  const bool front = context.of_line ? context.line_front : faces;
  if (!context.of_line && cull_facing(state, front)) return context.tell(PrimitiveFate::kFacing);
  const std::int32_t left = std::min({v0.x, v1.x, v2.x}), right = std::max({v0.x, v1.x, v2.x});
  const std::int32_t top = std::min({v0.y, v1.y, v2.y}), bottom = std::max({v0.y, v1.y, v2.y});
  // Positions that no viewport can give come from NaN and infinities; edge arithmetic need not cope with them.
  constexpr std::int32_t kLimit = 1 << 23;
  if (left < -kLimit || top < -kLimit || right > kLimit || bottom > kLimit || right - left > kLimit ||
      bottom - top > kLimit)
    return context.tell(PrimitiveFate::kTooFar);
  const PixelRect bounds = pixels_between(plan, left, top, right, bottom);
  PixelRect region = plan.region[context.viewport];
  if (plan.as_reference.leaks_scissor) leak(region);
  const PixelRect visible = intersect(bounds, region);
  if (visible.empty()) return context.tell(bounds.empty() ? PrimitiveFate::kNoSample : PrimitiveFate::kScissor);
  base::LaneMask window = 0;
  const int wx = visible.x0 & ~1, wy = visible.y0 & ~1;
  if (plan.windows && visible.x1 - wx < 8 && visible.y1 - wy < 8 && right - left <= kWindowReach &&
      bottom - top <= kWindowReach) {
    const SetupVertex *second = area < 0 ? &v2 : &v1, *third = area < 0 ? &v1 : &v2;  // either rotation will do
    const std::int32_t x[3] = {v0.x, second->x, third->x}, y[3] = {v0.y, second->y, third->y};
    window = cover_window(x, y, wx, wy, bounds.x1 - wx < 4 && bounds.y1 - wy < 4);
    window = cut_window(window, wx, wy, bounds, visible);
    if (window == 0) return;
  }

  Primitive& p = context.out->append();
  const SetupVertex* order[3] = {&v0, &v1, &v2};
  if (area < 0) {  // 2.1: the provoking vertex keeps its place
    if (context.of_line || state.provoking_vertex_last)
      std::swap(order[0], order[1]);
    else
      std::swap(order[1], order[2]);
  }
  for (int i = 0; i < 3; ++i) {
    p.v[i] = order[i]->record;
    p.x[i] = order[i]->x;
    p.y[i] = order[i]->y;
  }
  complete_triangle(context, {front, visible, window}, p);
}

}  // namespace vitrine::raster
