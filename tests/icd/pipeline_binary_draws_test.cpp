// VK_KHR_pipeline_binary: draws of graphics pipelines that come from binaries, whole and by libraries.
#include <algorithm>

#include "tests/icd/pipeline_binaries_fixture.h"

#ifdef VK_KHR_pipeline_binary
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr VkGraphicsPipelineLibraryFlagsEXT kParts[] = {VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT,
                                                        VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT,
                                                        VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT,
                                                        VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT};

/// Every graphics stage, with colours that depend on all of them.
Picture2D every_stage() {
  Picture2D picture;
  picture.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  picture.depth = true;
  picture.stages = {
      {VK_SHADER_STAGE_VERTEX_BIT,
       "layout(location = 0) out vec3 color;\n"
       "void main() {\n"
       "  gl_Position = vec4(gl_VertexIndex == 1 ? 0.9 : -0.8, gl_VertexIndex == 2 ? 0.9 : -0.8, 0.25, 1);\n"
       "  color = vec3(gl_VertexIndex == 0, gl_VertexIndex == 1, gl_InstanceIndex);\n"
       "}\n"},
      {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
       "layout(vertices = 3) out;\n"
       "layout(location = 0) in vec3 color[];\n"
       "layout(location = 0) out vec3 colors[];\n"
       "void main() {\n"
       "  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
       "  colors[gl_InvocationID] = color[gl_InvocationID] * 0.75;\n"
       "  gl_TessLevelInner[0] = 3; gl_TessLevelOuter = float[](2, 3, 4, 1);\n"
       "}\n"},
      {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
       "layout(triangles) in;\n"
       "layout(location = 0) in vec3 colors[];\n"
       "layout(location = 0) out vec3 mixed;\n"
       "void main() {\n"
       "  vec3 t = gl_TessCoord;\n"
       "  gl_Position = t.x * gl_in[0].gl_Position + t.y * gl_in[1].gl_Position + t.z * gl_in[2].gl_Position;\n"
       "  mixed = t.x * colors[0] + t.y * colors[1] + t.z * colors[2];\n"
       "}\n"},
      {VK_SHADER_STAGE_GEOMETRY_BIT,
       "layout(triangles) in;\n"
       "layout(triangle_strip, max_vertices = 3) out;\n"
       "layout(location = 0) in vec3 mixed[];\n"
       "layout(location = 0) out vec3 shade;\n"
       "void main() {\n"
       "  for (int i = 0; i < 3; ++i) {\n"
       "    gl_Position = gl_in[i].gl_Position; shade = mixed[i] + 0.1 * float(gl_PrimitiveIDIn % 3); EmitVertex();\n"
       "  }\n"
       "}\n"},
      {VK_SHADER_STAGE_FRAGMENT_BIT,
       "layout(location = 0) in vec3 shade;\n"
       "layout(location = 0) out vec4 color;\n"
       "layout(push_constant) uniform P { vec4 tint; };\n"
       "void main() { color = vec4(shade * tint.zyx, 0.75); }\n"}};
  return picture;
}

class PipelineBinaryDraws : public PipelineBinaryDevice {
 protected:
  /// Libraries of the parts of a pipeline, without modules where they come from binaries.
  std::vector<VkPipeline> make_libraries(VkGraphicsPipelineCreateInfo info, VkPipelineCreateFlags2KHR flags,
                                         const std::vector<Binaries>& binaries = {}) {
    std::vector<VkPipeline> libraries;
    auto part = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>(const_cast<void*>(info.pNext));
    info.pNext = &part;
    for (std::size_t i = 0; i < std::size(kParts); ++i) {
      part.flags = kParts[i];
      const Binaries given = binaries.empty() ? Binaries{} : binaries[i];
      libraries.push_back(create(info, {flags | VK_PIPELINE_CREATE_2_LIBRARY_BIT_KHR, given}));
    }
    return libraries;
  }
  VkPipeline link(const std::vector<VkPipeline>& libraries, const PipelineChain& chain = {}) {
    auto list = make_struct<VkPipelineLibraryCreateInfoKHR>();
    list.libraryCount = static_cast<std::uint32_t>(libraries.size());
    list.pLibraries = libraries.data();
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&list);
    info.layout = layout;
    return create(info, chain);
  }
  std::string link_key(const std::vector<VkPipeline>& libraries) {
    auto list = make_struct<VkPipelineLibraryCreateInfoKHR>();
    list.libraryCount = static_cast<std::uint32_t>(libraries.size());
    list.pLibraries = libraries.data();
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&list);
    return key_of(&info);
  }
  static void forget_modules(std::span<VkPipelineShaderStageCreateInfo> stages) {
    for (VkPipelineShaderStageCreateInfo& stage : stages) stage.module = VK_NULL_HANDLE;
  }
  /// Blobs outlive everything else.
  void start_again() {
    TearDown();
    SetUp();
  }
};

TEST_F(PipelineBinaryDraws, GiveThePixelsOfTheSamePipeline) {
  const Picture2D picture = every_stage();
  const Contents expected = by_pipeline(picture);
  EXPECT_NE(expected, render(picture, [](VkCommandBuffer) {}));
  Blobs blobs;
  with_pipeline_info(
      picture, [&](const VkGraphicsPipelineCreateInfo& info, auto) { blobs = blobs_of(create(info, {kCapture})); });
  ASSERT_EQ(blobs.size(), 5u);
  start_again();
  with_pipeline_info(picture,
                     [&](const VkGraphicsPipelineCreateInfo& info, std::span<VkPipelineShaderStageCreateInfo> stages) {
                       forget_modules(stages);
                       const VkPipeline pipeline = create(info, {kCapture, read(blobs)});
                       EXPECT_EQ(by_pipeline(picture, pipeline), expected);
                       EXPECT_EQ(blobs_of(pipeline), blobs);
                     });
}

