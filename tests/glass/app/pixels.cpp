// A small application for the tests of `vitrine pixel`: fragments of all fates in two passes, then a copy, blits, a
// resolve, a second pass that samples what came out, a compute shader that stores. At the end it prints all texels of
// all images of four bytes a texel: "NAME LEVEL X Y HEX".
//
//   vitrine_test_pixels [FILE]    FILE: grows by a byte with each run; every other one draws something else
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/glass/app/pixels_comp.h"
#include "tests/glass/app/pixels_frag.h"
#include "tests/glass/app/pixels_geom.h"
#include "tests/glass/app/pixels_tesc.h"
#include "tests/glass/app/pixels_tese.h"
#include "tests/glass/app/pixels_vert.h"

namespace {

constexpr std::uint32_t kSize = 16;
constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;
enum Mode { kPlain, kDiscard, kNoSamples, kSecondPass, kCorner };

void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

struct Push {
  float color[4];
  float depth;
  int mode;
};

struct Image {
  std::string name;
  VkImage image{};
  VkDeviceMemory memory{};
  VkImageView view{}, level1{};
  std::uint32_t levels = 1;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

struct Buffer {
  VkBuffer buffer{};
  VkDeviceMemory memory{};
  unsigned char* data = nullptr;
};

float blue = 1;  ///< of the last fragments on the target

VkInstance instance;
VkPhysicalDevice physical;
VkDevice device;
VkQueue queue;
VkCommandBuffer commands;
VkPipelineLayout layout;
VkDescriptorSetLayout set_layout;
VkDescriptorSet set;

/// How often this has been called with the file.
long count_run(const char* name) {
  std::FILE* file = std::fopen(name, "ab");
  if (!file) std::exit(3);
  std::fputc('x', file);
  const long size = std::ftell(file);
  std::fclose(file);
  return size;
}

template <class F>
F get(const char* name) {
  return reinterpret_cast<F>(vkGetDeviceProcAddr(device, name));
}

void make_device() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  must(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0) std::exit(3);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  features.dynamicRendering = VK_TRUE;
  VkPhysicalDeviceFeatures core{};
  core.depthBounds = core.tessellationShader = core.geometryShader = VK_TRUE;
  VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  device_info.pEnabledFeatures = &core;
  must(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, 0, 0, &queue);
}

VkDeviceMemory allocate(const VkMemoryRequirements& needs) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  VkDeviceMemory memory;
  must(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
  return memory;
}

VkImageView make_view(VkImage image, VkFormat format, std::uint32_t level, std::uint32_t levels) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = format;
  const VkImageAspectFlags aspects =
      format == kDepth ? VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  info.subresourceRange = {aspects, level, levels, 0, 1};
  VkImageView view;
  must(vkCreateImageView(device, &info, nullptr, &view), "vkCreateImageView");
  return view;
}

