// A device on which sanitize is on, two buffers and an image that nothing has written, and shaders that read them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "glass/session.h"
#include "tests/glsl/compile.h"
#include "tests/icd/fixture.h"

namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

class WrittenMemory : public DeviceTest {
 protected:
  static constexpr VkDeviceSize kBytes = 256;  ///< of each buffer
  static constexpr std::uint32_t kSize = 8;    ///< of the image

  struct Memory {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
  };

  /// These tests run in a process of their own (tests/CMakeLists.txt).
  void SetUp() override {
    if (!glass::session().shadows_memory()) GTEST_SKIP() << "needs VITRINE_TOOLS=sanitize";
    DeviceTest::SetUp();
    VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
    listen();
    make(input);
    make(other);
    make(result);
    make_image();
    make_set();
    const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &command_pool), VK_SUCCESS);
  }

  void TearDown() override {
    if (!instance) return;
    VK_CALL(DestroyCommandPool)(device, command_pool, nullptr);
    for (const VkPipeline p : pipelines) VK_CALL(DestroyPipeline)(device, p, nullptr);
    for (const VkFramebuffer f : framebuffers) VK_CALL(DestroyFramebuffer)(device, f, nullptr);
    for (const VkRenderPass p : render_passes) VK_CALL(DestroyRenderPass)(device, p, nullptr);
    VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
    VK_CALL(DestroyDescriptorPool)(device, descriptor_pool, nullptr);
    VK_CALL(DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    VK_CALL(DestroySampler)(device, sampler, nullptr);
    VK_CALL(DestroyImageView)(device, view, nullptr);
    VK_CALL(DestroyImage)(device, image, nullptr);
    VK_CALL(FreeMemory)(device, image_memory, nullptr);
    for (const Memory& m : {input, other, result}) {
      VK_CALL(DestroyBuffer)(device, m.buffer, nullptr);
      VK_CALL(FreeMemory)(device, m.memory, nullptr);
    }
    VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
    DeviceTest::TearDown();
  }

  /// Records and runs commands; the rules that they broke.
  std::vector<std::string> found_by(const std::function<void(VkCommandBuffer)>& record) {
    found.clear();
    text.clear();
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = command_pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto info = make_struct<VkCommandBufferBeginInfo>();
    EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &info), VK_SUCCESS);
    record(commands);
    EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
    auto submit = make_struct<VkSubmitInfo>();
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    EXPECT_EQ(VK_CALL(QueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    EXPECT_EQ(VK_CALL(QueueWaitIdle)(queue), VK_SUCCESS);
    return found;
  }

  /// A compute shader with this body, `i` its invocation, run by so many invocations. No other has its places.
  void dispatch(VkCommandBuffer commands, const std::string& body, std::uint32_t invocations = 64) {
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, std::string(kResources) +
                                                           "layout(local_size_x = 1) in;\nvoid main() {\n  uint i = "
                                                           "gl_GlobalInvocationID.x;\n  " +
                                                           body + "\n  if (i == " + std::to_string(++dispatches) +
                                                           "000u) o[0] = 0u;\n}\n");
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    VK_CALL(DestroyShaderModule)(device, info.stage.module, nullptr);
    pipelines.push_back(pipeline);
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdBindDescriptorSets)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, invocations, 1, 1);
  }
  void read_buffer(VkCommandBuffer commands) { dispatch(commands, "o[i] = a[i] + 1u;"); }
  void load_image(VkCommandBuffer commands) {
    dispatch(commands, "o[i] = imageLoad(m, ivec2(i % 8u, i / 8u)).x + 1u;");
  }

  /// The image to VK_IMAGE_LAYOUT_GENERAL.
  void transition(VkCommandBuffer commands, VkImageLayout from) {
    auto barrier = make_struct<VkImageMemoryBarrier>();
    barrier.oldLayout = from;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.image = image;
    barrier.subresourceRange = kAll;
    VK_CALL(CmdPipelineBarrier)
    (commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
     &barrier);
  }
  void clear(VkCommandBuffer commands) {
    const VkClearColorValue value{};
    VK_CALL(CmdClearColorImage)(commands, image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &kAll);
  }
  void begin_rendering(VkCommandBuffer commands, VkAttachmentLoadOp load, VkAttachmentStoreOp store) {
    auto color = make_struct<VkRenderingAttachmentInfo>();
    color.imageView = view;
    color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    color.loadOp = load;
    color.storeOp = store;
    auto info = make_struct<VkRenderingInfo>();
    info.renderArea.extent = {kSize, kSize};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    VK_CALL(CmdBeginRendering)(commands, &info);
  }
  void run_render_pass(VkCommandBuffer commands, VkAttachmentLoadOp load, VkAttachmentStoreOp store,
                       VkImageLayout initial);
  /// A triangle over all of the image.
  void draw(VkCommandBuffer commands);

  /// Destroys the buffer and makes it again, in memory of its own.
  void remake(Memory& memory) {
    VK_CALL(DestroyBuffer)(device, memory.buffer, nullptr);
    VK_CALL(FreeMemory)(device, memory.memory, nullptr);
    make(memory);
    write_set();
  }

  VkQueue queue = VK_NULL_HANDLE;
  Memory input, other, result;
  VkImage image = VK_NULL_HANDLE;
  std::vector<std::string> found;
  std::string text;  ///< of the last finding

 private:
  static constexpr VkImageSubresourceRange kAll{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  static constexpr const char* kResources =
      "#version 450\n"
      "layout(set = 0, binding = 0) buffer A { uint a[64]; };\n"
      "layout(set = 0, binding = 1) buffer O { uint o[64]; };\n"
      "layout(set = 0, binding = 2, r32ui) uniform uimage2D m;\n"
      "layout(set = 0, binding = 3) uniform usampler2D t;\n";

  void listen();
  void make(Memory& memory);
  void make_image();
  void make_set();
  void write_set();
  VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, const std::string& glsl);

  inline static std::uint32_t dispatches = 0;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkDeviceMemory image_memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkCommandPool command_pool = VK_NULL_HANDLE;
  std::vector<VkPipeline> pipelines;
  std::vector<VkRenderPass> render_passes;
  std::vector<VkFramebuffer> framebuffers;
};

}  // namespace vitrine::icd::test
