// See small_program.h.
#include "tests/icd/small_program.h"

#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

constexpr std::uint32_t kSize = 160;  // pixels per side: several tiles, so that workers take part

#define VK_TRY(call)                                         \
  do {                                                       \
    const VkResult result_of_call = (call);                  \
    if (result_of_call != VK_SUCCESS) return result_of_call; \
  } while (false)

#define VK_CALL(name) VK_GET(p.instance, name)

VkResult make_module(Program& p, const std::uint32_t* words, std::size_t bytes, VkShaderModule* module) {
  VkShaderModuleCreateInfo info = make_struct<VkShaderModuleCreateInfo>();
  info.codeSize = bytes;
  info.pCode = words;
  return VK_CALL(CreateShaderModule)(p.device, &info, p.allocator, module);
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info = make_struct<VkPipelineShaderStageCreateInfo>();
  info.stage = bit;
  info.module = module;
  info.pName = "main";
  return info;
}

VkResult make_graphics_pipeline(Program& p) {
  const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, p.modules[1]),
                                                    stage(VK_SHADER_STAGE_FRAGMENT_BIT, p.modules[2])};
  const auto vertex_input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport viewport{0, 0, kSize, kSize, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSize, kSize}};
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
  auto info = make_struct<VkGraphicsPipelineCreateInfo>();
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &vertex_input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &multisample;
  info.pColorBlendState = &blend;
  info.layout = p.layout;
  info.renderPass = p.render_pass;
  return VK_CALL(CreateGraphicsPipelines)(p.device, VK_NULL_HANDLE, 1, &info, p.allocator, &p.pipelines[1]);
}

}  // namespace

VkResult make_device(Program& p) {
  VK_TRY(create_instance(&p.instance, p.allocator));
  VkPhysicalDevice physical_device;
  std::uint32_t count = 1;
  VK_TRY(VK_CALL(EnumeratePhysicalDevices)(p.instance, &count, &physical_device));
  return create_device(p.instance, physical_device, &p.device, p.allocator);
}

VkResult make_resources(Program& p) {
  VkMemoryAllocateInfo memory = make_struct<VkMemoryAllocateInfo>();
  memory.allocationSize = 4096 + (kSize + 16) * kSize * 4;
  VK_TRY(VK_CALL(AllocateMemory)(p.device, &memory, p.allocator, &p.memory));
  VkBufferCreateInfo buffer = make_struct<VkBufferCreateInfo>();
  buffer.size = 4096;
  buffer.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VK_TRY(VK_CALL(CreateBuffer)(p.device, &buffer, p.allocator, &p.buffer));
  VK_TRY(VK_CALL(BindBufferMemory)(p.device, p.buffer, p.memory, 0));
  VkImageCreateInfo image = make_struct<VkImageCreateInfo>();
  image.imageType = VK_IMAGE_TYPE_2D;
  image.format = VK_FORMAT_R8G8B8A8_UNORM;
  image.extent = {kSize, kSize, 1};
  image.mipLevels = image.arrayLayers = 1;
  image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.tiling = VK_IMAGE_TILING_LINEAR;
  image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  VK_TRY(VK_CALL(CreateImage)(p.device, &image, p.allocator, &p.image));
  VK_TRY(VK_CALL(BindImageMemory)(p.device, p.image, p.memory, 4096));
  VkImageViewCreateInfo view = make_struct<VkImageViewCreateInfo>();
  view.image = p.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = image.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return VK_CALL(CreateImageView)(p.device, &view, p.allocator, &p.view);
}

