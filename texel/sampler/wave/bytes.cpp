// The 8-bit fixed-point sampler for whole waves (lavapipe-texture-blend.md A1, A3): every dimension, one or two levels,
// averages, minima and maxima. Bits equal sample_scalar's.
//
// A wave passes through stages, each a loop over 64 lanes: offsets of texels by SIMD; their loads one by one, which
// on today's CPUs is faster than gathering; filters by SIMD.
#include <cstring>

#include "texel/sampler/prepared.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave/bytes.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/byte_blend-inl.h"
#include "texel/codec/widen-inl.h"
#include "texel/sampler/wave/bilinear-inl.h"
#include "texel/sampler/wave/block-inl.h"
#include "texel/sampler/wave/points-inl.h"
#include "texel/sampler/wave/state-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

constexpr std::size_t kMaxRows = 4;

/// Texels of one level as rows of pairs that are neighbours in x: rows (y0,z0) (y1,z0) (y0,z1) (y1,z1). A nearest
/// lookup has one row and only the first of the pair.
struct ByteTaps {
  IntLanes first[kMaxRows];                                ///< byte offset of the texel, or of its block
  IntLanes second[kMaxRows];                               ///< only where `adjacent` does not hold
  IntLanes inner_first[kMaxRows], inner_second[kMaxRows];  ///< compressed: place inside the block
  IntLanes weight[3];                                      ///< in [0, 255], twice, as 16-bit lanes times 128
  std::uint32_t rows = 1;
  bool adjacent = true;  ///< every second texel follows the first
};

/// How texels become words of four bytes, and where R, G, B, A are in them.
struct ByteFormat {
  bool fields = false;       ///< channels of other than 8 bits, widened to R, G, B, A
  std::uint32_t keep = ~0u;  ///< bits that belong to the texel
  std::array<std::int8_t, 4> rgba{0, 1, 2, 3};
};

ByteFormat byte_format(const FormatDesc& desc) {
  ByteFormat format;
  if (desc.is_compressed()) return format;
  format.fields = desc.channel[0].bits != 8 || desc.channel[1].bits % 8 != 0;
  if (desc.block_bytes < 4) format.keep = (1u << (8 * desc.block_bytes)) - 1;
  if (!format.fields) format.rgba = desc.rgba;
  return format;
}

// ---- offsets

struct ByteAxis {
  VI first, second;
};

/// Taps of one axis; stores the weight.
HWY_INLINE ByteAxis find_axis(const AxisLanes& axis, VF s, bool linear, std::size_t first, IntLanes& weight) {
  if (!linear) {
    const VI i = lanes_nearest_bytes(axis, s);
    return {i, i};
  }
  const ByteTapLanes taps = lanes_linear_bytes(axis, s);
  const VI w = hn::IfThenZeroElse(hn::Eq(taps.first, taps.second), taps.weight);  // equal texels: the first
  hn::Store(spread_weight(w), DI(), weight.lane + first);
  return {taps.first, taps.second};
}

/// Byte offset of texels of a row.
struct RowOffset {
  const FormatDesc& format;
  VI operator()(VI row, VI x) const {
    return hn::Add(row, hn::Mul(x, splat(static_cast<std::int32_t>(format.block_bytes))));
  }
};

