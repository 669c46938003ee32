// Transposition of four registers, four lanes at a time.
#include "raster/front/records.h"

#include "base/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/front/records.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void transpose(const std::uint32_t* const* from, std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride) {
  const hn::FixedTag<std::uint32_t, 4> d;
  const hn::FixedTag<std::uint64_t, 2> pairs;
  std::uint32_t i = 0;
  for (; i + 4 <= lanes; i += 4) {
    const auto a = hn::LoadU(d, from[0] + i), b = hn::LoadU(d, from[1] + i);
    const auto c = hn::LoadU(d, from[2] + i), e = hn::LoadU(d, from[3] + i);
    const auto ab01 = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    const auto ab23 = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
    const auto ce01 = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
    const auto ce23 = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    std::uint32_t* record = out + std::size_t{i} * stride;
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, ab01, ce01)), d, record);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, ab01, ce01)), d, record + stride);
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, ab23, ce23)), d, record + 2 * stride);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, ab23, ce23)), d, record + 3 * stride);
  }
  for (; i < lanes; ++i)
    for (std::uint32_t c = 0; c < 4; ++c) out[std::size_t{i} * stride + c] = from[c][i];
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(transpose);

void store_records(const std::uint32_t* const from[4], std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride) {
  HWY_DYNAMIC_DISPATCH(transpose)(from, lanes, out, stride);
}

}  // namespace vitrine::raster
#endif
