// What tools are told of commands: numbers, names, labels, resources; and how what they find reaches the application.
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

#include "glass/session.h"
#include "spirv/observed_command.h"
#include "tests/icd/resources_fixture.h"

namespace vitrine::icd::test {
namespace {

/// What the tool of these tests is told of a draw or dispatch.
struct Told {
  std::uint64_t submission = 0;
  std::uint32_t command = 0;
  std::string name, pipeline;
  std::vector<std::string> labels, resources;
  std::uint64_t pushed = 0, push_range = 0;
};

std::mutex told_mutex;
std::vector<Told> told;

class TellingProgram : public glass::ProgramTool {
 public:
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction*) override {
    const spirv::ObservedCommand* command = wave.resources->command;
    const std::lock_guard lock(told_mutex);
    if (!command) return nullptr;
    Told one{command->submission, command->command,
             command->name,       command->pipeline,
             command->labels,     {},
             command->pushed,     command->push_range(VK_SHADER_STAGE_COMPUTE_BIT)};
    for (std::uint32_t slot = 0; slot <= kKinds; ++slot) one.resources.push_back(command->resource(0, slot));
    one.resources.push_back(command->resource(1, 0));
    one.resources.push_back(command->resource(spirv::kDynamicSet, 0));
    told.push_back(one);
    return nullptr;
  }
};

/// Finds something in every dispatch.
class TellingTool : public glass::Tool {
 public:
  spirv::exec::Interest interest() const override { return {.blocks = true}; }
  std::shared_ptr<glass::ProgramTool> attach(const glass::ShaderIdentity&, const spirv::Program&) override {
    return std::make_shared<TellingProgram>();
  }
  std::vector<glass::Finding> take_findings() override {
    static const glass::Rule kRule{"test-rule", glass::Severity::kWarning, "", ""};
    std::vector<glass::Finding> out;
    const std::lock_guard lock(told_mutex);
    for (; taken_ < told.size(); ++taken_) {
      glass::Finding finding;
      finding.rule = &kRule;
      finding.message = "found";
      finding.address.submission = told[taken_].submission;
      finding.address.command = told[taken_].command;
      finding.address.labels = told[taken_].labels;
      out.push_back(finding);
    }
    return out;
  }

 private:
  std::size_t taken_ = 0;
};

/// What a messenger hears, and from which severities and types.
struct Heard {
  std::string id, message;
  std::int32_t number = 0;
  VkDebugUtilsMessageSeverityFlagBitsEXT severity{};
  VkDebugUtilsMessageTypeFlagsEXT type = 0;
  std::vector<std::string> queue_labels, labels, objects;
  VkBool32 fence_was_signaled = VK_FALSE;
};

class ObservedCommands : public ResourceTest {
 protected:
  /// The tool stays on for the process: these tests run in one of their own (tests/CMakeLists.txt).
  void SetUp() override {
    if (!std::getenv("VITRINE_TEST_TOOLS")) GTEST_SKIP() << "needs a process of its own";
    if (glass::session().idle()) glass::session().add(std::make_unique<TellingTool>());
    ResourceTest::SetUp();
    auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = &remember;
    info.pUserData = this;
    ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
    first_ = told.size();
    set_layout = make_set_layout_of(kTypes);
    layout = make_layout(set_layout);
    pipeline = make_compute(layout);
    name(VK_OBJECT_TYPE_PIPELINE, pipeline, "gauss");
  }
  void TearDown() override {
    if (!instance) return;
    VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    ResourceTest::TearDown();
  }

