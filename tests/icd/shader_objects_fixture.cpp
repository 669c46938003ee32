// See shader_objects_fixture.h.
#include "tests/icd/shader_objects_fixture.h"

#include <algorithm>
#include <cstring>
#include <utility>

#ifdef VK_EXT_shader_object
namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

namespace {

constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                             VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, VK_SHADER_STAGE_GEOMETRY_BIT,
                                             VK_SHADER_STAGE_FRAGMENT_BIT};

constexpr VkViewport kViewport{0, 0, kCanvas.width, kCanvas.height, 0, 1};
constexpr VkRect2D kScissor{{3, 2}, {60, 61}};

VkPipelineColorBlendAttachmentState blend_of(VkFormat format) {
  VkPipelineColorBlendAttachmentState out{};
  out.blendEnable = format == VK_FORMAT_R8G8B8A8_UNORM;
  out.srcColorBlendFactor = out.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  out.dstColorBlendFactor = out.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  out.colorWriteMask = 0xf;
  return out;
}

}  // namespace

void ShaderObjectDevice::make_device() {
  auto objects = make_struct<VkPhysicalDeviceShaderObjectFeaturesEXT>();
  objects.shaderObject = VK_TRUE;
  auto local = make_struct<VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR>(&objects);
  local.dynamicRenderingLocalRead = VK_TRUE;
  auto rendering = make_struct<VkPhysicalDeviceDynamicRenderingFeatures>(&local);
  rendering.dynamicRendering = VK_TRUE;
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&rendering);
  features.features.geometryShader = features.features.tessellationShader = VK_TRUE;
  features.features.vertexPipelineStoresAndAtomics = features.features.fragmentStoresAndAtomics = VK_TRUE;
  const char* const names[] = {VK_EXT_SHADER_OBJECT_EXTENSION_NAME, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
                               VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME, VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME,
                               VK_KHR_DYNAMIC_RENDERING_LOCAL_READ_EXTENSION_NAME};
  ASSERT_EQ(create_device(instance, physical_device, &device, host, &features, names), VK_SUCCESS);
}

void ShaderObjectDevice::SetUp() {
  Maintenance5Device::SetUp();
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
  auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
  shape.bindingCount = 1;
  shape.pBindings = &binding;
  ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout), VK_SUCCESS);
  auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  layout_info.setLayoutCount = layout_info.pushConstantRangeCount = 1;
  layout_info.pSetLayouts = &set_layout;
  layout_info.pPushConstantRanges = &kPushRange;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  auto pool = make_struct<VkDescriptorPoolCreateInfo>();
  pool.maxSets = pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool, nullptr, &descriptor_pool), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = descriptor_pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  storage = make_bytes(1024);
  std::memset(storage.data, 0, storage.size);
  const VkDescriptorBufferInfo bytes{storage.buffer, 0, VK_WHOLE_SIZE};
  auto write = make_struct<VkWriteDescriptorSet>();
  write.dstSet = set;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &bytes;
  VK_CALL(UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
}

void ShaderObjectDevice::TearDown() {
  for (const VkPipeline p : std::exchange(pipelines_, {})) VK_CALL(DestroyPipeline)(device, p, nullptr);
  for (const VkShaderModule m : std::exchange(modules_, {})) VK_CALL(DestroyShaderModule)(device, m, nullptr);
  const auto destroy_shader = get<PFN_vkDestroyShaderEXT>(instance, "vkDestroyShaderEXT");
  for (const VkShaderEXT s : std::exchange(shaders_, {})) destroy_shader(device, s, nullptr);
  VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
  VK_CALL(DestroyDescriptorPool)(device, descriptor_pool, nullptr);
  VK_CALL(DestroyDescriptorSetLayout)(device, set_layout, nullptr);
  Maintenance5Device::TearDown();
}

VkShaderCreateInfoEXT ShaderObjectDevice::shader_info(VkShaderStageFlagBits stage,
                                                      const std::vector<std::uint32_t>& words) {
  auto info = make_struct<VkShaderCreateInfoEXT>();
  info.stage = stage;
  info.codeType = VK_SHADER_CODE_TYPE_SPIRV_EXT;
  info.codeSize = words.size() * sizeof(std::uint32_t);
  info.pCode = words.data();
  info.pName = "main";
  info.setLayoutCount = info.pushConstantRangeCount = 1;
  info.pSetLayouts = &set_layout;
  info.pPushConstantRanges = &kPushRange;
  return info;
}

VkShaderEXT ShaderObjectDevice::make_shader(const VkShaderCreateInfoEXT& info) {
  VkShaderEXT shader = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateShadersEXT)(device, 1, &info, nullptr, &shader), VK_SUCCESS);
  shaders_.push_back(shader);
  return shader;
}

VkShaderEXT ShaderObjectDevice::make_shader(VkShaderStageFlagBits stage, const std::string& glsl) {
  const std::vector<std::uint32_t> words = compile(stage, glsl);
  return make_shader(shader_info(stage, words));
}

