// A small application, linked to the loader, for the tests of printf: runs one pipeline whose shaders want no
// resources, and writes what the validation layer or the driver says of it to where those were told to.
//
//   vitrine_test_speaker [--many] FILE.spv...    FILE ends with .comp.spv, .vert.spv, .tesc.spv, .tese.spv, .geom.spv,
//   .frag.spv:
//                                       one workgroup, or one triangle or patch of three vertices on 4 x 4 pixels;
//                                       --many: 40 workgroups, or 40 instances on 160 x 160 pixels
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

/// What ends the objects that were made, the last of them first: some versions of the validation layer die of objects
/// that are alive when the process ends.
std::vector<std::function<void()>> ends;

constexpr std::pair<const char*, VkShaderStageFlagBits> kStages[] = {
    {".comp.spv", VK_SHADER_STAGE_COMPUTE_BIT},
    {".vert.spv", VK_SHADER_STAGE_VERTEX_BIT},
    {".tesc.spv", VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT},
    {".tese.spv", VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT},
    {".geom.spv", VK_SHADER_STAGE_GEOMETRY_BIT},
    {".frag.spv", VK_SHADER_STAGE_FRAGMENT_BIT},
};
/// With --many, 40.
std::uint32_t times = 1;
VkExtent2D pixels() { return {4 * times, 4 * times}; }

struct Device {
  VkInstance instance{};
  VkPhysicalDevice physical{};
  VkDevice device{};
  VkQueue queue{};
};

Device make_device() {
  Device d;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo instance{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance.pApplicationInfo = &application;
  must(vkCreateInstance(&instance, nullptr, &d.instance), "vkCreateInstance");
  ends.push_back([d] { vkDestroyInstance(d.instance, nullptr); });
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(d.instance, &count, &d.physical) < 0 || count == 0) std::exit(3);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkPhysicalDeviceFeatures features;
  vkGetPhysicalDeviceFeatures(d.physical, &features);
  const char* const extension = VK_KHR_SHADER_NON_SEMANTIC_INFO_EXTENSION_NAME;
  VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  device.pEnabledFeatures = &features;
  device.enabledExtensionCount = 1;
  device.ppEnabledExtensionNames = &extension;
  must(vkCreateDevice(d.physical, &device, nullptr, &d.device), "vkCreateDevice");
  ends.push_back([d] { vkDestroyDevice(d.device, nullptr); });
  vkGetDeviceQueue(d.device, 0, 0, &d.queue);
  return d;
}

VkPipelineShaderStageCreateInfo stage_of(VkDevice device, const std::string& name) {
  VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  for (const auto& [ending, which] : kStages)
    if (name.ends_with(ending)) stage.stage = which;
  std::ifstream file(name, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::copy_n(bytes.data(), words.size() * 4, reinterpret_cast<char*>(words.data()));
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = words.size() * 4;
  info.pCode = words.data();
  must(vkCreateShaderModule(device, &info, nullptr, &stage.module), "vkCreateShaderModule");
  ends.push_back([=] { vkDestroyShaderModule(device, stage.module, nullptr); });
  stage.pName = "main";
  return stage;
}

/// A pass without attachments.
VkRenderPass make_pass(VkDevice device) {
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass;
  must(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
  ends.push_back([=] { vkDestroyRenderPass(device, pass, nullptr); });
  return pass;
}

using Stages = std::vector<VkPipelineShaderStageCreateInfo>;

bool has(const Stages& stages, VkShaderStageFlagBits which) {
  for (const auto& stage : stages)
    if (stage.stage == which) return true;
  return false;
}

VkPipeline make_graphics(VkDevice device, const Stages& stages, VkPipelineLayout layout, VkRenderPass pass) {
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = has(stages, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT) ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST
                                                                            : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  tessellation.patchControlPoints = 3;
  const VkViewport viewport{0, 0, static_cast<float>(pixels().width), static_cast<float>(pixels().height), 0, 1};
  const VkRect2D scissor{{0, 0}, pixels()};
  VkPipelineViewportStateCreateInfo viewports{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewports.viewportCount = viewports.scissorCount = 1;
  viewports.pViewports = &viewport;
  viewports.pScissors = &scissor;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pTessellationState = &tessellation;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.layout = layout;
  info.renderPass = pass;
  VkPipeline pipeline;
  must(vkCreateGraphicsPipelines(device, {}, 1, &info, nullptr, &pipeline), "vkCreateGraphicsPipelines");
  ends.push_back([=] { vkDestroyPipeline(device, pipeline, nullptr); });
  return pipeline;
}

VkPipeline make_compute(VkDevice device, const Stages& stages, VkPipelineLayout layout) {
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stages[0];
  info.layout = layout;
  VkPipeline pipeline;
  must(vkCreateComputePipelines(device, {}, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
  ends.push_back([=] { vkDestroyPipeline(device, pipeline, nullptr); });
  return pipeline;
}

void draw(VkDevice device, VkCommandBuffer commands, VkRenderPass pass, VkPipeline pipeline) {
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = pass;
  info.width = pixels().width;
  info.height = pixels().height;
  info.layers = 1;
  VkFramebuffer framebuffer;
  must(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  ends.push_back([=] { vkDestroyFramebuffer(device, framebuffer, nullptr); });
  VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin.renderPass = pass;
  begin.framebuffer = framebuffer;
  begin.renderArea = {{0, 0}, pixels()};
  vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdDraw(commands, 3, times, 0, 0);
  vkCmdEndRenderPass(commands);
}

void record(VkDevice device, const Stages& stages, VkCommandBuffer commands) {
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  VkPipelineLayout layout;
  must(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
  ends.push_back([=] { vkDestroyPipelineLayout(device, layout, nullptr); });
  if (has(stages, VK_SHADER_STAGE_COMPUTE_BIT)) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, make_compute(device, stages, layout));
    vkCmdDispatch(commands, times, 1, 1);
  } else {
    const VkRenderPass pass = make_pass(device);
    draw(device, commands, pass, make_graphics(device, stages, layout, pass));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Device d = make_device();
  Stages stages;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--many")
      times = 40;
    else
      stages.push_back(stage_of(d.device, argv[i]));
  }
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  must(vkCreateCommandPool(d.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  ends.push_back([=] { vkDestroyCommandPool(d.device, pool, nullptr); });
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands;
  must(vkAllocateCommandBuffers(d.device, &allocation, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(d.device, stages, commands);
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(d.queue, 1, &submit, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(d.queue), "vkQueueWaitIdle");
  while (!ends.empty()) {
    ends.back()();
    ends.pop_back();
  }
  return 0;
}
