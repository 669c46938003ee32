// Observed draws: who observes one is told what becomes of its primitives and fragments. An observed draw takes packed
// waves and whole blocks alone, and leaves the same bytes; which it is, is decided once per draw, tile and wave.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "raster/color_registers.h"
#include "raster/fragment_rate.h"
#include "raster/pixel_order.h"
#include "spirv/resources.h"
#include "texel/view.h"

namespace vitrine::spirv {
class Shader;  // spirv/shader.h
}

namespace vitrine::raster {

struct PassDesc;           // raster/pass_desc.h
struct Primitive;          // raster/primitive.h
class PrimitiveInstances;  // raster/primitive_instances.h

/// What becomes of a primitive. Each that is assembled, or that a tessellator or geometry shader makes, is culled or
/// rasterized; one that is clipped becomes parts, each of which is culled or rasterized. Of polygons that are drawn as
/// lines or points, and of smooth and stippled lines, the pieces are told of.
enum class PrimitiveFate : std::uint8_t {
  kCulledByDistance,  ///< all corners are outside of a cull distance
  kOutside,           ///< of the view volume, or of a clip distance
  kClipped,           ///< its parts come behind
  kFacing,            ///< cullMode
  kZeroArea,
  kTooFar,   ///< for fixed point: coordinates of NaN and infinity, too
  kScissor,  ///< outside of the scissor or the framebuffer
  kNoSample,
  kRasterized,
};
inline constexpr std::size_t kPrimitiveFates = static_cast<std::size_t>(PrimitiveFate::kRasterized) + 1;

/// What a sample of a fragment can fail, in the order of Vulkan 1.3.239, Fragment Operations.
enum class FragmentTest : std::uint8_t {
  kDiscardRectangle,
  kScissor,
  kSampleMask,  ///< of the pipeline
  kDepthBounds,
  kStencil,
  kDepth,
  kDiscard,     ///< by the shader
  kShaderMask,  ///< gl_SampleMask
  kAlphaToCoverage,
};
inline constexpr std::size_t kFragmentTests = static_cast<std::size_t>(FragmentTest::kAlphaToCoverage) + 1;

/// What the fragment shader reads of varyings, of fragments for which it may never run. Worked out when it is asked
/// for.
class FragmentInputs {
 public:
  virtual ~FragmentInputs() = default;
  virtual const spirv::Shader& shader() const = 0;
  /// What is in an input register, in a lane: at centroids as if no test took a sample, at samples in the first covered
  /// one. Nothing: the register holds no varying.
  virtual std::optional<std::uint32_t> word(std::uint32_t reg, std::size_t lane) = 0;
};

/// Fragments that are dealt with together. Of quads that are not in use no lane is told of.
struct FragmentGroup {
  QuadPositions position;
  std::uint32_t primitive[base::kQuadsPerWave];  ///< gl_PrimitiveID by quad
  const Primitive* from[base::kQuadsPerWave];    ///< by quad; null: it is not in use
  std::uint32_t layer = 0;
  /// Of shading() and shaded(): the lanes of quad q are fragments of this size, the first of which begins at its
  /// position. 0: they are pixels.
  FragmentRate rate = 0;
  const PrimitiveInstances* instances = nullptr;  ///< of `from`; null: the draw is not watched by pixels
  FragmentInputs* inputs = nullptr;  ///< of generated(); null: the same, or the draw has no fragment shader
};
/// Lanes of a group, by sample.
using SampleLanes = std::span<const base::LaneMask>;

/// What became of the fragments of a draw in a tile.
struct FragmentNumbers {
  std::uint64_t generated = 0;
  std::array<std::uint64_t, kFragmentTests> ended{};  ///< by the test that took the last sample
  std::uint64_t passed = 0;
  std::uint64_t texels = 0, bytes = 0;  ///< written to attachments
};

/// What one thread sees of a draw: a chunk of it in the front end, or a tile of it in the back end. The thread makes,
/// calls and destroys it.
class DrawWatch {
 public:
  virtual ~DrawWatch() = default;

  /// A chunk: its vertices are shaded, its primitives (or patches) assembled.
  virtual void assembled(std::uint64_t /*vertices*/, std::uint64_t /*primitives*/) {}
  /// Primitives that tessellator or geometry shader have made for the rasterizer.
  virtual void emitted(std::uint64_t /*primitives*/) {}
  /// `id`: gl_PrimitiveID. `instance`: gl_InstanceIndex; nothing: the draw is not watched by pixels, or has none but 0.
  virtual void primitive(std::uint32_t /*id*/, std::optional<std::uint32_t> /*instance*/, PrimitiveFate) {}

  /// A tile: samples of fragments are covered.
  virtual void generated(const FragmentGroup&, SampleLanes) {}
  /// Samples fail a test; `left`: those of the group that have failed none so far.
  virtual void failed(const FragmentGroup&, FragmentTest, SampleLanes /*lost*/, SampleLanes /*left*/) {}
  /// Depths of lanes of the group in a sample, on their way to the depth test.
  virtual void testing(const FragmentGroup&, std::uint32_t /*sample*/, const float* /*depth*/) {}
  /// The fragment shader is about to run.
  virtual void shading(const FragmentGroup&) {}
  /// The fragment shader runs: once for all samples, or, with sample shading, for one after the other.
  virtual void shaded(const FragmentGroup&, base::LaneMask /*invocations*/, base::LaneMask /*helpers*/) {}
  /// What the shader gave to colour attachment number `attachment`, four registers, before any of it is blended.
  virtual void coloring(const FragmentGroup&, std::uint32_t /*attachment*/, const ColorRegisters& /*color*/) {}
  /// Samples have passed all tests.
  virtual void passed(const FragmentGroup&, SampleLanes) {}
  /// They are in an attachment.
  virtual void written(const FragmentGroup&, const texel::ImageView&, SampleLanes) {}

  /// Whether it wants no more than numbers of a tile: those below, and shaded() where shaded_blocks() does not tell.
  virtual bool takes_numbers() const { return false; }
  /// At the end of the draw in the tile. Of fragments that what the draw or a later one puts over them hides, what
  /// would have become of them.
  virtual void numbers(const FragmentNumbers&) {}
  /// As shaded(): blocks of the tile's grid with an invocation for each pixel, at quad-ordered places.
  virtual void shaded_blocks(base::LaneMask /*places*/) {}
};

/// Shared by all threads that work on a draw; lives until the flush. Watches may be null. `command`: the draw; null:
/// nobody has named it.
class DrawObserver {
 public:
  virtual ~DrawObserver() = default;
  virtual std::unique_ptr<DrawWatch> watch_chunk(const spirv::ObservedCommand* command) = 0;
  /// `tile`: number of the tile in its pass.
  virtual std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand* command, std::uint32_t tile) = 0;
};

/// A tile that is being drawn: its first pixel and its layer.
struct TilePlace {
  const PassDesc* pass = nullptr;
  int x = 0, y = 0;
  std::uint32_t layer = 0;
};

/// Observes fragments on some tiles of a pass; elsewhere, and in the front end, a draw is drawn as if nobody observed.
/// Shared by all threads that work on the draw; lives until the flush.
class TileObserver {
 public:
  virtual ~TileObserver() = default;
  virtual bool watches(const TilePlace& place) const = 0;
  /// Null: the tile is not watched.
  virtual std::unique_ptr<DrawWatch> watch_tile(const spirv::ObservedCommand* command, const TilePlace& place) = 0;
};

}  // namespace vitrine::raster
