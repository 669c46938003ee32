// Texels of the images that a stopped shader has: where they lie, and what they hold.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "spirv/resources.h"
#include "texel/codec.h"

namespace vitrine::glass::debug {

/// Coordinates of a texel as imageLoad() has them, then the sample or level.
using TexelCoordinates = std::array<std::int64_t, 5>;

struct StoredTexelAt {
  std::byte* at = nullptr;
  std::uint32_t bytes = 0;
  const texel::FormatDesc* format = nullptr;
};

/// How many texels an image has by coordinate of imageLoad(), of level 0, array layers last.
struct ImageShape {
  const texel::FormatDesc* format = nullptr;
  std::uint32_t dimensions = 0;
  std::array<std::uint32_t, 3> size{};
};
/// Nothing: it is no image, or one whose texels find_texel() does not find.
std::optional<ImageShape> shape_of(const spirv::Descriptor& image);

/// Nothing: the image has no such texel, or it is compressed or lies in several planes.
std::optional<StoredTexelAt> find_texel(const spirv::Descriptor& image, const TexelCoordinates& at);
/// Without the view's swizzle.
texel::Texel decode(const StoredTexelAt& texel);
/// As imageStore() does it. False: texels of the format cannot be stored so.
bool encode(const StoredTexelAt& where, const texel::Texel& texel, std::array<std::byte, 16>& bytes);

}  // namespace vitrine::glass::debug
