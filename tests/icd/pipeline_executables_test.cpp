// VK_KHR_pipeline_executable_properties: what a pipeline says of its stages, with and without capture.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/icd/compute_fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

constexpr VkPipelineCreateFlags kCapture = VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;

class PipelineExecutables : public ComputeTest {
 protected:
  struct Form {
    std::string name, text;
  };

  void TearDown() override {
    for (const VkPipeline p : pipelines) VK_GET(instance, DestroyPipeline)(device, p, nullptr);
    ComputeTest::TearDown();
  }

  VkPipeline make_compute(VkPipelineCreateFlags flags, VkResult expected = VK_SUCCESS, const void* next = nullptr) {
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.flags = flags;
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
    info.stage.pNext = next;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateComputePipelines)(device, cache, 1, &info, nullptr, &pipeline), expected);
    pipelines.push_back(pipeline);
    return pipeline;
  }

  /// Vertex and fragment stage into one color attachment. `library`: made as one with all parts.
  VkPipeline make_graphics(VkPipelineCreateFlags flags, bool library = false) {
    const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    auto parts = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>();
    parts.flags = VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT |
                  VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT |
                  VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT |
                  VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;
    auto rendering = make_struct<VkPipelineRenderingCreateInfo>(library ? &parts : nullptr);
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &format;
    const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, kVertexWords),
                                                      stage(VK_SHADER_STAGE_FRAGMENT_BIT, kFragmentWords)};
    const auto vertices = make_struct<VkPipelineVertexInputStateCreateInfo>();
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, 8, 8, 0, 1};
    const VkRect2D scissor{{0, 0}, {8, 8}};
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
    info.flags = flags | (library ? VK_PIPELINE_CREATE_LIBRARY_BIT_KHR : 0);
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewports;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &multisample;
    info.pColorBlendState = &blend;
    info.layout = layout;
    return create(info);
  }

  VkPipeline link(VkPipeline library) {
    auto libraries = make_struct<VkPipelineLibraryCreateInfoKHR>();
    libraries.libraryCount = 1;
    libraries.pLibraries = &library;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&libraries);
    info.layout = layout;
    return create(info);
  }

  VkPipeline create(const VkGraphicsPipelineCreateInfo& info) {
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateGraphicsPipelines)(device, cache, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    pipelines.push_back(pipeline);
    return pipeline;
  }

  std::vector<VkPipelineExecutablePropertiesKHR> executables(VkPipeline pipeline) {
    auto info = make_struct<VkPipelineInfoKHR>();
    info.pipeline = pipeline;
    const auto ask = VK_GET(instance, GetPipelineExecutablePropertiesKHR);
    std::uint32_t count = 0;
    EXPECT_EQ(ask(device, &info, &count, nullptr), VK_SUCCESS);
    std::vector<VkPipelineExecutablePropertiesKHR> out(count, make_struct<VkPipelineExecutablePropertiesKHR>());
    EXPECT_EQ(ask(device, &info, &count, out.data()), VK_SUCCESS);
    return out;
  }

  VkPipelineExecutableInfoKHR executable(VkPipeline pipeline, std::uint32_t index) {
    auto info = make_struct<VkPipelineExecutableInfoKHR>();
    info.pipeline = pipeline;
    info.executableIndex = index;
    return info;
  }

  std::vector<VkPipelineExecutableStatisticKHR> statistics(VkPipeline pipeline, std::uint32_t index) {
    const auto info = executable(pipeline, index);
    const auto ask = VK_GET(instance, GetPipelineExecutableStatisticsKHR);
    std::uint32_t count = 0;
    EXPECT_EQ(ask(device, &info, &count, nullptr), VK_SUCCESS);
    std::vector<VkPipelineExecutableStatisticKHR> out(count, make_struct<VkPipelineExecutableStatisticKHR>());
    EXPECT_EQ(ask(device, &info, &count, out.data()), VK_SUCCESS);
    return out;
  }

  std::uint64_t statistic(VkPipeline pipeline, std::uint32_t index, const std::string& name) {
    for (const auto& s : statistics(pipeline, index))
      if (name == s.name) return s.value.u64;
    ADD_FAILURE() << "no statistic " << name;
    return 0;
  }

  std::vector<Form> forms(VkPipeline pipeline, std::uint32_t index) {
    const auto info = executable(pipeline, index);
    const auto ask = VK_GET(instance, GetPipelineExecutableInternalRepresentationsKHR);
    std::uint32_t count = 0;
    EXPECT_EQ(ask(device, &info, &count, nullptr), VK_SUCCESS);
    std::vector<VkPipelineExecutableInternalRepresentationKHR> raw(
        count, make_struct<VkPipelineExecutableInternalRepresentationKHR>());
    EXPECT_EQ(ask(device, &info, &count, raw.data()), VK_SUCCESS);
    std::vector<Form> out(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      out[i] = {raw[i].name, std::string(raw[i].dataSize, '?')};
      raw[i].pData = out[i].text.data();
    }
    EXPECT_EQ(ask(device, &info, &count, raw.data()), VK_SUCCESS);
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_TRUE(raw[i].isText);
      EXPECT_EQ(out[i].text.back(), '\0');
      EXPECT_EQ(out[i].text.find('\0'), raw[i].dataSize - 1) << "the size is the text's, with its zero";
      out[i].text.pop_back();
    }
    return out;
  }

  std::vector<VkPipeline> pipelines;
};

