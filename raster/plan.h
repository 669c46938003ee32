// What is derived once from the state and the shader interfaces of a draw and then shared by all of its chunks and
// tiles: register numbers, the order of varyings, viewport constants, draw regions, the order of tests, and which of
// the ways through the back end may be taken. Values only: raster/plan/make_plan.h fills them in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "raster/draw.h"
#include "raster/output/color_writer.h"
#include "raster/output/depth_stencil.h"
#include "raster/pixel_rect.h"
#include "raster/stage.h"
#include "raster/topology.h"

namespace vitrine::raster {

inline constexpr std::uint32_t kNoReg = ~std::uint32_t{0};
/// Of components that are interpolated, with what the device needs itself: barycentric coordinates, smooth lines.
inline constexpr std::uint32_t kMaxVaryings = 136;
/// With the flat ones, each of three vertices.
inline constexpr std::uint32_t kMaxRecordVaryings = kMaxVaryings + 3 * 128;
inline constexpr std::uint32_t kMaxClipDistances = 8;
inline constexpr int kTileSize = 64;
/// Vertex or index positions of a chunk, about; runs are cut to this many.
inline constexpr std::uint32_t kChunkPositions = 1024;

/// Window coordinates = clip / w * scale + translate (lavapipe-rasterization.md 1.1).
struct ViewportTransform {
  float sx = 0, sy = 0, sz = 0, tx = 0, ty = 0, tz = 0;
  float z_min = 0, z_max = 1;  ///< depth clamp range (5.3)
};

/// One interpolated component that leaves the vertex stage.
struct Varying {
  std::uint32_t vertex_reg = kNoReg;  ///< kNoReg: not written, reads 0
  spirv::Interpolation interpolation = spirv::Interpolation::kPerspective;
  /// Not kAnyCorner: of one corner of the primitive. Flat: what that has; else a barycentric coordinate, 1 there and 0
  /// at the others (Vulkan 1.3.239, Barycentric Interpolation).
  std::uint8_t corner = kAnyCorner;
  static constexpr std::uint8_t kAnyCorner = 255;
};

/// A register of the fragment shader that takes something of a varying: its value somewhere, or a part of its plane.
struct VaryingRead {
  std::uint32_t reg;
  std::uint16_t varying;
  spirv::SampleLocation location;
  spirv::InputPart part;
};
/// Values at two places (the centre's, the centroid's or a sample's) and three parts of the plane.
inline constexpr std::uint32_t kMaxVaryingReads = 5 * kMaxVaryings;

/// Pairs of triangles that become rectangles (9.2).
struct RectanglePlan {
  bool any = false;                  ///< pairs are looked for
  std::uint32_t segment = 0;         ///< primitives of a strip, list or fan that are worked on together
  std::uint32_t batch_vertices = 0;  ///< vertices of those that go through the clipper together, at most
};

/// When depth and stencil are tested relative to shading (5.4).
enum class TestOrder : std::uint8_t { kNone, kEarly, kLate };

struct VertexInput {
  enum class Source : std::uint8_t {
    kAttribute,
    kVertexIndex,
    kInstanceIndex,
    kBaseVertex,
    kBaseInstance,
    kDrawIndex,
    kViewIndex,
    kZero
  };
  Source source = Source::kZero;
  std::uint8_t component = 0;  ///< attributes with 64-bit components: number of the 32-bit word
  std::uint8_t attribute = 0;  ///< index in State::attribute
  std::uint32_t reg = 0;
};

/// Register numbers of the outputs of the last stage before rasterization; kNoReg where not written.
struct VertexOutputs {
  std::array<std::uint32_t, 4> position;
  std::array<std::uint32_t, kMaxClipDistances> clip_distance, cull_distance;
  std::uint32_t clip_count = 0, cull_count = 0;
  std::uint32_t point_size = kNoReg, layer = kNoReg, viewport_index = kNoReg, primitive_id = kNoReg;
  std::uint32_t shading_rate = kNoReg;
};

/// Register numbers of the fragment stage; kNoReg where not read or written.
struct FragmentRegisters {
  std::array<std::uint32_t, 4> frag_coord;
  std::array<std::uint32_t, 2> point_coord, sample_position, interpolation_center;
  std::array<std::uint32_t, 2 * kMaxSamples> interpolation_sample;
  std::uint32_t interpolation_scale = kNoReg;
  std::uint32_t front_facing = kNoReg, sample_id = kNoReg, sample_mask_in = kNoReg, primitive_id = kNoReg;
  std::uint32_t helper = kNoReg, layer = kNoReg, view_index = kNoReg, shading_rate = kNoReg;
  std::array<std::array<std::uint32_t, 4>, kMaxColorAttachments> color;
  std::array<std::uint32_t, 4> color_second;  ///< attachment 0, index 1
  std::uint32_t depth = kNoReg, stencil = kNoReg, sample_mask = kNoReg;
};

/// Tessellation and geometry stages of a draw, and where vertices lie between them (spirv/stage_memory.h).
struct StagePlan {
  const spirv::ShaderInterface *control = nullptr, *evaluation = nullptr, *geometry = nullptr;
  spirv::StageModes tessellation;      ///< modes of control and evaluation shader together
  std::uint32_t vertex_words = 0;      ///< of what the vertex shader gives
  std::uint32_t evaluation_words = 0;  ///< of what the evaluation shader gives to a geometry shader
  bool any() const { return evaluation != nullptr || geometry != nullptr; }
};

/// A 32-bit output of the last stage before rasterization that transform feedback captures.
struct Capture {
  std::uint32_t reg = 0;
  std::uint32_t offset = 0;  ///< bytes in the stride
  std::uint8_t buffer = 0;
};

/// Ways of the reference that somebody asked for (deviations.md; base/as_reference.h), where they concern the draw.
struct ReferenceWays {
  bool keeps_outside_points = false;  ///< point-clipping
  float largest_point = 1024;         ///< pixels: pointSizeRange, or the reference's (large-points)
  std::uint32_t segment = 0;  ///< primitives that the reference works on at a time, where a chunk has to be that; or 0
  bool numbers_segments = false;            ///< each counts gl_PrimitiveID from 0 (patch-numbers)
  std::uint32_t tessellated_mask = ~0u;     ///< of numbers of vertices in a segment (tessellated-vertices)
  bool evaluated_ids = false;               ///< fragments' gl_PrimitiveID is 0 (tessellation-primitive-id)
  bool first_layer = false;                 ///< clipped primitives of all views go to one layer (multiview-layers)
  bool outlines_face_front = false;         ///< polygon-mode-facing
  bool smooth_outlines_face_front = false;  ///< smooth-outline-facing
  bool flushes_flat = false;                ///< stipple-flat-integers
  bool stipples_lines = false;              ///< stipple-per-line
  bool scales_integers = false;             ///< smooth-line-integers
  bool divides = true;                      ///< by w, in the viewport transform (identity-viewport)
  bool counts_segments = false;             ///< long-strip-vertices
  bool one_sample_masks = false;            ///< sample 0 stands for all of a line (one-sample-line-masks)
  bool first_sample_depth = false;          ///< the same for its tests (line-depth-first-sample)
  bool needs_corner = false;                ///< lines without a corner of a pixel vanish (multisample-short-lines)
  bool leaks_scissor = false;               ///< multisample-scissor
  bool nine_vertices = false;               ///< nine-vertices
};

struct PipelinePlan {
  const State* state = nullptr;
  const spirv::ShaderInterface* vertex = nullptr;
  StagePlan stages;
  const std::vector<spirv::InterfaceSlot>* outputs = nullptr;  ///< of the last stage before rasterization
  TopologyShape shape;
  std::uint32_t corners = 3;                         ///< of the primitives that are rasterized
  std::uint32_t chunk_positions = 0;                 ///< of a chunk, about
  std::uint32_t position_weight = 1;                 ///< what a position may become, in vertices
  bool counts_primitives = false;                    ///< chunks depend on how many primitives those before them gave
  const spirv::ShaderInterface* fragment = nullptr;  ///< null: none

