// Random textures, samplers and coordinates: every dimensionality, format class, filter, address mode and kind of LOD.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "harness/run.h"

namespace vitrine::cts {

enum class Kind { kImplicit, kBias, kLod, kGrad, kOffset, kProj, kGather, kFetch, kQuery, kShadow };

struct Shape {
  VkImageViewType view;
  const char* suffix;    ///< of the GLSL sampler type
  uint32_t coordinates;  ///< components of a coordinate, with the layer
  uint32_t dimensions;   ///< components of a gradient
};
inline constexpr Shape k1D{VK_IMAGE_VIEW_TYPE_1D, "1D", 1, 1}, k1DArray{VK_IMAGE_VIEW_TYPE_1D_ARRAY, "1DArray", 2, 1},
    k2D{VK_IMAGE_VIEW_TYPE_2D, "2D", 2, 2}, k2DArray{VK_IMAGE_VIEW_TYPE_2D_ARRAY, "2DArray", 3, 2},
    k3D{VK_IMAGE_VIEW_TYPE_3D, "3D", 3, 3}, kCube{VK_IMAGE_VIEW_TYPE_CUBE, "Cube", 3, 3},
    kCubeArray{VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, "CubeArray", 4, 3};

inline constexpr uint32_t kSize = 64;  // of the target

struct Family {
  const char* name;
  Kind kind;
  std::vector<Shape> shapes;
  uint32_t count;
  bool compressed = false, anisotropic = false;
  bool bordered = false;      ///< custom border colours and swizzled views
  bool reduced = false;       ///< minimum or maximum of the taps
  bool unnormalized = false;  ///< coordinates in texels
  bool special = false;       ///< coordinates, levels and gradients that are infinite, huge, tiny or no numbers
  bool mixed = false;         ///< one filter linear and one nearest, wherever that can be compared
  bool integer = false;       ///< whole numbers alone
  bool lacking = false;       ///< formats that the reference lacks, or cannot filter: it gets a stand-in
};

inline constexpr VkFormatFeatureFlags kSampled = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT,
                                      kFiltered = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;

/// What a case looks up, the same on both devices, with a table of coordinates and other random numbers.
struct RandomLookup {
  Shape shape;
  FormatInfo info;
  ImageSpec spec;
  VkSamplerCreateInfo sampler;    ///< without pNext
  std::vector<Binding> bindings;  ///< 0 and 1: the texture and the table
  std::string description;

  bool is_cube() const { return shape.dimensions == 3 && shape.view != VK_IMAGE_VIEW_TYPE_3D; }
};
RandomLookup random_lookup(Run& run, const Family& family);

/// "", "u" or "i": before the vec4 that a lookup gives.
std::string result_prefix(const RandomLookup& lookup, Kind kind);
/// Of four components that hold a result.
VkFormat result_format(const RandomLookup& lookup, Kind kind);
/// GLSL's declarations of the texture `t`, the `table`, and of base, dx and dy in push constants.
std::string lookup_declarations(const RandomLookup& lookup, Kind kind);
/// An expression of the coordinates vec4 c, their differences gx and gy, and vec4 extra.
std::string lookup(Random& random, const Family& family, const Shape& shape);
/// base, dx, dy of coordinates that change linearly: the texture, or an edge of it, is in the middle of the picture.
std::array<float, 12> random_slopes(Random& random, const Shape& shape, const VkSamplerCreateInfo& sampler);

}  // namespace vitrine::cts