TEST_F(PipelineExecutables, EveryStageIsOne) {
  const auto compute = executables(make_compute(0));
  ASSERT_EQ(compute.size(), 1u);
  EXPECT_STREQ(compute[0].name, "compute");
  EXPECT_EQ(compute[0].stages, VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT});
  EXPECT_EQ(compute[0].subgroupSize, 64u);
  const auto graphics = executables(make_graphics(0));
  ASSERT_EQ(graphics.size(), 2u);
  EXPECT_EQ(graphics[0].stages, VkShaderStageFlags{VK_SHADER_STAGE_VERTEX_BIT});
  EXPECT_EQ(graphics[1].stages, VkShaderStageFlags{VK_SHADER_STAGE_FRAGMENT_BIT});
  EXPECT_STRNE(graphics[0].name, graphics[1].name);
}

TEST_F(PipelineExecutables, TheSubgroupSizeIsTheRequiredOne) {
  auto size = make_struct<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>();
  size.requiredSubgroupSize = 16;
  const auto compute = executables(make_compute(0, VK_SUCCESS, &size));
  ASSERT_EQ(compute.size(), 1u);
  EXPECT_EQ(compute[0].subgroupSize, 16u);
}

TEST_F(PipelineExecutables, StatisticsSayWhatTheProgramIs) {
  const VkPipeline plain = make_compute(0), captured = make_compute(kCapture);
  const auto numbers = statistics(plain, 0), same = statistics(captured, 0);
  ASSERT_EQ(numbers.size(), same.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_TRUE(names.insert(numbers[i].name).second) << numbers[i].name;
    EXPECT_NE(numbers[i].description[0], 0);
    EXPECT_EQ(numbers[i].format, VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR);
    EXPECT_EQ(numbers[i].value.u64, same[i].value.u64) << "capturing changes nothing: " << numbers[i].name;
  }
  EXPECT_GT(statistic(plain, 0, "instructions"), 0u);
  EXPECT_GT(statistic(plain, 0, "registers"), 0u);
  EXPECT_EQ(statistic(make_graphics(0), 0, "instructions"), 7u) << "of every SIMD target";
  EXPECT_EQ(statistic(plain, 0, "stores"), 1u);
  EXPECT_EQ(statistic(plain, 0, "loads"), 0u);
  EXPECT_EQ(statistic(plain, 0, "atomics"), 0u);
  EXPECT_EQ(statistic(plain, 0, "image operations"), 0u);
  EXPECT_EQ(statistic(plain, 0, "local array bytes"), 0u);
  EXPECT_EQ(statistic(plain, 0, "shared bytes"), 0u);
}

