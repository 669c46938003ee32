// Recording, submitting, replaying what needs no shader: buffers, queries, events, secondary command buffers, errors
// that stick.
#include "icd/replay/replay.h"

#include <cstring>
#include <thread>
#include <vector>

#include "icd/record/command_buffer.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

class Replay : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
    auto info = make_struct<VkCommandPoolCreateInfo>();
    info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &info, nullptr, &pool), VK_SUCCESS);
    buffer = make_buffer(64 * 1024, &words);
  }
  void TearDown() override {
    VK_GET(instance, DestroyCommandPool)(device, pool, nullptr);
    for (VkBuffer b : buffers) VK_GET(instance, DestroyBuffer)(device, b, nullptr);
    for (VkDeviceMemory m : memories) VK_GET(instance, FreeMemory)(device, m, nullptr);
    DeviceTest::TearDown();
  }
  VkBuffer make_buffer(VkDeviceSize size, std::uint32_t** mapped) {
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    VkBuffer out;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &out), VK_SUCCESS);
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = size;
    VkDeviceMemory memory;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, out, memory, 0), VK_SUCCESS);
    void* data;
    EXPECT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    *mapped = static_cast<std::uint32_t*>(data);
    buffers.push_back(out);
    memories.push_back(memory);
    return out;
  }
  VkCommandBuffer make_commands(VkCommandBufferLevel level = VK_COMMAND_BUFFER_LEVEL_PRIMARY) {
    auto info = make_struct<VkCommandBufferAllocateInfo>();
    info.commandPool = pool;
    info.level = level;
    info.commandBufferCount = 1;
    VkCommandBuffer out;
    EXPECT_EQ(VK_GET(instance, AllocateCommandBuffers)(device, &info, &out), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    EXPECT_EQ(VK_GET(instance, BeginCommandBuffer)(out, &begin), VK_SUCCESS);
    return out;
  }
  VkResult submit(VkCommandBuffer commands) {
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    return VK_GET(instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
  }
  void end_and_run(VkCommandBuffer commands) {
    ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(commands), VK_SUCCESS);
    ASSERT_EQ(submit(commands), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  }
  VkQueryPool make_query_pool(VkQueryType type, std::uint32_t count, VkQueryPipelineStatisticFlags statistics = 0) {
    auto info = make_struct<VkQueryPoolCreateInfo>();
    info.queryType = type;
    info.queryCount = count;
    info.pipelineStatistics = statistics;
    VkQueryPool out;
    EXPECT_EQ(VK_GET(instance, CreateQueryPool)(device, &info, nullptr, &out), VK_SUCCESS);
    return out;
  }

  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  std::uint32_t* words = nullptr;
  std::vector<VkBuffer> buffers;
  std::vector<VkDeviceMemory> memories;
};

TEST_F(Replay, FillsUpdatesAndCopiesInOrder) {
  const VkCommandBuffer c = make_commands();
  const std::uint32_t update[2] = {1, 2};
  const VkBufferCopy copy{0, 4096, 16};
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, VK_WHOLE_SIZE, 7);
  VK_GET(instance, CmdUpdateBuffer)(c, buffer, 4, sizeof update, update);
  VK_GET(instance, CmdCopyBuffer)(c, buffer, buffer, 1, &copy);
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, 4, 9);
  end_and_run(c);
  const std::uint32_t expected[4] = {7, 1, 2, 7};
  EXPECT_EQ(std::memcmp(words + 1024, expected, 16), 0);
  EXPECT_EQ(words[0], 9u);
  EXPECT_EQ(words[16 * 1024 - 1], 7u);
}

TEST_F(Replay, RunsAgainUnchangedAndSecondariesToo) {
  const VkCommandBuffer secondary = make_commands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
  const VkBufferCopy copy{0, 4, 4};
  VK_GET(instance, CmdCopyBuffer)(secondary, buffer, buffer, 1, &copy);
  ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(secondary), VK_SUCCESS);
  const VkCommandBuffer c = make_commands();
  VK_GET(instance, CmdExecuteCommands)(c, 1, &secondary);
  ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(c), VK_SUCCESS);
  for (const std::uint32_t value : {5u, 6u}) {
    words[0] = value;
    words[1] = 0;
    ASSERT_EQ(submit(c), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
    EXPECT_EQ(words[1], value);
  }
}

TEST_F(Replay, WaitsForEventsThatTheHostSetsLater) {
  const auto info = make_struct<VkEventCreateInfo>();
  VkEvent event;
  ASSERT_EQ(VK_GET(instance, CreateEvent)(device, &info, nullptr, &event), VK_SUCCESS);
  const VkCommandBuffer c = make_commands();
  VK_GET(instance, CmdWaitEvents)
  (c, 1, &event, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, nullptr, 0, nullptr, 0, nullptr);
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, 4, 3);
  VK_GET(instance, CmdResetEvent)(c, event, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(c), VK_SUCCESS);
  ASSERT_EQ(submit(c), VK_SUCCESS) << "must not block";
  ASSERT_EQ(VK_GET(instance, SetEvent)(device, event), VK_SUCCESS);
  ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  EXPECT_EQ(words[0], 3u);
  EXPECT_EQ(VK_GET(instance, GetEventStatus)(device, event), VK_EVENT_RESET);
  VK_GET(instance, DestroyEvent)(device, event, nullptr);
}

