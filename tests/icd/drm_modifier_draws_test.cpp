// Draws, blits and stores to pictures that are a part of a larger one: what lies beside them, and between their rows,
// is somebody else's.
#include <array>
#include <cstring>
#include <string>

#include "tests/glsl/compile.h"
#include "tests/icd/fixture.h"
#include "texel/format.h"

namespace vitrine::icd::test {
namespace {

constexpr VkDeviceSize kMemory = VkDeviceSize{1} << 19, kOffset = 4096 + 64, kGap = 192;
constexpr std::uint8_t kForeign = 0xab;

class DrmModifierDraws : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    const auto info = make_struct<VkPipelineLayoutCreateInfo>();
    ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = kMemory;
    ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    void* data = nullptr;
    ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    bytes = static_cast<std::uint8_t*>(data);
  }
  void TearDown() override {
    VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
    VK_GET(instance, FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  void make_target(VkFormat format, VkExtent2D extent) {
    const VkDeviceSize row = extent.width * texel::format_desc(format).block_bytes;
    pitch = (row + 63) / 64 * 64 + kGap;
    const VkSubresourceLayout place{kOffset, 0, pitch, 0, 0};
    auto exact = make_struct<VkImageDrmFormatModifierExplicitCreateInfoEXT>();
    exact.drmFormatModifierPlaneCount = 1;
    exact.pPlaneLayouts = &place;
    auto info = make_struct<VkImageCreateInfo>(&exact);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_DRM_FORMAT_MODIFIER_EXT;
    info.usage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
    auto view_info = make_struct<VkImageViewCreateInfo>();
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = format;
    view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(VK_GET(instance, CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  }

  void make_pass(VkFormat format, VkExtent2D extent) {
    VkAttachmentDescription attachment{};
    attachment.format = format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_GENERAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    auto info = make_struct<VkRenderPassCreateInfo>();
    info.attachmentCount = info.subpassCount = 1;
    info.pAttachments = &attachment;
    info.pSubpasses = &subpass;
    ASSERT_EQ(VK_GET(instance, CreateRenderPass)(device, &info, nullptr, &pass), VK_SUCCESS);
    auto buffer = make_struct<VkFramebufferCreateInfo>();
    buffer.renderPass = pass;
    buffer.attachmentCount = 1;
    buffer.pAttachments = &view;
    buffer.width = extent.width;
    buffer.height = extent.height;
    buffer.layers = 1;
    ASSERT_EQ(VK_GET(instance, CreateFramebuffer)(device, &buffer, nullptr, &framebuffer), VK_SUCCESS);
  }

  VkShaderModule make_module(VkShaderStageFlagBits stage, const std::string& text) {
    std::string log;
    const auto words =
        vitrine::test::compile_glsl(stage, "#version 450\n" + text, vitrine::test::VulkanVersion::k11, log);
    EXPECT_FALSE(words.empty()) << log;
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = words.size() * 4;
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    return module;
  }

  void make_pipeline(VkExtent2D extent, bool blends) {
    const VkShaderModule modules[2] = {
        make_module(VK_SHADER_STAGE_VERTEX_BIT,
                    "void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4 - 1, 0, 1); }"),
        make_module(VK_SHADER_STAGE_FRAGMENT_BIT,
                    "layout(location = 0) out vec4 v; void main() { v = vec4(0.25) + gl_FragCoord.xyxy * 0.001; }")};
    std::array<VkPipelineShaderStageCreateInfo, 2> stages;
    for (std::size_t i = 0; i < 2; ++i) {
      stages[i] = make_struct<VkPipelineShaderStageCreateInfo>();
      stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
      stages[i].module = modules[i];
      stages[i].pName = "main";
    }
    const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport area{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &area;
    viewport.pScissors = &scissor;
    auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
    rasterization.lineWidth = 1;
    auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = 0xf;
    state.blendEnable = blends;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
    blend.attachmentCount = 1;
    blend.pAttachments = &state;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>();
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &multisample;
    info.pColorBlendState = &blend;
    info.layout = layout;
    info.renderPass = pass;
    const auto create = VK_GET(instance, CreateGraphicsPipelines);
    ASSERT_EQ(create(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    for (const VkShaderModule module : modules) VK_GET(instance, DestroyShaderModule)(device, module, nullptr);
  }

  void destroy() {
    VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
    VK_GET(instance, DestroyFramebuffer)(device, framebuffer, nullptr);
    VK_GET(instance, DestroyRenderPass)(device, pass, nullptr);
    VK_GET(instance, DestroyImageView)(device, view, nullptr);
    VK_GET(instance, DestroyImage)(device, image, nullptr);
  }

  void draw(VkCommandBuffer commands, VkExtent2D extent) {
    VkClearValue clear{};
    clear.color = {{0.5f, 0.5f, 0.5f, 0.5f}};
    auto begin = make_struct<VkRenderPassBeginInfo>();
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = extent;
    begin.clearValueCount = 1;
    begin.pClearValues = &clear;
    VK_GET(instance, CmdBeginRenderPass)(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    VK_GET(instance, CmdDraw)(commands, 3, 1, 0, 0);
    VK_GET(instance, CmdEndRenderPass)(commands);
  }

  /// Turns the left half onto the right one.
  void blit(VkCommandBuffer commands, VkExtent2D extent) {
    const auto width = static_cast<std::int32_t>(extent.width), height = static_cast<std::int32_t>(extent.height);
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {width / 3, height, 1};
    region.dstOffsets[0] = {width, 0, 0};
    region.dstOffsets[1] = {width / 2, height, 1};
    const auto record = VK_GET(instance, CmdBlitImage);
    record(commands, image, VK_IMAGE_LAYOUT_GENERAL, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region, VK_FILTER_LINEAR);
  }

  /// Bytes of nobody else that have changed; those of others must not have.
  std::size_t changed(VkFormat format, VkExtent2D extent) const {
    const VkDeviceSize row_bytes = extent.width * texel::format_desc(format).block_bytes;
    std::size_t count = 0;
    for (VkDeviceSize at = 0; at < kMemory; ++at) {
      const bool behind = at >= kOffset;
      const VkDeviceSize row = behind ? (at - kOffset) / pitch : 0, column = behind ? (at - kOffset) % pitch : 0;
      const bool inside = behind && row < extent.height && column < row_bytes;
      if (inside)
        count += bytes[at] != kForeign;
      else if (bytes[at] != kForeign)
        ADD_FAILURE() << texel::format_desc(format).name << ": row " << row << " byte " << column, at = kMemory;
    }
    return count;
  }

  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::uint8_t* bytes = nullptr;
  VkDeviceSize pitch = 0;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

TEST_F(DrmModifierDraws, LeaveWhatLiesBesideThePicture) {
  for (const VkFormat format :
       {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8_UNORM,
        VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
    for (const VkExtent2D extent : {VkExtent2D{19, 9}, VkExtent2D{70, 66}, VkExtent2D{64, 8}}) {
      for (const bool blends : {false, true}) {
        std::memset(bytes, kForeign, kMemory);
        make_target(format, extent);
        make_pass(format, extent);
        make_pipeline(extent, blends);
        run([&](VkCommandBuffer commands) {
          draw(commands, extent);
          blit(commands, extent);
        });
        const std::size_t whole = extent.width * extent.height * texel::format_desc(format).block_bytes;
        EXPECT_GT(changed(format, extent), whole / 2) << texel::format_desc(format).name;
        destroy();
        if (HasFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace vitrine::icd::test
