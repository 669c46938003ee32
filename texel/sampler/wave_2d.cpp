// Samples two-dimensional images with SIMD: the 8-bit fixed-point path on packed bytes and the float path, with one or
// two mip levels and depth comparison. Bits equal sample_scalar's (lavapipe-texture-blend.md A3, A4, A6).
#include "texel/sampler/wave_2d.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave_2d.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave_fetch-inl.h"
#include "texel/sampler/wave_lod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

/// Where the levels of a view lie, for gathers by level.
struct LevelTable {
  alignas(64) std::int32_t width[kMaxLevels];
  alignas(64) std::int32_t height[kMaxLevels];
  alignas(64) std::int32_t pitch[kMaxLevels];
  alignas(64) std::int32_t offset[kMaxLevels];
};

LevelTable make_table(const ImageView& view) {
  LevelTable table;
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    const LevelLayout& level = view.level[i];
    table.width[i] = static_cast<std::int32_t>(level.extent.width);
    table.height[i] = static_cast<std::int32_t>(level.extent.height);
    table.pitch[i] = static_cast<std::int32_t>(level.row_pitch);
    table.offset[i] = static_cast<std::int32_t>(level.offset);
  }
  return table;
}

/// One vector of lanes on its way through the sampler.
struct Point {
  base::LaneMask active = 0;  ///< of this vector, lane 0 in bit 0
  VF s, t;
  VI layer;
  VI layer_offset;  ///< bytes
  VI offset_x, offset_y;
  VF reference;
};

/// The level (or the level of each lane) that is being read.
struct LevelLanes {
  AxisLanes x, y;
  VI index;
  VI pitch;
  VI origin;  ///< bytes
};

HWY_INLINE VI lookup(const std::int32_t* table, VI level, bool uniform) {
  return uniform ? splat(table[0]) : hn::GatherIndex(DI(), table, level);
}

HWY_INLINE LevelLanes make_level(const Plan& plan, const LevelTable& table, const Point& point, VI level,
                                 bool has_offset) {
  const bool one = plan.view->level_count == 1 || !plan.lod_needed;
  LevelLanes out;
  out.x.address = plan.address[0];
  out.y.address = plan.address[1];
  out.x.pot = plan.pot[0];
  out.y.pot = plan.pot[1];
  out.x.normalized = out.y.normalized = !plan.sampler->unnormalized;
  out.x.has_offset = out.y.has_offset = has_offset;
  out.x.offset = point.offset_x;
  out.y.offset = point.offset_y;
  out.x.size = lookup(table.width, level, one);
  out.y.size = lookup(table.height, level, one);
  out.x.size_float = lanes_int_to_float(out.x.size);
  out.y.size_float = lanes_int_to_float(out.y.size);
  out.index = level;
  out.pitch = lookup(table.pitch, level, one);
  out.origin = hn::Add(lookup(table.offset, level, one), point.layer_offset);
  return out;
}

// ---- texels that no gather decodes, lane by lane

constexpr std::size_t kMaxLanes = 16;
static_assert(hn::MaxLanes(DU()) <= kMaxLanes);

/// Calls fetch(lane, level, layer, x, y) for every active lane; coordinates are inside the level.
template <class Fetch>
HWY_INLINE void for_each_texel(const Point& point, const LevelLanes& level, VI x, VI y, Fetch fetch) {
  alignas(64) std::uint32_t at[4][kMaxLanes];
  hn::Store(hn::BitCast(DU(), level.index), DU(), at[0]);
  hn::Store(hn::BitCast(DU(), point.layer), DU(), at[1]);
  hn::Store(hn::BitCast(DU(), x), DU(), at[2]);
  hn::Store(hn::BitCast(DU(), y), DU(), at[3]);
  base::for_each_lane(point.active,
                      [&](std::size_t lane) { fetch(lane, at[0][lane], at[1][lane], at[2][lane], at[3][lane]); });
}

TexelLanes fetch_each(const Plan& plan, const Point& point, const LevelLanes& level, VI x, VI y) {
  alignas(64) std::uint32_t value[4][kMaxLanes] = {};
  for_each_texel(point, level, x, y,
                 [&](std::size_t lane, std::uint32_t l, std::uint32_t layer, std::uint32_t px, std::uint32_t py) {
                   Texel texel;
                   fetch_texel(plan, l, layer, px, py, 0, texel);
                   for (std::size_t c = 0; c < 4; ++c) value[c][lane] = texel[c];
                 });
  return {as_float(hn::Load(DU(), value[0])), as_float(hn::Load(DU(), value[1])), as_float(hn::Load(DU(), value[2])),
          as_float(hn::Load(DU(), value[3]))};
}

