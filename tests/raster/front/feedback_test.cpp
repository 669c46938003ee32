// What a chunk of lists captures and how it is written: any number of words a vertex, shared vertices, several waves.
#include "raster/front/feedback.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kVertices = 150;

std::uint32_t value_of(std::uint32_t vertex, std::uint32_t word) { return 1000 * (vertex + 1) + word; }

/// A draw whose vertices give `words` words to one buffer, and its chunk.
struct Captured {
  State state;
  std::unique_ptr<PipelinePlan> plan = std::make_unique<PipelinePlan>();
  std::unique_ptr<DrawRecord> draw = std::make_unique<DrawRecord>();
  Run run{};
  Chunk chunk;
  VertexScratch vertices;
  CaptureScratch scratch;

  Captured(VkPrimitiveTopology topology, std::uint32_t words, const std::vector<std::uint16_t>& slots) {
    state.topology = topology;
    plan->state = &state;
    plan->shape = topology_of(topology).shape;
    plan->corners = plan->shape.corners;
    for (std::uint32_t k = 0; k < words; ++k) plan->capture[k] = {words - 1 - k, 4 * k, 0};
    plan->capture_begin.fill(words);
    plan->capture_begin[0] = 0;
    draw->plan = plan.get();
    const auto positions = static_cast<std::uint32_t>(slots.size());
    run.end = (positions - plan->shape.first) / plan->shape.step + 1;
    chunk.draw = draw.get();
    chunk.runs = &run;
    chunk.run_count = 1;
    vertices.slot = slots;
  }

  /// The vertex shader's waves: register r of vertex v is word (words - 1 - r) of it.
  void shade(std::uint32_t words) {
    std::vector<base::WaveRegister> registers(words);
    for (std::uint32_t base = 0; base < kVertices; base += base::kWaveWidth) {
      const std::uint32_t lanes = std::min<std::uint32_t>(kVertices - base, base::kWaveWidth);
      for (std::uint32_t r = 0; r < words; ++r)
        for (std::uint32_t i = 0; i < lanes; ++i) registers[r].lane[i] = value_of(base + i, words - 1 - r);
      capture_wave(*plan, {nullptr, registers.data()}, base, lanes, scratch);
    }
  }

  /// Bytes of a buffer of this many, with vertices `stride` bytes apart.
  std::vector<std::uint32_t> write(std::uint32_t stride, std::size_t buffer_words) {
    std::vector<std::uint32_t> memory(buffer_words, 7);
    TransformFeedback feedback;
    feedback.buffer[0] = {reinterpret_cast<std::byte*>(memory.data()), 4 * buffer_words, 0};
    plan->xfb_stride[0] = stride;
    draw->call.feedback = &feedback;
    Arena arena;
    capture_runs(chunk, vertices, scratch);
    write_capture(*draw, *finish_capture(arena, scratch));
    return memory;
  }
};

std::vector<std::uint32_t> expected(const std::vector<std::uint16_t>& slots, std::uint32_t words, std::uint32_t stride,
                                    std::size_t buffer_words) {
  std::vector<std::uint32_t> memory(buffer_words, 7);
  for (std::size_t p = 0; p < slots.size(); ++p)
    for (std::uint32_t k = 0; k < words; ++k) memory[p * stride / 4 + k] = value_of(slots[p], k);
  return memory;
}

TEST(Feedback, ListsOfAnyNumberOfWordsAVertex) {
  std::vector<std::uint16_t> slots(kVertices);
  std::iota(slots.begin(), slots.end(), std::uint16_t{0});
  for (const VkPrimitiveTopology topology :
       {VK_PRIMITIVE_TOPOLOGY_POINT_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST})
    for (const std::uint32_t words : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 11u})
      for (const std::uint32_t stride : {4 * words, 4 * words + 8}) {
        Captured captured(topology, words, slots);
        captured.shade(words);
        const std::size_t room = kVertices * stride / 4;
        EXPECT_EQ(captured.write(stride, room), expected(slots, words, stride, room))
            << topology << ", " << words << " words, stride " << stride;
      }
}

TEST(Feedback, SharedVerticesComeAsOftenAsTheyAreUsed) {
  const std::vector<std::uint16_t> slots = {0, 1, 2, 2, 1, 3, 140, 141, 142, 149, 0, 149};
  Captured captured(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 6, slots);
  captured.shade(6);
  EXPECT_EQ(captured.write(24, 72), expected(slots, 6, 24, 72));
}

TEST(Feedback, StripsTurnEveryOtherTriangle) {
  Captured captured(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 5, {0, 1, 2, 3});
  captured.shade(5);
  EXPECT_EQ(captured.write(20, 30), expected({0, 1, 2, 1, 3, 2}, 5, 20, 30));
}

TEST(Feedback, PrimitivesWithoutRoomAreLeftOut) {
  const std::vector<std::uint16_t> slots = {0, 1, 2, 3, 4, 5};
  Captured captured(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 4, slots);
  captured.shade(4);
  EXPECT_EQ(captured.write(16, 19), expected({0, 1, 2, 3}, 4, 16, 19));
}

TEST(Feedback, WithoutABufferNothingIsWritten) {
  Captured captured(VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 4, {0, 1});
  captured.shade(4);
  EXPECT_EQ(captured.write(16, 0), std::vector<std::uint32_t>());
}

}  // namespace
}  // namespace vitrine::raster
