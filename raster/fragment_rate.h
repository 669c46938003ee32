// Fragment shading rates: how many pixels a fragment covers, and how rates are combined (Vulkan 1.3.239, Fragment
// Shading Rates). Fragments lie on a grid of their size that begins at the framebuffer's first pixel.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdint>

namespace vitrine::raster {

/// Size of a fragment, as shaders and attachments encode it: log2 of its width in bits 2 and 3, of its height in bits 0
/// and 1; each at most 2. 0: one pixel.
using FragmentRate = std::uint8_t;
inline constexpr std::uint32_t kFragmentRates = 16;
inline constexpr std::uint32_t kLargestFragment = 4;  ///< pixels, of a width and of a height
inline constexpr std::uint32_t kMaxFragmentPixels = kLargestFragment * kLargestFragment;
/// Samples of all pixels of a fragment: as many as gl_SampleMask has bits.
inline constexpr std::uint32_t kMaxFragmentSamples = 32;

constexpr std::uint32_t log_width(FragmentRate rate) { return rate >> 2 & 3u; }
constexpr std::uint32_t log_height(FragmentRate rate) { return rate & 3u; }
constexpr std::uint32_t width_of(FragmentRate rate) { return 1u << log_width(rate); }
constexpr std::uint32_t height_of(FragmentRate rate) { return 1u << log_height(rate); }
constexpr std::uint32_t pixels_of(FragmentRate rate) { return width_of(rate) * height_of(rate); }
/// Of logarithms; larger ones than a rate can have become the largest.
constexpr FragmentRate make_rate(std::uint32_t log_width, std::uint32_t log_height) {
  return static_cast<FragmentRate>(std::min(log_width, 2u) << 2 | std::min(log_height, 2u));
}
/// Of pixels: powers of two, of which the largest is taken that is not larger.
constexpr FragmentRate rate_of_size(std::uint32_t width, std::uint32_t height) {
  const auto log = [](std::uint32_t size) { return size >= 4 ? 2u : size >= 2 ? 1u : 0u; };
  return make_rate(log(width), log(height));
}

/// What vkGetPhysicalDeviceFragmentShadingRatesKHR tells of a rate and a number of samples.
constexpr bool supports_rate(FragmentRate rate, std::uint32_t samples) {
  return pixels_of(rate) * samples <= kMaxFragmentSamples;
}

/// Combining the Fragment Shading Rates, steps 1 to 4 of clamping: of the rates that are not larger, the one of the
/// largest area, then of the smallest aspect ratio, then the wide one.
constexpr FragmentRate clamp_rate(FragmentRate rate, std::uint32_t samples) {
  if (supports_rate(rate, samples)) return rate;
  FragmentRate best = 0;
  for (std::uint32_t w = 0; w <= log_width(rate); ++w)
    for (std::uint32_t h = 0; h <= log_height(rate); ++h) {
      const FragmentRate one = make_rate(w, h);
      const std::uint32_t sum = width_of(one) + height_of(one), best_sum = width_of(best) + height_of(best);
      const bool better = pixels_of(one) > pixels_of(best) || (pixels_of(one) == pixels_of(best) && sum <= best_sum);
      if (supports_rate(one, samples) && better) best = one;
    }
  return best;
}

/// VkFragmentShadingRateCombinerOpKHR, before it is clamped. Products are those of
/// fragmentShadingRateStrictMultiplyCombiner.
constexpr FragmentRate combine_rates(VkFragmentShadingRateCombinerOpKHR op, FragmentRate a, FragmentRate b) {
  const auto each = [&](auto&& f) { return make_rate(f(log_width(a), log_width(b)), f(log_height(a), log_height(b))); };
  switch (op) {
    case VK_FRAGMENT_SHADING_RATE_COMBINER_OP_REPLACE_KHR:
      return b;
    case VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MIN_KHR:
      return each([](std::uint32_t x, std::uint32_t y) { return std::min(x, y); });
    case VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MAX_KHR:
      return each([](std::uint32_t x, std::uint32_t y) { return std::max(x, y); });
    case VK_FRAGMENT_SHADING_RATE_COMBINER_OP_MUL_KHR:
      return each([](std::uint32_t x, std::uint32_t y) { return x + y; });
    default:
      return a;
  }
}

/// The rates of a draw. Inputs of combinations are clamped, as fragmentShadingRateClampCombinerInputs says.
struct FragmentRates {
  bool any = false;  ///< fragments may cover more than one pixel: all else counts only then
  std::uint32_t samples = 1;
  FragmentRate pipeline = 0;
  VkFragmentShadingRateCombinerOpKHR primitive_op = VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR;
  VkFragmentShadingRateCombinerOpKHR attachment_op = VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR;

  FragmentRate combined(VkFragmentShadingRateCombinerOpKHR op, FragmentRate a, std::uint32_t b) const {
    return clamp_rate(combine_rates(op, a, clamp_rate(make_rate(b >> 2 & 3, b & 3), samples)), samples);
  }
  /// The first combination. `word`: gl_PrimitiveShadingRateEXT.
  FragmentRate with_primitive(std::uint32_t word) const { return combined(primitive_op, pipeline, word); }
  /// The second one: the fragment's. `texel`: of the attachment.
  FragmentRate with_attachment(FragmentRate of_primitive, std::uint32_t texel) const {
    return combined(attachment_op, of_primitive, texel);
  }
};

}  // namespace vitrine::raster