void ShaderObjectDevice::destroy(VkShaderEXT shader) {
  std::erase(shaders_, shader);
  VK_CALL(DestroyShaderEXT)(device, shader, nullptr);
}

std::map<VkShaderStageFlagBits, VkShaderEXT> ShaderObjectDevice::make_shaders(const Stages& stages) {
  std::map<VkShaderStageFlagBits, VkShaderEXT> out;
  for (const auto& [stage, glsl] : stages) out[stage] = make_shader(stage, glsl);
  return out;
}

std::vector<std::byte> ShaderObjectDevice::binary_of(VkShaderEXT shader) {
  const auto get_binary = VK_CALL(GetShaderBinaryDataEXT);
  std::size_t size = 0;
  EXPECT_EQ(get_binary(device, shader, &size, nullptr), VK_SUCCESS);
  std::vector<std::byte> binary(size);
  EXPECT_EQ(get_binary(device, shader, &size, binary.data()), VK_SUCCESS);
  EXPECT_EQ(size, binary.size());
  return binary;
}

void ShaderObjectDevice::bind(VkCommandBuffer commands, const std::map<VkShaderStageFlagBits, VkShaderEXT>& shaders) {
  std::vector<VkShaderEXT> handles;
  for (const VkShaderStageFlagBits stage : kStages) {
    const auto found = shaders.find(stage);
    handles.push_back(found == shaders.end() ? VK_NULL_HANDLE : found->second);
  }
  VK_CALL(CmdBindShadersEXT)(commands, std::size(kStages), kStages, handles.data());
}

