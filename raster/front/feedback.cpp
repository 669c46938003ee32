// Transform feedback.
#include "raster/front/feedback.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/numeric.h"
#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

std::uint32_t byte_of(const Capture& capture) { return capture.offset & spirv::kXfbBytes; }

/// Room for one more primitive: all captures of all its vertices lie inside their buffers.
bool fits(const TransformFeedback& feedback, const PipelinePlan& plan, std::span<const Capture> captures) {
  for (const Capture& capture : captures) {
    const XfbBuffer& buffer = feedback.buffer[capture.buffer];
    const std::uint64_t last = buffer.offset + std::uint64_t{plan.corners - 1} * plan.xfb_stride[capture.buffer];
    if (!buffer.data || last + byte_of(capture) + spirv::captured_bytes(capture.offset) > buffer.size) return false;
  }
  return true;
}

/// Writes one primitive and moves the buffers' offsets on.
void write_primitive(TransformFeedback& feedback, const PipelinePlan& plan, std::span<const Capture> captures,
                     const std::uint32_t* words) {
  std::uint32_t used = 0;
  for (const Capture& capture : captures) used |= 1u << capture.buffer;
  for (std::uint32_t v = 0; v < plan.corners; ++v) {
    for (const Capture& capture : captures) {
      XfbBuffer& buffer = feedback.buffer[capture.buffer];
      std::uint32_t bits = *words++;
      if ((capture.offset & spirv::kXfbHalf) != 0) bits = base::float_to_half_nearest(std::bit_cast<float>(bits));
      std::memcpy(buffer.data + buffer.offset + byte_of(capture), &bits, spirv::captured_bytes(capture.offset));
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
  if (scratch.vertices.size() < (std::size_t{base} + lanes) * stride) scratch.vertices.resize((base + lanes) * stride);
  for (std::size_t k = 0; k < stride; ++k) {
    const std::uint32_t* lane = outputs.at(captures[k].reg).lane;
    for (std::uint32_t i = 0; i < lanes; ++i) scratch.vertices[(base + i) * stride + k] = lane[i];
  }
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
      const std::uint32_t* words = captured.words;
      for (std::uint32_t p = 0; p < captured.primitives; ++p, words += captures.size() * plan.corners) {
        if (!fits(*feedback, plan, captures)) continue;
        write_primitive(*feedback, plan, captures, words);
        ++written;
      }
    }
    count(queries.generated[stream], captured.primitives);
    if (!feedback || !queries.feedback[stream]) continue;
    count(&queries.feedback[stream][0], written);
    count(&queries.feedback[stream][1], captured.primitives);
  }
}

}  // namespace vitrine::raster
