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

/// Code of a colour written to an attachment (blended, blitted, resolved), by approximate_rsqrt. Where this CPU has an
/// RSQRTPS, VITRINE_RSQRT=cpu takes that instead, so that a reference on a CPU of another vendor can be compared with.
std::uint8_t encode_srgb_attachment(float linear);

/// Below this the attachment's curve is a line of kSrgbLinearScale; above it c[0] x^0.375 + c[1] x^0.5 + c[2].
inline constexpr float kSrgbLinearEnd = 0.0031308f, kSrgbLinearScale = 12.92f * 255.0f;
inline constexpr float kSrgbCurve[3] = {static_cast<float>(0.675f * 1.0622 * 255.0f),
                                        static_cast<float>(0.325f * 1.0622 * 255.0f), -0.0620f * 255.0f};

/// Whether encode_srgb_attachment takes the CPU's RSQRTPS.
bool encodes_by_cpu();

/// Significand of approximate_rsqrt less 1, in units of 2^-12, by bits 11 to 23 of the operand. One more entry than
/// that, so that each can be read with the one behind it.
extern const std::array<std::uint16_t, 8193> kRsqrtSteps;

/// Whether this CPU's RSQRTPS may stand for encode_srgb_attachment's: it gives the same bits, tried out over the table,
/// or is what was asked for.
bool cpu_has_rsqrt();

/// RSQRTPS by table: positive normal operands; 0 and denormals give +infinity, infinity gives 0. The reference encodes
/// with this instruction, whose bits are the vendor's own; these are an AVX-512 AMD processor's, on every CPU.
float approximate_rsqrt(float value);

}  // namespace vitrine::texel