Image make_image(const char* name, VkFormat format, VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT,
                 std::uint32_t levels = 1) {
  Image out;
  out.name = name;
  out.levels = levels;
  out.samples = samples;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {kSize, kSize, 1};
  info.mipLevels = levels;
  info.arrayLayers = 1;
  info.samples = samples;
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  info.usage |= format == kDepth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (samples == VK_SAMPLE_COUNT_1_BIT && format == kColor) info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  must(vkCreateImage(device, &info, nullptr, &out.image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, out.image, &needs);
  out.memory = allocate(needs);
  must(vkBindImageMemory(device, out.image, out.memory, 0), "vkBindImageMemory");
  VkDebugUtilsObjectNameInfoEXT named{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  named.objectType = VK_OBJECT_TYPE_IMAGE;
  named.objectHandle = reinterpret_cast<std::uint64_t>(out.image);
  named.pObjectName = name;
  get<PFN_vkSetDebugUtilsObjectNameEXT>("vkSetDebugUtilsObjectNameEXT")(device, &named);
  out.view = make_view(out.image, format, 0, levels);
  return out;
}

Buffer make_buffer(VkDeviceSize size) {
  Buffer b;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  must(vkCreateBuffer(device, &info, nullptr, &b.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, b.buffer, &needs);
  b.memory = allocate(needs);
  must(vkBindBufferMemory(device, b.buffer, b.memory, 0), "vkBindBufferMemory");
  void* data = nullptr;
  must(vkMapMemory(device, b.memory, 0, VK_WHOLE_SIZE, 0, &data), "vkMapMemory");
  b.data = static_cast<unsigned char*>(data);
  return b;
}

VkShaderModule make_module(const std::uint32_t* words, std::size_t bytes) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = bytes;
  info.pCode = words;
  VkShaderModule module;
  must(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
  return module;
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

void make_layout() {
  VkDescriptorSetLayoutBinding bindings[4] = {};
  for (std::uint32_t i = 0; i < 4; ++i) {
    bindings[i].binding = i;
    bindings[i].descriptorType = i < 2 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
  }
  VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set_info.bindingCount = 4;
  set_info.pBindings = bindings;
  must(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout), "vkCreateDescriptorSetLayout");
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &set_layout;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  must(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
}

/// What pipelines differ in.
struct Look {
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool depth = false, blend = false, alpha_to_coverage = false;
  VkColorComponentFlags mask = 15;
  std::uint32_t sample_mask = ~0u;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  bool tessellates = false, emits = false;  ///< stages behind the vertex shader
  bool shades = true;                       ///< there is a fragment shader
};

std::vector<VkPipelineShaderStageCreateInfo> stages_of(const Look& look) {
  std::vector<VkPipelineShaderStageCreateInfo> stages{
      stage(VK_SHADER_STAGE_VERTEX_BIT, make_module(pixels_vert, sizeof pixels_vert))};
  const auto add = [&](VkShaderStageFlagBits which, const std::uint32_t* words, std::size_t bytes) {
    stages.push_back(stage(which, make_module(words, bytes)));
  };
  if (look.tessellates) {
    add(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, pixels_tesc, sizeof pixels_tesc);
    add(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, pixels_tese, sizeof pixels_tese);
  }
  if (look.emits) add(VK_SHADER_STAGE_GEOMETRY_BIT, pixels_geom, sizeof pixels_geom);
  if (look.shades) add(VK_SHADER_STAGE_FRAGMENT_BIT, pixels_frag, sizeof pixels_frag);
  return stages;
}

VkPipeline make_pipeline(const char* name, const Look& look) {
  const std::vector<VkPipelineShaderStageCreateInfo> stages = stages_of(look);
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = look.tessellates ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
  tessellation.patchControlPoints = 3;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  const VkViewport whole{0, 0, kSize, kSize, 0, 1};
  viewport.viewportCount = viewport.scissorCount = 1;
  viewport.pViewports = &whole;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  raster.cullMode = look.cull;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = look.samples;
  multisample.pSampleMask = &look.sample_mask;
  multisample.alphaToCoverageEnable = look.alpha_to_coverage;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = look.depth;
  depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  depth.minDepthBounds = 0, depth.maxDepthBounds = 0.1f;
  depth.front.compareOp = VK_COMPARE_OP_NEVER;
  depth.back = depth.front;
  VkPipelineColorBlendAttachmentState attachment{};
  attachment.blendEnable = look.blend;
  attachment.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  attachment.colorWriteMask = look.mask;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE,
                                   VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 3;
  dynamic.pDynamicStates = states;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &kColor;
  if (look.depth) rendering.depthAttachmentFormat = rendering.stencilAttachmentFormat = kDepth;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pTessellationState = &tessellation;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline pipeline;
  must(vkCreateGraphicsPipelines(device, {}, 1, &info, nullptr, &pipeline), "vkCreateGraphicsPipelines");
  VkDebugUtilsObjectNameInfoEXT named{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  named.objectType = VK_OBJECT_TYPE_PIPELINE;
  named.objectHandle = reinterpret_cast<std::uint64_t>(pipeline);
  named.pObjectName = name;
  get<PFN_vkSetDebugUtilsObjectNameEXT>("vkSetDebugUtilsObjectNameEXT")(device, &named);
  return pipeline;
}

VkPipeline make_compute() {
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, make_module(pixels_comp, sizeof pixels_comp));
  info.layout = layout;
  VkPipeline pipeline;
  must(vkCreateComputePipelines(device, {}, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
  return pipeline;
}

void make_set(const Image& mips, const Image& resolved, const Image& last, const Image& stored) {
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2}};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = 2;
  pool_info.pPoolSizes = sizes;
  VkDescriptorPool pool;
  must(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocation.descriptorPool = pool;
  allocation.descriptorSetCount = 1;
  allocation.pSetLayouts = &set_layout;
  must(vkAllocateDescriptorSets(device, &allocation, &set), "vkAllocateDescriptorSets");
  VkSamplerCreateInfo sampler_info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler_info.magFilter = sampler_info.minFilter = VK_FILTER_LINEAR;
  sampler_info.maxLod = VK_LOD_CLAMP_NONE;
  sampler_info.addressModeU = sampler_info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSampler sampler;
  must(vkCreateSampler(device, &sampler_info, nullptr, &sampler), "vkCreateSampler");
  const VkImageView views[] = {mips.view, resolved.view, last.view, stored.view};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const VkDescriptorImageInfo image{sampler, views[i], VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = i;
    write.descriptorCount = 1;
    write.descriptorType = i < 2 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }
}

void wait() {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier,
                       0, nullptr, 0, nullptr);
}

void to_general(const Image& image, VkImageAspectFlags aspects) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.image = image.image;
  barrier.subresourceRange = {aspects, 0, image.levels, 0, 1};
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr,
                       0, nullptr, 1, &barrier);
}

void label(const char* name) {
  VkDebugUtilsLabelEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
  info.pLabelName = name;
  get<PFN_vkCmdBeginDebugUtilsLabelEXT>("vkCmdBeginDebugUtilsLabelEXT")(commands, &info);
}
void end_label() { get<PFN_vkCmdEndDebugUtilsLabelEXT>("vkCmdEndDebugUtilsLabelEXT")(commands); }

void begin(const Image& color, const Image* depth, const Image* resolve) {
  VkRenderingAttachmentInfo target{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  target.imageView = color.view;
  target.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  target.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  target.clearValue.color.float32[3] = 1;
  if (resolve) {
    target.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    target.resolveImageView = resolve->view;
    target.resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
  }
  VkRenderingAttachmentInfo plane{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (depth) plane.imageView = depth->view;
  plane.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  plane.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  plane.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  plane.clearValue.depthStencil = {0.5f, 0};
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {kSize, kSize};
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &target;
  if (depth) info.pDepthAttachment = info.pStencilAttachment = &plane;
  vkCmdBeginRendering(commands, &info);
}

void draw(VkPipeline pipeline, const Push& push, std::uint32_t instances = 1, std::uint32_t first_instance = 0) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                     &push);
  vkCmdDraw(commands, 3, instances, 0, first_instance);
}

void scissor(std::int32_t x) {
  const VkRect2D area{{x, 0}, {kSize, kSize}};
  vkCmdSetScissor(commands, 0, 1, &area);
}

/// One of each fate, on all pixels but those of the last columns, which the scissor leaves.
void draw_single_sampled(const Image& target, const Image& depth) {
  Look look;
  look.depth = true;
  const VkPipeline plain = make_pipeline("plain", look);
  look.blend = true;
  const VkPipeline blended = make_pipeline("blended", look);
  look.mask = 0;
  const VkPipeline masked = make_pipeline("masked", look);
  look.shades = false;
  const VkPipeline depth_alone = make_pipeline("depth alone", look);
  label("scene");
  label("fates");
  begin(target, &depth, nullptr);
  scissor(0);
  vkCmdSetStencilTestEnable(commands, VK_FALSE);
  vkCmdSetDepthBoundsTestEnable(commands, VK_FALSE);
  draw(plain, {{1, 0, 0, 1}, 0.25f, kPlain});
  scissor(12);
  draw(plain, {{0, 1, 0, 1}, 0.25f, kPlain});
  scissor(0);
  draw(plain, {{0, 1, 0, 1}, 0.75f, kPlain});
  vkCmdSetStencilTestEnable(commands, VK_TRUE);
  draw(plain, {{0, 1, 0, 1}, 0.25f, kPlain});
  vkCmdSetStencilTestEnable(commands, VK_FALSE);
  vkCmdSetDepthBoundsTestEnable(commands, VK_TRUE);
  draw(plain, {{0, 1, 0, 1}, 0.25f, kPlain});
  vkCmdSetDepthBoundsTestEnable(commands, VK_FALSE);
  draw(plain, {{0, 1, 0, 1}, 0.25f, kDiscard});
  draw(plain, {{0, 1, 0, 1}, 0.25f, kNoSamples});
  draw(masked, {{0, 1, 0, 1}, 0.25f, kPlain});
  draw(blended, {{0, 0, blue, 0.5f}, 0.25f, kPlain});
  draw(depth_alone, {{}, 0.25f, kPlain});
  const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{0.25f, 0.5f, 0.75f, 1}}}};
  const VkClearRect rect{{{0, 0}, {2, 2}}, 0, 1};
  vkCmdClearAttachments(commands, 1, &clear, 1, &rect);
  vkCmdEndRendering(commands);
  end_label();
}

