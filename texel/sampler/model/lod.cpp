// Derivatives, rho, level of detail and cube faces, in the operation order of lavapipe-texture-blend.md A4, A5 and A8.
#include "texel/sampler/model/lod.h"

#include <algorithm>
#include <cmath>

#include "base/numeric.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;
using base::max_second;
using base::min_second;

constexpr std::uint32_t kSignBit = 0x80000000u;

float value_at(const base::WaveRegister* values, std::size_t lane) {
  return values != nullptr ? float_of(values->lane[lane]) : 0.0f;
}

float flip_sign(float value, std::uint32_t sign) { return float_of(bits_of(value) ^ sign); }

/// Which component is major: 0, 1, 2 for x, y, z. Ties prefer z, then y.
int major_axis(const float v[3]) {
  const float s = std::fabs(v[0]), t = std::fabs(v[1]), r = std::fabs(v[2]);
  if (!(r < max_second(s, t))) return 2;
  return !(s <= t) ? 0 : 1;
}

/// The face's (sc, tc) of a direction or of its derivative.
void face_coordinates(const float v[3], int axis, std::uint32_t sign, float& sc, float& tc) {
  if (axis == 0) {
    sc = flip_sign(v[2], sign ^ kSignBit);
    tc = -v[1];
  } else if (axis == 1) {
    sc = v[0];
    tc = flip_sign(v[2], sign);
  } else {
    sc = flip_sign(v[0], sign);
    tc = -v[1];
  }
}

/// d(u) of a projected coordinate.
float projected_derivative(float d_coord, float coord, float d_major_over_major, float half_inverse) {
  return (d_coord - d_major_over_major * coord) * half_inverse;
}

void project_cube(LanePoint& point, bool with_derivatives) {
  const float v[3] = {point.coord[0], point.coord[1], point.coord[2]};
  const int axis = major_axis(v);
  const float major = v[axis];
  const std::uint32_t sign = bits_of(major) & kSignBit;
  float sc = 0, tc = 0;
  face_coordinates(v, axis, sign, sc, tc);
  point.face = static_cast<std::uint32_t>(2 * axis) + (sign >> 31);
  float scale = 0;
  if (with_derivatives) {
    const float inverse = 1.0f / major;
    const float half = 0.5f * inverse;
    float* const derivatives[2] = {point.ddx, point.ddy};
    for (float* d : derivatives) {
      float d_sc = 0, d_tc = 0;
      face_coordinates(d, axis, sign, d_sc, d_tc);
      const float d_major = d[axis] * inverse;
      d[0] = projected_derivative(d_sc, sc, d_major, half);
      d[1] = projected_derivative(d_tc, tc, d_major, half);
    }
    scale = std::fabs(half);
  } else {
    const float magnitude = std::fabs(major);
    scale = !(magnitude <= 0.0f) ? 0.5f / magnitude : 0.0f;  // NaN stays one
  }
  point.coord[0] = sc * scale + 0.5f;
  point.coord[1] = tc * scale + 0.5f;
}

/// Anisotropic footprints are measured on the face: differences of the quad's projected coordinates.
void set_projected_differences(const SampleRequest& request, std::size_t lane, bool with_derivatives,
                               LanePoint& point) {
  if (!request.quads) return;
  const std::size_t first = lane & ~std::size_t{3};
  LanePoint corner[3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) corner[i].coord[c] = value_at(request.coord[c], first + i);
    project_cube(corner[i], with_derivatives);
  }
  for (std::size_t c = 0; c < 2; ++c) {
    point.ddx[c] = corner[1].coord[c] - corner[0].coord[c];
    point.ddy[c] = corner[2].coord[c] - corner[0].coord[c];
  }
}

float square(float v) { return v * v; }

/// (d0*W)^2 + (d1*H)^2 [+ (d2*D)^2], summed left to right.
float scaled_length(const float d[3], const float size[3], std::uint32_t dims) {
  float sum = square(d[0] * size[0]);
  for (std::uint32_t i = 1; i < dims; ++i) sum = sum + square(d[i] * size[i]);
  return sum;
}

void first_level_size(const Plan& plan, float size[3]) {
  const Extent& extent = plan.view->level[0].extent;
  size[0] = static_cast<float>(extent.width);
  size[1] = static_cast<float>(extent.height);
  size[2] = static_cast<float>(extent.depth);
}

/// rho squared; rho itself for one dimension.
float compute_rho(const Plan& plan, const LanePoint& point, bool given_derivatives) {
  float size[3];
  first_level_size(plan, size);
  float rho = 0;
  // The shorter axis, whatever the ratio: the reference's test of it is never true (A8 step 1).
  if (plan.anisotropic) return min_second(scaled_length(point.ddx, size, 2), scaled_length(point.ddy, size, 2));
  if (plan.dims == 1) {
    rho = max_second(std::fabs(point.ddx[0]), std::fabs(point.ddy[0])) * size[0];
  } else {
    rho = max_second(scaled_length(point.ddx, size, plan.dims), scaled_length(point.ddy, size, plan.dims));
  }
  if (given_derivatives && (bits_of(rho) & 0x7f800000u) == 0x7f800000u) return 0.0f;
  return rho;
}

/// Logarithm to base 2 by linear interpolation between powers of two.
float fast_log2(float v) {
  const std::uint32_t bits = bits_of(v);
  const auto exponent = static_cast<std::int32_t>((bits >> 23) & 255) - 128;
  return static_cast<float>(exponent) + float_of((bits & 0x7fffffu) | 0x3f800000u);
}

