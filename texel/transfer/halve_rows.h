// Rows of texels at half the width: what mip levels are made of. The bits of blend_columns and blend_rows with decoding
// before and encoding after them, without the rows between.
#pragma once

#include <cstddef>
#include <cstdint>

#include "texel/format.h"

namespace vitrine::texel {

/// Texel i of `out` is the blend of texels 2 i and 2 i + 1 of two rows of the same format. Weights are of the second
/// texel and of the lower row: in [0, 255] if `bytes` was asked for, else in [0, 1].
struct HalvedRow {
  const std::byte *upper = nullptr, *lower = nullptr;
  std::size_t count = 0;  ///< texels of `out`
  const float* weight_x = nullptr;
  const std::int32_t* byte_weight_x = nullptr;
  float weight_y = 0;
  std::int32_t byte_weight_y = 0;
  std::byte* out = nullptr;
};

using RowHalver = void (*)(const HalvedRow&);

/// Of texels as values: a Texel each.
RowHalver texel_halver();

/// Of texels as words of four bytes.
RowHalver word_halver();

/// Null for formats that have none. `bytes`: with the reference's 8-bit rounding.
RowHalver row_halver(const FormatDesc& format, bool bytes);

}  // namespace vitrine::texel