  static VKAPI_ATTR VkBool32 VKAPI_CALL remember(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT type,
                                                 const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
    auto& test = *static_cast<ObservedCommands*>(self);
    Heard heard{data->pMessageIdName, data->pMessage, data->messageIdNumber, severity, type, {}, {}, {}, VK_FALSE};
    for (std::uint32_t i = 0; i < data->queueLabelCount; ++i)
      heard.queue_labels.emplace_back(data->pQueueLabels[i].pLabelName);
    for (std::uint32_t i = 0; i < data->cmdBufLabelCount; ++i)
      heard.labels.emplace_back(data->pCmdBufLabels[i].pLabelName);
    for (std::uint32_t i = 0; i < data->objectCount; ++i)
      heard.objects.emplace_back(data->pObjects[i].pObjectName ? data->pObjects[i].pObjectName : "");
    if (test.fence)
      heard.fence_was_signaled =
          get<PFN_vkGetFenceStatus>(test.instance, "vkGetFenceStatus")(test.device, test.fence) == VK_SUCCESS;
    test.heard.push_back(heard);
    return VK_FALSE;
  }

  template <class H>
  void name(VkObjectType type, H handle, const char* text) {
    auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
    info.objectType = type;
    info.objectHandle = reinterpret_cast<std::uint64_t>(handle);
    info.pObjectName = text;
    EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &info), VK_SUCCESS);
  }
  VkDebugUtilsLabelEXT label(const char* text) {
    auto out = make_struct<VkDebugUtilsLabelEXT>();
    out.pLabelName = text;
    return out;
  }
  void begin_label(VkCommandBuffer commands, const char* text) {
    const auto info = label(text);
    VK_CALL(CmdBeginDebugUtilsLabelEXT)(commands, &info);
  }
  void dispatch_one(VkCommandBuffer commands, VkDescriptorSet inputs) {
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    const VkDescriptorSet sets[] = {inputs, output};
    VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  }
  /// What has been told since the test began.
  std::span<const Told> news() const { return std::span<const Told>(told).subspan(first_); }

  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  std::vector<Heard> heard;

 private:
  std::size_t first_ = 0;
};

using Names = std::vector<std::string>;

TEST_F(ObservedCommands, CountCommandsButNotLabels) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  for (std::uint64_t submission = 1; submission <= 2; ++submission) {
    const VkCommandBuffer commands = begin();
    begin_label(commands, "unseen");
    VK_CALL(CmdEndDebugUtilsLabelEXT)(commands);
    VK_CALL(CmdSetDeviceMask)(commands, 1);
    dispatch_one(commands, inputs);
    VK_CALL(CmdDispatchBase)(commands, 0, 0, 0, 1, 1, 1);
    run(commands);
    ASSERT_EQ(news().size(), 2 * submission);
    const Told &first = news()[2 * submission - 2], &second = news()[2 * submission - 1];
    EXPECT_EQ(first.submission, submission);
    EXPECT_EQ(first.command, 4u) << "after a device mask, a pipeline and sets";
    EXPECT_EQ(first.name, "vkCmdDispatch");
    EXPECT_EQ(first.pipeline, "gauss");
    EXPECT_EQ(second.command, 5u);
    EXPECT_EQ(second.name, "vkCmdDispatchBase");
  }
}

TEST_F(ObservedCommands, SecondaryCommandBuffersCountWhereTheyRun) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = command_pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer secondary = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &secondary), VK_SUCCESS);
  auto inheritance = make_struct<VkCommandBufferInheritanceInfo>();
  auto info = make_struct<VkCommandBufferBeginInfo>();
  info.pInheritanceInfo = &inheritance;
  ASSERT_EQ(VK_CALL(BeginCommandBuffer)(secondary, &info), VK_SUCCESS);
  begin_label(secondary, "inner");
  dispatch_one(secondary, inputs);
  VK_CALL(CmdEndDebugUtilsLabelEXT)(secondary);
  ASSERT_EQ(VK_CALL(EndCommandBuffer)(secondary), VK_SUCCESS);
  const VkCommandBuffer commands = begin();
  begin_label(commands, "outer");
  VK_CALL(CmdExecuteCommands)(commands, 1, &secondary);
  dispatch_one(commands, inputs);
  run(commands);
  ASSERT_EQ(news().size(), 2u);
  EXPECT_EQ(news()[0].command, 4u);
  EXPECT_EQ(news()[0].labels, (Names{"outer", "inner"}));
  EXPECT_EQ(news()[1].command, 7u);
  EXPECT_EQ(news()[1].labels, (Names{"outer"}));
}

