// The bits of a vector mask without a detour through memory: the loops over quads live on them. Include after
// <hwy/highway.h>, in a file that follows the foreach_target pattern.

#include <hwy/highway.h>

#include <cstdint>

#if defined(VITRINE_RASTER_LANE_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_RASTER_LANE_BITS_INL_H_
#undef VITRINE_RASTER_LANE_BITS_INL_H_
#else
#define VITRINE_RASTER_LANE_BITS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

/// Lane 0 in bit 0.
template <class M>
HWY_INLINE std::uint64_t bits_of_mask(M mask) {
#if HWY_TARGET <= HWY_AVX3
  return static_cast<std::uint64_t>(mask.raw);
#else
  return hwy::HWY_NAMESPACE::detail::BitsFromMask(mask);
#endif
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
