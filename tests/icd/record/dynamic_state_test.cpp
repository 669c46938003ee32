// Dynamic state: every name is known, and copying one state leaves the others alone.
#include "icd/record/dynamic_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "icd/edge/util.h"

namespace vitrine::icd {
namespace {

/// States that are not in raster::State.
bool lies_elsewhere(DynamicState s) {
#ifdef VK_EXT_attachment_feedback_loop_dynamic_state
  if (s == DynamicState::kAttachmentFeedbackLoopEnable) return true;
#endif
  return s == DynamicState::kVertexStride || s == DynamicState::kColorWriteEnable ||
         s == DynamicState::kPatchControlPoints || s == DynamicState::kTessellationDomainOrigin ||
         s == DynamicState::kExtraPrimitiveOverestimationSize;
}

/// A state whose every byte that dynamic state can reach differs from the default.
raster::State unlike_default() {
  raster::State s;
  s.viewport_count = 3;
  s.viewport.fill({1, 2, 3, 4, 0.5f, 0.6f});
  s.scissor.fill({{1, 2}, {3, 4}});
  s.line_width = 5;
  s.depth_bias_constant = s.depth_bias_clamp = s.depth_bias_slope = 2;
  s.blend_constants.fill(0.5f);
  s.min_depth_bounds = 0.25f;
  s.front = s.back = {VK_STENCIL_OP_INVERT, VK_STENCIL_OP_ZERO, VK_STENCIL_OP_REPLACE, VK_COMPARE_OP_LESS, 1, 2, 3};
  s.attribute_count = 2;
  s.sample_mask = 5;
  s.blend.fill({true, VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE,
                VK_BLEND_OP_MAX, VK_BLEND_OP_MIN, 3});
  s.line_stipple_factor = 7;
  s.cull_mode = VK_CULL_MODE_FRONT_BIT;
  s.front_face = VK_FRONT_FACE_CLOCKWISE;
  s.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
  s.depth_test = s.depth_write = s.depth_bounds_test = s.stencil_test = s.rasterizer_discard = s.depth_bias = true;
  s.depth_compare = VK_COMPARE_OP_GREATER;
  s.primitive_restart = s.logic_op_enable = s.depth_clamp = s.alpha_to_coverage = s.alpha_to_one = true;
  s.provoking_vertex_last = s.line_stipple = s.negative_one_to_one = true;
  s.logic_op = VK_LOGIC_OP_XOR;
  s.depth_clip = false;
  s.discard.fill({{1, 2}, {3, 4}});
  s.discard_count = 3;
  s.discard_inside = true;
  s.rasterized_stream = 2;
  s.overestimates = true;
  s.polygon_mode = VK_POLYGON_MODE_LINE;
  s.samples = 4;
  s.line_mode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
  s.custom_locations = true;
  s.locations = raster::kFourSamples;
  s.fragment_size = {2, 4};
  return s;
}

raster::SampleLocations located(std::uint32_t per_pixel, const std::vector<VkSampleLocationEXT>& locations) {
  VkSampleLocationsInfoEXT info = make_struct<VkSampleLocationsInfoEXT>();
  info.sampleLocationsPerPixel = static_cast<VkSampleCountFlagBits>(per_pixel);
  info.sampleLocationGridSize = {1, 1};
  info.sampleLocationsCount = static_cast<std::uint32_t>(locations.size());
  info.pSampleLocations = locations.data();
  return sample_locations(info);
}

TEST(DynamicStates, SampleLocationsAreSixteenthsInsideThePixel) {
  const float nan = std::nanf("");
  const raster::SampleLocations four = located(4, {{0.5f, 0.9375f}, {0.51f, 1.0f}, {-3.0f, 1e9f}, {nan, 0.0f}});
  EXPECT_EQ(four.count, 4u);
  EXPECT_EQ(std::vector<std::int32_t>(four.x, four.x + 8), (std::vector<std::int32_t>{128, 128, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(std::vector<std::int32_t>(four.y, four.y + 8), (std::vector<std::int32_t>{240, 240, 240, 0, 0, 0, 0, 0}));
}

TEST(DynamicStates, SampleLocationsThatCannotBeAreTheStandardOnes) {
  EXPECT_EQ(located(4, {{0.5f, 0.5f}}).x[1], raster::kFourSamples.x[1]) << "fewer than the count";
  EXPECT_EQ(located(16, std::vector<VkSampleLocationEXT>(16)).count, 1u);
  EXPECT_EQ(located(0, {}).count, 1u);
}

TEST(DynamicStates, EveryStateIsCopiedAlone) {
  const raster::State source = unlike_default();
  raster::State all;
  for (int i = 0; i < static_cast<int>(DynamicState::kCount); ++i) {
    const auto which = static_cast<DynamicState>(i);
    if (lies_elsewhere(which)) continue;
    raster::State one;
    copy_state(source, which, one);
    EXPECT_NE(std::memcmp(&one, &all, sizeof one), 0) << i << " copies nothing";
    // Copying back from a default state restores what was there.
    copy_state(raster::State{}, which, one);
    const raster::State plain;
    EXPECT_EQ(one.cull_mode, plain.cull_mode);
    EXPECT_EQ(one.blend[0].write_mask, plain.blend[0].write_mask);
    EXPECT_EQ(one.viewport_count, plain.viewport_count);
  }
}

TEST(DynamicStates, ColorWritesCloseMasks) {
  raster::State state;
  apply_color_writes(state, 0b10);
  EXPECT_EQ(state.blend[0].write_mask, 0u);
  EXPECT_EQ(state.blend[1].write_mask, 0xfu);
}

TEST(DynamicStates, UnknownNamesAreNotDynamic) {
  EXPECT_EQ(dynamic_state_of(VK_DYNAMIC_STATE_COVERAGE_REDUCTION_MODE_NV), DynamicState::kCount);
  EXPECT_EQ(dynamic_state_of(VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT), DynamicState::kScissorCount);
}

}  // namespace
}  // namespace vitrine::icd
