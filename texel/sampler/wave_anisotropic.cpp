// Anisotropic filtering for whole waves (lavapipe-texture-blend.md A8): the twin of sample_anisotropic, for compressed
// formats and comparisons too. The lanes of a vector walk through their ellipses together, each inside its own bounds.
#include <algorithm>
#include <cstring>

#include "texel/sampler/anisotropic.h"
#include "texel/sampler/prepared.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave_anisotropic.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave_texels-inl.h"
#include "texel/sampler/wave_words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

constexpr std::size_t kMaxLanes = 16;
static_assert(hn::MaxLanes(DU()) <= kMaxLanes);

/// The ellipse of each lane; names as in anisotropic.cpp.
struct EllipseLanes {
  VF tu, tv;
  VF a, b, c;
  VI u0, u1, v0, v1;
};

/// Of the coordinates on the image or on the face.
HWY_INLINE Slopes ellipse_slopes(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                 std::size_t first) {
  Slopes d;
  for (std::size_t i = 0; i < 2; ++i) {
    if (request.lod_mode == LodMode::kGrad) {
      d.x[i] = p.plan.cube ? hn::Load(DF(), state.slope_x[i].lane + first) : load_lanes(request.ddx[i], first);
      d.y[i] = p.plan.cube ? hn::Load(DF(), state.slope_y[i].lane + first) : load_lanes(request.ddy[i], first);
    } else if (request.quads) {
      coarse_slope(hn::LoadU(DF(), state.coord[i] + first), d.x[i], d.y[i]);
    } else {
      d.x[i] = d.y[i] = splat(0.0f);
    }
  }
  return d;
}

HWY_INLINE EllipseLanes make_ellipse(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                     std::size_t first) {
  const ImageView& view = *p.plan.view;
  const VF s = hn::LoadU(DF(), state.coord[0] + first), t = hn::LoadU(DF(), state.coord[1] + first);
  const Slopes slope = ellipse_slopes(p, request, state, first);
  VF scaling = splat(1.0f / static_cast<float>(1u << view.base_level));
  if (!p.one_level) {
    // 2^-level, exactly.
    const VI level = hn::Add(hn::Load(DI(), state.level[0].lane + first), splat(static_cast<int>(view.base_level)));
    scaling = hn::BitCast(DF(), hn::ShiftLeft<23>(hn::Sub(splat(127), level)));
  }
  const VF width = splat(static_cast<float>(view.level0_extent.width));
  const VF height = splat(static_cast<float>(view.level0_extent.height));
  const VF ux = hn::Mul(hn::Mul(slope.x[0], width), scaling), uy = hn::Mul(hn::Mul(slope.y[0], width), scaling);
  const VF vx = hn::Mul(hn::Mul(slope.x[1], height), scaling), vy = hn::Mul(hn::Mul(slope.y[1], height), scaling);
  const VF one = splat(1.0f), four = splat(4.0f), two = splat(2.0f);
  EllipseLanes e;
  e.a = hn::Add(hn::Add(square_of(vx), square_of(vy)), one);
  e.b = hn::Mul(hn::Add(hn::Mul(ux, vx), hn::Mul(uy, vy)), splat(-2.0f));
  e.c = hn::Add(hn::Add(square_of(ux), square_of(uy)), one);
  const VF f = hn::Sub(hn::Mul(e.a, e.c), hn::Div(square_of(e.b), four));
  const VF d = hn::Add(hn::Sub(splat(0.0f), square_of(e.b)), hn::Mul(hn::Mul(e.a, e.c), four));
  const VF box_u = hn::Mul(hn::Div(two, d), hn::Sqrt(hn::Mul(hn::Mul(d, e.c), f)));
  const VF box_v = hn::Mul(hn::Div(two, d), hn::Sqrt(hn::Mul(hn::Mul(e.a, d), f)));
  const VF g = hn::Div(splat(1023.0f), f);
  e.a = hn::Mul(e.a, g);
  e.b = hn::Mul(e.b, g);
  e.c = hn::Mul(e.c, g);
  e.tu = hn::Add(hn::Mul(s, hn::Mul(width, scaling)), splat(-0.5f));
  e.tv = hn::Add(hn::Mul(t, hn::Mul(height, scaling)), splat(-0.5f));
  e.u0 = lanes_floor_to_int(hn::Sub(e.tu, box_u));
  e.u1 = lanes_truncate_to_int(hn::Ceil(hn::Add(e.tu, box_u)));
  e.v0 = lanes_floor_to_int(hn::Sub(e.tv, box_v));
  e.v1 = lanes_truncate_to_int(hn::Ceil(hn::Add(e.tv, box_v)));
  return e;
}