TEST_F(Replay, TimestampsGrowAndBecomeAvailable) {
  const VkQueryPool queries = make_query_pool(VK_QUERY_TYPE_TIMESTAMP, 3);
  std::uint64_t results[3][2] = {};
  const VkQueryResultFlags flags = VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT;
  const auto get = VK_GET(instance, GetQueryPoolResults);
  const VkCommandBuffer c = make_commands();
  VK_GET(instance, CmdResetQueryPool)(c, queries, 0, 3);
  VK_GET(instance, CmdWriteTimestamp)(c, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, queries, 0);
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, VK_WHOLE_SIZE, 1);
  VK_GET(instance, CmdWriteTimestamp)(c, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
  VK_GET(instance, CmdCopyQueryPoolResults)(c, queries, 0, 2, buffer, 64, 16, flags);
  end_and_run(c);
  EXPECT_EQ(get(device, queries, 0, 2, sizeof results, results, 16, flags), VK_SUCCESS);
  EXPECT_GT(results[0][0], 0u);
  EXPECT_GE(results[1][0], results[0][0]);
  EXPECT_EQ(results[1][1], 1u);
  EXPECT_EQ(std::memcmp(words + 16, results, 32), 0) << "the host and the copy disagree";
  EXPECT_EQ(get(device, queries, 0, 3, sizeof results, results, 16, flags), VK_NOT_READY);
  EXPECT_EQ(results[2][1], 0u);
  const VkCommandBuffer later = make_commands();
  VK_GET(instance, CmdResetQueryPool)(later, queries, 0, 3);
  const VkPipelineStageFlags2 stages[] = {VK_PIPELINE_STAGE_2_NONE, VK_PIPELINE_STAGE_2_COPY_BIT,
                                          VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  for (std::uint32_t i = 0; i < 3; ++i) VK_GET(instance, CmdWriteTimestamp2)(later, stages[i], queries, i);
  end_and_run(later);
  const std::uint64_t before = results[1][0];
  EXPECT_EQ(get(device, queries, 0, 3, sizeof results, results, 16, flags), VK_SUCCESS);
  EXPECT_GE(results[0][0], before);
  for (std::uint32_t i = 1; i < 3; ++i) EXPECT_GE(results[i][0], results[i - 1][0]);
  VK_GET(instance, DestroyQueryPool)(device, queries, nullptr);
}

TEST_F(Replay, ResultsSkipDisabledStatisticsAndUnavailableValues) {
  const VkQueryPool queries = make_query_pool(VK_QUERY_TYPE_PIPELINE_STATISTICS, 2,
                                              VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                                                  VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT);
  QueryPool& p = from_handle<QueryPool>(queries);
  reset_queries(p, 0, 2);
  p.counters_of(0)[1] = 11;
  p.counters_of(0)[10] = std::uint64_t{1} << 40;
  p.available[0] = 1;
  std::uint32_t out[2][3] = {{99, 99, 99}, {99, 99, 99}};
  const auto get = VK_GET(instance, GetQueryPoolResults);
  EXPECT_EQ(get(device, queries, 0, 2, sizeof out, out, 12, VK_QUERY_RESULT_WITH_AVAILABILITY_BIT), VK_NOT_READY);
  EXPECT_EQ(out[0][0], 11u);
  EXPECT_EQ(out[0][1], 0xffffffffu);
  EXPECT_EQ(out[0][2], 1u);
  EXPECT_EQ(out[1][0], 99u) << "unavailable results stay untouched";
  EXPECT_EQ(out[1][2], 0u);
  VK_GET(instance, DestroyQueryPool)(device, queries, nullptr);
}

TEST_F(Replay, FirstRecordingErrorSticks) {
  CountingAllocator allocator;
  VkCommandPool counted;
  const auto info = make_struct<VkCommandPoolCreateInfo>();
  ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &info, allocator.callbacks(), &counted), VK_SUCCESS);
  std::swap(pool, counted);
  const VkCommandBuffer c = make_commands();
  allocator.fail_after(0);
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, 4, 1);
  allocator.fail_after(~std::size_t{0});
  VK_GET(instance, CmdFillBuffer)(c, buffer, 0, 4, 1);
  EXPECT_EQ(VK_GET(instance, EndCommandBuffer)(c), VK_ERROR_OUT_OF_HOST_MEMORY);
  EXPECT_EQ(VK_GET(instance, ResetCommandBuffer)(c, 0), VK_SUCCESS);
  const auto begin = make_struct<VkCommandBufferBeginInfo>();
  EXPECT_EQ(VK_GET(instance, BeginCommandBuffer)(c, &begin), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, EndCommandBuffer)(c), VK_SUCCESS);
  std::swap(pool, counted);
  VK_GET(instance, DestroyCommandPool)(device, counted, allocator.callbacks());
  EXPECT_EQ(allocator.live(), 0u);
}

TEST_F(Replay, CutsWhatLeavesTheBuffer) {
  const VkCommandBuffer c = make_commands();
  const VkBufferCopy copies[2] = {{64 * 1024 - 4, 0, 1 << 20}, {1 << 20, 4, 4}};
  words[16 * 1024 - 1] = 42;
  words[1] = 5;
  VK_GET(instance, CmdCopyBuffer)(c, buffer, buffer, 2, copies);
  VK_GET(instance, CmdFillBuffer)(c, buffer, 1 << 20, 4, 1);
  end_and_run(c);
  EXPECT_EQ(words[0], 42u);
  EXPECT_EQ(words[1], 5u);
}

}  // namespace
}  // namespace vitrine::icd::test
