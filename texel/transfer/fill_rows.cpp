// Rows of equal texels, a few vectors at a time.
#include <array>
#include <cstring>

#include "base/simd.h"
#include "texel/transfer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/transfer/fill_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Three vectors of any target: a multiple of every block size that has a clear value (1, 2, 3, 4, 6, 8, 12, 16 bytes).
/// A pattern has as many bytes and one vector more, so that it can be read from everywhere in the first 192.
inline constexpr std::size_t kPatternBytes = 192;

/// The end of a row: fewer than kPatternBytes, which begin with the pattern. `after`: bytes of the row in front of
/// them.
template <class D>
HWY_INLINE void fill_end(D d, std::uint8_t* to, std::size_t left, std::size_t after, const std::uint8_t* pattern) {
  const std::size_t n = hn::Lanes(d);
  std::size_t at = 0;
  for (; at + n <= left; at += n) hn::StoreU(hn::LoadU(d, pattern + at), d, to + at);
  if (at == left) return;
  if (after + left >= n) {  // one more vector, which ends where the row does
    const std::size_t phase = left >= n ? left - n : kPatternBytes + left - n;
    hn::StoreU(hn::LoadU(d, pattern + phase), d, to + left - n);
    return;
  }
  if constexpr (hn::MaxLanes(D()) > 16) {
    fill_end(hn::CappedTag<std::uint8_t, 16>(), to, left, after, pattern);
  } else {
    for (; at < left; ++at) to[at] = pattern[at];
  }
}

void fill(std::byte* first, std::uint64_t pitch, std::size_t row_bytes, std::size_t rows, const std::byte* pattern) {
  const hn::CappedTag<std::uint8_t, kPatternBytes / 3> d;
  const std::size_t n = hn::Lanes(d);
  const auto* from = reinterpret_cast<const std::uint8_t*>(pattern);
  const auto a = hn::LoadU(d, from), b = hn::LoadU(d, from + n), c = hn::LoadU(d, from + 2 * n);
  for (; rows != 0; --rows, first += pitch) {
    auto* to = reinterpret_cast<std::uint8_t*>(first);
    std::size_t left = row_bytes;
    for (; left >= 3 * n; left -= 3 * n, to += 3 * n) {
      hn::StoreU(a, d, to);
      hn::StoreU(b, d, to + n);
      hn::StoreU(c, d, to + 2 * n);
    }
    fill_end(d, to, left, row_bytes - left, from);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::texel {

HWY_EXPORT(fill);

void fill_rows(std::byte* first, std::uint64_t pitch, std::size_t row_bytes, std::size_t rows, const StoredTexel& value,
               std::size_t block_bytes) {
  constexpr std::size_t kBytes = 192 + 64;
  std::array<std::byte, kBytes + sizeof(value.bytes)> pattern;  // the last value may begin anywhere in front of kBytes
  for (std::size_t filled = 0; filled < kBytes; filled += block_bytes)
    std::memcpy(pattern.data() + filled, value.bytes.data(), sizeof(value.bytes));
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(fill)(first, pitch, row_bytes, rows, pattern.data());
}

}  // namespace vitrine::texel
#endif  // HWY_ONCE