VU fetch_each_packed(const Plan& plan, const Point& point, const LevelLanes& level, VI x, VI y) {
  alignas(64) std::uint32_t value[kMaxLanes] = {};
  for_each_texel(point, level, x, y,
                 [&](std::size_t lane, std::uint32_t l, std::uint32_t layer, std::uint32_t px, std::uint32_t py) {
                   ByteTexel bytes;
                   fetch_bytes(*plan.view, l, layer, px, py, 0, bytes);
                   std::memcpy(&value[lane], bytes.data(), sizeof(value[lane]));
                 });
  return hn::Load(DU(), value);
}

// ---- bytes

/// How texels become words of four bytes, and where R, G, B, A are in them.
struct ByteFormat {
  bool gathered = true;      ///< else R, G, B, A are fetched lane by lane
  bool fields = false;       ///< channels of other than 8 bits, widened to R, G, B, A
  std::uint32_t keep = ~0u;  ///< bits that belong to the texel
  int shift = 2;             ///< log2 of the texel's bytes
  std::array<std::int8_t, 4> rgba{0, 1, 2, 3};
};

ByteFormat byte_format(const FormatDesc& desc) {
  ByteFormat format;
  format.gathered = !desc.is_compressed() && desc.block_bytes != 3;
  if (!format.gathered) return format;
  format.fields = desc.channel[0].bits != 8 || desc.channel[1].bits % 8 != 0;
  if (desc.block_bytes < 4) format.keep = (1u << (8 * desc.block_bytes)) - 1;
  format.shift = desc.block_bytes == 4 ? 2 : desc.block_bytes - 1;
  if (!format.fields) format.rgba = desc.rgba;
  return format;
}

/// Widens every channel to 8 bits by repeating its bits, in R, G, B, A order; missing alpha is 255.
HWY_INLINE VU widen_fields(const FormatDesc& desc, VU word) {
  VU packed = hn::Set(DU(), desc.rgba[3] < 0 ? 0xFF000000u : 0u);
  for (std::size_t i = 0; i < desc.channel_count; ++i) {
    const int bits = desc.channel[i].bits;
    const VU field = hn::And(hn::ShiftRightSame(word, desc.channel[i].offset), hn::Set(DU(), (1u << bits) - 1));
    const VU wide = bits == 1 ? hn::Sub(hn::ShiftLeft<8>(field), field)
                              : hn::Or(hn::ShiftLeftSame(field, 8 - bits), hn::ShiftRightSame(field, 2 * bits - 8));
    packed = hn::Or(packed, hn::ShiftLeftSame(wide, 8 * desc.component[i]));
  }
  return packed;
}

HWY_INLINE VU fetch_packed(const Plan& plan, const ByteFormat& format, const Point& point, const LevelLanes& level,
                           VI row, VI x, VI y) {
  if (!format.gathered) return fetch_each_packed(plan, point, level, x, y);
  const VI offset = hn::Add(row, hn::ShiftLeftSame(x, format.shift));
  const VU word = hn::And(gather_words(plan.view->base, offset), hn::Set(DU(), format.keep));
  return format.fields ? widen_fields(*plan.view->format, word) : word;
}

/// Two of four bytes in 16-bit lanes each.
struct Halves {
  hn::Vec<hn::Repartition<std::uint16_t, DU>> even, odd;
};
using D16 = hn::Repartition<std::uint16_t, DU>;

HWY_INLINE Halves unpack_bytes(VU packed) {
  const VU mask = hn::Set(DU(), 0x00FF00FFu);
  return {hn::BitCast(D16(), hn::And(packed, mask)), hn::BitCast(D16(), hn::And(hn::ShiftRight<8>(packed), mask))};
}

HWY_INLINE VU pack_bytes(const Halves& halves) {
  return hn::Or(hn::BitCast(DU(), halves.even), hn::ShiftLeft<8>(hn::BitCast(DU(), halves.odd)));
}

/// (a + ((w * (b - a) + 128) >> 8)) & 255 modulo 2^16: the bits that remain do not depend on the sign.
template <class V16>
HWY_INLINE V16 lerp_16(V16 weight, V16 a, V16 b) {
  const V16 product = hn::Add(hn::Mul(weight, hn::Sub(b, a)), hn::Set(D16(), std::uint16_t{128}));
  return hn::And(hn::Add(a, hn::ShiftRight<8>(product)), hn::Set(D16(), std::uint16_t{255}));
}

