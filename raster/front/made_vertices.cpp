// Copies in the arena, and the depth and the varyings of what is new.
#include "raster/front/made_vertices.h"

#include <cstring>

#include "base/x86_arithmetic.h"

namespace vitrine::raster {

Vertex* copy_record(const PipelinePlan& plan, Arena& arena, const Vertex* record) {
  Vertex* copy = arena.take<Vertex>(plan.vertex_stride);
  std::memcpy(copy, record, plan.vertex_stride * sizeof(Vertex));
  return copy;
}

const Vertex* with_flat_values(const PipelinePlan& plan, Arena& arena, const Vertex* record, const Vertex* flat) {
  if (!plan.flat_count || record == flat) return record;
  Vertex* copy = copy_record(plan, arena, record);
  const std::uint32_t first = 4 + plan.perspective_count + plan.linear_count;
  std::memcpy(copy + first, flat + first, plan.flat_count * sizeof(Vertex));
  return copy;
}

Vertex* biased_copy(const PipelinePlan& plan, Arena& arena, const Vertex* record, float offset) {
  Vertex* copy = copy_record(plan, arena, record);
  const float z = copy[2] + offset;
  copy[2] = z > 0 ? (z > 1 ? 1 : z) : 0;  // NaN: 0
  return copy;
}

const Vertex* between(const PipelinePlan& plan, Arena& arena, const Vertex* from, const Vertex* to, float t) {
  Vertex* made = arena.take<Vertex>(plan.vertex_stride);
  // (This device alone: deviations.md, stipple-flat-integers.)
  const bool flushes = plan.as_reference.flushes_flat;
  const std::uint32_t smooth = 4 + (flushes ? plan.varying_count() : plan.perspective_count + plan.linear_count);
  for (std::uint32_t i = 0; i < smooth; ++i)
    made[i] = base::x86_add(base::x86_mul(base::x86_sub(to[i], from[i]), t), from[i]);
  std::memcpy(made + smooth, from + smooth, (plan.vertex_stride - smooth) * sizeof(Vertex));
  return made;
}

}  // namespace vitrine::raster
