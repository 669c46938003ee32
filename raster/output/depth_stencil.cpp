// Depth over quads in vectors of four lanes; stencil, and quads at the edge of the image, lane by lane.
#include "raster/output/depth_stencil.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/numeric.h"
#include "base/simd.h"
#include "raster/output/depth_compare.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/output/depth_stencil.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/lane_bits-inl.h"
#include "raster/output/depth_formats-inl.h"

#ifndef VITRINE_RASTER_DEPTH_STENCIL_ONCE
#define VITRINE_RASTER_DEPTH_STENCIL_ONCE
namespace vitrine::raster {

/// A depth test of whole quads, without stencil.
struct DepthPass {
  std::byte* base;
  std::uint64_t pitch;
  int width, height;
  VkCompareOp compare;
  bool write;
};

}  // namespace vitrine::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::lanes_mask_from_bits;
using base::HWY_NAMESPACE::lanes_max_second;
using base::HWY_NAMESPACE::lanes_min_second;

using F4 = hn::FixedTag<float, 4>;
using VF = hn::Vec<F4>;
using VI = hn::Vec<I4>;
using M4 = hn::Mask<I4>;

/// A quad that sticks out of the image is worked on in a copy of its pixels.
struct EdgeQuad {
  std::byte copy[2][8];
  std::byte *row0, *row1;
  std::size_t bytes0, bytes1;
};
HWY_INLINE EdgeQuad open_edge_quad(const DepthPass& pass, int x, int y, std::byte* row, int texel_bytes) {
  EdgeQuad quad{};
  quad.row0 = row;
  quad.row1 = row + pass.pitch;
  quad.bytes0 = static_cast<std::size_t>(texel_bytes) * (x + 1 < pass.width ? 2u : 1u);
  quad.bytes1 = y + 1 < pass.height ? quad.bytes0 : 0;
  std::memcpy(quad.copy[0], quad.row0, quad.bytes0);
  if (quad.bytes1) std::memcpy(quad.copy[1], quad.row1, quad.bytes1);
  return quad;
}
HWY_INLINE void close_edge_quad(const EdgeQuad& quad) {
  std::memcpy(quad.row0, quad.copy[0], quad.bytes0);
  if (quad.bytes1) std::memcpy(quad.row1, quad.copy[1], quad.bytes1);
}

template <class Format>
HWY_INLINE std::uint32_t test_quad(const DepthPass& pass, const float* z, std::uint32_t nibble, std::byte* row0,
                                   std::byte* row1) {
  const I4 d;
  const VI value = Format::encode(hn::LoadU(F4(), z));
  const VI stored = Format::load(row0, row1);
  const M4 covered = lanes_mask_from_bits(d, nibble);
  const M4 passed = hn::And(covered, compare<Format>(pass.compare, value, stored));
  const auto bits = static_cast<std::uint32_t>(bits_of_mask(passed)) & 15u;
  if (pass.write && bits != 0) Format::store(hn::IfThenElse(passed, value, stored), row0, row1);
  return bits;
}

/// Two whole quads side by side, of a format of 32-bit words: rows of four pixels. Returns the eight lanes' bits.
template <class Format>
HWY_INLINE std::uint32_t test_pair(const DepthPass& pass, const float* z, std::byte* row0, std::byte* row1) {
  const I4 d;
  const hn::FixedTag<std::uint64_t, 2> halves;
  const auto top = hn::BitCast(halves, hn::LoadU(d, reinterpret_cast<const std::int32_t*>(row0)));
  const auto bottom = hn::BitCast(halves, hn::LoadU(d, reinterpret_cast<const std::int32_t*>(row1)));
  VI left = hn::BitCast(d, hn::InterleaveLower(halves, top, bottom));
  VI right = hn::BitCast(d, hn::InterleaveUpper(halves, top, bottom));
  const VI left_value = Format::encode(hn::LoadU(F4(), z)), right_value = Format::encode(hn::LoadU(F4(), z + 4));
  if constexpr (std::is_same_v<Format, D24>) {
    left = D24::value_of(left);
    right = D24::value_of(right);
  }
  const M4 left_passed = compare<Format>(pass.compare, left_value, left);
  const M4 right_passed = compare<Format>(pass.compare, right_value, right);
  const auto bits =
      static_cast<std::uint32_t>((bits_of_mask(left_passed) & 15) | (bits_of_mask(right_passed) & 15) << 4);
  if (pass.write && bits != 0) {
    const auto a = hn::BitCast(halves, hn::IfThenElse(left_passed, left_value, left));
    const auto b = hn::BitCast(halves, hn::IfThenElse(right_passed, right_value, right));
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(halves, a, b)), d, reinterpret_cast<std::int32_t*>(row0));
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(halves, a, b)), d, reinterpret_cast<std::int32_t*>(row1));
  }
  return bits;
}