template <std::uint32_t kDims>
HWY_NOINLINE void find_taps(const PreparedSampler& p, const SampleRequest& request, const WaveState& state, int which,
                            bool linear, ByteTaps& taps) {
  const Plan& plan = p.plan;
  const FormatDesc& format = *plan.view->format;
  const RowOffset offset{format};
  taps.rows = linear ? 1u << (kDims - 1) : 1u;
  taps.adjacent = !format.is_compressed();
  const bool same_level = level_is_uniform(p, request, plan.cube);
  LevelLanes level;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (first == 0 || !same_level) load_level<kDims>(p, request, state, which, first, plan.cube, level);
    ByteAxis axis[3];
    for (std::uint32_t i = 0; i < kDims; ++i) {
      axis[i] = find_axis(level.axis[i], hn::LoadU(DF(), state.coord[i] + first), linear, first, taps.weight[i]);
    }
    VI x_first = axis[0].first, x_second = axis[0].second;
    VI inner_x[2] = {splat(0), splat(0)};
    if (format.is_compressed()) {
      x_first = split_block(axis[0].first, format.block_width, inner_x[0]);
      x_second = split_block(axis[0].second, format.block_width, inner_x[1]);
    } else if (linear) {
      const auto next = hn::Eq(axis[0].second, hn::Add(axis[0].first, splat(1)));
      taps.adjacent = taps.adjacent && hn::AllTrue(DI(), next);
    }
    for (std::uint32_t r = 0; r < taps.rows; ++r) {
      VI row = level.origin;
      VI inner_y = splat(0);
      if (kDims > 1) {
        VI y = (r & 1) != 0 ? axis[1].second : axis[1].first;
        if (format.is_compressed()) {
          y = split_block(y, format.block_height, inner_y);
          inner_y = hn::Mul(inner_y, splat(static_cast<std::int32_t>(format.block_width)));
        }
        row = hn::Add(row, hn::Mul(y, level.row_pitch));
      }
      if (kDims > 2) row = hn::Add(row, hn::Mul((r & 2) != 0 ? axis[2].second : axis[2].first, level.slice_pitch));
      hn::Store(offset(row, x_first), DI(), taps.first[r].lane + first);
      if (linear) hn::Store(offset(row, x_second), DI(), taps.second[r].lane + first);
      if (format.is_compressed()) {
        hn::Store(hn::Add(inner_x[0], inner_y), DI(), taps.inner_first[r].lane + first);
        if (linear) hn::Store(hn::Add(inner_x[1], inner_y), DI(), taps.inner_second[r].lane + first);
      }
    }
  }
}

// ---- loads

/// Words of a row: first and second texel of each lane in turn, or only first ones; compressed: all first ones, then
/// the second ones.
struct alignas(64) RowWords {
  std::uint32_t word[2 * base::kWaveWidth];
};

/// Exactly kBytes at each offset, and zeros behind them up to a word.
template <std::size_t kBytes, std::size_t kStep>
HWY_INLINE void load_each(const std::byte* base, const IntLanes& offset, std::uint32_t* to) {
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    std::uint32_t word[kBytes > 4 ? 2 : 1] = {};
    std::memcpy(word, base + offset.lane[lane], kBytes);
    std::memcpy(to + kStep * lane, word, sizeof(word));
  }
}

template <std::size_t kStep>
HWY_INLINE void load_texels(const FormatDesc& format, const std::byte* base, const IntLanes& offset,
                            std::uint32_t* to) {
  switch (format.block_bytes) {
    case 1:
      return load_each<1, kStep>(base, offset, to);
    case 2:
      return load_each<2, kStep>(base, offset, to);
    case 3:
      return load_each<3, kStep>(base, offset, to);
    default:
      return load_each<4, kStep>(base, offset, to);
  }
}

HWY_NOINLINE void load_row(const Plan& plan, const ByteTaps& taps, std::uint32_t r, bool linear, base::LaneMask active,
                           RowWords& row) {
  const ImageView& view = *plan.view;
  if (view.format->is_compressed()) {
    load_block_bytes(view, taps.first[r], taps.inner_first[r], active, row.word);
    if (!linear) return;
    load_block_bytes(view, taps.second[r], taps.inner_second[r], active, row.word + base::kWaveWidth);
  } else if (!linear) {
    load_texels<1>(*view.format, view.base, taps.first[r], row.word);
  } else if (taps.adjacent && view.format->block_bytes == 4) {
    load_each<8, 2>(view.base, taps.first[r], row.word);
  } else if (taps.adjacent && view.format->block_bytes == 2) {
    load_each<4, 2>(view.base, taps.first[r], row.word);
  } else if (taps.adjacent && view.format->block_bytes == 1) {
    load_each<2, 2>(view.base, taps.first[r], row.word);
  } else {
    load_texels<2>(*view.format, view.base, taps.first[r], row.word);
    load_texels<2>(*view.format, view.base, taps.second[r], row.word + 1);
  }
}

/// The two texels of each lane as bytes R, G, B, A (or in the format's order).
HWY_INLINE void split_pairs(const Plan& plan, const ByteTaps& taps, const ByteFormat& format, const RowWords& row,
                            std::size_t first, VU& a, VU& b) {
  if (plan.view->format->is_compressed()) {
    a = hn::Load(DU(), row.word + first);
    b = hn::Load(DU(), row.word + base::kWaveWidth + first);
    return;
  }
  const VU low = hn::Load(DU(), row.word + 2 * first);
  const VU high = hn::Load(DU(), row.word + 2 * first + hn::Lanes(DU()));
  a = hn::ConcatEven(DU(), high, low);
  b = hn::ConcatOdd(DU(), high, low);
  const FormatDesc& desc = *plan.view->format;
  if (desc.block_bytes < 3 && taps.adjacent) b = hn::ShiftRightSame(a, 8 * desc.block_bytes);
  if (desc.block_bytes < 4) {
    a = hn::And(a, hn::Set(DU(), format.keep));
    b = hn::And(b, hn::Set(DU(), format.keep));
  }
  if (format.fields) {
    a = widen_fields(desc, a);
    b = widen_fields(desc, b);
  }
}

