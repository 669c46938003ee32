// Texels around a point near the edges of a cube face (lavapipe-texture-blend.md A5).
#pragma once

#include <array>
#include <cstdint>

namespace vitrine::texel {

/// How a coordinate on the neighbour follows from the one along the shared edge.
enum class Along : std::uint8_t { kSame, kFlipped, kZero, kLast };

/// Where a texel goes that leaves face f over edge e (x < 0, x > last, y < 0, y > last), at 4 f + e: the neighbour in
/// bits 0..3, the rules (Along) of its x in bits 4..7 and of its y from bit 8.
extern const std::array<std::int32_t, 24> kCubeCrossings;

struct CubeTexel {
  std::uint32_t face = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// The 2x2 footprint in the order (x0,y0) (x1,y0) (x0,y1) (x1,y1). `corner` is the index of the texel that does not
/// exist, 4 if all do; that entry then repeats a texel that exists.
struct CubeTaps {
  CubeTexel texel[4];
  float weight_x = 0;
  float weight_y = 0;
  std::uint32_t corner = 4;
};

/// u, v in [0, 1] on `face`, faces `size` texels wide.
CubeTaps cube_taps(std::uint32_t face, float u, float v, std::int32_t size);

/// Weights at a corner: a third of the missing texel's weight goes to each of the others.
void corner_weights(const CubeTaps& taps, float weight[4]);

}  // namespace vitrine::texel