VkResult make_descriptors(Program& p) {
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                             nullptr};
  VkDescriptorSetLayoutCreateInfo set_layout = make_struct<VkDescriptorSetLayoutCreateInfo>();
  set_layout.bindingCount = 1;
  set_layout.pBindings = &binding;
  VK_TRY(VK_CALL(CreateDescriptorSetLayout)(p.device, &set_layout, p.allocator, &p.set_layout));
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  VkDescriptorPoolCreateInfo pool = make_struct<VkDescriptorPoolCreateInfo>();
  pool.maxSets = 1;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  VK_TRY(VK_CALL(CreateDescriptorPool)(p.device, &pool, p.allocator, &p.descriptor_pool));
  VkDescriptorSetAllocateInfo allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = p.descriptor_pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &p.set_layout;
  VK_TRY(VK_CALL(AllocateDescriptorSets)(p.device, &allocate, &p.set));
  const VkDescriptorBufferInfo buffer{p.buffer, 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = p.set;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &buffer;
  VK_CALL(UpdateDescriptorSets)(p.device, 1, &write, 0, nullptr);
  VkPipelineLayoutCreateInfo layout = make_struct<VkPipelineLayoutCreateInfo>();
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &p.set_layout;
  return VK_CALL(CreatePipelineLayout)(p.device, &layout, p.allocator, &p.layout);
}

VkResult make_render_pass(Program& p) {
  VkAttachmentDescription attachment{};
  attachment.format = VK_FORMAT_R8G8B8A8_UNORM;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo render_pass = make_struct<VkRenderPassCreateInfo>();
  render_pass.attachmentCount = 1;
  render_pass.pAttachments = &attachment;
  render_pass.subpassCount = 1;
  render_pass.pSubpasses = &subpass;
  VK_TRY(VK_CALL(CreateRenderPass)(p.device, &render_pass, p.allocator, &p.render_pass));
  VkFramebufferCreateInfo framebuffer = make_struct<VkFramebufferCreateInfo>();
  framebuffer.renderPass = p.render_pass;
  framebuffer.attachmentCount = 1;
  framebuffer.pAttachments = &p.view;
  framebuffer.width = framebuffer.height = kSize;
  framebuffer.layers = 1;
  return VK_CALL(CreateFramebuffer)(p.device, &framebuffer, p.allocator, &p.framebuffer);
}

VkResult make_pipelines(Program& p) {
  VK_TRY(make_module(p, kComputeWords, sizeof kComputeWords, &p.modules[0]));
  VK_TRY(make_module(p, kVertexWords, sizeof kVertexWords, &p.modules[1]));
  VK_TRY(make_module(p, kFragmentWords, sizeof kFragmentWords, &p.modules[2]));
  auto compute = make_struct<VkComputePipelineCreateInfo>();
  compute.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, p.modules[0]);
  compute.layout = p.layout;
  VK_TRY(VK_CALL(CreateComputePipelines)(p.device, VK_NULL_HANDLE, 1, &compute, p.allocator, &p.pipelines[0]));
  return make_graphics_pipeline(p);
}

VkResult begin_commands(Program& p, VkCommandBuffer& commands) {
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = p.command_pool;
  allocate.commandBufferCount = 1;
  VK_TRY(VK_CALL(AllocateCommandBuffers)(p.device, &allocate, &commands));
  const auto begin = make_struct<VkCommandBufferBeginInfo>();
  return VK_CALL(BeginCommandBuffer)(commands, &begin);
}

VkResult record(Program& p) {
  auto query_pool = make_struct<VkQueryPoolCreateInfo>();
  query_pool.queryType = VK_QUERY_TYPE_OCCLUSION;
  query_pool.queryCount = 1;
  VK_TRY(VK_CALL(CreateQueryPool)(p.device, &query_pool, p.allocator, &p.query_pool));
  const auto pool = make_struct<VkCommandPoolCreateInfo>();
  VK_TRY(VK_CALL(CreateCommandPool)(p.device, &pool, p.allocator, &p.command_pool));
  VK_TRY(begin_commands(p, p.commands));
  VK_CALL(CmdResetQueryPool)(p.commands, p.query_pool, 0, 1);
  VK_CALL(CmdBindPipeline)(p.commands, VK_PIPELINE_BIND_POINT_COMPUTE, p.pipelines[0]);
  VK_CALL(CmdBindDescriptorSets)
  (p.commands, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout, 0, 1, &p.set, 0, nullptr);
  VK_CALL(CmdDispatch)(p.commands, 2, 1, 1);
  const VkClearValue clear{};
  auto render = make_struct<VkRenderPassBeginInfo>();
  render.renderPass = p.render_pass;
  render.framebuffer = p.framebuffer;
  render.renderArea.extent = {kSize, kSize};
  render.clearValueCount = 1;
  render.pClearValues = &clear;
  VK_CALL(CmdBeginRenderPass)(p.commands, &render, VK_SUBPASS_CONTENTS_INLINE);
  VK_CALL(CmdBindPipeline)(p.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p.pipelines[1]);
  VK_CALL(CmdBeginQuery)(p.commands, p.query_pool, 0, 0);
  VK_CALL(CmdDraw)(p.commands, 3, 1, 0, 0);
  VK_CALL(CmdEndQuery)(p.commands, p.query_pool, 0);
  VK_CALL(CmdEndRenderPass)(p.commands);
  return VK_CALL(EndCommandBuffer)(p.commands);
}