/// Parts without shaders have no binaries.
TEST_F(PipelineBinaryDraws, OfLibrariesGiveThePixelsOfTheWholePipeline) {
  const Picture2D picture = every_stage();
  const Contents expected = by_pipeline(picture);
  std::vector<Blobs> blobs;
  with_pipeline_info(picture, [&](const VkGraphicsPipelineCreateInfo& info, auto) {
    const std::vector<VkPipeline> libraries = make_libraries(info, kCapture);
    for (const VkPipeline library : libraries) blobs.push_back(blobs_of(library));
    EXPECT_TRUE(binaries_of(link(libraries)).empty());
    for (const VkPipeline library : libraries) {
      auto release = make_struct<VkReleaseCapturedPipelineDataInfoKHR>();
      release.pipeline = library;
      EXPECT_EQ(VK_CALL(ReleaseCapturedPipelineDataKHR)(device, &release, nullptr), VK_SUCCESS);
    }
    EXPECT_EQ(by_pipeline(picture, link(libraries)), expected) << "what they were made from is still theirs";
  });
  const std::size_t counts[] = {0, 4, 1, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(blobs[i].size(), counts[i]);
  start_again();
  with_pipeline_info(picture,
                     [&](const VkGraphicsPipelineCreateInfo& info, std::span<VkPipelineShaderStageCreateInfo> stages) {
                       forget_modules(stages);
                       std::vector<Binaries> binaries;
                       for (const Blobs& part : blobs) binaries.push_back(part.empty() ? Binaries{} : read(part));
                       EXPECT_EQ(by_pipeline(picture, link(make_libraries(info, 0, binaries))), expected);
                     });
}

/// A pipeline that links libraries has their stages: its binaries stand for them.
TEST_F(PipelineBinaryDraws, OfLinkedPipelinesStandForTheStagesOfLibraries) {
  const Picture2D picture = every_stage();
  const Contents expected = by_pipeline(picture);
  Picture2D blank = picture;
  blank.stages[VK_SHADER_STAGE_FRAGMENT_BIT] =
      "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.5, 0, 0, 1); }\n";
  with_pipeline_info(picture, [&](const VkGraphicsPipelineCreateInfo& info, auto) {
    const std::vector<VkPipeline> libraries = make_libraries(info, 0);
    const Blobs blobs = blobs_of(link(libraries, {kCapture}));
    ASSERT_EQ(blobs.size(), 5u);
    with_pipeline_info(blank, [&](const VkGraphicsPipelineCreateInfo& other_info, auto) {
      const std::vector<VkPipeline> others = make_libraries(other_info, 0);
      EXPECT_NE(by_pipeline(picture, link(others)), expected);
      EXPECT_EQ(by_pipeline(picture, link(others, {0, read(blobs)})), expected);
      EXPECT_NE(link_key(others), link_key(libraries));
    });
    EXPECT_EQ(link_key(make_libraries(info, 0)), link_key(libraries));
  });
}

/// Nothing is compiled before they are linked, and so nothing is found.
TEST_F(PipelineBinaryDraws, LibrariesHitNothingInCaches) {
  VkPipelineCache cache;
  const auto cache_info = make_struct<VkPipelineCacheCreateInfo>();
  ASSERT_EQ(VK_CALL(CreatePipelineCache)(device, &cache_info, nullptr, &cache), VK_SUCCESS);
  with_pipeline_info(every_stage(), [&](VkGraphicsPipelineCreateInfo& info, auto) {
    VkPipelineCreationFeedback whole{};
    auto feedback = make_struct<VkPipelineCreationFeedbackCreateInfo>(const_cast<void*>(info.pNext));
    feedback.pPipelineCreationFeedback = &whole;
    auto part = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>(&feedback);
    part.flags = VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT;
    info.pNext = &part;
    info.flags = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
    for (int i = 0; i < 2; ++i) {
      VkPipeline library;
      ASSERT_EQ(VK_CALL(CreateGraphicsPipelines)(device, cache, 1, &info, nullptr, &library), VK_SUCCESS);
      EXPECT_EQ(whole.flags, VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT);
      VK_CALL(DestroyPipeline)(device, library, nullptr);
    }
  });
  VK_CALL(DestroyPipelineCache)(device, cache, nullptr);
}

/// The fragment shader takes no part, but its binary is there: whether it does is no matter of the binaries.
TEST_F(PipelineBinaryDraws, WithoutRasterizationHaveAllStages) {
  with_pipeline_info(every_stage(), [&](VkGraphicsPipelineCreateInfo& info, auto) {
    const Blobs all = blobs_of(create(info, {kCapture}));
    const std::string key = key_of(&info);
    VkPipelineRasterizationStateCreateInfo rasterization = *info.pRasterizationState;
    rasterization.rasterizerDiscardEnable = VK_TRUE;
    info.pRasterizationState = &rasterization;
    EXPECT_EQ(blobs_of(create(info, {kCapture})), all);
    EXPECT_EQ(key_of(&info), key);
    create(info, {0, read(all)});
  });
}

}  // namespace
}  // namespace vitrine::icd::test
#endif
