// Shaders that do not end, of every stage: the device is lost, what goes on elsewhere is not. Run with a small
// VITRINE_SHADER_BUDGET; with the default one each takes about a second.
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/glsl/compile.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

struct StageText {
  VkShaderStageFlagBits stage;
  std::string text;
};

/// A loop that the compiler cannot see through, of whatever a stage has that differs: `(x & 1) == 0` for ever.
std::string endless(const std::string& seed) {
  return "  uint x = uint(" + seed + ") * 2u;\n  while ((x & 1u) == 0u) x = x * 6u + 4u;\n";
}

constexpr char kVersion[] = "#version 460\n";
constexpr char kPosition[] =
    "  gl_Position = vec4(4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0, 0.5, 1.0);\n";
constexpr char kLevels[] =
    "  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelInner[0] = 2.0;\n";

/// All shaders of a pipeline in which `stage` does not end; 0: all do.
std::vector<StageText> pipeline_of(int stage) {
  const auto loop = [&](VkShaderStageFlagBits own, const char* seed, const char* use) {
    return stage == own ? endless(seed) + "  " + use + "\n" : std::string();
  };
  if (stage == VK_SHADER_STAGE_COMPUTE_BIT)
    return {{VK_SHADER_STAGE_COMPUTE_BIT,
             std::string(kVersion) + "layout(local_size_x = 64) in;\nshared uint s[64];\n" + "void main() {\n" +
                 endless("gl_GlobalInvocationID.x") + "  s[gl_LocalInvocationIndex] = x;\n}\n"}};
  std::vector<StageText> stages;
  stages.push_back({VK_SHADER_STAGE_VERTEX_BIT,
                    std::string(kVersion) + "void main() {\n" + kPosition +
                        loop(VK_SHADER_STAGE_VERTEX_BIT, "gl_VertexIndex", "gl_Position.z = float(x);") + "}\n"});
  if (stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT || stage == VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT) {
    stages.push_back({VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                      std::string(kVersion) + "layout(vertices = 3) out;\nvoid main() {\n" + kLevels +
                          "  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n" +
                          loop(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, "gl_InvocationID",
                               "gl_out[gl_InvocationID].gl_Position.z = float(x);") +
                          "}\n"});
    stages.push_back(
        {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
         std::string(kVersion) + "layout(triangles) in;\nvoid main() {\n" +
             "  gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position;\n" +
             loop(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "gl_TessCoord.x * 8.0", "gl_Position.z = float(x);") +
             "}\n"});
  }
  if (stage == VK_SHADER_STAGE_GEOMETRY_BIT)
    stages.push_back({VK_SHADER_STAGE_GEOMETRY_BIT,
                      std::string(kVersion) + "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n" +
                          "void main() {\n  for (int i = 0; i < 3; ++i) {\n" +
                          loop(VK_SHADER_STAGE_GEOMETRY_BIT, "gl_PrimitiveIDIn", "") +
                          "    gl_Position = gl_in[i].gl_Position;\n    gl_Position.z = float(x & 1u);\n" +
                          "    EmitVertex();\n  }\n}\n"});
  stages.push_back({VK_SHADER_STAGE_FRAGMENT_BIT,
                    std::string(kVersion) + "void main() {\n" +
                        loop(VK_SHADER_STAGE_FRAGMENT_BIT, "gl_FragCoord.x", "gl_FragDepth = float(x & 1u);") + "}\n"});
  return stages;
}

constexpr VkExtent2D kPixels = {8, 8};

class EndlessShaders : public DeviceTest, public ::testing::WithParamInterface<VkShaderStageFlagBits> {
 protected:
  void SetUp() override {
    if (std::getenv("VITRINE_SHADER_BUDGET") == nullptr) GTEST_SKIP() << "the default budget takes a second each";
    DeviceTest::SetUp();
  }

  void make_device() override { device = make_device_with_queues(); }