/// Sums of a vector of lanes.
struct Sums {
  VF color[4];
  VF total;
};

/// Whether every lane's box is one that the loops below can walk; else the wave goes lane by lane.
HWY_INLINE bool small_boxes(const EllipseLanes& e, base::LaneMask active) {
  alignas(64) std::int32_t bound[4][kMaxLanes];
  hn::Store(e.u0, DI(), bound[0]);
  hn::Store(e.u1, DI(), bound[1]);
  hn::Store(e.v0, DI(), bound[2]);
  hn::Store(e.v1, DI(), bound[3]);
  bool small = true;
  base::for_each_lane(active & base::first_lanes(hn::Lanes(DI())), [&](std::size_t lane) {
    const std::int64_t width = std::int64_t{bound[1][lane]} - bound[0][lane] + 1;
    const std::int64_t height = std::int64_t{bound[3][lane]} - bound[2][lane] + 1;
    small = small && width > 0 && height > 0 && width < (1 << 12) && height < (1 << 12);
  });
  return small;
}

/// One axis of the level, as the walk needs it: u / size, exactly.
struct WalkAxis {
  AxisLanes lanes;
  VF inverse;  ///< of sizes that are powers of two
  VI last;

  explicit WalkAxis(const AxisLanes& axis) : lanes(axis) {
    lanes.normalized = true;
    inverse = hn::Div(splat(1.0f), axis.size_float);
    last = hn::Sub(axis.size, splat(1));
  }

  /// The texel nearest to `texel`, inside the level; `outside`: that of the border colour.
  HWY_INLINE VI nearest(VF texel, hn::Mask<DI>& outside) const {
    const VF s = lanes.pot ? hn::Mul(texel, inverse) : hn::Div(texel, lanes.size_float);
    const VI at = lanes_nearest(lanes, s);
    outside = hn::Or(hn::Lt(at, splat(0)), hn::Gt(at, last));
    return lanes.address == Address::kBorder ? lanes_clamp(at, last) : at;
  }
};

/// Where texels lie: of compressed formats, their blocks and the places inside.
struct WalkPlaces {
  VI offset, inner;
};

template <bool kBlocks>
HWY_INLINE WalkPlaces place_row(const FormatDesc& format, const LevelLanes& level, VI y) {
  VI inner = splat(0);
  if constexpr (kBlocks) {
    y = split_block(y, format.block_height, inner);
    inner = hn::Mul(inner, splat(static_cast<std::int32_t>(format.block_width)));
  }
  return {hn::Add(level.origin, hn::Mul(y, level.row_pitch)), inner};
}

template <bool kBlocks>
HWY_INLINE WalkPlaces place_in_row(const FormatDesc& format, const WalkPlaces& row, VI x) {
  VI inner = splat(0);
  if constexpr (kBlocks) x = split_block(x, format.block_width, inner);
  return {hn::Add(row.offset, hn::Mul(x, splat(static_cast<std::int32_t>(format.block_bytes)))),
          hn::Add(row.inner, inner)};
}

