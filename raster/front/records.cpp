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

using Four = hn::FixedTag<std::uint32_t, 4>;

/// Rows become columns.
HWY_INLINE void transpose(hn::Vec<Four> v[4]) {
  const Four d;
  const hn::FixedTag<std::uint64_t, 2> pairs;
  const auto ab01 = hn::BitCast(pairs, hn::InterleaveLower(d, v[0], v[1]));
  const auto ab23 = hn::BitCast(pairs, hn::InterleaveUpper(d, v[0], v[1]));
  const auto ce01 = hn::BitCast(pairs, hn::InterleaveLower(d, v[2], v[3]));
  const auto ce23 = hn::BitCast(pairs, hn::InterleaveUpper(d, v[2], v[3]));
  v[0] = hn::BitCast(d, hn::InterleaveLower(pairs, ab01, ce01));
  v[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, ab01, ce01));
  v[2] = hn::BitCast(d, hn::InterleaveLower(pairs, ab23, ce23));
  v[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, ab23, ce23));
}

void store_four(const std::uint32_t* const* from, std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride) {
  const Four d;
  std::uint32_t i = 0;
  for (; i + 4 <= lanes; i += 4) {
    hn::Vec<Four> v[4] = {hn::LoadU(d, from[0] + i), hn::LoadU(d, from[1] + i), hn::LoadU(d, from[2] + i),
                          hn::LoadU(d, from[3] + i)};
    transpose(v);
    for (std::uint32_t k = 0; k < 4; ++k) hn::StoreU(v[k], d, out + std::size_t{i + k} * stride);
  }
  for (; i < lanes; ++i)
    for (std::uint32_t c = 0; c < 4; ++c) out[std::size_t{i} * stride + c] = from[c][i];
}

void load_four(const std::byte* const* at, std::uint32_t lanes, std::uint32_t* const* to) {
  const Four d;
  for (std::uint32_t i = 0; i < lanes; i += 4) {
    hn::Vec<Four> v[4];
    for (std::uint32_t k = 0; k < 4; ++k)
      v[k] = hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(at[i + k < lanes ? i + k : i]));
    transpose(v);
    for (std::uint32_t c = 0; c < 4; ++c)
      if (to[c] != nullptr) hn::StoreU(v[c], d, to[c] + i);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(store_four);
HWY_EXPORT(load_four);

void store_records(const std::uint32_t* const from[4], std::uint32_t lanes, std::uint32_t* out, std::uint32_t stride) {
  HWY_DYNAMIC_DISPATCH(store_four)(from, lanes, out, stride);
}

void load_records(const std::byte* const* at, std::uint32_t lanes, std::uint32_t* const to[4]) {
  HWY_DYNAMIC_DISPATCH(load_four)(at, lanes, to);
}

}  // namespace vitrine::raster
#endif