// ---- filters

/// a + ((w * (b - a) + 128) >> 8), with `weight` = 128 w; or the smaller or larger where w is not 0.
HWY_INLINE V16 reduce_16(VkSamplerReductionMode mode, V16 weight, V16 a, V16 b) {
  if (mode == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
    return hn::Add(a, rounded_product(weight, hn::Sub(b, a)));
  }
  const V16 extreme = mode == VK_SAMPLER_REDUCTION_MODE_MIN ? hn::Min(a, b) : hn::Max(a, b);
  return hn::IfThenElse(hn::Eq(weight, hn::Zero(D16())), a, extreme);
}

HWY_INLINE Halves reduce_bytes(VkSamplerReductionMode mode, VI weight, const Halves& a, const Halves& b) {
  const V16 w = hn::BitCast(D16(), weight);
  return {reduce_16(mode, w, a.even, b.even), reduce_16(mode, w, a.odd, b.odd)};
}

/// One packed texel per lane.
struct alignas(64) PackedLanes {
  std::uint32_t lane[base::kWaveWidth];
};

HWY_NOINLINE void filter_rows(const Plan& plan, const ByteTaps& taps, const ByteFormat& format,
                              const RowWords rows[kMaxRows], PackedLanes& out) {
  const VkSamplerReductionMode mode = plan.sampler->reduction;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    Halves row[kMaxRows];
    const VI weight_x = hn::Load(DI(), taps.weight[0].lane + first);
    for (std::uint32_t r = 0; r < taps.rows; ++r) {
      VU a, b;
      split_pairs(plan, taps, format, rows[r], first, a, b);
      row[r] = reduce_bytes(mode, weight_x, unpack_bytes(a), unpack_bytes(b));
    }
    if (taps.rows > 1) {
      const VI weight_y = hn::Load(DI(), taps.weight[1].lane + first);
      row[0] = reduce_bytes(mode, weight_y, row[0], row[1]);
      if (taps.rows > 2) {
        row[2] = reduce_bytes(mode, weight_y, row[2], row[3]);
        row[0] = reduce_bytes(mode, hn::Load(DI(), taps.weight[2].lane + first), row[0], row[2]);
      }
    }
    hn::Store(pack_bytes(row[0]), DU(), out.lane + first);
  }
}

HWY_NOINLINE void keep_texels(const Plan& plan, const ByteFormat& format, const RowWords& row, PackedLanes& out) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    VU packed = hn::And(hn::Load(DU(), row.word + first), hn::Set(DU(), format.keep));
    if (format.fields) packed = widen_fields(*plan.view->format, packed);
    hn::Store(packed, DU(), out.lane + first);
  }
}

HWY_NOINLINE void filter_level(const PreparedSampler& p, const ByteFormat& format, const SampleRequest& request,
                               const WaveState& state, int which, bool linear, PackedLanes& out) {
  ByteTaps taps;
  RowWords rows[kMaxRows];
  const auto find = p.plan.dims == 1 ? find_taps<1> : p.plan.dims == 2 ? find_taps<2> : find_taps<3>;
  find(p, request, state, which, linear, taps);
  for (std::uint32_t r = 0; r < taps.rows; ++r) load_row(p.plan, taps, r, linear, request.active, rows[r]);
  linear ? filter_rows(p.plan, taps, format, rows, out) : keep_texels(p.plan, format, rows[0], out);
}

/// One filter over one or two levels.
HWY_NOINLINE void filter_levels(const PreparedSampler& p, const ByteFormat& format, const SampleRequest& request,
                                const WaveState& state, bool linear, PackedLanes& out) {
  filter_level(p, format, request, state, 0, linear, out);
  if (p.plan.mip != MipFilter::kLinear || p.one_level) return;
  IntLanes weight;
  bool any = false;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    const VF scaled = hn::Mul(hn::Load(DF(), state.fraction.lane + first), splat(256.0f));
    const VI w = hn::And(lanes_truncate_to_int(scaled), splat(255));
    any = any || !hn::AllTrue(DI(), hn::Eq(w, splat(0)));
    hn::Store(spread_weight(w), DI(), weight.lane + first);
  }
  if (!any) return;
  PackedLanes next;
  filter_level(p, format, request, state, 1, linear, next);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    const Halves a = unpack_bytes(hn::Load(DU(), out.lane + first));
    const Halves b = unpack_bytes(hn::Load(DU(), next.lane + first));
    const VI w = hn::Load(DI(), weight.lane + first);
    hn::Store(pack_bytes(reduce_bytes(p.plan.sampler->reduction, w, a, b)), DU(), out.lane + first);
  }
}