TEST_F(PipelineExecutables, CapturedShadersShowTheirWayThroughTheCompiler) {
  const std::vector<Form> all = forms(make_graphics(kCapture), 0);
  ASSERT_GE(all.size(), 4u) << "at least one step changes the vertex shader";
  EXPECT_EQ(all.front().name, "SPIR-V");
  EXPECT_NE(all.front().text.find("OpShiftRightArithmetic"), std::string::npos) << all.front().text;
  EXPECT_EQ(all[1].name, "IR 1: front end");
  EXPECT_EQ(all.back().name, "program");
  EXPECT_NE(all.back().text.find("I2F"), std::string::npos) << all.back().text;
  std::set<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_TRUE(names.insert(all[i].name).second) << all[i].name;
    EXPECT_FALSE(all[i].text.empty()) << all[i].name;
    if (i > 0) {
      EXPECT_NE(all[i].text, all[i - 1].text) << all[i].name << " has changed something";
    }
  }
}

TEST_F(PipelineExecutables, WithoutCaptureThereIsNothingToShow) {
  const VkPipeline first = make_compute(kCapture);
  EXPECT_TRUE(forms(make_compute(0), 0).empty()) << "though another pipeline of the same shader has it";
  EXPECT_FALSE(forms(make_compute(kCapture), 0).empty()) << "though the cache has the shader without";
  EXPECT_EQ(forms(first, 0).size(), forms(make_compute(kCapture), 0).size());
}

TEST_F(PipelineExecutables, ACaptureThatWasNotMadeHasToBeCompiled) {
  constexpr VkPipelineCreateFlags kCachedOnly = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
  make_compute(0);
  make_compute(kCapture | kCachedOnly, VK_PIPELINE_COMPILE_REQUIRED);
  make_compute(kCapture);
  make_compute(kCapture | kCachedOnly);
}

TEST_F(PipelineExecutables, LibrariesHaveNoneUntilTheyAreLinked) {
  const VkPipeline library = make_graphics(kCapture, true);
  EXPECT_TRUE(executables(library).empty());
  const VkPipeline linked = link(library);
  ASSERT_EQ(executables(linked).size(), 2u);
  EXPECT_FALSE(forms(linked, 0).empty());
  EXPECT_FALSE(forms(linked, 1).empty());
  EXPECT_TRUE(forms(link(make_graphics(0, true)), 0).empty());
}

TEST_F(PipelineExecutables, ArraysThatAreTooShortAreIncomplete) {
  const VkPipeline pipeline = make_graphics(kCapture);
  auto info = make_struct<VkPipelineInfoKHR>();
  info.pipeline = pipeline;
  std::uint32_t count = 1;
  auto one = make_struct<VkPipelineExecutablePropertiesKHR>();
  EXPECT_EQ(VK_GET(instance, GetPipelineExecutablePropertiesKHR)(device, &info, &count, &one), VK_INCOMPLETE);
  EXPECT_EQ(count, 1u);
  const auto vertex = executable(pipeline, 0);
  auto number = make_struct<VkPipelineExecutableStatisticKHR>();
  EXPECT_EQ(VK_GET(instance, GetPipelineExecutableStatisticsKHR)(device, &vertex, &count, &number), VK_INCOMPLETE);
  EXPECT_EQ(count, 1u);
}

TEST_F(PipelineExecutables, TextsThatDoNotFitAreCut) {
  const VkPipeline pipeline = make_compute(kCapture);
  const auto info = executable(pipeline, 0);
  const auto ask = VK_GET(instance, GetPipelineExecutableInternalRepresentationsKHR);
  std::uint32_t count = 0;
  ASSERT_EQ(ask(device, &info, &count, nullptr), VK_SUCCESS);
  std::vector<VkPipelineExecutableInternalRepresentationKHR> all(
      count, make_struct<VkPipelineExecutableInternalRepresentationKHR>());
  char room[17];
  std::fill_n(room, sizeof room, '#');
  all[0].dataSize = 16;
  all[0].pData = room;
  EXPECT_EQ(ask(device, &info, &count, all.data()), VK_INCOMPLETE);
  EXPECT_EQ(count, all.size());
  EXPECT_EQ(all[0].dataSize, 16u);
  EXPECT_STREQ(room, "; SPIR-V\n; Vers");
  EXPECT_EQ(room[16], '#') << "behind the room";
  all[0].dataSize = 0;
  EXPECT_EQ(ask(device, &info, &count, all.data()), VK_INCOMPLETE);
  EXPECT_EQ(all[0].dataSize, 0u);
}

}  // namespace
}  // namespace vitrine::icd::test
