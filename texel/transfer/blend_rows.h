// Blends rows of texels with weights, as bytes in words (the reference's 8-bit rounding) or as floats.
#pragma once

#include <cstddef>
#include <cstdint>

#include "texel/codec.h"

namespace vitrine::texel {

/// out[i] = source[first[i]] blended with source[second[i]], weights in [0, 255] or [0, 1].
void blend_columns(const std::uint32_t* source, const std::int32_t* first, const std::int32_t* second,
                   const std::int32_t* weight, std::size_t count, std::uint32_t* out);
void blend_columns(const Texel* source, const std::int32_t* first, const std::int32_t* second, const float* weight,
                   std::size_t count, Texel* out);

/// out[i] = a[i] blended with b[i], one weight for all.
void blend_rows(const std::uint32_t* a, const std::uint32_t* b, std::int32_t weight, std::size_t count,
                std::uint32_t* out);
void blend_rows(const Texel* a, const Texel* b, float weight, std::size_t count, Texel* out);

}  // namespace vitrine::texel
