// Where the samples of a pixel lie (Vulkan 1.3.239, Rasterization: "standard sample locations").
// lavapipe-rasterization.md 8.1.
#pragma once

#include <cstdint>

namespace vitrine::raster {

inline constexpr std::uint32_t kMaxSamples = 8;

/// Places from the pixel's corner, or, where `count` is 1, from the only place at which coverage is computed. Entries
/// from `count` on repeat the last: so reads a shader a sample that does not exist.
struct SampleLocations {
  std::uint32_t count;
  std::int32_t x[kMaxSamples], y[kMaxSamples];  ///< 24.8 fixed point
  /// Pixels.
  float pixel_x(std::uint32_t sample) const { return static_cast<float>(x[sample]) / 256; }
  float pixel_y(std::uint32_t sample) const { return static_cast<float>(y[sample]) / 256; }
};

inline constexpr SampleLocations kSingleSample{1, {}, {}};
inline constexpr SampleLocations kTwoSamples{2, {192, 64, 64, 64, 64, 64, 64, 64}, {192, 64, 64, 64, 64, 64, 64, 64}};
inline constexpr SampleLocations kFourSamples{
    4, {96, 224, 32, 160, 160, 160, 160, 160}, {32, 96, 160, 224, 224, 224, 224, 224}};
inline constexpr SampleLocations kEightSamples{
    8, {144, 112, 208, 80, 48, 16, 176, 240}, {80, 176, 144, 48, 208, 112, 240, 16}};

constexpr const SampleLocations& standard_locations(std::uint32_t samples) {
  return samples == 8 ? kEightSamples : samples == 4 ? kFourSamples : samples == 2 ? kTwoSamples : kSingleSample;
}

}  // namespace vitrine::raster