  std::array<Capture, kMaxVaryings> capture;  ///< stream after stream
  std::array<std::uint32_t, kMaxStreams + 1> capture_begin{};
  std::array<std::uint32_t, spirv::kMaxXfbBuffers> xfb_stride{};  ///< bytes

  std::uint32_t vertex_input_count = 0;
  std::array<VertexInput, 160> vertex_input;
  VertexOutputs out;

  /// Varyings in the order perspective, linear, flat.
  std::uint32_t perspective_count = 0, linear_count = 0, flat_count = 0;
  std::array<Varying, kMaxRecordVaryings> varying;
  bool numbers_corners = false;  ///< some are of one corner: primitives have records of their own
  std::uint32_t varying_count() const { return perspective_count + linear_count + flat_count; }
  /// In the order values at the centre, at the centroid, at samples; parts of planes last.
  std::uint32_t read_count = 0;
  std::array<VaryingRead, kMaxVaryingReads> read;
  std::uint32_t point_size_word = kNoReg;  ///< of a Vertex record; kNoReg: gl_PointSize is not written, 1
  std::uint32_t vertex_stride = 4;         ///< 32-bit words of a Vertex record, a multiple of 4

  FragmentRegisters frag;

  std::array<ViewportTransform, kMaxViewports> viewport;
  std::array<PixelRect, kMaxViewports> region;  ///< framebuffer and scissor (3.3, without the viewport's rectangle)
  PixelRect wide_region;                        ///< of viewport 0, for lines and points: with its rectangle
  float pixel_offset = 0.5f;                    ///< `po` of 3.1
  bool discards = false;                        ///< discard rectangles count
  bool overestimates = false;                   ///< areas cover all pixels that they touch
  bool per_vertex_viewport = false;             ///< transform form B, viewport chosen by the primitive
  bool fused_transform = true;                  ///< form A; after tessellation and geometry stages form B
  bool draws_points = false, draws_lines = false;
  bool smooth_lines =
      false;  ///< lines become quads whose coverage scales alpha (6.5): the last four perspective varyings
  bool bias_in_vertices = false;  ///< polygon mode LINE / POINT: bias per vertex (5.1, second form)
  bool depth_bias = false;
  ReferenceWays as_reference;
  bool guard_band = false;  ///< clipped in x and y at twice the volume, and cut to viewport 0's rectangle (9.1)
  RectanglePlan rectangles;

