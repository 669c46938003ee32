// The steps of `vitrine reduce`, with questions that need no device.
#include <gtest/gtest.h>

#include <algorithm>

#include "glass/bug/file.h"
#include "glass/cli/reduce_steps.h"
#include "tests/glass/bug/bugs.h"

namespace vitrine::glass::cli {
namespace {

using bug::Bug;

TEST(Reduce, LeavesTheOneWorkgroupThatIsNeeded) {
  Bug bug = bug::small_bug();
  bug.command.groups = {100, 7, 1};
  reduce_invocations(bug, [](const Bug& b) {
    const auto has = [&](int i, std::uint32_t group) {
      return b.command.base[i] <= group && group - b.command.base[i] < b.command.groups[i];
    };
    return has(0, 77) && has(1, 3);
  });
  EXPECT_EQ(bug.command.base, (std::array<std::uint32_t, 3>{77, 3, 0}));
  EXPECT_EQ(bug.command.groups, (std::array<std::uint32_t, 3>{1, 1, 1}));
}

TEST(Reduce, LeavesTheAddressedBufferThatIsNeeded) {
  Bug bug = bug::small_bug();
  bug.memories.push_back({64, 0x7f0000002000, {}});
  bug.buffers.push_back({"far", 64, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, 1, 0});
  bug.buffers.push_back({"near", 64, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, 1, 0});
  bug.addressed = {1, 2};
  const auto needed = [](const Bug& b) {
    return std::ranges::any_of(b.addressed, [&](std::uint32_t number) { return b.buffers[number].name == "near"; });
  };
  reduce_descriptors(bug, needed);
  ASSERT_EQ(bug.addressed.size(), 1u);
  EXPECT_TRUE(needed(bug));
  EXPECT_EQ(bug.buffers.size(), 1u);
}

TEST(Reduce, LeavesTheTriangleThatIsNeeded) {
  Bug bug = bug::small_bug();
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  bug.command.groups = {};
  bug.command.draws = {{30, 0, 0}, {300, 6, 0}, {30, 0, 0}};
  bug.command.instances = 8;
  reduce_invocations(bug, [](const Bug& b) {
    const auto has = [](const bug::Draw& d) { return d.first <= 60 && d.first + d.count >= 63; };
    return b.command.instances > 0 && std::ranges::any_of(b.command.draws, has);
  });
  ASSERT_EQ(bug.command.draws.size(), 1u);
  EXPECT_EQ(bug.command.draws[0].first, 60u);
  EXPECT_EQ(bug.command.draws[0].count, 3u);
  EXPECT_EQ(bug.command.instances, 1u);
}

TEST(Reduce, EmptiesMemoryThatIsNotNeeded) {
  Bug bug = bug::small_bug();
  bug::Bytes bytes(4096, std::byte{7});
  bug.memories[0] = {4096, 0, {{0, false, std::make_shared<bug::Bytes>(bytes), nullptr}}};
  bug.buffers[0].size = 4096;
  reduce_memory(bug, [](const Bug& b) {
    return std::ranges::any_of(b.memories[0].pieces, [](const bug::Piece& p) {
      return p.offset <= 1000 && 1000 < p.offset + p.before->size() && (*p.before)[1000 - p.offset] == std::byte{7};
    });
  });
  std::size_t written = 0, all = 0;
  for (const bug::Piece& piece : bug.memories[0].pieces) {
    all += piece.before->size();
    written += piece.unwritten ? 0 : piece.before->size();
  }
  EXPECT_EQ(all, 4096u);
  EXPECT_EQ(written, 64u);
  EXPECT_EQ(bug::fault_of(bug), "");
}

TEST(Reduce, DropsObjectsThatNothingNames) {
  Bug bug = bug::small_bug();
  bug.memories.insert(bug.memories.begin(), {32, 0, {}});
  bug.buffers[0].memory = 1;
  bug.buffers.insert(bug.buffers.begin(), {"unused", 32, 0, 0, 0});
  bug.descriptors[0].buffer = 1;
  bug.images.resize(2);
  bug.views.resize(1);
  bug.views[0].image = 1;
  drop_unused(bug);
  EXPECT_EQ(bug::fault_of(bug), "");
  ASSERT_EQ(bug.buffers.size(), 1u);
  EXPECT_EQ(bug.buffers[0].name, "particles");
  ASSERT_EQ(bug.memories.size(), 1u);
  EXPECT_EQ(bug.memories[0].pieces.size(), 1u);
  EXPECT_TRUE(bug.images.empty() && bug.views.empty());
}

TEST(Reduce, KeepsStateThatMatters) {
  Bug bug = bug::small_bug();
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  bug.state.depth_test = bug.state.stencil_test = true;
  reduce_state(bug, [](const Bug& b) { return b.state.stencil_test; });
  EXPECT_TRUE(bug.state.stencil_test);
  EXPECT_FALSE(bug.state.depth_test);
}

/// A draw with a shading rate attachment that `bug` has last.
void attach_rates(Bug& bug) {
  bug.stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  bug.images.resize(2);
  bug.images[1].name = "rates";
  bug.views.resize(2);
  bug.views[0].image = 0;
  bug.views[1].image = 1;
  bug.rendering.rate = 1;
  bug.state.rate_combiners[1] = VK_FRAGMENT_SHADING_RATE_COMBINER_OP_REPLACE_KHR;
}

TEST(Reduce, LeavesRatesOutThatAreNotNeeded) {
  Bug bug = bug::small_bug();
  attach_rates(bug);
  Bug same = bug;
  reduce_state(bug, [](const Bug&) { return true; });
  EXPECT_EQ(bug.rendering.rate, bug::kNone);
  EXPECT_TRUE(bug.images.empty());
  const auto needed = [](const Bug& b) {
    return b.rendering.rate != bug::kNone && b.images[b.views[b.rendering.rate].image].name == "rates";
  };
  reduce_state(same, needed);
  drop_unused(same);
  EXPECT_TRUE(needed(same));
  EXPECT_EQ(same.images.size(), 1u);
}

TEST(Reduce, NothingThatIsAllNeeded) {
  const Bug bug = bug::small_bug();
  Bug same = bug;
  const StillFound never = [](const Bug&) { return false; };
  for (const auto step : {reduce_invocations, reduce_descriptors, reduce_memory, reduce_state}) step(same, never);
  EXPECT_EQ(bug::describe(same), bug::describe(bug));
}

}  // namespace
}  // namespace vitrine::glass::cli
