// sRGB: the reference's decoding curve, and its two encoders, that of clears and that of colour attachments
// (lavapipe-texture-blend.md parts C and D, lavapipe-rasterization.md 11.1). None is the exact curve.
#pragma once

#include <array>
#include <cstdint>

namespace vitrine::texel {

/// Linear value of each 8-bit sRGB code.
extern const std::array<float, 256> kSrgbToLinear;

/// The exact curve, to eight decimal digits: what the reference uses for BC7 only.
extern const std::array<float, 256> kSrgbToLinearExact;

/// Code of a clear value: thresholds of the reference's table-driven conversion. NaN gives 0.
std::uint8_t encode_srgb_clear(float linear);

/// Code of a colour written to an attachment (blended, blitted, resolved).
std::uint8_t encode_srgb_attachment(float linear);

/// The 12-bit reciprocal square root: index = lowest exponent bit (0: operands in [0.5, 1) times a power of 4, 1: in
/// [1, 2)) above the 10 leading mantissa bits of the operand; value = the 12 leading mantissa bits of the result, whose
/// exponent is that of 1.0 (index bit 0) or 0.5 (index bit 1), with 4096 for the first value of the next binade.
///
/// The reference encodes with the CPU's RSQRTPS, whose results are the vendor's own. This table is Intel's: over all
/// operands it equals 1/sqrt(x) at the middle of the interval of 2^-10 that x lies in, rounded to nearest at 12
/// mantissa bits. No exact data of AMD's is public; another CPU's bits would replace only this table.
extern const std::array<std::uint16_t, 2048> kRsqrtTable;

/// RSQRTPS by table: positive normal operands; 0 and denormals give +infinity, infinity gives 0.
float approximate_rsqrt(float value);

}  // namespace vitrine::texel