/// Of the lanes of `wanted`; others are zero or anything finite.
HWY_NOINLINE TexelLanes fetch_from_blocks(const ImageView& view, const WalkPlaces& at, base::LaneMask wanted) {
  const FormatDesc& format = *view.format;
  if (const S3tcKind kind = s3tc_kind(format); kind != S3tcKind::kNone) {
    const VU word = gather_s3tc(kind, view.base, at.offset, at.inner);
    const bool srgb = format.is_srgb();
    const FormatDesc& bytes = format_desc(srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM);
    const auto channel = [&](std::size_t c) HWY_ATTR {
      return srgb ? convert_field<Numeric::kSrgb>(word, bytes.channel[c])
                  : convert_field<Numeric::kUnorm>(word, bytes.channel[c]);
    };
    return {channel(0), channel(1), channel(2), channel(3)};
  }
  alignas(64) std::int32_t offset[kMaxLanes], inner[kMaxLanes];
  hn::Store(at.offset, DI(), offset);
  hn::Store(at.inner, DI(), inner);
  alignas(64) float value[4][kMaxLanes]{};
  BlockCache& cache = block_cache();
  base::for_each_lane(wanted, [&](std::size_t lane) {
    const Texel& texel = cache.texels(format, view.base + offset[lane])[inner[lane]];
    for (std::size_t c = 0; c < 4; ++c) std::memcpy(&value[c][lane], &texel[c], sizeof(float));
  });
  return {hn::Load(DF(), value[0]), hn::Load(DF(), value[1]), hn::Load(DF(), value[2]), hn::Load(DF(), value[3])};
}

/// The texels of the lanes of `wanted`, or the border colour, or the outcome of their comparison with `reference`.
template <Numeric kNumeric, bool kBlocks>
HWY_INLINE TexelLanes texel_at(const Plan& plan, const WalkPlaces& at, hn::Mask<DI> wanted, hn::Mask<DI> outside,
                               bool bordered, const VF* reference) {
  const ImageView& view = *plan.view;
  TexelLanes texel;
  if constexpr (kBlocks) {
    texel = fetch_from_blocks(view, at, lanes_mask_bits(DI(), wanted));
  } else if (kNumeric == Numeric::kUfloat && view.format->format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) {
    texel = split_shared_exponent(gather_words(view.base, at.offset));
  } else {
    texel = fetch_lanes<kNumeric>(*view.format, view.base, at.offset);
  }
  if (bordered) {
    const auto put = [&](VF value, std::size_t c) HWY_ATTR {
      return hn::IfThenElse(hn::RebindMask(DF(), outside), as_float(hn::Set(DU(), plan.border[c])), value);
    };
    texel = {put(texel.r, 0), put(texel.g, 1), put(texel.b, 2), put(texel.a, 3)};
  }
  if (reference != nullptr) {
    const auto holds = compare_lanes(plan.sampler->compare_op, *reference, texel.r);
    texel.r = hn::IfThenElseZero(holds, splat(1.0f));
  }
  return texel;
}

/// What a vector of lanes walks through.
struct Footprint {
  LevelLanes level;  ///< from the slice on
  EllipseLanes ellipse;
  hn::Mask<DI> outside;  ///< no slice
  base::LaneMask active;
  VF reference;
};

