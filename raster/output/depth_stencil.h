// Depth and stencil tests and writes (Vulkan 1.3.239, Stencil Test, Depth Test; lavapipe-rasterization.md 5.3, 5.5),
// quad by quad in order, so that quads of one wave may lie on the same pixels.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/draw.h"
#include "raster/pixel_order.h"
#include "texel/view.h"

namespace vitrine::raster {

enum class DepthFormat : std::uint8_t { kNone, kD16, kD24, kD32 };
DepthFormat depth_format(const texel::ImageView& view);

/// Depth and stencil planes of one layer and sample. Rows are `pitch` bytes apart.
struct DepthStencilTarget {
  std::byte* depth = nullptr;
  std::byte* stencil = nullptr;
  std::uint64_t depth_pitch = 0, stencil_pitch = 0;
  int width = 0, height = 0;
  DepthFormat format = DepthFormat::kNone;
};

/// Bytes of a texel's depth.
constexpr std::uint64_t depth_bytes(DepthFormat format) { return format == DepthFormat::kD16 ? 2 : 4; }

/// Which tests a draw has, with the state of each; decided once per draw.
struct DepthStencilTests {
  const State* state = nullptr;
  bool depth = false, depth_write = false, depth_bounds = false, stencil = false;
  bool any() const { return depth || depth_bounds || stencil; }
};

/// The depths of a viewport, low <= high.
struct DepthRange {
  float low, high;
};

/// 5.3 steps 1 (where `restricted`) and 2: in place, lanes of quads [0, quads). `clamp`: null, or z range per quad.
void clamp_depth(const DepthRange* clamp, bool restricted, std::uint32_t quads, float* z);

/// Lanes by the first test that they failed.
struct FailedTests {
  base::LaneMask depth_bounds = 0, stencil = 0, depth = 0;
};

/// Tests lanes of `mask`: depth bounds, stencil, depth; returns those that pass. `z` is clamped. Writes depth where
/// `write` and the state say, and stencil always as the state says. `front`: bit q is the facing of quad q.
/// `reference`: per-lane stencil reference or null. `failed`: for observers, or null.
base::LaneMask test_depth_stencil(const DepthStencilTests& tests, const DepthStencilTarget& target,
                                  const QuadPositions& quads, std::uint32_t front, const float* z,
                                  const std::uint32_t* reference, base::LaneMask mask, bool write,
                                  FailedTests* failed = nullptr);

}  // namespace vitrine::raster
