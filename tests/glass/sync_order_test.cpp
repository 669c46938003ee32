// What orders commands, without a device: clocks of stages, records of bytes, and what hazards say of both.
#include <gtest/gtest.h>

#include "glass/sync/byte_set.h"
#include "glass/sync/hazards.h"

namespace vitrine::glass::sync {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kCopy = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkAccessFlags2 kShaderWrite = VK_ACCESS_2_SHADER_WRITE_BIT, kShaderRead = VK_ACCESS_2_SHADER_READ_BIT;
constexpr Use kStore{Stage::kCompute, Access::kStorageWrite}, kLoad{Stage::kCompute, Access::kStorageRead};
constexpr Use kRead{Stage::kCopy, Access::kTransferRead};

Tag work(std::uint32_t command) { return make_tag(1, command, Part::kWork); }

/// One barrier of all memory, recorded as a command.
void barrier(Order& order, std::uint32_t command, VkPipelineStageFlags2 first, VkAccessFlags2 writes,
             VkPipelineStageFlags2 second, VkAccessFlags2 accesses) {
  const Clock before = order.before(first_scope(first, writes), make_tag(1, command, Part::kBefore));
  order.after(second_scope(second, accesses), before, true);
}

TEST(SyncOrder, StagesAreLogicallyEarlierAndLater) {
  const Scope first = first_scope(VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, 0);
  EXPECT_NE(first.executed & bit(Stage::kIndex), 0u);
  EXPECT_EQ(first.executed & bit(Stage::kFragment), 0u);
  EXPECT_EQ(first.accessed, bit(Stage::kVertex));
  const Scope second = second_scope(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, kShaderRead);
  EXPECT_NE(second.executed & bit(Stage::kColor), 0u);
  EXPECT_EQ(second.executed & bit(Stage::kEarlyTests), 0u);
  EXPECT_EQ(second.executed & bit(Stage::kCompute), 0u);
}

TEST(SyncOrder, TopAndBottomOfThePipeWaitForNobody) {
  EXPECT_TRUE(first_scope(VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT, 0).empty());
  EXPECT_TRUE(second_scope(VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, 0).empty());
  EXPECT_EQ(first_scope(VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, 0).accessed, 0u);
  EXPECT_EQ(first_scope(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0).executed & bit(Stage::kHost), 0u);
}

TEST(SyncOrder, AWriteIsUnorderedThenNotAvailableThenNotVisibleThenVisible) {
  Order order;
  const PastWrite write{kStore, work(1), {}};
  EXPECT_EQ(order.standing(write, kLoad), Standing::kUnordered);
  barrier(order, 2, kCompute, 0, kCompute, kShaderRead);
  EXPECT_EQ(order.standing(write, kLoad), Standing::kNotAvailable);
  barrier(order, 3, kCompute, kShaderWrite, kCompute, VK_ACCESS_2_UNIFORM_READ_BIT);
  EXPECT_EQ(order.standing(write, kLoad), Standing::kNotVisible);
  barrier(order, 4, kCompute, kShaderWrite, kCompute, kShaderRead);
  EXPECT_EQ(order.standing(write, kLoad), Standing::kVisible);
  EXPECT_EQ(order.standing({kStore, work(5), {}}, kLoad), Standing::kUnordered) << "it comes behind the barrier";
}

TEST(SyncOrder, WhatWaitsForAllComesBehindABarrierToNoStage) {
  const Order order;
  const Passage passages[] = {{second_scope(VK_PIPELINE_STAGE_2_NONE, 0), make_tag(1, 2, Part::kBefore)}};
  const PastWrite write{kStore, work(1), passages};
  const auto standing_before = [&](VkPipelineStageFlags2 first, std::uint32_t command) {
    return Order::standing(write, order.before(first_scope(first, 0), make_tag(1, command, Part::kBefore)));
  };
  EXPECT_EQ(standing_before(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 3), Standing::kVisible);
  EXPECT_EQ(standing_before(kCompute, 3), Standing::kNotAvailable);
}

TEST(SyncOrder, ChainsHoldWhereStagesMeet) {
  Order order;
  const PastWrite write{kStore, work(1), {}};
  barrier(order, 2, kCompute, kShaderWrite, kCopy, 0);
  barrier(order, 3, VK_PIPELINE_STAGE_2_BLIT_BIT, 0, kCompute, kShaderRead);
  EXPECT_EQ(order.standing(write, kLoad), Standing::kUnordered);
  barrier(order, 4, kCopy, 0, kCompute, kShaderRead);
  EXPECT_EQ(order.standing(write, kLoad), Standing::kVisible);
}

TEST(SyncRecords, KeepWhatAdjoinsTogetherAndSplitWhereItMust) {
  Records records;
  const auto who = std::make_shared<Who>();
  const auto write = [&](std::uintptr_t first, std::uintptr_t end, Tag tag) {
    records.update({first, end}, [&](const Range&, State& state) { state = {{kStore, tag, 0, who}, {}, {}}; });
  };
  write(0, 64, 1);
  write(64, 128, 1);
  EXPECT_EQ(records.size(), 1u);
  write(32, 40, 2);
  EXPECT_EQ(records.size(), 3u);
  std::vector<Range> seen;
  records.look({30, 50}, [&](const Range& bytes, const State&) { seen.push_back(bytes); });
  EXPECT_EQ(seen, (std::vector<Range>{{30, 32}, {32, 40}, {40, 50}}));
  records.forget({0, 36});
  EXPECT_EQ(records.size(), 2u);
  records.forget_until(1);
  EXPECT_EQ(records.size(), 1u);
}

TEST(SyncBytes, AreRangesInOrder) {
  ByteSet bytes;
  bytes.add(2040, 16);
  bytes.add(100, 1);
  bytes.add(101, 63);
  EXPECT_EQ(bytes.ranges(), (std::vector<Range>{{100, 164}, {2040, 2056}}));
}

/// A device without one.
class SyncHazards : public ::testing::Test {
 protected:
  void touch(std::uint32_t command, Use use, Range range, const char* what) {
    auto who = std::make_shared<Who>();
    who->what = who->place = what;
    who->address.submission = 1;
    who->address.command = command;
    hazards.touch(work(command), {use, 0, {range}, who, {}});
  }
  std::vector<std::string> found() {
    hazards.end_submission();
    std::vector<std::string> texts;
    for (const Finding& finding : hazards.take())
      texts.push_back(std::string(finding.rule->id) + " " + std::to_string(finding.address.command) + " behind " +
                      std::to_string(finding.related.at(0).address.command) + ", " + std::to_string(finding.count));
    return texts;
  }
  Hazards hazards;
};

TEST_F(SyncHazards, AreToldOnceForTwoPlacesWithTheirNumber) {
  hazards.begin_submission(1, 0);
  for (std::uint32_t n = 0; n < 3; ++n) {
    touch(2 * n + 1, kStore, {0, 64}, "store");
    touch(2 * n + 2, kRead, {0, 64}, "copy");
  }
  EXPECT_EQ(found(),
            (std::vector<std::string>{"sync-read-after-write 2 behind 1, 3", "sync-write-after-read 3 behind 2, 2"}));
  EXPECT_EQ(found(), std::vector<std::string>{});
}

TEST_F(SyncHazards, ComeInTheOrderOfCommandsHoweverTheyAreTold) {
  hazards.begin_submission(1, 0);
  touch(2, kRead, {0, 64}, "copy");
  touch(1, kStore, {0, 64}, "store");
  EXPECT_EQ(found(), std::vector<std::string>{"sync-read-after-write 2 behind 1, 1"});
}

TEST_F(SyncHazards, NameThePlaceThatTouchedTheByte) {
  hazards.begin_submission(1, 0);
  const auto several = std::make_shared<Several>();
  Touch both{{Stage::kCompute, Access::kStorageWrite}, 0, {{0, 64}}, nullptr, {}};
  for (std::uintptr_t part = 0; part < 2; ++part) {
    auto who = std::make_shared<Who>();
    who->what = who->place = part == 0 ? "even" : "odd";
    auto& [bytes, place] = several->parts.emplace_back();
    for (std::uintptr_t at = part * 4; at < 64; at += 8) bytes.add(at, 4);
    place = std::move(who);
  }
  both.who = several->parts[0].second;
  both.several = several;
  hazards.touch(work(1), std::move(both));
  touch(2, kRead, {12, 16}, "copy");
  hazards.end_submission();
  const std::vector<Finding> findings = hazards.take();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].related.at(0).message.substr(0, 3), "odd");
}

TEST_F(SyncHazards, EndWhereTheHostHasWaited) {
  hazards.begin_submission(1, 0);
  touch(1, kStore, {0, 64}, "store");
  hazards.end_submission();
  hazards.signal_fence(this);
  hazards.host_waited(this);
  hazards.begin_submission(2, hazards.host());
  auto who = std::make_shared<Who>();
  hazards.touch(make_tag(2, 1, Part::kWork), {kRead, 0, {{0, 64}}, who, {}});
  EXPECT_EQ(found(), std::vector<std::string>{});
}

TEST_F(SyncHazards, AreForgottenWithTheirMemory) {
  hazards.begin_submission(1, 0);
  touch(1, kStore, {0, 64}, "store");
  hazards.settle();
  hazards.forget({0, 64});
  touch(2, kRead, {0, 64}, "copy");
  EXPECT_EQ(found(), std::vector<std::string>{});
}

}  // namespace
}  // namespace vitrine::glass::sync