VkResult submit(Program& p) {
  const auto fence = make_struct<VkFenceCreateInfo>();
  VK_TRY(VK_CALL(CreateFence)(p.device, &fence, p.allocator, &p.fence));
  VkQueue queue;
  VK_CALL(GetDeviceQueue)(p.device, 0, 0, &queue);
  auto info = make_struct<VkSubmitInfo>();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &p.commands;
  return VK_CALL(QueueSubmit)(queue, 1, &info, p.fence);
}

VkResult wait(Program& p) { return VK_CALL(WaitForFences)(p.device, 1, &p.fence, VK_TRUE, ~std::uint64_t{0}); }

VkResult run(Program& p) {
  for (const auto step :
       {make_device, make_resources, make_descriptors, make_render_pass, make_pipelines, record, submit, wait}) {
    VK_TRY(step(p));
  }
  return VK_SUCCESS;
}

void check_results(Program& p) {
  void* data = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory)(p.device, p.memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
  const auto* numbers = static_cast<const std::uint32_t*>(data);
  for (std::uint32_t i = 0; i < 128; ++i) ASSERT_EQ(numbers[i], i * 3 + 1);
  const VkImageSubresource subresource{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
  VkSubresourceLayout layout;
  VK_CALL(GetImageSubresourceLayout)(p.device, p.image, &subresource, &layout);
  const auto* row = numbers + (4096 + layout.offset) / 4;
  EXPECT_EQ(row[0], 0xffff00ffu);
  std::uint64_t passed = 0;
  EXPECT_EQ(VK_CALL(GetQueryPoolResults)(p.device, p.query_pool, 0, 1, sizeof passed, &passed, sizeof passed,
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
            VK_SUCCESS);
  EXPECT_GT(passed, 0u);
}

void destroy_recorded(Program& p) {
  VK_CALL(DestroyCommandPool)(p.device, p.command_pool, p.allocator);
  VK_CALL(DestroyQueryPool)(p.device, p.query_pool, p.allocator);
  for (const VkPipeline pipeline : p.pipelines) VK_CALL(DestroyPipeline)(p.device, pipeline, p.allocator);
  for (const VkShaderModule module : p.modules) VK_CALL(DestroyShaderModule)(p.device, module, p.allocator);
}

void destroy_objects(Program& p) {
  VK_CALL(DestroyFence)(p.device, p.fence, p.allocator);
  destroy_recorded(p);
  VK_CALL(DestroyFramebuffer)(p.device, p.framebuffer, p.allocator);
  VK_CALL(DestroyRenderPass)(p.device, p.render_pass, p.allocator);
  VK_CALL(DestroyPipelineLayout)(p.device, p.layout, p.allocator);
  VK_CALL(DestroyDescriptorPool)(p.device, p.descriptor_pool, p.allocator);
  VK_CALL(DestroyDescriptorSetLayout)(p.device, p.set_layout, p.allocator);
  VK_CALL(DestroyImageView)(p.device, p.view, p.allocator);
  VK_CALL(DestroyImage)(p.device, p.image, p.allocator);
  VK_CALL(DestroyBuffer)(p.device, p.buffer, p.allocator);
  VK_CALL(FreeMemory)(p.device, p.memory, p.allocator);
}

void destroy(Program& p) {
  if (!p.instance) return;
  if (p.device) {
    destroy_objects(p);
    VK_CALL(DestroyDevice)(p.device, p.allocator);
  }
  VK_CALL(DestroyInstance)(p.instance, p.allocator);
}

}  // namespace vitrine::icd::test