TEST_F(ObservedCommands, LabelsGoOnOverSubmissionsAndQueuesHaveTheirOwn) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  const auto frame = label("frame"), marker = label("marker"), gone = label("gone");
  VK_CALL(QueueBeginDebugUtilsLabelEXT)(queue, &frame);
  VkCommandBuffer commands = begin();
  begin_label(commands, "open");
  VK_CALL(CmdInsertDebugUtilsLabelEXT)(commands, &gone);
  VK_CALL(CmdInsertDebugUtilsLabelEXT)(commands, &marker);
  dispatch_one(commands, inputs);
  run(commands);
  VK_CALL(QueueEndDebugUtilsLabelEXT)(queue);
  commands = begin();
  VK_CALL(CmdEndDebugUtilsLabelEXT)(commands);
  VK_CALL(CmdEndDebugUtilsLabelEXT)(commands);
  dispatch_one(commands, inputs);
  run(commands);
  ASSERT_EQ(news().size(), 2u);
  EXPECT_EQ(news()[0].labels, (Names{"frame", "open", "marker"}));
  EXPECT_EQ(news()[1].labels, Names{});
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].queue_labels, (Names{"frame"}));
  EXPECT_EQ(heard[0].labels, (Names{"open", "marker"}));
}

TEST_F(ObservedCommands, ResourcesHaveNamesAndSizes) {
  name(VK_OBJECT_TYPE_BUFFER, data.buffer, "particles");
  name(VK_OBJECT_TYPE_IMAGE, image, "albedo");
  name(VK_OBJECT_TYPE_BUFFER_VIEW, texels, "table");
  name(VK_OBJECT_TYPE_SAMPLER, sampler, "nearest");
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  const VkDescriptorBufferInfo range{data.buffer, 256, 512};
  auto write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = inputs;
  write.dstBinding = 1;
  write.descriptorCount = 1;
  write.descriptorType = kTypes[1];
  write.pBufferInfo = &range;
  VK_CALL(UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
  const VkCommandBuffer commands = begin();
  dispatch_one(commands, inputs);
  run(commands);
  ASSERT_EQ(news().size(), 1u);
  const Names& r = news()[0].resources;
  EXPECT_EQ(r[0], "uniform buffer 'particles' (set 0, binding 0, 4096 bytes)");
  EXPECT_EQ(r[1], "storage buffer 'particles' (set 0, binding 1, 512 bytes at offset 256)");
  EXPECT_EQ(r[2], "combined image sampler 'albedo' (set 0, binding 2, 16x16, R32_SFLOAT)");
  EXPECT_EQ(r[3], "sampled image 'albedo' (set 0, binding 3, 16x16, R32_SFLOAT)");
  EXPECT_EQ(r[4], "sampler 'nearest' (set 0, binding 4)");
  EXPECT_EQ(r[5], "storage image 'albedo' (set 0, binding 5, 16x16, R32_SFLOAT)");
  EXPECT_EQ(r[6], "uniform texel buffer 'table' (set 0, binding 6, 1024 texels of R32_SFLOAT)");
  EXPECT_EQ(r[7], "storage texel buffer 'table' (set 0, binding 7, 1024 texels of R32_SFLOAT)");
  EXPECT_EQ(r[8], "") << "there is no such slot";
  EXPECT_EQ(r[9], "storage buffer (set 1, binding 0, 4096 bytes)") << "without a name";
}

TEST_F(ObservedCommands, ResourcesThatAreNotThereSaySo) {
  const VkCommandBuffer commands = begin();
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 1, 1, &output, 0, nullptr);
  VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  dispatch_one(commands, make_set(set_layout));
  run(commands);
  ASSERT_EQ(news().size(), 2u);
  EXPECT_EQ(news()[0].resources[1], "storage buffer (set 0, binding 1, nothing is bound)");
  EXPECT_EQ(news()[1].resources[1], "storage buffer (set 0, binding 1, no resource)");
}