template <Numeric kNumeric, bool kBlocks = false>
HWY_NOINLINE void walk(const Plan& plan, const Footprint& in, const VF* reference, Sums& sums) {
  const LevelLanes& level = in.level;
  const EllipseLanes& e = in.ellipse;
  const FormatDesc& format = *plan.view->format;
  // Texels without weight may be infinities or NaN.
  constexpr bool kFloat = kNumeric == Numeric::kSfloat || kNumeric == Numeric::kUfloat;
  const bool bordered = std::any_of(plan.address.begin(), plan.address.begin() + plan.dims,
                                    [](Address a) { return a == Address::kBorder; });
  const auto live = lanes_mask_from_bits(DI(), in.active);
  const WalkAxis x_axis(level.axis[0]), y_axis(level.axis[1]);
  const VF u_start = hn::Sub(lanes_int_to_float(e.u0), e.tu);
  const VF dq_start = hn::Mul(hn::Add(hn::Mul(u_start, splat(2.0f)), splat(1.0f)), e.a);
  const VF q_start = hn::Mul(square_of(u_start), e.a);
  const VF ddq = hn::Mul(e.a, splat(2.0f));
  VI iv = e.v0;
  for (auto rows = live; !hn::AllFalse(DI(), rows);
       iv = hn::Add(iv, splat(1)), rows = hn::And(live, hn::Not(hn::Gt(iv, e.v1)))) {
    const VF v = lanes_int_to_float(iv);
    const VF offset = hn::Sub(v, e.tv);
    VF dq = hn::Add(hn::Mul(offset, e.b), dq_start);
    VF q = hn::Add(hn::Mul(hn::Add(hn::Mul(e.c, offset), hn::Mul(e.b, u_start)), offset), q_start);
    hn::Mask<DI> outside_y, outside_x;
    const WalkPlaces row = place_row<kBlocks>(format, level, y_axis.nearest(v, outside_y));
    outside_y = hn::Or(outside_y, in.outside);
    VI iu = e.u0;
    for (auto texels = rows; !hn::AllFalse(DI(), texels);
         iu = hn::Add(iu, splat(1)), texels = hn::And(rows, hn::Not(hn::Gt(iu, e.u1)))) {
      const VI index = lanes_truncate_to_int(q);
      q = hn::Add(q, dq);
      dq = hn::Add(dq, ddq);
      const auto weighed = hn::And(texels, hn::Not(hn::Gt(index, splat(1023))));
      if (hn::AllFalse(DI(), weighed)) continue;
      const VI entry = hn::Min(hn::Max(index, splat(0)), splat(1023));
      const VF weight =
          hn::IfThenElseZero(hn::RebindMask(DF(), weighed), hn::GatherIndex(DF(), kEllipseWeights.data(), entry));
      const VI at = x_axis.nearest(lanes_int_to_float(iu), outside_x);
      const TexelLanes texel = texel_at<kNumeric, kBlocks>(plan, place_in_row<kBlocks>(format, row, at), weighed,
                                                           hn::Or(outside_x, outside_y), bordered, reference);
      const VF value[4] = {texel.r, texel.g, texel.b, texel.a};
      const auto add = [&](std::size_t c) HWY_ATTR {
        const VF sum = hn::Add(sums.color[c], hn::Mul(value[c], weight));
        sums.color[c] = kFloat ? hn::IfThenElse(hn::RebindMask(DF(), weighed), sum, sums.color[c]) : sum;
      };
      add(0);
      if (reference == nullptr) add(1), add(2), add(3);
      sums.total = hn::Add(sums.total, weight);
    }
  }
}

/// Compressed texels are values already: those that may be infinite go with the floats.
void walk_any(const Plan& plan, const Footprint& in, bool compare, Sums& sums) {
  const FormatDesc& format = *plan.view->format;
  const VF* const reference = compare ? &in.reference : nullptr;
  if (format.is_compressed()) {
    const Numeric numeric = format.channel[0].numeric;
    return numeric == Numeric::kUfloat || numeric == Numeric::kSfloat
               ? walk<Numeric::kSfloat, true>(plan, in, reference, sums)
               : walk<Numeric::kUnorm, true>(plan, in, reference, sums);
  }
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return walk<Numeric::kUnorm>(plan, in, reference, sums);
    case Numeric::kSrgb:
      return walk<Numeric::kSrgb>(plan, in, reference, sums);
    case Numeric::kSnorm:
      return walk<Numeric::kSnorm>(plan, in, reference, sums);
    case Numeric::kUfloat:
      return walk<Numeric::kUfloat>(plan, in, reference, sums);
    default:
      return walk<Numeric::kSfloat>(plan, in, reference, sums);
  }
}

