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
inline constexpr std::size_t kPatternBytes = 192;

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
    std::memcpy(to, from, left);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::texel {

HWY_EXPORT(fill);

void fill_rows(std::byte* first, std::uint64_t pitch, std::size_t row_bytes, std::size_t rows, const StoredTexel& value,
               std::size_t block_bytes) {
  constexpr std::size_t kBytes = 192;
  std::array<std::byte, kBytes> pattern;
  std::memcpy(pattern.data(), value.bytes.data(), block_bytes);
  for (std::size_t filled = block_bytes; filled < kBytes; filled += block_bytes)
    std::memcpy(pattern.data() + filled, value.bytes.data(), block_bytes);
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(fill)(first, pitch, row_bytes, rows, pattern.data());
}

}  // namespace vitrine::texel
#endif  // HWY_ONCE