/// Whether quads q and q + 1 are covered and lie side by side inside the image.
HWY_INLINE bool is_pair(const DepthPass& pass, const QuadPositions& quads, std::uint32_t q, base::LaneMask mask) {
  return (mask >> (4 * q) & 0xff) == 0xff && q + 1 < base::kQuadsPerWave && quads.x[q + 1] == quads.x[q] + 2 &&
         quads.y[q + 1] == quads.y[q] && quads.x[q] + 3 < pass.width && quads.y[q] + 1 < pass.height;
}

template <class Format>
base::LaneMask test_quads(const DepthPass& pass, const QuadPositions& quads, const float* z, base::LaneMask mask) {
  base::LaneMask passed = 0;
  for (base::LaneMask left = mask; left != 0;) {
    const auto q = static_cast<std::uint32_t>(std::countr_zero(left)) / 4;
    const auto nibble = static_cast<std::uint32_t>(mask >> (4 * q)) & 15u;
    left &= ~(base::LaneMask{15} << (4 * q));
    const int x = quads.x[q], y = quads.y[q];
    std::byte* row =
        pass.base + static_cast<std::uint64_t>(y) * pass.pitch + std::uint64_t{quads.x[q]} * Format::kBytes;
    std::uint32_t bits;
    if constexpr (Format::kBytes == 4) {
      if (is_pair(pass, quads, q, left | base::LaneMask{nibble} << (4 * q))) {
        left &= ~(base::LaneMask{15} << (4 * (q + 1)));
        passed |= base::LaneMask{test_pair<Format>(pass, z + 4 * q, row, row + pass.pitch)} << (4 * q);
        continue;
      }
    }
    if (x + 1 < pass.width && y + 1 < pass.height) {
      bits = test_quad<Format>(pass, z + 4 * q, nibble, row, row + pass.pitch);
    } else {
      EdgeQuad edge = open_edge_quad(pass, x, y, row, Format::kBytes);
      bits = test_quad<Format>(pass, z + 4 * q, nibble, edge.copy[0], edge.copy[1]);
      close_edge_quad(edge);
    }
    passed |= base::LaneMask{bits} << (4 * q);
  }
  return passed;
}

base::LaneMask test_depth(DepthFormat format, const DepthPass& pass, const QuadPositions& quads, const float* z,
                          base::LaneMask mask) {
  switch (format) {
    case DepthFormat::kD16:
      return test_quads<D16>(pass, quads, z, mask);
    case DepthFormat::kD24:
      return test_quads<D24>(pass, quads, z, mask);
    case DepthFormat::kD32:
      return test_quads<D32>(pass, quads, z, mask);
    default:
      return mask;
  }
}