/// `weight` in [0, 255] per lane.
HWY_INLINE Halves lerp_bytes(VI weight, const Halves& a, const Halves& b) {
  const auto w = hn::BitCast(D16(), hn::Or(weight, hn::ShiftLeft<16>(weight)));
  return {lerp_16(w, a.even, b.even), lerp_16(w, a.odd, b.odd)};
}

HWY_INLINE Halves filter_bytes(const Plan& plan, const ByteFormat& format, const Point& point, const LevelLanes& level,
                               bool linear) {
  if (!linear) {
    const VI x = lanes_nearest_bytes(level.x, point.s);
    const VI y = lanes_nearest_bytes(level.y, point.t);
    const VI row = hn::Add(level.origin, hn::Mul(y, level.pitch));
    return unpack_bytes(fetch_packed(plan, format, point, level, row, x, y));
  }
  const ByteTapLanes x = lanes_linear_bytes(level.x, point.s);
  const ByteTapLanes y = lanes_linear_bytes(level.y, point.t);
  const VI upper = hn::Add(level.origin, hn::Mul(y.first, level.pitch));
  const VI lower = hn::Add(level.origin, hn::Mul(y.second, level.pitch));
  const Halves top =
      lerp_bytes(x.weight, unpack_bytes(fetch_packed(plan, format, point, level, upper, x.first, y.first)),
                 unpack_bytes(fetch_packed(plan, format, point, level, upper, x.second, y.first)));
  const Halves bottom =
      lerp_bytes(x.weight, unpack_bytes(fetch_packed(plan, format, point, level, lower, x.first, y.second)),
                 unpack_bytes(fetch_packed(plan, format, point, level, lower, x.second, y.second)));
  return lerp_bytes(y.weight, top, bottom);
}

// ---- floats

HWY_INLINE VF lerp_float(VF weight, VF a, VF b) { return lanes_fma(weight, hn::Sub(b, a), a); }

HWY_INLINE TexelLanes lerp_texels(VF weight, const TexelLanes& a, const TexelLanes& b) {
  return {lerp_float(weight, a.r, b.r), lerp_float(weight, a.g, b.g), lerp_float(weight, a.b, b.b),
          lerp_float(weight, a.a, b.a)};
}

HWY_INLINE TexelLanes select_texels(hn::Mask<DF> first, const TexelLanes& a, const TexelLanes& b) {
  return {hn::IfThenElse(first, a.r, b.r), hn::IfThenElse(first, a.g, b.g), hn::IfThenElse(first, a.b, b.b),
          hn::IfThenElse(first, a.a, b.a)};
}

HWY_INLINE hn::Mask<DI> outside_of(VI i, VI size) { return hn::Or(hn::Lt(i, splat(0)), hn::Not(hn::Lt(i, size))); }

HWY_INLINE VF border_component(const Plan& plan, std::size_t component) {
  return as_float(hn::Set(DU(), plan.border[component]));
}

/// A texel inside the level; Numeric::kNone stands for formats that no gather decodes.
template <Numeric kNumeric>
HWY_INLINE TexelLanes texel_inside(const Plan& plan, const Point& point, const LevelLanes& level, VI x, VI y) {
  if constexpr (kNumeric == Numeric::kNone) {
    return fetch_each(plan, point, level, x, y);
  } else {
    const FormatDesc& format = *plan.view->format;
    const VI column = hn::Mul(x, splat(static_cast<std::int32_t>(format.block_bytes)));
    const VI offset = hn::Add(hn::Add(level.origin, hn::Mul(y, level.pitch)), column);
    return fetch_lanes<kNumeric>(format, plan.view->base, offset);
  }
}

/// The texel at (x, y), the border colour outside.
template <Numeric kNumeric>
HWY_INLINE TexelLanes texel_at(const Plan& plan, const Point& point, const LevelLanes& level, VI x, VI y, bool border) {
  if (!border) return texel_inside<kNumeric>(plan, point, level, x, y);
  const auto outside = hn::RebindMask(DF(), hn::Or(outside_of(x, level.x.size), outside_of(y, level.y.size)));
  const VI inside_x = lanes_clamp(x, hn::Sub(level.x.size, splat(1)));
  const VI inside_y = lanes_clamp(y, hn::Sub(level.y.size, splat(1)));
  const TexelLanes texel = texel_inside<kNumeric>(plan, point, level, inside_x, inside_y);
  return {hn::IfThenElse(outside, border_component(plan, 0), texel.r),
          hn::IfThenElse(outside, border_component(plan, 1), texel.g),
          hn::IfThenElse(outside, border_component(plan, 2), texel.b),
          hn::IfThenElse(outside, border_component(plan, 3), texel.a)};
}

