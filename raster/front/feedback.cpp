// Transform feedback.
#include "raster/front/feedback.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/numeric.h"
#include "raster/front/records.h"
#include "raster/topology.h"
#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

std::uint32_t byte_of(const Capture& capture) { return capture.offset & spirv::kXfbBytes; }

/// Captures of a vertex that lie side by side: words [from, from + count) go to `byte` of its place in a buffer.
struct CaptureRun {
  std::uint32_t buffer = 0, byte = 0, from = 0, count = 0;
  bool words = true;  ///< they are words; otherwise it is one capture of fewer bytes
};

std::vector<CaptureRun> runs_of(std::span<const Capture> captures) {
  std::vector<CaptureRun> runs;
  for (std::uint32_t k = 0; k < captures.size(); ++k) {
    const Capture& capture = captures[k];
    const bool words = spirv::captured_bytes(capture.offset) == 4;
    if (words && !runs.empty() && runs.back().words && runs.back().buffer == capture.buffer &&
        runs.back().byte + 4 * runs.back().count == byte_of(capture))
      ++runs.back().count;
    else
      runs.push_back({capture.buffer, byte_of(capture), k, 1, words});
  }
  return runs;
}

/// Whether vertices lie in the buffer as they were gathered.
bool is_whole_vertex(const PipelinePlan& plan, std::span<const Capture> captures, const CaptureRun& run) {
  return run.words && run.byte == 0 && run.count == captures.size() && plan.xfb_stride[run.buffer] == 4 * run.count;
}

/// How many of `primitives` have room: all captures of all their vertices lie inside their buffers.
std::uint64_t fitting(const TransformFeedback& feedback, const PipelinePlan& plan, std::span<const Capture> captures,
                      std::uint64_t primitives) {
  for (const Capture& capture : captures) {
    const XfbBuffer& buffer = feedback.buffer[capture.buffer];
    const std::uint64_t stride = plan.xfb_stride[capture.buffer];
    const std::uint64_t end =
        buffer.offset + (plan.corners - 1) * stride + byte_of(capture) + spirv::captured_bytes(capture.offset);
    if (!buffer.data || end > buffer.size) return 0;
    if (stride != 0) primitives = std::min(primitives, (buffer.size - end) / (plan.corners * stride) + 1);
  }
  return primitives;
}

/// Writes vertices and moves the buffers' offsets on.
void write_vertices(TransformFeedback& feedback, const PipelinePlan& plan, std::span<const Capture> captures,
                    const std::uint32_t* words, std::uint64_t vertices) {
  if (vertices == 0) return;  // there may be no buffer
  const std::vector<CaptureRun> runs = runs_of(captures);
  if (const CaptureRun& run = runs[0]; is_whole_vertex(plan, captures, run)) {
    XfbBuffer& buffer = feedback.buffer[run.buffer];
    std::memcpy(buffer.data + buffer.offset, words, vertices * plan.xfb_stride[run.buffer]);
    buffer.offset += vertices * plan.xfb_stride[run.buffer];
    return;
  }
  std::uint32_t used = 0;
  for (const CaptureRun& run : runs) used |= 1u << run.buffer;
  for (std::uint64_t v = 0; v < vertices; ++v, words += captures.size()) {
    for (const CaptureRun& run : runs) {
      const XfbBuffer& buffer = feedback.buffer[run.buffer];
      std::byte* const to = buffer.data + buffer.offset + run.byte;
      if (run.words) {
        std::memcpy(to, words + run.from, std::size_t{4} * run.count);
        continue;
      }
      const std::uint32_t offset = captures[run.from].offset;
      std::uint32_t bits = words[run.from];
      if ((offset & spirv::kXfbHalf) != 0) bits = base::float_to_half_nearest(std::bit_cast<float>(bits));
      std::memcpy(to, &bits, spirv::captured_bytes(offset));
    }
    for (std::uint32_t b = 0; b < spirv::kMaxXfbBuffers; ++b)
      if ((used >> b & 1) != 0) feedback.buffer[b].offset += plan.xfb_stride[b];
  }
}

void count(std::atomic<std::uint64_t>* counter, std::uint64_t value) {
  if (counter) counter->fetch_add(value, std::memory_order_relaxed);
}

std::span<const Capture> captures_of(const PipelinePlan& plan, std::uint32_t stream) {
  return {plan.capture.data() + plan.capture_begin[stream], plan.capture.data() + plan.capture_begin[stream + 1]};
}

}  // namespace

bool is_captured(const DrawCall& draw) {
  if (draw.feedback) return true;
  for (std::uint32_t stream = 0; stream < kMaxStreams; ++stream)
    if (draw.queries.feedback[stream] || draw.queries.generated[stream]) return true;
  return false;
}

