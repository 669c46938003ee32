// VK_KHR_performance_query: which counters there are, and what they are of dispatches and draws.
#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/icd/fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint32_t kSide = 8;

class PerformanceQuery : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    VK_GET(instance, DestroyDevice)(device, nullptr);
    device = VK_NULL_HANDLE;
    auto rendering = make_struct<VkPhysicalDeviceDynamicRenderingFeatures>();
    rendering.dynamicRendering = VK_TRUE;
    auto features = make_struct<VkPhysicalDevicePerformanceQueryFeaturesKHR>(&rendering);
    features.performanceCounterQueryPools = VK_TRUE;
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features), VK_SUCCESS);
    VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
    const auto lock = make_struct<VkAcquireProfilingLockInfoKHR>();
    ASSERT_EQ(VK_GET(instance, AcquireProfilingLockKHR)(device, &lock), VK_SUCCESS);
    enumerate();
    make_buffer();
    make_pipelines();
    const auto info = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_GET(instance, CreateCommandPool)(device, &info, nullptr, &commands_pool), VK_SUCCESS);
  }
  void TearDown() override {
    VK_GET(instance, ReleaseProfilingLockKHR)(device);
    VK_GET(instance, DestroyCommandPool)(device, commands_pool, nullptr);
    for (const VkPipeline p : {compute, graphics}) VK_GET(instance, DestroyPipeline)(device, p, nullptr);
    VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
    VK_GET(instance, DestroyDescriptorPool)(device, sets, nullptr);
    VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    for (const VkShaderModule m : modules) VK_GET(instance, DestroyShaderModule)(device, m, nullptr);
    VK_GET(instance, DestroyImageView)(device, view, nullptr);
    VK_GET(instance, DestroyImage)(device, image, nullptr);
    VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
    for (const VkDeviceMemory m : memories) VK_GET(instance, FreeMemory)(device, m, nullptr);
    DeviceTest::TearDown();
  }

  void enumerate() {
    const auto ask = VK_GET(instance, EnumeratePhysicalDeviceQueueFamilyPerformanceQueryCountersKHR);
    std::uint32_t count = 0;
    ASSERT_EQ(ask(physical_device, 0, &count, nullptr, nullptr), VK_SUCCESS);
    counters.assign(count, make_struct<VkPerformanceCounterKHR>());
    descriptions.assign(count, make_struct<VkPerformanceCounterDescriptionKHR>());
    ASSERT_EQ(ask(physical_device, 0, &count, counters.data(), descriptions.data()), VK_SUCCESS);
  }

  std::uint32_t index_of(const std::string& name) {
    for (std::uint32_t i = 0; i < descriptions.size(); ++i)
      if (descriptions[i].name == name) return i;
    ADD_FAILURE() << "no counter " << name;
    return 0;
  }

  VkDeviceMemory allocate(const VkMemoryRequirements& needed) {
    auto info = make_struct<VkMemoryAllocateInfo>();
    info.allocationSize = needed.size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
    memories.push_back(memory);
    return memory;
  }

  void make_buffer() {
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = 4096;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
    VkMemoryRequirements needed;
    VK_GET(instance, GetBufferMemoryRequirements)(device, buffer, &needed);
    const VkDeviceMemory memory = allocate(needed);
    ASSERT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
    void* mapped = nullptr;
    ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    words = static_cast<const std::uint32_t*>(mapped);
    auto image_info = make_struct<VkImageCreateInfo>();
    image_info.imageType = VK_IMAGE_TYPE_2D;
    image_info.format = VK_FORMAT_R8G8B8A8_UNORM;
    image_info.extent = {kSide, kSide, 1};
    image_info.mipLevels = image_info.arrayLayers = 1;
    image_info.samples = VK_SAMPLE_COUNT_1_BIT;
    image_info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    ASSERT_EQ(VK_GET(instance, CreateImage)(device, &image_info, nullptr, &image), VK_SUCCESS);
    VK_GET(instance, GetImageMemoryRequirements)(device, image, &needed);
    ASSERT_EQ(VK_GET(instance, BindImageMemory)(device, image, allocate(needed), 0), VK_SUCCESS);
    auto view_info = make_struct<VkImageViewCreateInfo>();
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = image_info.format;
    view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(VK_GET(instance, CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  }

  template <std::size_t N>
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, const std::uint32_t (&code)[N]) {
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = sizeof code;
    info.pCode = code;
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    modules.push_back(module);
    auto out = make_struct<VkPipelineShaderStageCreateInfo>();
    out.stage = bit;
    out.module = module;
    out.pName = "main";
    return out;
  }

  void make_pipelines() {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
    auto set_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
    set_info.bindingCount = 1;
    set_info.pBindings = &binding;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &set_info, nullptr, &set_layout), VK_SUCCESS);
    auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
    pool_info.maxSets = pool_info.poolSizeCount = 1;
    pool_info.pPoolSizes = &size;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &pool_info, nullptr, &sets), VK_SUCCESS);
    auto allocate_info = make_struct<VkDescriptorSetAllocateInfo>();
    allocate_info.descriptorPool = sets;
    allocate_info.descriptorSetCount = 1;
    allocate_info.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate_info, &set), VK_SUCCESS);
    const VkDescriptorBufferInfo bound{buffer, 0, VK_WHOLE_SIZE};
    auto write = make_struct<VkWriteDescriptorSet>();
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &bound;
    VK_GET(instance, UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
    info.layout = layout;
    ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &compute),
              VK_SUCCESS);
    make_graphics();
  }

  void make_graphics() {
    const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &format;
    const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, kVertexWords),
                                                      stage(VK_SHADER_STAGE_FRAGMENT_BIT, kFragmentWords)};
    const auto vertices = make_struct<VkPipelineVertexInputStateCreateInfo>();
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, kSide, kSide, 0, 1};
    const VkRect2D scissor{{0, 0}, {kSide / 2, kSide}};
    auto viewports = make_struct<VkPipelineViewportStateCreateInfo>();
    viewports.viewportCount = viewports.scissorCount = 1;
    viewports.pViewports = &viewport;
    viewports.pScissors = &scissor;
    auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
    rasterization.lineWidth = 1;
    auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = 0xf;
    auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewports;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &multisample;
    info.pColorBlendState = &blend;
    info.layout = layout;
    ASSERT_EQ(VK_GET(instance, CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &graphics),
              VK_SUCCESS);
  }

  VkQueryPool make_pool(const std::vector<std::string>& names) {
    std::vector<std::uint32_t> indices;
    for (const std::string& name : names) indices.push_back(index_of(name));
    auto wanted = make_struct<VkQueryPoolPerformanceCreateInfoKHR>();
    wanted.counterIndexCount = static_cast<std::uint32_t>(indices.size());
    wanted.pCounterIndices = indices.data();
    std::uint32_t passes = 0;
    VK_GET(instance, GetPhysicalDeviceQueueFamilyPerformanceQueryPassesKHR)(physical_device, &wanted, &passes);
    EXPECT_EQ(passes, 1u);
    auto info = make_struct<VkQueryPoolCreateInfo>(&wanted);
    info.queryType = VK_QUERY_TYPE_PERFORMANCE_QUERY_KHR;
    info.queryCount = 2;
    VkQueryPool pool = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateQueryPool)(device, &info, nullptr, &pool), VK_SUCCESS);
    VK_GET(instance, ResetQueryPool)(device, pool, 0, 2);
    return pool;
  }

  template <class F>
  void submit(F&& record) {
    auto allocate_info = make_struct<VkCommandBufferAllocateInfo>();
    allocate_info.commandPool = commands_pool;
    allocate_info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    ASSERT_EQ(VK_GET(instance, AllocateCommandBuffers)(device, &allocate_info, &commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    ASSERT_EQ(VK_GET(instance, BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
    const auto bind = VK_GET(instance, CmdBindDescriptorSets);
    bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    record(commands);
    ASSERT_EQ(VK_GET(instance, EndCommandBuffer)(commands), VK_SUCCESS);
    auto pass = make_struct<VkPerformanceQuerySubmitInfoKHR>();
    auto info = make_struct<VkSubmitInfo>(&pass);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    ASSERT_EQ(VK_GET(instance, QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, QueueWaitIdle)(queue), VK_SUCCESS);
  }

  void dispatch_groups(VkCommandBuffer commands, std::uint32_t groups) {
    VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute);
    VK_GET(instance, CmdDispatch)(commands, groups, 1, 1);
  }

  void begin_rendering(VkCommandBuffer commands) {
    auto attachment = make_struct<VkRenderingAttachmentInfo>();
    attachment.imageView = view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    auto info = make_struct<VkRenderingInfo>();
    info.renderArea = {{0, 0}, {kSide, kSide}};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &attachment;
    VK_GET(instance, CmdBeginRendering)(commands, &info);
    VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, graphics);
  }

  std::vector<std::uint64_t> results(VkQueryPool pool, std::uint32_t query, std::size_t count) {
    std::vector<VkPerformanceCounterResultKHR> raw(count);
    const std::size_t bytes = count * sizeof(VkPerformanceCounterResultKHR);
    EXPECT_EQ(VK_GET(instance, GetQueryPoolResults)(device, pool, query, 1, bytes, raw.data(), bytes,
                                                    VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    std::vector<std::uint64_t> values;
    for (const VkPerformanceCounterResultKHR& result : raw) values.push_back(result.uint64);
    return values;
  }

  VkQueue queue = VK_NULL_HANDLE;
  std::vector<VkPerformanceCounterKHR> counters;
  std::vector<VkPerformanceCounterDescriptionKHR> descriptions;
  std::vector<VkDeviceMemory> memories;
  std::vector<VkShaderModule> modules;
  VkBuffer buffer = VK_NULL_HANDLE;
  const std::uint32_t* words = nullptr;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool sets = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline compute = VK_NULL_HANDLE, graphics = VK_NULL_HANDLE;
  VkCommandPool commands_pool = VK_NULL_HANDLE;
};

TEST_F(PerformanceQuery, CountersHaveNamesUnitsAndNumbersOfTheirOwn) {
  ASSERT_GT(counters.size(), 40u);
  std::set<std::string> names, uuids;
  for (std::size_t i = 0; i < counters.size(); ++i) {
    EXPECT_EQ(counters[i].storage, VK_PERFORMANCE_COUNTER_STORAGE_UINT64_KHR);
    EXPECT_EQ(counters[i].scope, VK_PERFORMANCE_COUNTER_SCOPE_COMMAND_KHR);
    names.insert(std::string(descriptions[i].category) + "/" + descriptions[i].name);
    uuids.emplace(reinterpret_cast<const char*>(counters[i].uuid), VK_UUID_SIZE);
    EXPECT_NE(std::strlen(descriptions[i].description), 0u);
  }
  EXPECT_EQ(names.size(), counters.size());
  EXPECT_EQ(uuids.size(), counters.size());
  EXPECT_EQ(counters[index_of("bytesStored")].unit, VK_PERFORMANCE_COUNTER_UNIT_BYTES_KHR);
  std::uint32_t few = 3;
  const auto ask = VK_GET(instance, EnumeratePhysicalDeviceQueueFamilyPerformanceQueryCountersKHR);
  EXPECT_EQ(ask(physical_device, 0, &few, counters.data(), nullptr), VK_INCOMPLETE);
  EXPECT_EQ(few, 3u);
}

TEST_F(PerformanceQuery, CountsTheDispatchesInside) {
  const VkQueryPool pool = make_pool({"bytesStored", "invocations", "loads", "stores"});
  submit([&](VkCommandBuffer commands) {
    dispatch_groups(commands, 4);  // before: not counted
    VK_GET(instance, CmdBeginQuery)(commands, pool, 0, 0);
    dispatch_groups(commands, 2);
    VK_GET(instance, CmdEndQuery)(commands, pool, 0);
    dispatch_groups(commands, 5);
    VK_GET(instance, CmdBeginQuery)(commands, pool, 1, 0);
    VK_GET(instance, CmdEndQuery)(commands, pool, 1);
  });
  EXPECT_EQ(results(pool, 0, 4), (std::vector<std::uint64_t>{512, 128, 0, 128}));
  EXPECT_EQ(results(pool, 1, 4), (std::vector<std::uint64_t>{0, 0, 0, 0}));
  EXPECT_EQ(words[100], 301u);
  VK_GET(instance, DestroyQueryPool)(device, pool, nullptr);
}

TEST_F(PerformanceQuery, CountsTheDrawsInsideOfARenderPassAndAroundIt) {
  const std::vector<std::string> names = {"vertices",          "primitives rasterized", "fragments generated",
                                          "fragments scissor", "shading invocations",   "attachments bytes"};
  const VkQueryPool pool = make_pool(names);
  const auto draw = [&](VkCommandBuffer commands) { VK_GET(instance, CmdDraw)(commands, 3, 1, 0, 0); };
  submit([&](VkCommandBuffer commands) {
    begin_rendering(commands);
    draw(commands);
    VK_GET(instance, CmdBeginQuery)(commands, pool, 0, 0);
    draw(commands);
    VK_GET(instance, CmdEndQuery)(commands, pool, 0);
    draw(commands);
    VK_GET(instance, CmdEndRendering)(commands);
    VK_GET(instance, CmdBeginQuery)(commands, pool, 1, 0);
    begin_rendering(commands);
    draw(commands);
    draw(commands);
    VK_GET(instance, CmdEndRendering)(commands);
    VK_GET(instance, CmdEndQuery)(commands, pool, 1);
  });
  // The triangle is clipped to half of the target, then cut by the scissor.
  const auto one = results(pool, 0, names.size()), two = results(pool, 1, names.size());
  EXPECT_EQ(one[0], 3u);
  EXPECT_EQ(one[2], kSide * kSide);
  EXPECT_EQ(one[3], kSide * kSide / 2);
  EXPECT_EQ(one[4], kSide * kSide / 2);
  EXPECT_EQ(one[5], kSide * kSide / 2 * 4);
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(two[i], 2 * one[i]) << names[i];
  VK_GET(instance, DestroyQueryPool)(device, pool, nullptr);
}

TEST_F(PerformanceQuery, ResultsCanBeCopied) {
  const VkQueryPool pool = make_pool({"stores", "invocations"});
  submit([&](VkCommandBuffer commands) {
    VK_GET(instance, CmdBeginQuery)(commands, pool, 0, 0);
    dispatch_groups(commands, 1);
    VK_GET(instance, CmdEndQuery)(commands, pool, 0);
    VK_GET(instance, CmdCopyQueryPoolResults)(commands, pool, 0, 1, buffer, 2048, 16, VK_QUERY_RESULT_WAIT_BIT);
  });
  EXPECT_EQ((std::vector<std::uint32_t>(words + 512, words + 516)), (std::vector<std::uint32_t>{64, 0, 64, 0}));
  VK_GET(instance, DestroyQueryPool)(device, pool, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