/// Comparison of the reference with a texel's depth.
HWY_INLINE hn::Mask<DF> compare_lanes(VkCompareOp op, VF reference, VF texel) {
  switch (op) {
    case VK_COMPARE_OP_LESS:
      return hn::Lt(reference, texel);
    case VK_COMPARE_OP_EQUAL:
      return hn::Eq(reference, texel);
    case VK_COMPARE_OP_LESS_OR_EQUAL:
      return hn::Le(reference, texel);
    case VK_COMPARE_OP_GREATER:
      return hn::Gt(reference, texel);
    case VK_COMPARE_OP_NOT_EQUAL:
      return hn::Not(hn::Eq(reference, texel));
    case VK_COMPARE_OP_GREATER_OR_EQUAL:
      return hn::Ge(reference, texel);
    case VK_COMPARE_OP_ALWAYS:
      return hn::RebindMask(DF(), hn::Eq(hn::Zero(DU()), hn::Zero(DU())));
    default:
      return hn::RebindMask(DF(), hn::Ne(hn::Zero(DU()), hn::Zero(DU())));
  }
}

template <Numeric kNumeric>
HWY_INLINE hn::Mask<DF> compare_at(const Plan& plan, const Point& point, const LevelLanes& level, VI x, VI y,
                                   bool border) {
  return compare_lanes(plan.sampler->compare_op, point.reference,
                       texel_at<kNumeric>(plan, point, level, x, y, border).r);
}

HWY_INLINE VF select_weight(VF weight, hn::Mask<DF> first, hn::Mask<DF> second) {
  return hn::Add(hn::IfThenElseZero(second, weight), hn::IfThenElseZero(first, hn::Sub(splat(1.0f), weight)));
}

template <Numeric kNumeric>
HWY_INLINE VF filter_compare(const Plan& plan, const Point& point, const LevelLanes& level, bool linear, bool border) {
  if (!linear) {
    const VI x = lanes_nearest(level.x, point.s);
    const VI y = lanes_nearest(level.y, point.t);
    return hn::IfThenElseZero(compare_at<kNumeric>(plan, point, level, x, y, border), splat(1.0f));
  }
  const TapLanes x = lanes_linear(level.x, point.s);
  const TapLanes y = lanes_linear(level.y, point.t);
  const VF top = select_weight(x.weight, compare_at<kNumeric>(plan, point, level, x.first, y.first, border),
                               compare_at<kNumeric>(plan, point, level, x.second, y.first, border));
  const VF bottom = select_weight(x.weight, compare_at<kNumeric>(plan, point, level, x.first, y.second, border),
                                  compare_at<kNumeric>(plan, point, level, x.second, y.second, border));
  return lerp_float(y.weight, top, bottom);
}

template <Numeric kNumeric>
HWY_INLINE TexelLanes filter_floats(const Plan& plan, const Point& point, const LevelLanes& level, bool linear,
                                    bool border) {
  if (!linear) {
    return texel_at<kNumeric>(plan, point, level, lanes_nearest(level.x, point.s), lanes_nearest(level.y, point.t),
                              border);
  }
  const TapLanes x = lanes_linear(level.x, point.s);
  const TapLanes y = lanes_linear(level.y, point.t);
  const TexelLanes top = lerp_texels(x.weight, texel_at<kNumeric>(plan, point, level, x.first, y.first, border),
                                     texel_at<kNumeric>(plan, point, level, x.second, y.first, border));
  const TexelLanes bottom = lerp_texels(x.weight, texel_at<kNumeric>(plan, point, level, x.first, y.second, border),
                                        texel_at<kNumeric>(plan, point, level, x.second, y.second, border));
  return lerp_texels(y.weight, top, bottom);
}

// ---- waves

HWY_INLINE VI load_ints(const base::WaveRegister* values, std::size_t first) {
  return hn::BitCast(DI(), hn::Load(DU(), values->lane + first));
}