void ShaderObjectDevice::set_states(VkCommandBuffer commands, const Picture2D& picture) {
  const VkSampleMask mask = ~0u;
  VK_CALL(CmdSetVertexInputEXT)(commands, 0, nullptr, 0, nullptr);
  VK_CALL(CmdSetPrimitiveTopologyEXT)(commands, picture.topology);
  VK_CALL(CmdSetPrimitiveRestartEnableEXT)(commands, VK_FALSE);
  VK_CALL(CmdSetPatchControlPointsEXT)(commands, 3);
  VK_CALL(CmdSetTessellationDomainOriginEXT)(commands, VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT);
  VK_CALL(CmdSetViewportWithCountEXT)(commands, 1, &kViewport);
  VK_CALL(CmdSetScissorWithCountEXT)(commands, 1, &kScissor);
  VK_CALL(CmdSetRasterizerDiscardEnableEXT)(commands, VK_FALSE);
  VK_CALL(CmdSetDepthClampEnableEXT)(commands, VK_FALSE);
  VK_CALL(CmdSetPolygonModeEXT)(commands, VK_POLYGON_MODE_FILL);
  VK_CALL(CmdSetCullModeEXT)(commands, VK_CULL_MODE_NONE);
  VK_CALL(CmdSetFrontFaceEXT)(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  VK_CALL(CmdSetDepthBiasEnableEXT)(commands, VK_FALSE);
  VK_CALL(CmdSetLineWidth)(commands, 1);
  VK_CALL(CmdSetRasterizationSamplesEXT)(commands, VK_SAMPLE_COUNT_1_BIT);
  VK_CALL(CmdSetSampleMaskEXT)(commands, VK_SAMPLE_COUNT_1_BIT, &mask);
  VK_CALL(CmdSetAlphaToCoverageEnableEXT)(commands, VK_FALSE);
  VK_CALL(CmdSetDepthTestEnableEXT)(commands, picture.depth);
  VK_CALL(CmdSetDepthWriteEnableEXT)(commands, picture.depth);
  VK_CALL(CmdSetDepthCompareOpEXT)(commands, VK_COMPARE_OP_LESS);
  VK_CALL(CmdSetStencilTestEnableEXT)(commands, VK_FALSE);
  for (std::uint32_t i = 0; i < picture.colors.size(); ++i) {
    const VkPipelineColorBlendAttachmentState blend = blend_of(picture.colors[i]);
    const VkColorBlendEquationEXT equation{blend.srcColorBlendFactor, blend.dstColorBlendFactor, blend.colorBlendOp,
                                           blend.srcAlphaBlendFactor, blend.dstAlphaBlendFactor, blend.alphaBlendOp};
    VK_CALL(CmdSetColorBlendEnableEXT)(commands, i, 1, &blend.blendEnable);
    VK_CALL(CmdSetColorBlendEquationEXT)(commands, i, 1, &equation);
    VK_CALL(CmdSetColorWriteMaskEXT)(commands, i, 1, &blend.colorWriteMask);
  }
  const float push[4] = {0.25f, 0.5f, 0.75f, 1.0f};
  VK_CALL(CmdPushConstants)(commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof push, push);
  const auto bind_sets = VK_CALL(CmdBindDescriptorSets);
  bind_sets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
}

VkShaderModule ShaderObjectDevice::make_module(VkShaderStageFlagBits stage, const std::string& glsl) {
  const std::vector<std::uint32_t> words = compile(stage, glsl);
  const VkShaderModuleCreateInfo info = module_info(words);
  VkShaderModule module = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
  return modules_.emplace_back(module);
}

void ShaderObjectDevice::with_pipeline_info(const Picture2D& picture, const Create& create) {
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  for (const auto& [stage, glsl] : picture.stages) {
    auto out = make_struct<VkPipelineShaderStageCreateInfo>();
    out.stage = stage;
    out.module = make_module(stage, glsl);
    out.pName = "main";
    stages.push_back(out);
  }
  const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = picture.topology;
  auto tessellation = make_struct<VkPipelineTessellationStateCreateInfo>();
  tessellation.patchControlPoints = 3;
  auto viewports = make_struct<VkPipelineViewportStateCreateInfo>();
  viewports.viewportCount = viewports.scissorCount = 1;
  viewports.pViewports = &kViewport;
  viewports.pScissors = &kScissor;
  auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
  rasterization.lineWidth = 1;
  auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
  multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  auto depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
  depth.depthTestEnable = depth.depthWriteEnable = picture.depth;
  depth.depthCompareOp = VK_COMPARE_OP_LESS;
  std::vector<VkPipelineColorBlendAttachmentState> blends;
  for (const VkFormat format : picture.colors) blends.push_back(blend_of(format));
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  blend.attachmentCount = static_cast<std::uint32_t>(blends.size());
  blend.pAttachments = blends.data();
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(picture.colors.size());
  rendering.pColorAttachmentFormats = picture.colors.data();
  if (picture.depth) rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pTessellationState = &tessellation;
  info.pViewportState = &viewports;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.layout = layout;
  create(info, stages);
}

VkPipeline ShaderObjectDevice::make_pipeline(const Picture2D& picture) {
  VkPipeline pipeline = VK_NULL_HANDLE;
  with_pipeline_info(picture, [&](const VkGraphicsPipelineCreateInfo& info, auto) {
    EXPECT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  });
  return pipelines_.emplace_back(pipeline);
}

ShaderObjectDevice::Contents ShaderObjectDevice::render(const Picture2D& picture, const Record& record,
                                                        VkRenderingFlags flags) {
  std::vector<Picture> targets;
  std::vector<VkRenderingAttachmentInfo> colors;
  const auto attach = [&](VkFormat format, VkImageAspectFlags aspect) {
    auto info = make_struct<VkRenderingAttachmentInfo>();
    if (format == VK_FORMAT_UNDEFINED) return info;
    targets.push_back(
        make_picture(VK_IMAGE_TYPE_2D, format, {kCanvas.width, kCanvas.height, 1}, 1, VK_SAMPLE_COUNT_1_BIT, aspect));
    info.imageView = targets.back().view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (aspect == VK_IMAGE_ASPECT_DEPTH_BIT)
      info.clearValue.depthStencil = {0.5f, 0};
    else
      info.clearValue.color = {{0.1f, 0.2f, 0.3f, 0.4f}};
    return info;
  };
  for (const VkFormat format : picture.colors) colors.push_back(attach(format, VK_IMAGE_ASPECT_COLOR_BIT));
  const VkRenderingAttachmentInfo depth =
      attach(picture.depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED, VK_IMAGE_ASPECT_DEPTH_BIT);
  run([&](VkCommandBuffer commands) {
    auto info = make_struct<VkRenderingInfo>();
    info.flags = flags;
    info.renderArea = {{0, 0}, kCanvas};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = picture.depth ? &depth : nullptr;
    VK_CALL(CmdBeginRenderingKHR)(commands, &info);
    record(commands);
    VK_CALL(CmdEndRenderingKHR)(commands);
  });
  Contents out;
  for (const Picture& target : targets) out.emplace_back(target.data, target.data + target.size);
  return out;
}

ShaderObjectDevice::Contents ShaderObjectDevice::by_pipeline(const Picture2D& picture) {
  return by_pipeline(picture, make_pipeline(picture));
}

ShaderObjectDevice::Contents ShaderObjectDevice::by_pipeline(const Picture2D& picture, VkPipeline pipeline) {
  return render(picture, [&](VkCommandBuffer commands) {
    set_states(commands, picture);
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    VK_CALL(CmdDraw)(commands, picture.vertices, 2, 0, 0);
  });
}

ShaderObjectDevice::Contents ShaderObjectDevice::by_objects(const Picture2D& picture) {
  const auto shaders = make_shaders(picture.stages);
  return render(picture, [&](VkCommandBuffer commands) {
    set_states(commands, picture);
    bind(commands, shaders);
    VK_CALL(CmdDraw)(commands, picture.vertices, 2, 0, 0);
  });
}

void ShaderObjectDevice::expect_same(const Picture2D& picture) {
  const Contents blank = render(picture, [](VkCommandBuffer) {});
  const Contents pipeline = by_pipeline(picture), objects = by_objects(picture);
  EXPECT_NE(pipeline, blank);
  EXPECT_EQ(pipeline, objects);
}

}  // namespace vitrine::icd::test
#endif
