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

RunCutter::RunCutter(const DrawCall& draw, const TopologyShape& shape, std::uint32_t instance, std::uint32_t piece,
                     bool numbers_pieces)
    : draw_(draw),
      shape_(shape),
      piece_(piece),
      numbers_pieces_(numbers_pieces),
      restarts_(draw.index_data && draw.state->primitive_restart),
      strip_{0, 0, 0, instance, 0, true} {}

bool RunCutter::open_strip() {
  strip_.first_id += static_cast<std::uint32_t>(total_);
  begin_ = total_ = 0;
  const std::uint64_t count = draw_.count;
  while (at_ < count && total_ == 0) {
    std::uint64_t end = count;
    if (restarts_) {
      const std::uint32_t restart = restart_value(draw_.index_type);
      for (end = at_; end < count && read_index(draw_, draw_.first + end) != restart;) ++end;
    }
    strip_.start = static_cast<std::uint32_t>(at_);
    total_ = primitives_in(shape_, static_cast<std::uint32_t>(end - at_));
    at_ = end + 1;
  }
  return total_ != 0;
}

bool RunCutter::next(Run& run) {
  if (begin_ == total_ && !open_strip()) return false;
  run = strip_;
  run.begin = static_cast<std::uint32_t>(begin_);
  begin_ = std::min(total_, begin_ + piece_);
  run.end = static_cast<std::uint32_t>(begin_);
  run.ends = begin_ == total_;
  if (numbers_pieces_) run.first_id = 0 - run.begin;
  return true;
}

}  // namespace vitrine::raster