HWY_INLINE Point load_point(const Plan& plan, const SampleRequest& request, std::size_t first) {
  Point point;
  point.active = (request.active >> first) & base::first_lanes(hn::Lanes(DF()));
  point.s = load_lanes(request.coord[0], first);
  point.t = load_lanes(request.coord[1], first);
  point.layer = point.layer_offset = splat(0);
  if (plan.arrayed) {
    const VI last = splat(static_cast<std::int32_t>(plan.view->layer_count) - 1);
    point.layer = lanes_clamp(lanes_round_to_int(load_lanes(request.coord[2], first)), last);
    point.layer_offset = hn::Mul(point.layer, splat(static_cast<std::int32_t>(plan.view->layer_stride)));
  }
  point.offset_x = request.offset[0] != nullptr ? load_ints(request.offset[0], first) : splat(0);
  point.offset_y = request.offset[1] != nullptr ? load_ints(request.offset[1], first) : splat(0);
  point.reference = splat(0.0f);
  if (request.dref != nullptr) {
    point.reference = load_lanes(request.dref, first);
    if (plan.view->format->channel[0].numeric != Numeric::kSfloat) {
      point.reference = lanes_max_second(lanes_min_second(point.reference, splat(1.0f)), splat(0.0f));
    }
  }
  return point;
}

HWY_INLINE LodLanes load_lod(const Plan& plan, const SampleRequest& request, const Point& point, std::size_t first) {
  if (!plan.lod_needed) return {splat(0), splat(0), splat(0.0f), hn::RebindMask(DF(), hn::Ne(splat(0), splat(0)))};
  return lanes_lod(plan, request, point.s, point.t, first);
}

HWY_INLINE bool any_active(base::LaneMask active, std::size_t first) {
  return ((active >> first) & base::first_lanes(hn::Lanes(DF()))) != 0;
}

/// Stores components of the active lanes through the view's mapping. Other lanes may hold another descriptor's result.
HWY_INLINE void store_mapped(const ImageView& view, base::LaneMask active, const VF source[4], std::size_t first,
                             base::WaveRegister result[4]) {
  const auto mask = lanes_mask_from_bits(DU(), active);
  const VF all[6] = {source[0], source[1], source[2], source[3], splat(0.0f), splat(1.0f)};
  for (std::size_t c = 0; c < 4; ++c) {
    hn::BlendedStore(as_unsigned(all[view.swizzle[c]]), mask, DU(), result[c].lane + first);
  }
}

HWY_INLINE VF byte_channel(VU packed, std::int8_t index, float missing) {
  if (index < 0) return splat(missing);
  const VU byte = hn::And(hn::ShiftRightSame(packed, 8 * index), hn::Set(DU(), 255u));
  return hn::Mul(lanes_int_to_float(hn::BitCast(DI(), byte)), splat(1.0f / 255.0f));
}

HWY_INLINE Halves select_halves(hn::Mask<DF> first, const Halves& a, const Halves& b) {
  const VU mask = as_unsigned(hn::VecFromMask(DF(), first));
  const auto m16 = hn::BitCast(D16(), mask);
  return {hn::Or(hn::And(m16, a.even), hn::AndNot(m16, b.even)), hn::Or(hn::And(m16, a.odd), hn::AndNot(m16, b.odd))};
}

/// One filter over one or two levels.
HWY_INLINE Halves filter_byte_levels(const Plan& plan, const ByteFormat& format, const LevelTable& table,
                                     const Point& point, const LodLanes& lod, bool has_offset, bool linear) {
  const Halves halves =
      filter_bytes(plan, format, point, make_level(plan, table, point, lod.level0, has_offset), linear);
  if (plan.mip != MipFilter::kLinear) return halves;
  const VI weight = hn::And(lanes_truncate_to_int(hn::Mul(lod.fraction, splat(256.0f))), splat(255));
  if (hn::AllTrue(DI(), hn::Eq(weight, splat(0)))) return halves;
  const LevelLanes next = make_level(plan, table, point, lod.level1, has_offset);
  return lerp_bytes(weight, halves, filter_bytes(plan, format, point, next, linear));
}

