// Sizes and statistics of chunks.
#include "raster/front/chunk.h"

namespace vitrine::raster {

std::uint32_t positions_of(const Chunk& chunk) {
  const TopologyShape& shape = chunk.draw->plan->shape;
  std::uint32_t count = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) count += run_span(shape, chunk.runs[r]).count();
  return count;
}

std::uint64_t count_assembly(const Chunk& chunk, std::uint32_t vertices) {
  const TopologyShape& shape = chunk.draw->plan->shape;
  std::uint64_t primitives = 0, assembled = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const Run& run = chunk.runs[r];
    primitives += run.end - run.begin;
    // (The reference counts anew what two segments of a strip share: deviations.md, long-strip-vertices.)
    if (chunk.draw->plan->as_reference.counts_segments && run.ends && run.end > 0)
      assembled += std::uint64_t{(run.end - 1) / chunk.draw->plan->as_reference.segment} * (shape.first - shape.step);
    assembled += std::uint64_t{run.end - run.begin} * shape.step + (run.begin == 0 ? shape.first - shape.step : 0);
  }
  const QueryCounters& queries = chunk.draw->call.queries;
  queries.count(Statistic::kInputAssemblyVertices, assembled);
  queries.count(Statistic::kInputAssemblyPrimitives, primitives);
  queries.count(Statistic::kVertexInvocations, vertices);
  if (chunk.watch) chunk.watch->assembled(vertices, primitives);
  return primitives;
}

}  // namespace vitrine::raster