  std::uint32_t samples = 1;         ///< of the attachments
  std::uint32_t raster_samples = 1;  ///< locations at which coverage is computed: 1 for Bresenham lines
  const SampleLocations* locations = &kSingleSample;  ///< those
  bool sample_shading = false;
  FragmentRates rates;
  std::uint32_t sample_mask = ~0u;  ///< 0: nothing is drawn

  TestOrder depth_order = TestOrder::kNone;
  DepthStencilTests tests;
  bool restricts_depth = true;  ///< fragments' depth is clamped to [0, 1] (5.3)
  bool clamps_depth = false;    ///< and to the range of its viewport
  bool early_reject = false;    ///< late order: failing now means failing later, so such quads need not be shaded
  bool in_order = false;        ///< fragments that write memory (interlock), early_reject whose outcome the shader
                                ///< sees, as the centroid: no primitive is tested or shaded before the writes of those
                                ///< in front of it
  std::uint32_t color_count = 0;
  std::array<ColorWriter, kMaxColorAttachments> writer;
  bool dual_source = false;
  bool alpha_to_one = false;
  bool counts_early = false;     ///< samples are counted before the fragment shader runs
  bool replaces_colors = false;  ///< every covered pixel of every attachment is overwritten, whatever it held
  bool shades = true;            ///< the fragment shader's run can be observed
  bool may_kill = false;         ///< discard, sample mask output, alpha to coverage
  bool windows = false;          ///< small triangles are covered in the front end (Primitive::window)
  bool tests_rows = false;       ///< depth of whole blocks is tested row by row (raster/tile/block_depth.h)
  bool hides_blocks = false;     ///< limits of stored depths reject whole blocks (raster/tile/hierarchical_depth.h)
  bool shades_blocks =
      false;  ///< nearly full blocks are shaded on their own, without packing (raster/tile/block_shade.h)
};

/// The vertex stream that is rasterized.
inline std::uint32_t rasterized_stream(const PipelinePlan& plan) {
  return plan.stages.geometry ? plan.state->rasterized_stream : 0;
}

/// Where depth clamp keeps the depths of a viewport.
inline DepthRange depth_range(const PipelinePlan& plan, std::uint32_t viewport) {
  return {plan.viewport[viewport].z_min, plan.viewport[viewport].z_max};
}

}  // namespace vitrine::raster