/// Levels of a clamped level of detail; `nearest` is its integer for filters that take one level.
void choose_levels(const Plan& plan, Lod& lod, std::int32_t nearest) {
  const auto last = static_cast<std::int32_t>(plan.view->level_count) - 1;
  if (plan.mip == MipFilter::kNone && !plan.anisotropic) return;
  if (plan.mip != MipFilter::kLinear || plan.anisotropic) {
    lod.level0 = lod.level1 = static_cast<std::uint32_t>(std::clamp(nearest, 0, last));
    return;
  }
  const float floor = std::floor(lod.clamped);
  const std::int32_t level = base::truncate_to_int(floor);
  if (level < 0) return;
  lod.level0 = static_cast<std::uint32_t>(std::min(level, last));
  lod.level1 = level >= last ? lod.level0 : lod.level0 + 1;
  lod.fraction = level >= last ? 0.0f : lod.clamped - floor;
}

Lod shortcut(const Plan& plan, float rho) {
  Lod lod;
  lod.minify = !(rho <= 1.0f);  // also of NaN
  const float base = plan.squared_rho ? rho : rho * 1.41421356237309504880f;
  const auto exponent = static_cast<std::int32_t>((bits_of(base) >> 23) & 255);
  choose_levels(plan, lod, plan.squared_rho ? (exponent - 126) >> 1 : exponent - 127);
  return lod;
}

}  // namespace

QuadDerivative coarse_derivative(const base::WaveRegister& coord, std::size_t lane) {
  const std::size_t first = lane & ~std::size_t{3};
  const float origin = float_of(coord.lane[first]);
  return {float_of(coord.lane[first + 1]) - origin, float_of(coord.lane[first + 2]) - origin};
}

QuadDerivative fine_derivative(const base::WaveRegister& coord, std::size_t lane) {
  return {float_of(coord.lane[lane | 1]) - float_of(coord.lane[lane & ~std::size_t{1}]),
          float_of(coord.lane[lane | 2]) - float_of(coord.lane[lane & ~std::size_t{2}])};
}

LanePoint locate(const Plan& plan, const SampleRequest& request, std::size_t lane) {
  LanePoint point;
  const std::uint32_t components = plan.cube ? 3 : plan.dims;
  const bool implicit = request.lod_mode == LodMode::kImplicit || request.lod_mode == LodMode::kBias;
  const bool given = request.lod_mode == LodMode::kGrad;
  const bool cube_derivatives =
      plan.cube && !plan.face_query &&
      ((plan.lod_needed && !plan.lod_fixed && (implicit || given)) || (plan.anisotropic && given));
  for (std::uint32_t i = 0; i < components; ++i) {
    point.coord[i] = value_at(request.coord[i], lane);
    if (given) {
      point.ddx[i] = value_at(request.ddx[i], lane);
      point.ddy[i] = value_at(request.ddy[i], lane);
    } else if (request.coord[i] != nullptr && request.quads && (implicit || plan.anisotropic)) {
      const QuadDerivative d =
          plan.cube ? fine_derivative(*request.coord[i], lane) : coarse_derivative(*request.coord[i], lane);
      point.ddx[i] = d.dx;
      point.ddy[i] = d.dy;
    }
  }
  if (plan.cube) project_cube(point, cube_derivatives);
  if (plan.cube && (plan.anisotropic || plan.face_query) && !given)
    set_projected_differences(request, lane, cube_derivatives, point);
  return point;
}

Lod level_of_detail(const Plan& plan, const SampleRequest& request, const LanePoint& point, std::size_t lane) {
  const Sampler& sampler = *plan.sampler;
  float value = sampler.min_lod;
  if (!plan.lod_fixed) {
    const bool derived = request.lod_mode != LodMode::kExplicit && request.lod_mode != LodMode::kZero;
    if (derived) {
      const bool given = (plan.cube && !plan.face_query) || request.lod_mode == LodMode::kGrad;
      const float rho = compute_rho(plan, point, given);
      if (plan.shortcut_lod && request.min_lod == nullptr) return shortcut(plan, rho);
      value = 0.5f * fast_log2(plan.squared_rho || plan.anisotropic ? rho : rho * rho);
      if (request.lod_mode == LodMode::kBias) value = value + value_at(request.lod, lane);
    } else {
      value = request.lod_mode == LodMode::kExplicit ? value_at(request.lod, lane) : 0.0f;
    }
    if (sampler.mip_lod_bias != 0.0f) value = value + sampler.mip_lod_bias;
  }
  Lod lod;
  lod.value = lod.clamped = value;
  if (plan.apply_max_lod) lod.clamped = min_second(lod.clamped, sampler.max_lod);
  if (plan.apply_min_lod) lod.clamped = max_second(lod.clamped, sampler.min_lod);
  if (request.min_lod != nullptr) lod.clamped = max_second(lod.clamped, value_at(request.min_lod, lane));
  lod.minify = !(lod.clamped <= 0.0f);
  if (plan.view->min_lod != 0.0f) lod.clamped = max_second(lod.clamped, plan.view->min_lod);
  choose_levels(plan, lod, plan.anisotropic ? base::truncate_to_int(lod.clamped) : base::round_to_int(lod.clamped));
  return lod;
}

}  // namespace vitrine::texel
