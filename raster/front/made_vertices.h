// Vertices that clipping, outlines and the pieces of lines make out of others.
#pragma once

#include "raster/arena.h"
#include "raster/plan.h"
#include "raster/primitive.h"

namespace vitrine::raster {

Vertex* copy_record(const PipelinePlan& plan, Arena& arena, const Vertex* record);

/// `record` with the flat values of another; itself if there are none, or it is the other.
const Vertex* with_flat_values(const PipelinePlan& plan, Arena& arena, const Vertex* record, const Vertex* flat);

/// With `offset` added to the depth, which is clamped to [0, 1].
Vertex* biased_copy(const PipelinePlan& plan, Arena& arena, const Vertex* record, float offset);

/// A vertex on the way from one to the other, in window space and without perspective; flat values as in the first.
const Vertex* between(const PipelinePlan& plan, Arena& arena, const Vertex* from, const Vertex* to, float t);

}  // namespace vitrine::raster