void sample_bytes_wave(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]) {
  const ByteFormat format = byte_format(*plan.view->format);
  const LevelTable table = make_table(*plan.view);
  const bool has_offset = request.offset[0] != nullptr;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(request.active, first)) continue;
    const Point point = load_point(plan, request, first);
    const LodLanes lod = load_lod(plan, request, point, first);
    Halves halves = filter_byte_levels(plan, format, table, point, lod, has_offset, plan.mag_linear);
    if (plan.min_linear != plan.mag_linear) {
      const Halves minified = filter_byte_levels(plan, format, table, point, lod, has_offset, plan.min_linear);
      halves = select_halves(lod.minify, minified, halves);
    }
    const VU packed = pack_bytes(halves);
    const VF channels[4] = {byte_channel(packed, format.rgba[0], 0.0f), byte_channel(packed, format.rgba[1], 0.0f),
                            byte_channel(packed, format.rgba[2], 0.0f), byte_channel(packed, format.rgba[3], 1.0f)};
    store_mapped(*plan.view, point.active, channels, first, result);
  }
}

/// A comparison or texels, one filter over one or two levels.
template <Numeric kNumeric>
HWY_INLINE TexelLanes filter_float_levels(const Plan& plan, const SampleRequest& request, const Point& point,
                                          const LevelLanes levels[2], VF fraction, bool linear, bool two_levels,
                                          bool border) {
  if (request.dref != nullptr) {
    VF value = filter_compare<kNumeric>(plan, point, levels[0], linear, border);
    if (two_levels) {
      value = lerp_float(fraction, value, filter_compare<kNumeric>(plan, point, levels[1], linear, border));
    }
    return {value, splat(0.0f), splat(0.0f), splat(1.0f)};
  }
  const TexelLanes texel = filter_floats<kNumeric>(plan, point, levels[0], linear, border);
  if (!two_levels) return texel;
  return lerp_texels(fraction, texel, filter_floats<kNumeric>(plan, point, levels[1], linear, border));
}

template <Numeric kNumeric>
void sample_floats_wave(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]) {
  const LevelTable table = make_table(*plan.view);
  const bool has_offset = request.offset[0] != nullptr;
  const bool border = plan.address[0] == Address::kBorder || plan.address[1] == Address::kBorder;
  const bool two_levels = plan.mip == MipFilter::kLinear;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(request.active, first)) continue;
    const Point point = load_point(plan, request, first);
    const LodLanes lod = load_lod(plan, request, point, first);
    const LevelLanes levels[2] = {make_level(plan, table, point, lod.level0, has_offset),
                                  make_level(plan, table, point, lod.level1, has_offset)};
    TexelLanes texel =
        filter_float_levels<kNumeric>(plan, request, point, levels, lod.fraction, plan.min_linear, two_levels, border);
    if (plan.min_linear != plan.mag_linear) {
      // Magnified lanes take one level.
      const TexelLanes magnified =
          filter_float_levels<kNumeric>(plan, request, point, levels, lod.fraction, plan.mag_linear, false, border);
      texel = select_texels(lod.minify, texel, magnified);
    }
    const VF channels[4] = {texel.r, texel.g, texel.b, texel.a};
    store_mapped(*plan.view, point.active, channels, first, result);
  }
}

void sample_wave(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]) {
  if (plan.aos) return sample_bytes_wave(plan, request, result);
  const FormatDesc& format = *plan.view->format;
  if (format.is_compressed() || format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) {
    return sample_floats_wave<Numeric::kNone>(plan, request, result);
  }
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return sample_floats_wave<Numeric::kUnorm>(plan, request, result);
    case Numeric::kSnorm:
      return sample_floats_wave<Numeric::kSnorm>(plan, request, result);
    case Numeric::kSrgb:
      return sample_floats_wave<Numeric::kSrgb>(plan, request, result);
    case Numeric::kUfloat:
      return sample_floats_wave<Numeric::kUfloat>(plan, request, result);
    default:
      return sample_floats_wave<Numeric::kSfloat>(plan, request, result);
  }
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(sample_wave);

/// Offsets of all texels must fit a signed 32-bit gather index.
bool small_enough(const ImageView& view) {
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span = (view.layer_count - 1) * view.layer_stride + last.offset + last.sample_stride;
  return span < (std::uint64_t{1} << 31) - 64;
}

}  // namespace

bool sample_wave_2d(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]) {
  const bool averaged = plan.sampler->reduction == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
  if (plan.zero || plan.dims != 2 || plan.cube || plan.anisotropic || !averaged || plan.view->format->is_integer() ||
      request.op != SampleOp::kSample || !small_enough(*plan.view)) {
    return false;
  }
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(sample_wave)(plan, request, result);
  return true;
}

}  // namespace vitrine::texel

#endif