void capture_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                  CaptureScratch& scratch) {
  const std::span<const Capture> captures = captures_of(plan, 0);
  const std::size_t stride = captures.size();
  constexpr std::size_t kGroup = 4;  // of a record, store_records
  const std::size_t words = (std::size_t{base} + lanes) * stride + kGroup;
  if (scratch.vertices.size() < words) scratch.vertices.resize(words);
  std::uint32_t* const to = scratch.vertices.data() + std::size_t{base} * stride;
  const auto lanes_of = [&](std::size_t k) { return outputs.at(captures[k].reg).lane; };
  if (stride < kGroup) {
    for (std::size_t k = 0; k < stride; ++k)
      for (std::uint32_t i = 0; i < lanes; ++i) to[i * stride + k] = lanes_of(k)[i];
    return;
  }
  // The last group may reach into the vertex behind: that one's first group comes after it.
  for (std::size_t k = (stride - 1) / kGroup * kGroup + kGroup; k != 0;) {
    k -= kGroup;
    const std::uint32_t* from[kGroup];
    for (std::size_t c = 0; c < kGroup; ++c) from[c] = lanes_of(std::min(k + c, stride - 1));
    store_records(from, lanes, to + k, static_cast<std::uint32_t>(stride));
  }
}

/// Primitives whose corners are these slots, one after the other.
void capture_list(const PipelinePlan& plan, std::span<const std::uint16_t> slots, CaptureScratch& scratch) {
  const std::size_t stride = captures_of(plan, 0).size();
  std::vector<std::uint32_t>& words = scratch.words[0];
  for (std::size_t begin = 0, end = 0; begin < slots.size(); begin = end) {
    // Vertices that no primitives share lie as they are wanted.
    for (end = begin + 1; end < slots.size() && slots[end] == slots[end - 1] + 1; ++end)
      ;
    const std::uint32_t* const from = scratch.vertices.data() + slots[begin] * stride;
    words.insert(words.end(), from, from + (end - begin) * stride);
  }
  scratch.primitives[0] += static_cast<std::uint32_t>(slots.size()) / plan.corners;
}

void capture_primitive(const PipelinePlan& plan, const std::uint32_t* slot, CaptureScratch& scratch) {
  const std::size_t stride = captures_of(plan, 0).size();
  for (std::uint32_t c = 0; c < plan.corners; ++c) {
    const auto vertex = scratch.vertices.begin() + static_cast<std::ptrdiff_t>(slot[c] * stride);
    scratch.words[0].insert(scratch.words[0].end(), vertex, vertex + static_cast<std::ptrdiff_t>(stride));
  }
  ++scratch.primitives[0];
}

void capture_runs(const Chunk& chunk, const VertexScratch& vertices, CaptureScratch& scratch) {
  const PipelinePlan& plan = *chunk.draw->plan;
  const State& state = *plan.state;
  if (is_list_in_order(state.topology)) return capture_list(plan, {vertices.slot.data(), positions_of(chunk)}, scratch);
  for_each_primitive(chunk, [&](const Run&, std::uint32_t i, const auto& entry_of) {
    const Corners corners = corners_of(state.topology, state.provoking_vertex_last, i);
    std::uint32_t slot[3] = {};
    for (std::uint32_t c = 0; c < plan.corners; ++c) slot[c] = vertices.slot[entry_of(corners.at[c])];
    capture_primitive(plan, slot, scratch);
  });
}

void capture_emitted(const PipelinePlan& plan, std::uint32_t stream, std::span<const ListedPrimitive> primitives,
                     std::span<const std::uint32_t> emitted, const std::uint32_t* memory, CaptureScratch& scratch) {
  const std::span<const Capture> captures = captures_of(plan, stream);
  for (const ListedPrimitive& primitive : primitives)
    for (std::uint32_t c = 0; c < plan.corners; ++c)
      for (const Capture& capture : captures)
        scratch.words[stream].push_back(memory[emitted[primitive.slot[c]] + capture.reg]);
  scratch.primitives[stream] += static_cast<std::uint32_t>(primitives.size());
}

const CaptureOutput* finish_capture(Arena& arena, CaptureScratch& scratch) {
  CaptureOutput* output = nullptr;
  for (std::uint32_t stream = 0; stream < kMaxStreams; ++stream) {
    if (scratch.primitives[stream] == 0) continue;
    if (!output) output = new (arena.take<CaptureOutput>(1)) CaptureOutput{};
    std::vector<std::uint32_t>& words = scratch.words[stream];
    std::uint32_t* stored = arena.take<std::uint32_t>(words.size());
    std::copy(words.begin(), words.end(), stored);
    output->stream[stream] = {stored, scratch.primitives[stream]};
    words.clear();
    scratch.primitives[stream] = 0;
  }
  return output;
}

void write_capture(const DrawRecord& draw, const CaptureOutput& output) {
  const PipelinePlan& plan = *draw.plan;
  TransformFeedback* feedback = draw.call.feedback;
  const QueryCounters& queries = draw.call.queries;
  for (std::uint32_t stream = 0; stream < kMaxStreams; ++stream) {
    const CaptureOutput::Stream& captured = output.stream[stream];
    const std::span<const Capture> captures = captures_of(plan, stream);
    std::uint64_t written = 0;
    if (feedback && !captures.empty()) {
      written = fitting(*feedback, plan, captures, captured.primitives);
      write_vertices(*feedback, plan, captures, captured.words, written * plan.corners);
    }
    count(queries.generated[stream], captured.primitives);
    if (!feedback || !queries.feedback[stream]) continue;
    count(&queries.feedback[stream][0], written);
    count(&queries.feedback[stream][1], captured.primitives);
  }
}

}  // namespace vitrine::raster
