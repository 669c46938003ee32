// Primitive restart and cutting into runs.
#include "raster/front/assembly.h"

#include <algorithm>
#include <cstring>

namespace vitrine::raster {
namespace {

std::uint32_t index_size(VkIndexType type) {
  return type == VK_INDEX_TYPE_UINT32 ? 4 : type == VK_INDEX_TYPE_UINT16 ? 2 : 1;
}

std::uint32_t restart_value(VkIndexType type) {
  return type == VK_INDEX_TYPE_UINT32 ? 0xffffffffu : type == VK_INDEX_TYPE_UINT16 ? 0xffffu : 0xffu;
}

std::uint32_t primitives_in(const TopologyShape& shape, std::uint32_t positions) {
  return shape.corners == 0 || positions < shape.first ? 0 : (positions - shape.first) / shape.step + 1;
}

/// One strip of `positions` positions, in pieces of at most `piece` primitives.
std::uint32_t append_strip(const TopologyShape& shape, const Run& strip, std::uint32_t positions, std::uint32_t piece,
                           bool numbers_pieces, std::vector<Run>& runs) {
  const std::uint32_t total = primitives_in(shape, positions);
  for (std::uint32_t begin = 0; begin < total; begin += piece) {
    Run run = strip;
    run.begin = begin;
    run.end = std::min(total, begin + piece);
    run.ends = run.end == total;
    if (numbers_pieces) run.first_id = 0 - begin;
    runs.push_back(run);
  }
  return total;
}

}  // namespace

std::uint32_t read_index(const DrawCall& draw, std::uint64_t position) {
  const std::uint32_t size = index_size(draw.index_type);
  const std::uint64_t at = position * size;
  if (at + size > draw.index_bytes) return 0;
  std::uint32_t value = 0;
  std::memcpy(&value, draw.index_data + at, size);
  return value;
}

std::uint32_t piece_of(const TopologyShape& shape, std::uint32_t positions) {
  return std::max<std::uint32_t>(positions / shape.step & ~1u, 2);
}

RunSpan run_span(const TopologyShape& shape, const Run& run) {
  if (shape.neighbours)
    return {run.begin == 0 ? 0 : run.begin * shape.step - 2,
            (run.end - 1) * shape.step + shape.first + (run.ends ? 0 : 1), false};
  if (shape.fan) return {run.begin + 1, run.end + 2, true};
  return {run.begin * shape.step, (run.end - 1) * shape.step + shape.first, false};
}

void append_runs(const DrawCall& draw, std::uint32_t instance, std::uint32_t piece, bool numbers_pieces,
                 std::vector<Run>& runs) {
  const TopologyShape shape = topology_shape(draw);
  Run strip{0, 0, 0, instance, 0, true};
  if (!draw.index_data || !draw.state->primitive_restart) {
    append_strip(shape, strip, draw.count, piece, numbers_pieces, runs);
    return;
  }
  const std::uint32_t restart = restart_value(draw.index_type);
  std::uint32_t start = 0;
  for (std::uint32_t i = 0; i <= draw.count; ++i) {
    if (i < draw.count && read_index(draw, std::uint64_t{draw.first} + i) != restart) continue;
    strip.start = start;
    strip.first_id += append_strip(shape, strip, i - start, piece, numbers_pieces, runs);
    start = i + 1;
  }
}

}  // namespace vitrine::raster
