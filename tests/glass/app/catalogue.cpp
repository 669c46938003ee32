// An application, linked to the loader, that runs the modules of the catalogues of faults and races
// (tests/glass/kept_catalogue.h), one a submission, in the order of their names: the first is submission 1.
//
//   vitrine_test_catalogue FOLDER TOOL    those of this tool
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "tests/glass/app/catalogue_scene.h"

namespace catalogue {
namespace {

namespace fs = std::filesystem;

struct Case {
  fs::path module;
  VkShaderStageFlagBits stage{};
  std::uint32_t groups = 1;
};

std::vector<Case> read_cases(const fs::path& folder, const std::string& tool) {
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".case") continue;
    std::ifstream file(entry.path());
    std::uint32_t stage = 0;
    std::string of;
    Case one;
    file >> stage >> one.groups >> of;
    one.stage = static_cast<VkShaderStageFlagBits>(stage);
    one.module = fs::path(entry.path()).replace_extension(".spv");
    if (of == tool) cases.push_back(one);
  }
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.module < b.module; });
  return cases;
}

VkShaderModule read_module(const Device& d, const fs::path& name) {
  std::ifstream file(name, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::copy_n(bytes.data(), words.size() * 4, reinterpret_cast<char*>(words.data()));
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = words.size() * 4;
  info.pCode = words.data();
  VkShaderModule module;
  must(vkCreateShaderModule(d.device, &info, nullptr, &module), "vkCreateShaderModule");
  return module;
}

/// The stages of the case's pipeline: its own, and plain ones around it.
std::vector<VkPipelineShaderStageCreateInfo> stages_of(const Device& d, const Case& one) {
  std::vector<VkShaderStageFlagBits> wanted{one.stage};
  if (one.stage != VK_SHADER_STAGE_COMPUTE_BIT) wanted = {VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_FRAGMENT_BIT};
  if (one.stage == VK_SHADER_STAGE_GEOMETRY_BIT) wanted.push_back(one.stage);
  if (one.stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT || one.stage == VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT)
    wanted.insert(wanted.end(),
                  {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT});
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  for (const VkShaderStageFlagBits stage : wanted) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = read_module(
        d, stage == one.stage ? one.module : one.module.parent_path() / ("plain" + std::to_string(stage) + ".spv"));
    info.pName = "main";
    stages.push_back(info);
  }
  return stages;
}

VkPipeline make_compute(const Device& d, const VkPipelineShaderStageCreateInfo& stage, VkPipelineLayout layout) {
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stage;
  info.layout = layout;
  VkPipeline pipeline;
  must(vkCreateComputePipelines(d.device, {}, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
  return pipeline;
}

VkPipeline make_graphics(const Device& d, const std::vector<VkPipelineShaderStageCreateInfo>& stages,
                         VkShaderStageFlagBits fault, VkPipelineLayout layout) {
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = stages.size() == 4                      ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST
                      : fault == VK_SHADER_STAGE_FRAGMENT_BIT ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
                                                              : VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  VkPipelineTessellationStateCreateInfo patches{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  patches.patchControlPoints = 1;
  const VkViewport viewport{0, 0, kPixels, 1, 0, 1};
  const VkRect2D scissor{{0, 0}, {kPixels, 1}};
  VkPipelineViewportStateCreateInfo viewports{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewports.viewportCount = viewports.scissorCount = 1;
  viewports.pViewports = &viewport;
  viewports.pScissors = &scissor;
  VkPipelineRasterizationStateCreateInfo rasterization{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  rasterization.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState plain{};
  plain.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 1;
  blend.pAttachments = &plain;
  const VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &format;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.pNext = &rendering;
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pTessellationState = &patches;
  info.pViewportState = &viewports;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.layout = layout;
  VkPipeline pipeline;
  must(vkCreateGraphicsPipelines(d.device, {}, 1, &info, nullptr, &pipeline), "vkCreateGraphicsPipelines");
  return pipeline;
}

void draw(VkCommandBuffer commands, const Scene& scene, std::uint32_t vertices) {
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  color.imageView = scene.target();
  color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {kPixels, 1}};
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &color;
  vkCmdBeginRendering(commands, &info);
  vkCmdDraw(commands, vertices, 1, 0, 0);
  vkCmdEndRendering(commands);
}

void run(const Device& d, const Case& one, VkCommandBuffer commands) {
  const Scene scene(d);
  const auto stages = stages_of(d, one);
  const bool computes = one.stage == VK_SHADER_STAGE_COMPUTE_BIT;
  const VkPipeline pipeline =
      computes ? make_compute(d, stages[0], scene.layout) : make_graphics(d, stages, one.stage, scene.layout);
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  scene.fill(commands);
  const VkPipelineBindPoint point = computes ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
  scene.bind(commands, point);
  vkCmdBindPipeline(commands, point, pipeline);
  if (computes)
    vkCmdDispatch(commands, one.groups, 1, 1);
  else
    draw(commands, scene, stages.size() == 4 ? 1 : one.stage == VK_SHADER_STAGE_FRAGMENT_BIT ? 3 : 8);
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(d.queue, 1, &submit, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(d.queue), "vkQueueWaitIdle");
  vkDestroyPipeline(d.device, pipeline, nullptr);
  for (const auto& stage : stages) vkDestroyShaderModule(d.device, stage.module, nullptr);
}

}  // namespace

Device make_device() {
  Device d;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instance{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance.pApplicationInfo = &application;
  must(vkCreateInstance(&instance, nullptr, &d.instance), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(d.instance, &count, &d.physical) < 0 || count == 0) std::exit(3);
  VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT interlock{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT};
  VkPhysicalDeviceVulkan13Features core13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &interlock};
  VkPhysicalDeviceVulkan12Features core12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &core13};
  VkPhysicalDeviceVulkan11Features core11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &core12};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &core11, {}};
  vkGetPhysicalDeviceFeatures2(d.physical, &features);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const char* const extension = VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME;
  VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device.pNext = &features;
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  device.enabledExtensionCount = 1;
  device.ppEnabledExtensionNames = &extension;
  must(vkCreateDevice(d.physical, &device, nullptr, &d.device), "vkCreateDevice");
  vkGetDeviceQueue(d.device, 0, 0, &d.queue);
  return d;
}

namespace {

void run_all(const fs::path& folder, const std::string& tool) {
  const Device d = make_device();
  VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  VkCommandPool pool;
  must(vkCreateCommandPool(d.device, &info, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands;
  must(vkAllocateCommandBuffers(d.device, &allocation, &commands), "vkAllocateCommandBuffers");
  std::uint64_t submission = 0;
  for (const Case& one : read_cases(folder, tool)) {
    std::printf("%llu %s\n", static_cast<unsigned long long>(++submission), one.module.stem().c_str());
    run(d, one, commands);
  }
  vkDestroyCommandPool(d.device, pool, nullptr);
  vkDestroyDevice(d.device, nullptr);
  vkDestroyInstance(d.instance, nullptr);
}

}  // namespace
}  // namespace catalogue

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  catalogue::run_all(argv[1], argv[2]);
}
