// Texels of compressed formats for a wave of lanes: places inside blocks by SIMD, blocks decoded once each.

#include "texel/block/cache.h"
#include "texel/sampler/wave/s3tc-inl.h"
#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_BLOCK_INL_H_
#undef VITRINE_TEXEL_WAVE_BLOCK_INL_H_
#else
#define VITRINE_TEXEL_WAVE_BLOCK_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// i / block and, in `inner`, i % block; 0 <= i < 2^15, block <= 12: the product by 2^19 / block, rounded up, is exact.
HWY_INLINE VI split_block(VI i, std::uint32_t block, VI& inner) {
  const auto inverse = static_cast<std::int32_t>(((1u << 19) + block - 1) / block);
  const VI quotient = hn::ShiftRight<19>(hn::Mul(i, splat(inverse)));
  inner = hn::Sub(i, hn::Mul(quotient, splat(static_cast<std::int32_t>(block))));
  return quotient;
}

/// Decoded bytes of the active lanes' texels.
HWY_INLINE void load_block_bytes(const ImageView& view, const IntLanes& offset, const IntLanes& inner,
                                 base::LaneMask active, std::uint32_t* to) {
  if (decode_s3tc(*view.format, view.base, offset, inner, to)) return;
  BlockCache& cache = block_cache();
  std::int32_t last = -1;  // neighbours often share a block
  const std::uint32_t* texels = nullptr;
  base::for_each_lane(active, [&](std::size_t lane) {
    if (offset.lane[lane] != last) texels = cache.bytes(*view.format, view.base + offset.lane[lane]);
    last = offset.lane[lane];
    to[lane] = texels[inner.lane[lane]];
  });
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