void draw_multisampled(const Image& samples, const Image& resolved) {
  Look look;
  look.samples = VK_SAMPLE_COUNT_4_BIT;
  const VkPipeline plain = make_pipeline("samples", look);
  look.sample_mask = 0xe;
  const VkPipeline few = make_pipeline("few samples", look);
  look.sample_mask = ~0u;
  look.alpha_to_coverage = true;
  const VkPipeline by_alpha = make_pipeline("by alpha", look);
  label("samples");
  begin(samples, nullptr, &resolved);
  scissor(0);
  vkCmdSetStencilTestEnable(commands, VK_FALSE);
  vkCmdSetDepthBoundsTestEnable(commands, VK_FALSE);
  draw(plain, {{0, 1, 0, 1}, 0.25f, kPlain});
  draw(few, {{1, 1, 0, 1}, 0.25f, kPlain}, 2, 5);
  draw(by_alpha, {{1, 1, 1, 0}, 0.25f, kPlain});
  vkCmdEndRendering(commands);
  end_label();
}

/// Primitives that do not reach pixel (5, 5): a viewport that does not cover it, and one that is culled.
void draw_elsewhere(const Image& image) {
  Look look;
  const VkPipeline plain = make_pipeline("elsewhere", look);
  look.cull = VK_CULL_MODE_BACK_BIT;
  const VkPipeline culled = make_pipeline("culled", look);
  begin(image, nullptr, nullptr);
  scissor(0);
  vkCmdSetStencilTestEnable(commands, VK_FALSE);
  vkCmdSetDepthBoundsTestEnable(commands, VK_FALSE);
  draw(culled, {{0, 1, 0, 1}, 0.25f, kPlain});
  draw(plain, {{0, 1, 0, 1}, 0.25f, kCorner});
  vkCmdEndRendering(commands);
}

