// Queries of a primary command buffer that count what its secondary ones do (Vulkan 1.3.239, Command Buffers: Secondary
// Command Buffer Execution; feature inheritedQueries).
#include "tests/icd/compute_fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

class InheritedQueries : public ComputeTest {
 protected:
  void SetUp() override {
    ComputeTest::SetUp();
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
    info.layout = layout;
    ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, cache, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    auto query_info = make_struct<VkQueryPoolCreateInfo>();
    query_info.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
    query_info.queryCount = 2;
    query_info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
    ASSERT_EQ(VK_GET(instance, CreateQueryPool)(device, &query_info, nullptr, &queries), VK_SUCCESS);
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  }
  void TearDown() override {
    VK_GET(instance, DestroyCommandPool)(device, pool, nullptr);
    VK_GET(instance, DestroyQueryPool)(device, queries, nullptr);
    VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
    ComputeTest::TearDown();
  }
  void work(VkCommandBuffer commands, std::uint32_t groups) {
    VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_GET(instance, CmdDispatch)(commands, groups, 1, 1);
  }
  /// A secondary command buffer of two dispatches of `groups`.
  VkCommandBuffer secondary(std::uint32_t groups) {
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer out = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, AllocateCommandBuffers)(device, &allocate, &out), VK_SUCCESS);
    auto inheritance = make_struct<VkCommandBufferInheritanceInfo>();
    inheritance.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
    auto begin = make_struct<VkCommandBufferBeginInfo>();
    begin.pInheritanceInfo = &inheritance;
    EXPECT_EQ(VK_GET(instance, BeginCommandBuffer)(out, &begin), VK_SUCCESS);
    work(out, groups);
    work(out, groups);
    EXPECT_EQ(VK_GET(instance, EndCommandBuffer)(out), VK_SUCCESS);
    return out;
  }

  VkPipeline pipeline = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
};

TEST_F(InheritedQueries, CountWhatSecondaryCommandBuffersDo) {
  const VkCommandBuffer two = secondary(2), three = secondary(3);
  run([&](VkCommandBuffer commands) {
    VK_GET(instance, CmdResetQueryPool)(commands, queries, 0, 2);
    VK_GET(instance, CmdBeginQuery)(commands, queries, 0, 0);
    work(commands, 10);
    VK_GET(instance, CmdEndQuery)(commands, queries, 0);
    VK_GET(instance, CmdBeginQuery)(commands, queries, 1, 0);
    VK_GET(instance, CmdExecuteCommands)(commands, 1, &two);
    VK_GET(instance, CmdExecuteCommands)(commands, 1, &three);
    VK_GET(instance, CmdEndQuery)(commands, queries, 1);
    VK_GET(instance, CmdExecuteCommands)(commands, 1, &two);
  });
  std::uint64_t counts[2] = {};
  EXPECT_EQ(VK_GET(instance, GetQueryPoolResults)(device, queries, 0, 2, sizeof counts, counts, sizeof counts[0],
                                                  VK_QUERY_RESULT_64_BIT),
            VK_SUCCESS);
  EXPECT_GT(counts[0], 0u);
  EXPECT_EQ(counts[1], counts[0]) << "two and three groups, twice each";
}

}  // namespace
}  // namespace vitrine::icd::test
