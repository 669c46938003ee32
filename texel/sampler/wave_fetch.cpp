// Reads texels by integer coordinates with SIMD (lavapipe-texture-blend.md A10): the twin of fetch and fetch_buffer.
#include "texel/sampler/wave_fetch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave_fetch.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave_fetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

HWY_INLINE VI load_ints(const base::WaveRegister* values, std::size_t first) {
  return values != nullptr ? hn::BitCast(DI(), hn::Load(DU(), values->lane + first)) : splat(0);
}

/// 0 <= i < size.
HWY_INLINE hn::Mask<DI> within(VI i, VI size) { return hn::And(hn::Not(hn::Lt(i, splat(0))), hn::Lt(i, size)); }

/// Texels where `valid`, what lies outside elsewhere, through a component mapping; stored for active lanes only.
template <Numeric kNumeric>
HWY_INLINE void fetch_masked(const FormatDesc& format, const std::byte* base, VI offset, hn::Mask<DI> valid,
                             const std::array<std::uint8_t, 4>& swizzle, base::LaneMask active, std::size_t first,
                             base::WaveRegister result[4]) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  const VF one = kInteger ? as_float(hn::Set(DU(), 1u)) : splat(1.0f);
  const TexelLanes texel = fetch_lanes<kNumeric>(format, base, hn::IfThenElseZero(valid, offset));
  const auto mask = hn::RebindMask(DF(), valid);
  const VF alpha = format.rgba[3] < 0 ? texel.a : hn::IfThenElseZero(mask, texel.a);
  const VF all[6] = {hn::IfThenElseZero(mask, texel.r),
                     hn::IfThenElseZero(mask, texel.g),
                     hn::IfThenElseZero(mask, texel.b),
                     alpha,
                     splat(0.0f),
                     one};
  const auto lanes = lanes_mask_from_bits(DU(), active >> first);
  for (std::size_t c = 0; c < 4; ++c) {
    hn::BlendedStore(as_unsigned(all[swizzle[c]]), lanes, DU(), result[c].lane + first);
  }
}

HWY_INLINE bool any_active(base::LaneMask active, std::size_t first) {
  return ((active >> first) & base::first_lanes(hn::Lanes(DF()))) != 0;
}

template <Numeric kNumeric>
void fetch_image(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  alignas(64) std::int32_t width[kMaxLevels] = {}, height[kMaxLevels] = {}, pitch[kMaxLevels], origin[kMaxLevels];
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    width[i] = static_cast<std::int32_t>(view.level[i].extent.width);
    height[i] = static_cast<std::int32_t>(view.level[i].extent.height);
    pitch[i] = static_cast<std::int32_t>(view.level[i].row_pitch);
    origin[i] = static_cast<std::int32_t>(view.level[i].offset);
  }
  const bool layered = view.type != VK_IMAGE_VIEW_TYPE_2D;
  const VI texel_bytes = splat(static_cast<std::int32_t>(view.format->block_bytes));
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(request.active, first)) continue;
    const VI x = hn::Add(load_ints(request.coord[0], first), load_ints(request.offset[0], first));
    const VI y = hn::Add(load_ints(request.coord[1], first), load_ints(request.offset[1], first));
    const VI layer = layered ? load_ints(request.coord[2], first) : splat(0);
    VI level = load_ints(request.lod, first);
    auto valid = hn::And(within(level, splat(static_cast<std::int32_t>(view.level_count))),
                         within(layer, splat(static_cast<std::int32_t>(view.layer_count))));
    level = hn::IfThenElseZero(valid, level);
    valid = hn::And(valid, hn::And(within(x, hn::GatherIndex(DI(), width, level)),
                                   within(y, hn::GatherIndex(DI(), height, level))));
    const VI row = hn::Add(hn::GatherIndex(DI(), origin, level), hn::Mul(y, hn::GatherIndex(DI(), pitch, level)));
    const VI offset = hn::Add(hn::Add(row, hn::Mul(x, texel_bytes)),
                              hn::Mul(layer, splat(static_cast<std::int32_t>(view.layer_stride))));
    fetch_masked<kNumeric>(*view.format, view.base, offset, valid, view.swizzle, request.active, first, result);
  }
}

template <Numeric kNumeric>
void fetch_texels(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  base::WaveRegister result[4]) {
  constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
  const VI count = splat(static_cast<std::int32_t>(view.count));
  const VI texel_bytes = splat(static_cast<std::int32_t>(view.format->block_bytes));
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(active, first)) continue;
    const VI i = load_ints(&index, first);
    fetch_masked<kNumeric>(*view.format, view.data, hn::Mul(i, texel_bytes), within(i, count), kIdentity, active, first,
                           result);
  }
}

/// Calls body<numeric>() for the numeric formats that have a vector conversion.
template <class Body>
bool by_numeric(const FormatDesc& format, Body body) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return body.template operator()<Numeric::kUnorm>(), true;
    case Numeric::kSnorm:
      return body.template operator()<Numeric::kSnorm>(), true;
    case Numeric::kUint:
      return body.template operator()<Numeric::kUint>(), true;
    case Numeric::kSint:
      return body.template operator()<Numeric::kSint>(), true;
    case Numeric::kSfloat:
      return body.template operator()<Numeric::kSfloat>(), true;
    case Numeric::kSrgb:
      return body.template operator()<Numeric::kSrgb>(), true;
    default:
      return false;
  }
}

bool fetch_image_any(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  return by_numeric(*view.format, [&]<Numeric kNumeric>() { fetch_image<kNumeric>(view, request, result); });
}

bool fetch_texels_any(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                      base::WaveRegister result[4]) {
  return by_numeric(*view.format, [&]<Numeric kNumeric>() { fetch_texels<kNumeric>(view, active, index, result); });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(fetch_image_any);
HWY_EXPORT(fetch_texels_any);

constexpr std::uint64_t kSpanLimit = (std::uint64_t{1} << 31) - 64;

bool image_supported(const ImageView& view, const FetchRequest& request) {
  const bool flat = view.type != VK_IMAGE_VIEW_TYPE_1D && view.type != VK_IMAGE_VIEW_TYPE_1D_ARRAY &&
                    view.type != VK_IMAGE_VIEW_TYPE_3D;
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span = (view.layer_count - 1) * view.layer_stride + last.offset + last.sample_stride;
  return flat && view.format->plain && view.samples == 1 && request.sample == nullptr && span < kSpanLimit;
}

}  // namespace

bool fetch_wave(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  if (!image_supported(view, request)) return false;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(fetch_image_any)(view, request, result);
}

bool fetch_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       base::WaveRegister result[4]) {
  // Narrower texels would be read with bytes that may lie behind the buffer.
  const bool words = view.format->block_bytes % 4 == 0 && view.format->plain;
  if (!words || view.count == 0 || view.count * view.format->block_bytes >= kSpanLimit) return false;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(fetch_texels_any)(view, active, index, result);
}

}  // namespace vitrine::texel

#endif