/// Instances 4 to 6, behind a tessellation or a geometry shader.
void draw_stages(const Image& tessellated, const Image& emitted) {
  for (const Image* image : {&tessellated, &emitted}) {
    Look look;
    look.tessellates = image == &tessellated;
    look.emits = image == &emitted;
    begin(*image, nullptr, nullptr);
    draw(make_pipeline(image->name.c_str(), look), {{0, 1, 0, 1}, 0.25f, kPlain}, 3, 4);
    vkCmdEndRendering(commands);
  }
}

void blit(const Image& from, std::uint32_t from_level, const Image& to, std::uint32_t to_level) {
  VkImageBlit region{};
  region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, from_level, 0, 1};
  region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, to_level, 0, 1};
  region.srcOffsets[1] = {static_cast<std::int32_t>(kSize >> from_level),
                          static_cast<std::int32_t>(kSize >> from_level), 1};
  region.dstOffsets[1] = {static_cast<std::int32_t>(kSize >> to_level), static_cast<std::int32_t>(kSize >> to_level),
                          1};
  vkCmdBlitImage(commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region,
                 VK_FILTER_LINEAR);
  wait();
}

void read_back(const Image& image, std::uint32_t level, const Buffer& buffer, VkDeviceSize offset) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
  region.imageExtent = {kSize >> level, kSize >> level, 1};
  vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, buffer.buffer, 1, &region);
}

