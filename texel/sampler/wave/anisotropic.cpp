// Anisotropic filtering for whole waves (lavapipe-texture-blend.md A8): the twin of sample_anisotropic, for compressed
// formats and comparisons too. The lanes of a vector walk through their footprints together, each inside its own
// bounds.
#include <algorithm>
#include <cstring>

#include "texel/sampler/model/anisotropic.h"
#include "texel/sampler/prepared.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave/anisotropic.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave/walk-inl.h"
#include "texel/sampler/wave/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

constexpr std::size_t kMaxLanes = 16;
static_assert(hn::MaxLanes(DU()) <= kMaxLanes);

bool has_border(const Plan& plan) {
  return std::any_of(plan.address.begin(), plan.address.begin() + plan.dims,
                     [](Address a) { return a == Address::kBorder; });
}

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

template <Numeric kNumeric, bool kBlocks = false>
HWY_NOINLINE void walk(const Plan& plan, const Footprint& in, const VF* reference, Sums& sums) {
  const LevelLanes& level = in.level;
  const EllipseLanes& e = in.ellipse;
  const FormatDesc& format = *plan.view->format;
  // Texels without weight may be infinities or NaN.
  constexpr bool kFloat = kNumeric == Numeric::kSfloat || kNumeric == Numeric::kUfloat;
  const bool bordered = has_border(plan);
  const auto live = lanes_mask_from_bits(DI(), in.active);
  const WalkAxis x_axis(level.axis[0], e.u0, e.u1, live), y_axis(level.axis[1], e.v0, e.v1, live);
  const EllipseWalk walk(e);
  VI v = e.v0;
  for (auto lanes = live; !hn::AllFalse(DI(), lanes);
       v = hn::Add(v, splat(1)), lanes = hn::And(live, hn::Not(hn::Gt(v, e.v1)))) {
    hn::Mask<DI> outside_y, outside_x;
    const WalkPlaces place = place_row<kBlocks>(format, level, y_axis.nearest(v, outside_y));
    outside_y = hn::Or(outside_y, in.outside);
    RowWalk row = walk.row(lanes_int_to_float(v), lanes);
    for (RowWalk::Weight w; row.next_weighed(w);) {
      const VI at = x_axis.nearest(hn::Sub(row.u, splat(1)), outside_x);
      const TexelLanes texel = texel_at<kNumeric, kBlocks>(plan, place_in_row<kBlocks>(format, place, at), w.inside,
                                                           hn::Or(outside_x, outside_y), bordered, reference);
      const VF value[4] = {texel.r, texel.g, texel.b, texel.a};
      const auto add = [&](std::size_t c) HWY_ATTR {
        const VF sum = hn::Add(sums.color[c], hn::Mul(value[c], w.value));
        sums.color[c] = kFloat ? hn::IfThenElse(hn::RebindMask(DF(), w.inside), sum, sums.color[c]) : sum;
      };
      add(0);
      if (reference == nullptr) add(1), add(2), add(3);
      sums.total = hn::Add(sums.total, w.value);
    }
  }
}

/// Four texels of a row at a time; false if the format is none for that.
bool walk_fours(const Plan& plan, const Footprint& in, Sums& sums) {
  const FormatDesc& format = *plan.view->format;
  if (has_four_floats(format)) {
    if (format.block_bytes == 16) {
      return walk_rows<FourSums<16, false>>(plan, in, sums) || walk_rows<FourSums<16, true>>(plan, in, sums);
    }
    return walk_rows<FourSums<8, false>>(plan, in, sums) || walk_rows<FourSums<8, true>>(plan, in, sums);
  }
  if (s3tc_kind(format) != S3tcKind::kNone && !format.is_srgb()) return walk_rows<S3tcSums>(plan, in, sums);
  if (!averages_words(format) || format.block_bytes != 4) return false;
  const Numeric numeric = format.channel[0].numeric;
  if (numeric == Numeric::kUnorm && format.channel_count == 4 && fits_bytes(format))
    return walk_rows<ByteSums>(plan, in, sums);
  return by_averaged_numeric(numeric,
                             [&]<Numeric kNumeric>() { return walk_rows<WordSums<kNumeric>>(plan, in, sums); });
}

/// Compressed texels are values already: those that may be infinite go with the floats.
void walk_any(const Plan& plan, const Footprint& in, bool compare, Sums& sums) {
  const FormatDesc& format = *plan.view->format;
  const VF* const reference = compare ? &in.reference : nullptr;
  const bool bordered = has_border(plan);
  if (!bordered && !compare && walk_fours(plan, in, sums)) return;
  if (format.is_compressed()) {
    const Numeric numeric = format.channel[0].numeric;
    return numeric == Numeric::kUfloat || numeric == Numeric::kSfloat
               ? walk<Numeric::kSfloat, true>(plan, in, reference, sums)
               : walk<Numeric::kUnorm, true>(plan, in, reference, sums);
  }
  by_averaged_numeric(format.channel[0].numeric,
                      [&]<Numeric kNumeric>() { walk<kNumeric>(plan, in, reference, sums); });
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
  base::LaneMask leftover = 0;  // empty footprints, and huge ones
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