void clamp_to_range(const DepthRange* range, bool restricted, std::uint32_t quads, float* z) {
  const F4 d;
  for (std::uint32_t q = 0; q < quads; ++q) {
    VF v = hn::Load(d, z + 4 * q);
    if (restricted) v = lanes_max_second(lanes_min_second(v, hn::Set(d, 1.0f)), hn::Zero(d));
    if (range) v = lanes_max_second(lanes_min_second(v, hn::Set(d, range[q].high)), hn::Set(d, range[q].low));
    hn::Store(v, d, z + 4 * q);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {
namespace {

HWY_EXPORT(test_depth);
HWY_EXPORT(clamp_to_range);

std::uint8_t apply(VkStencilOp op, std::uint8_t stored, std::uint8_t reference) {
  switch (op) {
    case VK_STENCIL_OP_ZERO:
      return 0;
    case VK_STENCIL_OP_REPLACE:
      return reference;
    case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
      return stored == 255 ? stored : static_cast<std::uint8_t>(stored + 1);
    case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
      return stored == 0 ? stored : static_cast<std::uint8_t>(stored - 1);
    case VK_STENCIL_OP_INVERT:
      return static_cast<std::uint8_t>(~stored);
    case VK_STENCIL_OP_INCREMENT_AND_WRAP:
      return static_cast<std::uint8_t>(stored + 1);
    case VK_STENCIL_OP_DECREMENT_AND_WRAP:
      return static_cast<std::uint8_t>(stored - 1);
    default:
      return stored;
  }
}

/// 5.5. Lanes of one quad; the depth test between stencil test and stencil write is done by the caller's function.
class StencilQuad {
 public:
  StencilQuad(const StencilFace& face, std::byte* const texel[4], const std::uint32_t* reference)
      : face_(face), texel_(texel), reference_(reference) {}

  bool test(std::uint32_t lane) const {
    return compare_values<std::uint32_t>(face_.compare, reference(lane) & face_.compare_mask,
                                         stored(lane) & face_.compare_mask);
  }
  void write(std::uint32_t lane, VkStencilOp op) const {
    const std::uint8_t old = stored(lane), wanted = apply(op, old, reference(lane));
    const std::uint8_t value = static_cast<std::uint8_t>((wanted & face_.write_mask) | (old & ~face_.write_mask));
    std::memcpy(texel_[lane], &value, 1);
  }

 private:
  std::uint8_t reference(std::uint32_t lane) const {
    return reference_ ? static_cast<std::uint8_t>(reference_[lane]) : face_.reference;
  }
  std::uint8_t stored(std::uint32_t lane) const { return static_cast<std::uint8_t>(*texel_[lane]); }

  const StencilFace& face_;
  std::byte* const* texel_;
  const std::uint32_t* reference_;
};

/// Stored depth as a number, at the pixel of one lane.
double stored_depth(const DepthStencilTarget& target, const QuadPositions& quads, std::uint32_t lane) {
  const std::uint32_t q = lane / 4, bytes = target.format == DepthFormat::kD16 ? 2 : 4;
  const std::uint64_t x = quads.x[q] + (lane & 1), y = quads.y[q] + (lane >> 1 & 1);
  std::uint32_t word = 0;
  std::memcpy(&word, target.depth + y * target.depth_pitch + x * bytes, bytes);
  if (target.format == DepthFormat::kD32) return static_cast<double>(base::float_of(word));
  const std::uint32_t largest = target.format == DepthFormat::kD16 ? 0xffff : 0xffffff;
  return static_cast<double>(word & largest) / largest;
}

/// Vulkan 1.3.239, Depth Bounds Test: "If the depth value za is outside of the range [minDepthBounds, maxDepthBounds],
/// the depth bounds test sets the sample coverage to 0".
base::LaneMask inside_depth_bounds(const State& state, const DepthStencilTarget& target, const QuadPositions& quads,
                                   base::LaneMask mask) {
  base::LaneMask inside = 0;
  base::for_each_lane(mask, [&](std::size_t lane) {
    const double depth = stored_depth(target, quads, static_cast<std::uint32_t>(lane));
    if (depth >= static_cast<double>(state.min_depth_bounds) && depth <= static_cast<double>(state.max_depth_bounds))
      inside |= base::LaneMask{1} << lane;
  });
  return inside;
}

base::LaneMask depth_only(const DepthStencilTests& tests, const DepthStencilTarget& target, const QuadPositions& quads,
                          const float* z, base::LaneMask mask, bool write) {
  const DepthPass pass{target.depth,  target.depth_pitch,         target.width,
                       target.height, tests.state->depth_compare, write && tests.depth_write};
  return HWY_DYNAMIC_DISPATCH(test_depth)(target.format, pass, quads, z, mask);
}

/// Lanes of a quad that passed.
struct QuadTests {
  std::uint32_t stencil, depth;
};

/// One quad with stencil: stencil test, depth test of what passed, stencil write of all.
QuadTests stencil_quad(const DepthStencilTests& tests, const DepthStencilTarget& target, const QuadPositions& quads,
                       std::uint32_t q, bool front, const float* z, const std::uint32_t* reference,
                       std::uint32_t nibble, bool write) {
  const StencilFace& face = front ? tests.state->front : tests.state->back;
  std::byte* texel[4];
  for (std::uint32_t lane = 0; lane < 4; ++lane)
    texel[lane] = target.stencil + (quads.y[q] + (lane >> 1)) * target.stencil_pitch + quads.x[q] + (lane & 1);
  const StencilQuad stencil(face, texel, reference ? reference + 4 * q : nullptr);
  std::uint32_t passed = 0;
  for (std::uint32_t lane = 0; lane < 4; ++lane)
    if ((nibble >> lane & 1) != 0 && stencil.test(lane)) passed |= 1u << lane;
  std::uint32_t depth_passed = passed;
  if (tests.depth && passed)
    depth_passed = static_cast<std::uint32_t>(
        depth_only(tests, target, quads, z, base::LaneMask{passed} << (4 * q), write) >> (4 * q));
  for (std::uint32_t lane = 0; lane < 4; ++lane) {
    if ((nibble >> lane & 1) == 0) continue;
    const bool stencil_ok = (passed >> lane & 1) != 0, depth_ok = (depth_passed >> lane & 1) != 0;
    if (write) stencil.write(lane, !stencil_ok ? face.fail : depth_ok ? face.pass : face.depth_fail);
  }
  return {passed, depth_passed};
}

/// Nobody wants to know what failed.
struct Untold {
  void depth_bounds(base::LaneMask) {}
  void stencil(base::LaneMask) {}
  void depth(base::LaneMask) {}
};

struct Told {
  FailedTests& failed;
  void depth_bounds(base::LaneMask lanes) { failed.depth_bounds |= lanes; }
  void stencil(base::LaneMask lanes) { failed.stencil |= lanes; }
  void depth(base::LaneMask lanes) { failed.depth |= lanes; }
};

template <class Teller>
base::LaneMask test_quads(const DepthStencilTests& tests, const DepthStencilTarget& target, const QuadPositions& quads,
                          std::uint32_t front, const float* z, const std::uint32_t* reference, base::LaneMask mask,
                          bool write, Teller teller) {
  base::LaneMask result = 0;
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    base::LaneMask quad = mask & base::LaneMask{15} << (4 * q);
    if (tests.depth_bounds) {
      const base::LaneMask inside = inside_depth_bounds(*tests.state, target, quads, quad);
      teller.depth_bounds(quad & ~inside);
      quad = inside;
    }
    if (quad == 0) continue;
    if (tests.stencil) {
      const auto nibble = static_cast<std::uint32_t>(quad >> (4 * q)) & 15u;
      const bool faces = (front >> q & 1) != 0;
      const QuadTests passed = stencil_quad(tests, target, quads, q, faces, z, reference, nibble, write);
      teller.stencil(base::LaneMask{nibble & ~passed.stencil} << (4 * q));
      teller.depth(base::LaneMask{passed.stencil & ~passed.depth} << (4 * q));
      quad = base::LaneMask{passed.depth} << (4 * q);
    } else if (tests.depth) {
      const base::LaneMask passed = depth_only(tests, target, quads, z, quad, write);
      teller.depth(quad & ~passed);
      quad = passed;
    }
    result |= quad;
  }
  return result;
}

}  // namespace

DepthFormat depth_format(const texel::ImageView& view) {
  if (!view.format) return DepthFormat::kNone;
  switch (view.format->format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D16_UNORM_S8_UINT:
      return DepthFormat::kD16;
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return DepthFormat::kD24;
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return DepthFormat::kD32;
    default:
      return DepthFormat::kNone;
  }
}

void clamp_depth(const DepthRange* clamp, bool restricted, std::uint32_t quads, float* z) {
  HWY_DYNAMIC_DISPATCH(clamp_to_range)(clamp, restricted, quads, z);
}

base::LaneMask test_depth_stencil(const DepthStencilTests& tests, const DepthStencilTarget& target,
                                  const QuadPositions& quads, std::uint32_t front, const float* z,
                                  const std::uint32_t* reference, base::LaneMask mask, bool write,
                                  FailedTests* failed) {
  if (failed) return test_quads(tests, target, quads, front, z, reference, mask, write, Told{*failed});
  if (!tests.depth_bounds && !tests.stencil) return depth_only(tests, target, quads, z, mask, write);
  return test_quads(tests, target, quads, front, z, reference, mask, write, Untold{});
}

}  // namespace vitrine::raster
#endif
