// VK_EXT_fragment_shader_interlock, which the reference does not have: overlapping triangles read, change and write the
// memory of each pixel (or sample). The result of one draw equals that of one submission per triangle.
#include <array>
#include <cstring>
#include <vector>

#include "tests/icd/fixture.h"
#include "tests/icd/interlock_shaders.h"

namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr std::uint32_t kSize = 128;       ///< pixels: four tiles
constexpr std::uint32_t kTriangles = 400;  ///< of about a sixth of the target each
constexpr VkDeviceSize kImageBytes = kSize * kSize * 4, kBufferBytes = 4 * kImageBytes;

class Interlock : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = 16 * kImageBytes;
    ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    void* mapped = nullptr;
    ASSERT_EQ(VK_CALL(MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    bytes = static_cast<std::byte*>(mapped);
    make_image(VK_FORMAT_R32_UINT, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_TILING_LINEAR, VK_IMAGE_USAGE_STORAGE_BIT, 0,
               storage);
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = kBufferBytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    ASSERT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
    ASSERT_EQ(VK_CALL(BindBufferMemory)(device, buffer, memory, kImageBytes), VK_SUCCESS);
    make_descriptors();
    VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &command_pool), VK_SUCCESS);
  }

  void TearDown() override {
    VK_CALL(DestroyCommandPool)(device, command_pool, nullptr);
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
    VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
    VK_CALL(DestroyDescriptorPool)(device, descriptor_pool, nullptr);
    VK_CALL(DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    for (const Picture& p : {storage, target}) {
      VK_CALL(DestroyImageView)(device, p.view, nullptr);
      VK_CALL(DestroyImage)(device, p.image, nullptr);
    }
    VK_CALL(DestroyBuffer)(device, buffer, nullptr);
    VK_CALL(FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  struct Picture {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
  };

  void make_image(VkFormat format, VkSampleCountFlagBits samples, VkImageTiling tiling, VkImageUsageFlags usage,
                  VkDeviceSize offset, Picture& out) {
    auto info = make_struct<VkImageCreateInfo>();
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {kSize, kSize, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = samples;
    info.tiling = tiling;
    info.usage = usage;
    ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &out.image), VK_SUCCESS);
    ASSERT_EQ(VK_CALL(BindImageMemory)(device, out.image, memory, offset), VK_SUCCESS);
    auto view = make_struct<VkImageViewCreateInfo>();
    view.image = out.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(VK_CALL(CreateImageView)(device, &view, nullptr, &out.view), VK_SUCCESS);
  }

  void make_descriptors() {
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
    auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
    shape.bindingCount = 2;
    shape.pBindings = bindings;
    ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout), VK_SUCCESS);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    auto pool = make_struct<VkDescriptorPoolCreateInfo>();
    pool.maxSets = 1;
    pool.poolSizeCount = 2;
    pool.pPoolSizes = sizes;
    ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool, nullptr, &descriptor_pool), VK_SUCCESS);
    auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
    allocate.descriptorPool = descriptor_pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
    const VkDescriptorImageInfo texture{VK_NULL_HANDLE, storage.view, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo range{buffer, 0, VK_WHOLE_SIZE};
    std::array<VkWriteDescriptorSet, 2> writes;
    for (std::uint32_t i = 0; i < 2; ++i) {
      writes[i] = make_struct<VkWriteDescriptorSet>();
      writes[i].dstSet = set;
      writes[i].dstBinding = i;
      writes[i].descriptorCount = 1;
      writes[i].descriptorType = bindings[i].descriptorType;
      writes[i].pImageInfo = &texture;
      writes[i].pBufferInfo = &range;
    }
    VK_CALL(UpdateDescriptorSets)(device, 2, writes.data(), 0, nullptr);
    auto info = make_struct<VkPipelineLayoutCreateInfo>();
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
  }

  VkShaderModule make_module(const std::uint32_t* words, std::size_t size) {
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = size;
    info.pCode = words;
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    return module;
  }

  void make_pipeline(const std::uint32_t* words, std::size_t size, VkSampleCountFlagBits sample_count,
                     bool sample_shading) {
    make_image(VK_FORMAT_R8G8B8A8_UNORM, sample_count, VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
               8 * kImageBytes, target);
    const VkShaderModule modules[] = {make_module(kScatteredVertexWords, sizeof kScatteredVertexWords),
                                      make_module(words, size)};
    std::array<VkPipelineShaderStageCreateInfo, 2> stages;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      stages[i] = make_struct<VkPipelineShaderStageCreateInfo>();
      stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
      stages[i].module = modules[i];
      stages[i].pName = "main";
    }
    const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport area{0, 0, kSize, kSize, 0, 1};
    const VkRect2D scissor{{0, 0}, {kSize, kSize}};
    auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &area;
    viewport.pScissors = &scissor;
    auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
    rasterization.lineWidth = 1;
    auto samples = make_struct<VkPipelineMultisampleStateCreateInfo>();
    samples.rasterizationSamples = sample_count;
    samples.sampleShadingEnable = sample_shading;
    samples.minSampleShading = 1;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = 15;
    auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &format;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.layout = layout;
    ASSERT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    for (const VkShaderModule module : modules) VK_CALL(DestroyShaderModule)(device, module, nullptr);
  }

  /// Clears the memory, draws all triangles, `at_once` in each submission; the memory after that.
  std::vector<std::byte> draw(std::uint32_t at_once) {
    std::memset(bytes, 0, kImageBytes + kBufferBytes);
    auto attachment = make_struct<VkRenderingAttachmentInfo>();
    attachment.imageView = target.view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    auto scope = make_struct<VkRenderingInfo>();
    scope.renderArea = {{0, 0}, {kSize, kSize}};
    scope.layerCount = scope.colorAttachmentCount = 1;
    scope.pColorAttachments = &attachment;
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = command_pool;
    allocate.commandBufferCount = 1;
    for (std::uint32_t first = 0; first < kTriangles; first += at_once) {
      VkCommandBuffer commands = VK_NULL_HANDLE;
      EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
      const auto begin = make_struct<VkCommandBufferBeginInfo>();
      EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
      VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
      VK_CALL(CmdBindDescriptorSets)
      (commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
      VK_CALL(CmdBeginRendering)(commands, &scope);
      VK_CALL(CmdDraw)(commands, 3 * at_once, 1, 3 * first, 0);
      VK_CALL(CmdEndRendering)(commands);
      EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
      auto submit = make_struct<VkSubmitInfo>();
      submit.commandBufferCount = 1;
      submit.pCommandBuffers = &commands;
      EXPECT_EQ(VK_CALL(QueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
      EXPECT_EQ(VK_CALL(QueueWaitIdle)(queue), VK_SUCCESS);
    }
    return {bytes, bytes + kImageBytes + kBufferBytes};
  }

  void expect_sequential() {
    const std::vector<std::byte> one_by_one = draw(1);
    EXPECT_NE(one_by_one, std::vector<std::byte>(one_by_one.size())) << "nothing drawn";
    EXPECT_EQ(draw(kTriangles), one_by_one);
    EXPECT_EQ(draw(kTriangles / 4), one_by_one);
  }

  VkDeviceMemory memory = VK_NULL_HANDLE;  ///< the storage image, the buffer, the attachment
  std::byte* bytes = nullptr;
  Picture storage, target;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkCommandPool command_pool = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
};

TEST_F(Interlock, PixelsInOrder) {
  make_pipeline(kPixelInterlockWords, sizeof kPixelInterlockWords, VK_SAMPLE_COUNT_1_BIT, false);
  expect_sequential();
}

TEST_F(Interlock, PixelsInOrderOfMultisampledTargets) {
  make_pipeline(kPixelInterlockWords, sizeof kPixelInterlockWords, VK_SAMPLE_COUNT_4_BIT, false);
  expect_sequential();
}

TEST_F(Interlock, PixelsInOrderWithSampleShading) {
  make_pipeline(kPixelInterlockWords, sizeof kPixelInterlockWords, VK_SAMPLE_COUNT_4_BIT, true);
  expect_sequential();
}

TEST_F(Interlock, SamplesInOrder) {
  make_pipeline(kSampleInterlockWords, sizeof kSampleInterlockWords, VK_SAMPLE_COUNT_4_BIT, true);
  expect_sequential();
}

}  // namespace
}  // namespace vitrine::icd::test
