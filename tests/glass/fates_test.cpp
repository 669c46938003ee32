// What draws are counted as: by draw, by pipeline, in all; and how often fragments lie on each other.
#include "glass/fates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "glass/draw_observers.h"

namespace vitrine::glass::test {
namespace {

using raster::FragmentGroup;
using raster::FragmentTest;

struct Command : spirv::ObservedCommand {
  Command(std::uint32_t number, std::string pipeline_name, std::uint64_t pass_number) {
    submission = 1;
    command = number;
    name = "vkCmdDraw";
    pipeline = std::move(pipeline_name);
    pipeline_number = 7;
    pass = pass_number;
  }
  std::string resource(std::uint32_t, std::uint32_t) const override { return {}; }
};

/// Quads side by side from the top left corner of a tile on.
FragmentGroup quads() {
  FragmentGroup group;
  for (std::uint16_t q = 0; q < base::kQuadsPerWave; ++q) {
    group.position.x[q] = static_cast<std::uint16_t>(2 * q);
    group.position.y[q] = 0;
  }
  return group;
}

std::uint64_t value_of(const Fates& fates, const std::string& name) {
  for (const FateCounter& counter : fate_counters())
    if (std::string(counter.group) + "/" + counter.name == name) return counter.value(fates);
  ADD_FAILURE() << name;
  return 0;
}

/// Eight fragments of which three fail the depth test, the others are shaded and written.
void draw(raster::DrawObserver& observer, const Command& command) {
  static const texel::ImageView view = [] {
    texel::ImageView color;
    color.format = &texel::format_desc(VK_FORMAT_R8G8B8A8_UNORM);
    return color;
  }();
  const auto chunk = observer.watch_chunk(&command);
  chunk->assembled(3, 1);
  chunk->primitive(0, std::nullopt, raster::PrimitiveFate::kRasterized);
  const auto tile = observer.watch_tile(&command, 0);
  const FragmentGroup group = quads();
  const base::LaneMask all = 0xff, lost = 0x07, left = all & ~lost;
  tile->generated(group, {&all, 1});
  tile->failed(group, FragmentTest::kDepth, {&lost, 1}, {&left, 1});
  tile->shaded(group, left, lost);
  tile->passed(group, {&left, 1});
  tile->written(group, view, {&left, 1});
}

TEST(Fates, AddUpByDrawPipelineAndProcess) {
  DrawCounts counts(true);
  draw(counts, {1, "gauss", 1});
  draw(counts, {2, "", 1});
  draw(counts, {2, "", 1});
  const auto pipelines = counts.of_pipelines();
  ASSERT_EQ(pipelines.size(), 2u);
  EXPECT_EQ(value_of(pipelines.at("gauss"), "/vertices"), 3u);
  EXPECT_EQ(value_of(pipelines.at("pipeline 7"), "primitives/rasterized"), 2u);
  EXPECT_EQ(value_of(pipelines.at("pipeline 7"), "fragments/depth"), 6u);
  const auto draws = counts.of_draws();
  ASSERT_EQ(draws.size(), 2u);
  EXPECT_EQ(draws[1].command, 2u);
  EXPECT_EQ(value_of(draws[1].fates, "fragments/generated"), 16u);
  const Fates total = counts.total();
  EXPECT_EQ(value_of(total, "fragments/passed"), 15u);
  EXPECT_EQ(value_of(total, "shading/helpers"), 9u);
  EXPECT_EQ(value_of(total, "shading/idleLanes"), 3u * 56);
  EXPECT_EQ(value_of(total, "attachments/bytes"), 60u);
}

TEST(Fates, SamplesOfOneFragmentEndItOnce) {
  DrawCounts counts(false);
  const Command command(1, "", 1);
  {
    const auto tile = counts.watch_tile(&command, 0);
    const FragmentGroup group = quads();
    const base::LaneMask none[2] = {0, 0}, first[2] = {1, 0}, second[2] = {0, 1};
    tile->failed(group, FragmentTest::kStencil, first, second);
    tile->failed(group, FragmentTest::kDepth, second, none);
  }
  EXPECT_EQ(value_of(counts.total(), "fragments/stencil"), 0u);
  EXPECT_EQ(value_of(counts.total(), "fragments/depth"), 1u);
}

TEST(Fates, OverdrawIsOfOnePass) {
  DrawCounts counts(false);
  for (const std::uint64_t pass : {1, 1, 1, 2, 3, 4, 5, 6}) draw(counts, {1, "", pass});
  EXPECT_EQ(counts.overdraw().pixels, 6u * 5);
  EXPECT_EQ(counts.overdraw().most, 3u);
}

TEST(Fates, OverdrawAddsWholeBlocksAndPixels) {
  DrawCounts counts(false);
  for (const std::uint64_t pass : {1, 2, 3, 4, 5, 6, 7}) {  // memory of the first ones is used again
    const Command command(1, "", pass);
    const auto tile = counts.watch_tile(&command, 3);
    FragmentGroup block, beside = quads();
    raster::place_block(64 + 16, 128 + 8, block.position);
    tile->shaded(block, base::kAllLanes, 0);
    tile->shaded(block, base::kAllLanes, 0);
    tile->shaded(block, 0x11, 0);              // two pixels of it
    tile->shaded(beside, base::kAllLanes, 0);  // 32 x 2 pixels, no block
    raster::place_block(64 + 18, 128 + 8, block.position);
    tile->shaded(block, base::kAllLanes, 0);  // no block of the grid: 16 new pixels
  }
  EXPECT_EQ(counts.overdraw().pixels, 7u * (64 + 64 + 16));
  EXPECT_EQ(counts.overdraw().most, 4u);
}

TEST(Fates, CountsWholeBlocksAsTheirFragments) {
  texel::ImageView color;
  color.format = &texel::format_desc(VK_FORMAT_R8G8B8A8_UNORM);
  DrawCounts counts(false), singly(false);
  const Command command(1, "", 1);
  const base::LaneMask places = 0b1010011, all = base::kAllLanes;
  auto whole = counts.watch_tile(&command, 3), tile = singly.watch_tile(&command, 3);
  ASSERT_TRUE(whole->takes_numbers());
  for (int layer = 0; layer < 2; ++layer) whole->shaded_blocks(places);
  raster::FragmentNumbers numbers;
  numbers.generated = numbers.passed = numbers.texels = 2 * 64 * 4;
  numbers.bytes = 4 * numbers.texels;
  whole->numbers(numbers);
  for (int layer = 0; layer < 2; ++layer)
    base::for_each_lane(places, [&](std::size_t place) {
      FragmentGroup block;
      raster::place_block(64 + 8 * raster::lane_x(static_cast<std::uint32_t>(place)),
                          128 + 8 * raster::lane_y(static_cast<std::uint32_t>(place)), block.position);
      tile->generated(block, {&all, 1});
      tile->shaded(block, all, 0);
      tile->passed(block, {&all, 1});
      tile->written(block, color, {&all, 1});
    });
  const FragmentGroup beside = quads();  // on parts of two of the blocks
  for (auto* watch : {&whole, &tile}) {
    (*watch)->shaded(beside, all, 0);
    watch->reset();
  }
  for (const FateCounter& counter : fate_counters())
    EXPECT_EQ(counter.value(counts.total()), counter.value(singly.total())) << counter.name;
  EXPECT_EQ(value_of(counts.total(), "fragments/passed"), 2 * 64 * 4);
  EXPECT_EQ(counts.overdraw().pixels, singly.overdraw().pixels);
  EXPECT_EQ(counts.overdraw().most, singly.overdraw().most);
}

TEST(Fates, SeveralObserversHearTheSame) {
  DrawCounts one(false), two(false);
  DrawObservers both;
  EXPECT_EQ(both.observer(), nullptr);
  both.add(one);
  EXPECT_EQ(both.observer(), &one);
  both.add(two);
  draw(*both.observer(), {1, "", 1});
  for (const FateCounter& counter : fate_counters()) EXPECT_EQ(counter.value(one.total()), counter.value(two.total()));
  EXPECT_EQ(value_of(two.total(), "fragments/passed"), 5u);
}

}  // namespace
}  // namespace vitrine::glass::test