/// The middle of an image goes to another one by two places of a buffer.
void stage(const Image& from, const Image& to, const Buffer& buffer) {
  constexpr VkDeviceSize kFirst = 12 * kSize * kSize * 4, kSecond = 14 * kSize * kSize * 4;
  read_back(from, 0, buffer, kFirst);
  wait();
  const VkBufferCopy bytes{kFirst, kSecond, kSize * kSize * 4};
  vkCmdCopyBuffer(commands, buffer.buffer, buffer.buffer, 1, &bytes);
  wait();
  VkBufferImageCopy region{};
  region.bufferOffset = kSecond + (4 * kSize + 4) * 4;
  region.bufferRowLength = kSize;
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageOffset = {4, 4, 0};
  region.imageExtent = {8, 8, 1};
  vkCmdCopyBufferToImage(commands, buffer.buffer, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  wait();
}

void print(const Image& image, std::uint32_t level, const unsigned char* data) {
  for (std::uint32_t y = 0; y < kSize >> level; ++y)
    for (std::uint32_t x = 0; x < kSize >> level; ++x, data += 4)
      std::printf("%s %u %u %u 0x%02x%02x%02x%02x\n", image.name.c_str(), level, x, y, data[3], data[2], data[1],
                  data[0]);
}

void make_commands() {
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  must(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  must(vkAllocateCommandBuffers(device, &allocation, &commands), "vkAllocateCommandBuffers");
}

void record(const std::vector<Image*>& colors, const std::vector<Image*>& staged, const Image& depth,
            const Buffer& upload, const Buffer& result) {
  Image &target = *colors[0], &samples = *colors[1], &resolved = *colors[2], &copy = *colors[3], &mips = *colors[4],
        &last = *colors[5], &stored = *colors[6], &culled = *colors[7];
  for (const Image* image : colors) to_general(*image, VK_IMAGE_ASPECT_COLOR_BIT);
  for (const Image* image : staged) to_general(*image, VK_IMAGE_ASPECT_COLOR_BIT);
  to_general(depth, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT);
  VkBufferImageCopy uploaded{};
  uploaded.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  uploaded.imageExtent = {kSize, kSize, 1};
  vkCmdCopyBufferToImage(commands, upload.buffer, stored.image, VK_IMAGE_LAYOUT_GENERAL, 1, &uploaded);
  wait();
  draw_single_sampled(target, depth);
  wait();
  draw_multisampled(samples, resolved);
  draw_elsewhere(culled);
  draw_stages(*staged[0], *staged[1]);
  wait();
  VkImageCopy region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.extent = {kSize, kSize, 1};
  vkCmdCopyImage(commands, target.image, VK_IMAGE_LAYOUT_GENERAL, copy.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  wait();
  blit(copy, 0, mips, 0);
  blit(mips, 0, mips, 1);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
  label("second pass");
  begin(last, nullptr, nullptr);
  scissor(0);
  draw(make_pipeline("sampling", {}), {{}, 0.25f, kSecondPass});
  vkCmdEndRendering(commands);
  end_label();
  wait();
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, make_compute());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
  vkCmdDispatch(commands, kSize / 4, kSize / 4, 1);
  wait();
  stage(last, *colors[8], result);
  VkDeviceSize offset = 0;
  for (const Image* image : colors)
    for (std::uint32_t level = 0; level < image->levels; ++level, offset += kSize * kSize * 4)
      if (image->samples == VK_SAMPLE_COUNT_1_BIT) read_back(*image, level, result, offset);
  end_label();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) blue = count_run(argv[1]) % 2 == 0 ? 0.5f : 1.0f;
  make_device();
  make_layout();
  make_commands();
  Image target = make_image("target", kColor), samples = make_image("samples", kColor, VK_SAMPLE_COUNT_4_BIT),
        resolved = make_image("resolved", kColor), copy = make_image("copy", kColor),
        mips = make_image("mips", kColor, VK_SAMPLE_COUNT_1_BIT, 2), last = make_image("last", kColor),
        stored = make_image("stored", kColor), culled = make_image("culled", kColor),
        depth = make_image("depth", kDepth), staged = make_image("staged", kColor),
        tessellated = make_image("tessellated", kColor), emitted = make_image("emitted", kColor);
  make_set(mips, resolved, last, stored);
  const std::vector<Image*> colors{&target, &samples, &resolved, &copy, &mips, &last, &stored, &culled, &staged};
  const Buffer upload = make_buffer(kSize * kSize * 4), result = make_buffer(16 * kSize * kSize * 4);
  std::memset(upload.data, 0x42, kSize * kSize * 4);
  VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin_info), "vkBeginCommandBuffer");
  record(colors, {&tessellated, &emitted}, depth, upload, result);
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(queue, 1, &submit, {}), "vkQueueSubmit");
  must(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
  const unsigned char* data = result.data;
  for (const Image* image : colors)
    for (std::uint32_t level = 0; level < image->levels; ++level, data += kSize * kSize * 4)
      if (image->samples == VK_SAMPLE_COUNT_1_BIT) print(*image, level, data);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
  return 0;
}