/// Formats that one of the instances above decodes.
bool has_instance(const FormatDesc& format) {
  const Numeric numeric = format.channel[0].numeric;
  if (format.is_compressed()) return true;
  return numeric == Numeric::kUnorm || numeric == Numeric::kSrgb || numeric == Numeric::kSnorm ||
         numeric == Numeric::kUfloat || numeric == Numeric::kSfloat;
}

/// The depth to compare with, clamped where texels are fixed-point.
HWY_INLINE VF load_reference(const ImageView& view, const SampleRequest& request, std::size_t first) {
  const VF reference = load_lanes(request.dref, first);
  if (view.format->channel[0].numeric == Numeric::kSfloat) return reference;
  return lanes_max_second(lanes_min_second(reference, splat(1.0f)), splat(0.0f));
}

HWY_INLINE void load_footprint(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                               std::size_t first, Footprint& out) {
  const bool volume = p.plan.dims == 3;
  if (volume)
    load_level<3>(p, request, state, 0, first, false, out.level);
  else
    load_level<2>(p, request, state, 0, first, p.plan.cube, out.level);
  out.outside = hn::FirstN(DI(), 0);
  if (volume) {
    const AxisLanes& axis = out.level.axis[2];
    const VI last = hn::Sub(axis.size, splat(1));
    const VI z = lanes_nearest(axis, hn::LoadU(DF(), state.coord[2] + first));
    if (axis.address == Address::kBorder) out.outside = hn::Or(hn::Lt(z, splat(0)), hn::Gt(z, last));
    out.level.origin = hn::Add(out.level.origin, hn::Mul(lanes_clamp(z, last), out.level.slice_pitch));
  }
  out.reference = splat(0.0f);
  if (request.dref != nullptr) out.reference = load_reference(*p.plan.view, request, first);
}

void sample_anisotropic_wave(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  const ImageView& view = *p.plan.view;
  if (!has_instance(*view.format)) return sample_by_lane(p, request, result);
  WaveState state;
  find_state(p, request, state);
  WaveTexels texels;
  base::LaneMask leftover = 0;  // empty ellipses, and huge ones
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    const base::LaneMask lanes = base::first_lanes(hn::Lanes(DF()));
    const base::LaneMask active = request.active >> first & lanes;
    if (active == 0) continue;
    Footprint in;
    in.active = active;
    in.ellipse = make_ellipse(p, request, state, first);
    if (!small_boxes(in.ellipse, active)) {
      leftover |= active << first;
      continue;
    }
    Sums sums{{splat(0.0f), splat(0.0f), splat(0.0f), splat(0.0f)}, splat(0.0f)};
    load_footprint(p, request, state, first, in);
    walk_any(p.plan, in, request.dref != nullptr, sums);
    leftover |= (lanes_mask_bits(DF(), hn::Eq(sums.total, splat(0.0f))) & active) << first;
    for (std::size_t c = 0; c < 4; ++c) {
      VF value = hn::Div(sums.color[c], sums.total);
      if (request.dref != nullptr && c != 0) value = splat(c == 3 ? 1.0f : 0.0f);
      hn::Store(value, DF(), texels.c[c].lane + first);
    }
  }
  if (leftover != 0) {
    base::WaveRegister rest[4];
    SampleRequest fewer = request;
    fewer.active = leftover;
    sample_scalar(p.plan, fewer, rest);
    store_texels(view, texels, request.active & ~leftover, result);
    for (std::size_t c = 0; c < 4; ++c) {
      if (result[c] == nullptr) continue;
      base::for_each_lane(leftover, [&](std::size_t lane) { result[c]->lane[lane] = rest[c].lane[lane]; });
    }
    return;
  }
  store_texels(view, texels, request.active, result);
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(sample_anisotropic_wave);

}  // namespace

PreparedSampler::Kernel anisotropic_kernel() {
  base::select_simd_target();
  return &HWY_DYNAMIC_DISPATCH(sample_anisotropic_wave);
}

}  // namespace vitrine::texel

#endif