  /// With two queues, if there are so many.
  VkDevice make_device_with_queues() {
    std::uint32_t count = 1;
    VkQueueFamilyProperties family;
    VK_CALL(GetPhysicalDeviceQueueFamilyProperties)(physical_device, &count, &family);
    queues = std::min(family.queueCount, 2u);
    const float priorities[2] = {1, 1};
    auto queue = make_struct<VkDeviceQueueCreateInfo>();
    queue.queueCount = queues;
    queue.pQueuePriorities = priorities;
    auto faults = make_struct<VkPhysicalDeviceFaultFeaturesEXT>();
    faults.deviceFault = VK_TRUE;
    VkPhysicalDeviceFeatures features{};
    features.tessellationShader = features.geometryShader = VK_TRUE;
    auto info = make_struct<VkDeviceCreateInfo>(&faults);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.pEnabledFeatures = &features;
    VkDevice made = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateDevice)(physical_device, &info, nullptr, &made), VK_SUCCESS);
    return made;
  }

  /// What one submission needs.
  struct Work {
    VkDevice device = VK_NULL_HANDLE;
    std::vector<VkShaderModule> modules;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkRenderPass pass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
  };

  Work make_work(VkDevice on, int endless_stage) {
    Work work;
    work.device = on;
    const auto layout = make_struct<VkPipelineLayoutCreateInfo>();
    EXPECT_EQ(VK_CALL(CreatePipelineLayout)(on, &layout, nullptr, &work.layout), VK_SUCCESS);
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const StageText& shader : pipeline_of(endless_stage)) {
      std::string log;
      const auto words = vitrine::test::compile_glsl(shader.stage, shader.text, vitrine::test::VulkanVersion::k11, log);
      EXPECT_FALSE(words.empty()) << log << shader.text;
      auto info = make_struct<VkShaderModuleCreateInfo>();
      info.codeSize = words.size() * 4;
      info.pCode = words.data();
      work.modules.emplace_back();
      EXPECT_EQ(VK_CALL(CreateShaderModule)(on, &info, nullptr, &work.modules.back()), VK_SUCCESS);
      auto stage = make_struct<VkPipelineShaderStageCreateInfo>();
      stage.stage = shader.stage;
      stage.module = work.modules.back();
      stage.pName = "main";
      stages.push_back(stage);
    }
    make_pass(work);
    stages[0].stage == VK_SHADER_STAGE_COMPUTE_BIT ? make_compute(work, stages[0]) : make_graphics(work, stages);
    record(work, stages[0].stage == VK_SHADER_STAGE_COMPUTE_BIT);
    return work;
  }

  void make_pass(Work& work) {
    VkSubpassDescription subpass{};
    auto pass = make_struct<VkRenderPassCreateInfo>();
    pass.subpassCount = 1;
    pass.pSubpasses = &subpass;
    EXPECT_EQ(VK_CALL(CreateRenderPass)(work.device, &pass, nullptr, &work.pass), VK_SUCCESS);
    auto framebuffer = make_struct<VkFramebufferCreateInfo>();
    framebuffer.renderPass = work.pass;
    framebuffer.width = kPixels.width;
    framebuffer.height = kPixels.height;
    framebuffer.layers = 1;
    EXPECT_EQ(VK_CALL(CreateFramebuffer)(work.device, &framebuffer, nullptr, &work.framebuffer), VK_SUCCESS);
  }

  void make_compute(Work& work, const VkPipelineShaderStageCreateInfo& stage) {
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = stage;
    info.layout = work.layout;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(work.device, VK_NULL_HANDLE, 1, &info, nullptr, &work.pipeline),
              VK_SUCCESS);
  }

  void make_graphics(Work& work, const std::vector<VkPipelineShaderStageCreateInfo>& stages) {
    const bool patches = stages[1].stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
    const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = patches ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    auto tessellation = make_struct<VkPipelineTessellationStateCreateInfo>();
    tessellation.patchControlPoints = 3;
    const VkViewport viewport{0, 0, static_cast<float>(kPixels.width), static_cast<float>(kPixels.height), 0, 1};
    const VkRect2D scissor{{0, 0}, kPixels};
    auto viewports = make_struct<VkPipelineViewportStateCreateInfo>();
    viewports.viewportCount = viewports.scissorCount = 1;
    viewports.pViewports = &viewport;
    viewports.pScissors = &scissor;
    auto raster = make_struct<VkPipelineRasterizationStateCreateInfo>();
    raster.lineWidth = 1;
    auto samples = make_struct<VkPipelineMultisampleStateCreateInfo>();
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>();
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pTessellationState = &tessellation;
    info.pViewportState = &viewports;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.layout = work.layout;
    info.renderPass = work.pass;
    EXPECT_EQ(VK_CALL(CreateGraphicsPipelines)(work.device, VK_NULL_HANDLE, 1, &info, nullptr, &work.pipeline),
              VK_SUCCESS);
  }

  void record(Work& work, bool compute) {
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    EXPECT_EQ(VK_CALL(CreateCommandPool)(work.device, &pool_info, nullptr, &work.pool), VK_SUCCESS);
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = work.pool;
    allocate.commandBufferCount = 1;
    EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(work.device, &allocate, &work.commands), VK_SUCCESS);
    const auto begin = make_struct<VkCommandBufferBeginInfo>();
    EXPECT_EQ(VK_CALL(BeginCommandBuffer)(work.commands, &begin), VK_SUCCESS);
    if (compute) {
      VK_CALL(CmdBindPipeline)(work.commands, VK_PIPELINE_BIND_POINT_COMPUTE, work.pipeline);
      VK_CALL(CmdDispatch)(work.commands, 1, 1, 1);
    } else {
      auto pass = make_struct<VkRenderPassBeginInfo>();
      pass.renderPass = work.pass;
      pass.framebuffer = work.framebuffer;
      pass.renderArea = {{0, 0}, kPixels};
      VK_CALL(CmdBeginRenderPass)(work.commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
      VK_CALL(CmdBindPipeline)(work.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, work.pipeline);
      VK_CALL(CmdDraw)(work.commands, 3, 1, 0, 0);
      VK_CALL(CmdEndRenderPass)(work.commands);
    }
    EXPECT_EQ(VK_CALL(EndCommandBuffer)(work.commands), VK_SUCCESS);
  }

  VkResult run(const Work& work, std::uint32_t queue_index = 0) {
    VkQueue queue;
    VK_CALL(GetDeviceQueue)(work.device, 0, queue_index, &queue);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &work.commands;
    const VkResult submitted = VK_CALL(QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE);
    const VkResult idle = VK_CALL(QueueWaitIdle)(queue);
    return submitted == VK_SUCCESS ? idle : submitted;
  }

  void destroy(const Work& work) {
    VK_CALL(DestroyCommandPool)(work.device, work.pool, nullptr);
    VK_CALL(DestroyPipeline)(work.device, work.pipeline, nullptr);
    VK_CALL(DestroyFramebuffer)(work.device, work.framebuffer, nullptr);
    VK_CALL(DestroyRenderPass)(work.device, work.pass, nullptr);
    VK_CALL(DestroyPipelineLayout)(work.device, work.layout, nullptr);
    for (const VkShaderModule module : work.modules) VK_CALL(DestroyShaderModule)(work.device, module, nullptr);
  }

  std::string fault_text() {
    auto counts = make_struct<VkDeviceFaultCountsEXT>();
    EXPECT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, nullptr), VK_SUCCESS);
    std::vector<VkDeviceFaultVendorInfoEXT> calls(counts.vendorInfoCount);
    counts.vendorBinarySize = 0;
    auto info = make_struct<VkDeviceFaultInfoEXT>();
    info.pVendorInfos = calls.data();
    EXPECT_EQ(VK_CALL(GetDeviceFaultInfoEXT)(device, &counts, &info), VK_SUCCESS);
    return info.description;
  }

  std::uint32_t queues = 1;
};

