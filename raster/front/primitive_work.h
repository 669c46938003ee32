// The primitives of a chunk on their way from assembly to setup: what they share, and what those need that are clipped,
// culled one by one, lines, points or outlines (lavapipe-rasterization.md 1.2, 1.7, 3.4, 9.2).
#pragma once

#include <cstdint>

#include "raster/front/clip.h"
#include "raster/front/collected.h"
#include "raster/front/primitive_context.h"
#include "raster/front/rectangles.h"
#include "raster/front/setup_batch.h"

namespace vitrine::raster {

struct PrimitiveWork : PrimitiveContext {
  const PipelinePlan& plan;
  SetupContext setup;
  ViewportTransform viewport;
  bool batches;                       ///< triangles inside the view volume need nothing but setup
  bool inside = false;                ///< so are all vertices of the chunk
  std::uint32_t stipple_counter = 0;  ///< pixels of the pattern used up by earlier lines of the strip
  TriangleBatch batch;
  bool clips_segment = false;  ///< triangles go to `clipped`, not to setup
  ClippedBatch own_batch;
  ClippedBatch& clipped;         ///< the chunk's own, or one that several chunks share
  std::uint32_t base_layer;      ///< of the view
  ViewLayer* waiting = nullptr;  ///< primitives go through the reference's clipper, and wait with those of other views
  std::uint32_t instance = 0;    ///< of what is worked on, without first_instance
  std::uint32_t discarded = 0;   ///< lines and triangles that the clipper leaves nothing of
  std::uint32_t parts = 0;       ///< triangles that it makes beyond the first of a polygon
  const Vertex* own[3] = {};     ///< of the corners, where those are numbered

  explicit PrimitiveWork(const PrimitiveContext& context)
      : PrimitiveContext(context),
        plan(*chunk.draw->plan),
        setup{&plan, &pass, &primitives},
        viewport(plan.viewport[0]),
        batches(plan.windows && plan.out.layer == kNoReg && !plan.per_vertex_viewport && !plan.bias_in_vertices &&
                plan.out.cull_count == 0 && !plan.numbers_corners),
        clipped(chunk.batch ? *chunk.batch : own_batch),
        base_layer(chunk.view) {
    setup.layer = static_cast<std::uint16_t>(base_layer);
    if (plan.rates.any) setup.rate = plan.rates.with_primitive(0);
    if (plan.rectangles.any && !chunk.batch) own_batch.begin(plan);
    setup.watch = chunk.watch;
  }
};

/// gl_InstanceIndex, where the watch is told of it.
inline std::optional<std::uint32_t> index_of_instance(const PrimitiveWork& w, std::uint32_t instance) {
  const PrimitiveInstances* const instances = w.chunk.draw->instances;
  return instances ? instances->index_of(instance) : std::nullopt;
}

/// The clipper's end of a line or triangle.
inline void discard(PrimitiveWork& w, PrimitiveFate fate) {
  ++w.discarded;
  w.setup.tell(fate);
}

/// Vulkan 1.3.239, VkQueryPipelineStatisticFlagBits: "If at least one vertex of the input primitive lies inside the
/// clipping volume, the counter is incremented by one or more", whatever its area and the culling by its face.
/// (The reference leaves out those that its clipper culls, and rectangles.)
void count_behind_clipper(const PrimitiveWork& w, std::uint64_t input);

/// deviations.md, multiview-layers: what goes through the reference's clipper waits, and goes to the layer of the view
/// that the first of it is of; what does not sends that off.
void choose_view_layer(PrimitiveWork& w, bool clips);

/// Where corners are told apart, the primitive's corners get records of their own (Varying::corner). A line has no
/// third corner, a point no second: what is asked of it is that of the last.
void number_corners(PrimitiveWork& w, const std::uint32_t* slot, std::uint32_t corners);

/// The record of corner `corner`.
inline const Vertex* record_of(const PrimitiveWork& w, std::uint32_t slot, std::uint32_t corner) {
  return w.plan.numbers_corners ? w.own[corner] : w.vertices.records + std::size_t{slot} * w.plan.vertex_stride;
}

ClipVertex clip_vertex(const PrimitiveWork& w, std::uint32_t slot, std::uint32_t corner);

/// 1.7: dropped if all corners are outside of one cull distance.
bool culled_by_distance(const PrimitiveWork& w, const std::uint32_t* slot, std::uint32_t corners);

/// 3.4: layer and viewport from the provoking vertex, and the shading rate.
void choose_layer_and_viewport(PrimitiveWork& w, std::uint32_t provoking_slot);

/// A record transformed by the primitive's own viewport (1.2 form B), when the viewport is chosen per primitive.
const Vertex* window_record(const PrimitiveWork& w, const ClipVertex& v);

void emit_filled(PrimitiveWork& w, const Vertex* const v[3]);

/// Two triangles that may be a rectangle. False: they are not; nothing has been set up.
bool emit_pair(PrimitiveWork& w, const PairCorners& v);

/// Sets up what has gone through the clipper: by pairs if it comes out even. `another`: a triangle that does not fit
/// comes next.
void flush_clipped(PrimitiveWork& w, bool another);

/// One triangle that went through the clipper or needs the slow path anyway.
void emit_slow(PrimitiveWork& w, const Vertex* const v[3], const bool edge[3]);

void emit_clipped(PrimitiveWork& w, std::uint32_t provoking, ClipPolygon& polygon);

void process_line(PrimitiveWork& w, const std::uint32_t slot[2]);

/// Vulkan 1.3.239, Primitive Clipping: "If the primitive under consideration is a point, then clipping passes it
/// unchanged if it lies within the clip volume; otherwise, it is discarded." (The reference keeps those outside in x
/// and y: deviation point-clipping. Behind a tessellation or geometry shader it forgets to transform them.)
void process_point(PrimitiveWork& w, std::uint32_t slot);

}  // namespace vitrine::raster