// ---- results

/// Bytes to floats through the view's component mapping.
HWY_NOINLINE void store_component(const PackedLanes& packed, int byte, base::LaneMask active, base::WaveRegister& to) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    const VU value = hn::And(hn::ShiftRightSame(hn::Load(DU(), packed.lane + first), 8 * byte), hn::Set(DU(), 255u));
    const VF scaled = hn::Mul(lanes_int_to_float(hn::BitCast(DI(), value)), splat(1.0f / 255.0f));
    store_lanes(as_unsigned(scaled), active, first, to);
  }
}

HWY_NOINLINE void store_constant(float value, base::LaneMask active, base::WaveRegister& to) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    store_lanes(as_unsigned(splat(value)), active, first, to);
  }
}

void sample_bytes(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  const Plan& plan = p.plan;
  const ByteFormat format = byte_format(*plan.view->format);
  WaveState state;
  find_state(p, request, state);
  PackedLanes packed;
  const bool two_filters = plan.min_linear != plan.mag_linear;
  const base::LaneMask minified = two_filters ? state.minify & request.active : 0;
  if (minified != request.active || !two_filters) filter_levels(p, format, request, state, plan.mag_linear, packed);
  if (minified != 0) {
    PackedLanes other;
    filter_levels(p, format, request, state, plan.min_linear, other);
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
      const auto take = lanes_mask_from_bits(DU(), minified >> first);
      hn::BlendedStore(hn::Load(DU(), other.lane + first), take, DU(), packed.lane + first);
    }
  }
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    const std::uint8_t source = plan.view->swizzle[c];
    const int byte = source < 4 ? format.rgba[source] : -1;
    if (byte >= 0) {
      store_component(packed, byte, request.active, *result[c]);
    } else {
      store_constant(source == 3 || source == 5 ? 1.0f : 0.0f, request.active, *result[c]);
    }
  }
}

void sample_bytes_bilinear(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  WaveState state;
  find_state(p, request, state);
  sample_bilinear(p, request, state, result);
}

void sample_bytes_nearest(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  WaveState state;
  find_state(p, request, state);
  const ByteResults results(*p.plan.view, result);
  WordLanes words;
  PointReader<NearestByteRule>(p, request, state).read(words);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DU())) {
    results.store(unpack_bytes(hn::Load(DU(), words.lane + first)), request.active, first);
  }
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(sample_bytes);
HWY_EXPORT(sample_bytes_bilinear);
HWY_EXPORT(sample_bytes_nearest);

/// Texels of four bytes, a channel each.
bool has_four_bytes(const FormatDesc& format) {
  return !format.is_compressed() && format.block_bytes == 4 && format.channel[0].bits == 8;
}

/// Whether sample_bilinear does what the general sampler does.
bool bilinear_suits(const Plan& plan) {
  for (std::uint32_t i = 0; i < plan.dims; ++i) {
    if (plan.address[i] != Address::kClamp && (plan.address[i] != Address::kRepeat || !plan.pot[i])) return false;
  }
  return plan.dims > 1 && !plan.cube && plan.min_linear && plan.mag_linear && has_four_bytes(*plan.view->format) &&
         !plan.sampler->unnormalized && plan.sampler->reduction == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
}

/// Whether sample_bytes_nearest does.
bool nearest_suits(const Plan& plan) {
  return plan.dims == 2 && !plan.cube && !plan.min_linear && !plan.mag_linear && plan.mip != MipFilter::kLinear &&
         has_four_bytes(*plan.view->format);
}

}  // namespace

PreparedSampler::Kernel byte_kernel(const Plan& plan) {
  base::select_simd_target();
  if (nearest_suits(plan)) return &HWY_DYNAMIC_DISPATCH(sample_bytes_nearest);
  return bilinear_suits(plan) ? &HWY_DYNAMIC_DISPATCH(sample_bytes_bilinear) : &HWY_DYNAMIC_DISPATCH(sample_bytes);
}

}  // namespace vitrine::texel

#endif