TEST_F(ObservedCommands, PushConstantsAreSetByCompatibleLayouts) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  const VkPipelineLayout same = make_layout(set_layout), larger = make_layout(set_layout, 16);
  const std::uint32_t values[4] = {};
  const auto push = [&](VkCommandBuffer commands, VkPipelineLayout with, std::uint32_t words) {
    VK_CALL(CmdPushConstants)(commands, with, VK_SHADER_STAGE_ALL, 0, words * 4, values);
    dispatch_one(commands, inputs);
  };
  VkCommandBuffer commands = begin();
  dispatch_one(commands, inputs);
  push(commands, larger, 4);
  push(commands, same, 1);
  run(commands);
  commands = begin();
  dispatch_one(commands, inputs);
  pipeline = make_compute(larger);
  push(commands, larger, 3);
  push(commands, same, 1);
  run(commands);
  ASSERT_EQ(news().size(), 6u);
  const std::uint64_t pushed[] = {0, 0, 1, 0, 7, 6}, ranges[] = {1, 1, 1, 1, 15, 15};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(news()[i].pushed, pushed[i]) << i;
    EXPECT_EQ(news()[i].push_range, ranges[i]) << i;
  }
}

TEST_F(ObservedCommands, PushConstantsOfOtherCommandBuffersAreNotSet) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = command_pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer secondary = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &secondary), VK_SUCCESS);
  auto inheritance = make_struct<VkCommandBufferInheritanceInfo>();
  auto info = make_struct<VkCommandBufferBeginInfo>();
  info.pInheritanceInfo = &inheritance;
  ASSERT_EQ(VK_CALL(BeginCommandBuffer)(secondary, &info), VK_SUCCESS);
  dispatch_one(secondary, inputs);
  ASSERT_EQ(VK_CALL(EndCommandBuffer)(secondary), VK_SUCCESS);
  const VkCommandBuffer commands = begin();
  const std::uint32_t value = 0;
  VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, 4, &value);
  dispatch_one(commands, inputs);
  VK_CALL(CmdExecuteCommands)(commands, 1, &secondary);
  dispatch_one(commands, inputs);
  run(commands);
  ASSERT_EQ(news().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(news()[i].pushed, i == 0 ? 1u : 0u) << i;
}

TEST_F(ObservedCommands, MessagesComeBeforeFencesWithRulesObjectsAndLabels) {
  const VkDescriptorSet inputs = make_full_set(set_layout, kTypes);
  const auto fence_info = make_struct<VkFenceCreateInfo>();
  ASSERT_EQ(VK_CALL(CreateFence)(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  name(VK_OBJECT_TYPE_DEVICE, device, "the device");
  const VkCommandBuffer commands = begin();
  name(VK_OBJECT_TYPE_COMMAND_BUFFER, commands, "the commands");
  dispatch_one(commands, inputs);
  ASSERT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
  auto info = make_struct<VkSubmitInfo>();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  ASSERT_EQ(VK_CALL(QueueSubmit)(queue, 1, &info, fence), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(WaitForFences)(device, 1, &fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
  ASSERT_EQ(heard.size(), 1u);
  const Heard& h = heard[0];
  EXPECT_EQ(h.id, "test-rule");
  EXPECT_EQ(h.number, static_cast<std::int32_t>(0xca6dbbe6u)) << "numbers never change";
  EXPECT_NE(h.message.find("warning: found [vitrine/test-rule]"), std::string::npos) << h.message;
  EXPECT_EQ(h.severity, VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT);
  EXPECT_EQ(h.type, VkDebugUtilsMessageTypeFlagsEXT{VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT});
  EXPECT_EQ(h.objects, (Names{"gauss", "the commands", "", "the device"}));
  EXPECT_FALSE(h.fence_was_signaled);
  VK_CALL(DestroyFence)(device, fence, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
