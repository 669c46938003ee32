// Samples at places that are known, standard or custom, against what the specification says of them: coverage and tests
// of sample i are those of the one sample of a viewport moved by what lies between its place and the pixel's centre;
// what shaders see of samples is computed. A side that cannot draw with so many samples, or cannot place them, puts out
// that.
#pragma once

#include <vector>

#include "harness/run.h"

namespace vitrine::cts {

/// A place in a pixel, in sixteenths of it.
struct Place {
  int x, y;
};
using Places = std::vector<Place>;

/// Vulkan 1.3.239, Multisampling, "standard sample locations".
const Places& standard_places(uint32_t samples);

/// Where samples are, and which state says so (VK_EXT_sample_locations).
struct Located {
  enum class By { kNothing, kPipeline, kCommand, kCommandEnable };

  Places places;
  By by = By::kNothing;  ///< kNothing: `places` are the standard ones
  uint32_t samples() const { return static_cast<uint32_t>(places.size()); }
  bool custom() const { return by != By::kNothing; }
};
inline Located standard(uint32_t samples) { return {standard_places(samples), Located::By::kNothing}; }

constexpr uint32_t kSide = 64;  ///< of targets; a power of two: window coordinates of the corners are exact

/// Whether this side draws with that many samples; the other computes what must come out.
bool draws(const Run& run, uint32_t samples);

/// Whether the lower left half of the target, cut along x + 2y = 60 (in pixels), covers a place of a pixel: its edge
/// passes between samples.
bool covered(const Place& place, uint32_t x, uint32_t y);
/// (0, 0), (0, 30), (60, 0) in pixels. The varying is the place itself.
extern const char kCutVertex[];

/// Random triangles, each of one depth and one colour, with random tests and blending.
void samples_as_viewports(Run& run, const Located& located);

constexpr const char* kSeenNames[] = {"inputs", "places", "at_sample", "centroid", "mask_out"};
constexpr size_t kSeenCount = 5;
/// What kSeenNames[which] says, seen in each sample of the triangle of kCutVertex.
void seen_by_shaders(Run& run, const Located& located, size_t which, VkSampleMask sample_mask);

}  // namespace vitrine::cts