TEST_P(EndlessShaders, LoseTheirDeviceAlone) {
  const VkDevice other = make_device_with_queues();
  const Work elsewhere = make_work(other, 0), endless_work = make_work(device, GetParam()),
             beside = make_work(device, 0);
  ASSERT_EQ(run(beside), VK_SUCCESS) << "a draw whose shaders end";
  EXPECT_EQ(run(endless_work), VK_ERROR_DEVICE_LOST);
  EXPECT_NE(fault_text().find("did not end within its budget"), std::string::npos) << fault_text();
  // Vulkan 1.3.239, Lost Device: commands end in finite time, whichever queue is asked.
  EXPECT_EQ(run(beside, queues - 1), VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(run(elsewhere), VK_SUCCESS) << "another device";
  for (const Work& work : {elsewhere, endless_work, beside}) destroy(work);
  VK_CALL(DestroyDevice)(device, nullptr);
  device = make_device_with_queues();
  const Work again = make_work(device, 0);
  EXPECT_EQ(run(again), VK_SUCCESS) << "a new device";
  destroy(again);
  VK_CALL(DestroyDevice)(other, nullptr);
}

std::string name_of(const ::testing::TestParamInfo<VkShaderStageFlagBits>& info) {
  switch (info.param) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "Vertex";
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return "TessellationControl";
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return "TessellationEvaluation";
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return "Geometry";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "Fragment";
    default:
      return "Compute";
  }
}

INSTANTIATE_TEST_SUITE_P(Stages, EndlessShaders,
                         ::testing::Values(VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                           VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, VK_SHADER_STAGE_GEOMETRY_BIT,
                                           VK_SHADER_STAGE_FRAGMENT_BIT, VK_SHADER_STAGE_COMPUTE_BIT),
                         name_of);

}  // namespace
}  // namespace vitrine::icd::test
