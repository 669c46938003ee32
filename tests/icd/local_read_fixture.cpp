// See local_read_fixture.h.
#include "tests/icd/local_read_fixture.h"

#include <algorithm>
#include <array>
#include <set>

#ifdef VK_KHR_dynamic_rendering_local_read
namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

namespace {

constexpr VkPipelineStageFlags kTests =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags kWriting = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | kTests;
constexpr VkPipelineStageFlags kReading = kWriting | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
constexpr VkAccessFlags kWrites = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags kReads = kWrites | VK_ACCESS_INPUT_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                 VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;

constexpr char kVertex[] =
    "layout(location = 0) out vec2 uv;\n"
    "void main() {\n"
    "  uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);\n"
    "  gl_Position = vec4(uv * 4 - 1 - 0.3 * gl_InstanceIndex, 0.4 + 0.3 * uv.x, 1);\n"
    "  LAYER\n"
    "}\n";

VkClearValue clear_of(std::size_t attachment) {
  VkClearValue value{};
  value.color = {{0.1f * static_cast<float>(attachment + 1), 0.25f, 0.5f, 0.75f}};
  return value;
}
constexpr VkClearDepthStencilValue kDepthClear{0.5f, 3};

VkImageAspectFlags aspects_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT
                                        : VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
}

/// The words without the InputAttachmentIndex of the variable that has this one (SPIR-V 3.20).
void strip_index(std::vector<std::uint32_t>& words, std::uint32_t index) {
  constexpr std::uint32_t kDecorate = 71, kInputAttachmentIndex = 43;
  for (std::size_t at = 5; at < words.size();) {
    const std::size_t length = words[at] >> 16;
    if ((words[at] & 0xffff) == kDecorate && words[at + 2] == kInputAttachmentIndex && words[at + 3] == index) {
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(at),
                  words.begin() + static_cast<std::ptrdiff_t>(at + length));
      return;
    }
    at += length;
  }
}

VkPipelineColorBlendAttachmentState blend_of(const Step& step, std::uint32_t attachment) {
  VkPipelineColorBlendAttachmentState out{};
  out.colorWriteMask = step.blends ? 0xfu ^ (1u << (attachment % 4)) : 0xf;
  out.blendEnable = step.blends && attachment % 2 == 0;
  out.srcColorBlendFactor = out.srcAlphaBlendFactor = VK_BLEND_FACTOR_CONSTANT_ALPHA;
  out.dstColorBlendFactor = attachment ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_SRC_COLOR;
  out.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  return out;
}

}  // namespace

std::uint32_t index_of(const std::vector<std::uint32_t>& all, std::uint32_t value) {
  const auto found = std::find(all.begin(), all.end(), value);
  return found == all.end() ? kUnused : static_cast<std::uint32_t>(found - all.begin());
}

StepMapping::StepMapping(const Scene& scene, const Step& step)
    : depth_index(index_of(step.inputs, scene.depth_number())),
      stencil_index(index_of(step.inputs, scene.depth_number() + 1)),
      attachments(make_struct<VkRenderingAttachmentLocationInfoKHR>()),
      inputs(make_struct<VkRenderingInputAttachmentIndexInfoKHR>()) {
  for (std::uint32_t i = 0; i < scene.colors.size(); ++i) {
    locations.push_back(index_of(step.colors, i));
    indices.push_back(index_of(step.inputs, i));
  }
  attachments.colorAttachmentCount = inputs.colorAttachmentCount = scene.depth_number();
  attachments.pColorAttachmentLocations = locations.data();
  inputs.pColorAttachmentInputIndices = indices.data();
  inputs.pDepthInputAttachmentIndex = scene.unnamed_depth ? nullptr : &depth_index;
  inputs.pStencilInputAttachmentIndex = &stencil_index;
}

void LocalReadDevice::make_device() {
  auto maintenance = make_struct<VkPhysicalDeviceMaintenance7FeaturesKHR>();
  maintenance.maintenance7 = VK_TRUE;
  auto local = make_struct<VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR>(&maintenance);
  local.dynamicRenderingLocalRead = VK_TRUE;
  auto ordered = make_struct<VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT>(&local);
  ordered.rasterizationOrderColorAttachmentAccess = VK_TRUE;
  auto libraries = make_struct<VkPhysicalDeviceGraphicsPipelineLibraryFeaturesEXT>(&ordered);
  libraries.graphicsPipelineLibrary = VK_TRUE;
  auto masks = make_struct<VkPhysicalDeviceExtendedDynamicState3FeaturesEXT>(&libraries);
  masks.extendedDynamicState3ColorWriteMask = VK_TRUE;
  auto views = make_struct<VkPhysicalDeviceMultiviewFeatures>(&masks);
  views.multiview = VK_TRUE;
  auto rendering = make_struct<VkPhysicalDeviceDynamicRenderingFeatures>(&views);
  rendering.dynamicRendering = VK_TRUE;
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&rendering);
  features.features.sampleRateShading = features.features.independentBlend = VK_TRUE;
  const char* const names[] = {VK_KHR_DYNAMIC_RENDERING_LOCAL_READ_EXTENSION_NAME,
                               VK_KHR_MAINTENANCE_7_EXTENSION_NAME,
                               VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
                               VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME,
                               VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME,
                               VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME,
                               VK_KHR_PIPELINE_LIBRARY_EXTENSION_NAME,
                               VK_EXT_GRAPHICS_PIPELINE_LIBRARY_EXTENSION_NAME,
                               VK_EXT_EXTENDED_DYNAMIC_STATE_3_EXTENSION_NAME,
                               VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME};
  ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features, names), VK_SUCCESS);
}

void LocalReadDevice::SetUp() {
  Maintenance5Device::SetUp();
  std::array<VkDescriptorSetLayoutBinding, kMaxInputs> bindings{};
  for (std::uint32_t i = 0; i < kMaxInputs; ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
  shape.bindingCount = kMaxInputs;
  shape.pBindings = bindings.data();
  ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout_), VK_SUCCESS);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, 64 * kMaxInputs};
  auto pool = make_struct<VkDescriptorPoolCreateInfo>();
  pool.maxSets = 64;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool, nullptr, &descriptor_pool_), VK_SUCCESS);
  auto layout = make_struct<VkPipelineLayoutCreateInfo>();
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout, nullptr, &layout_), VK_SUCCESS);
  const auto commands = make_struct<VkCommandPoolCreateInfo>();
  ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &commands, nullptr, &secondaries_), VK_SUCCESS);
}

void LocalReadDevice::TearDown() {
  for (const auto& destroy : cleanup_) destroy();
  VK_CALL(DestroyCommandPool)(device, secondaries_, nullptr);
  VK_CALL(DestroyPipelineLayout)(device, layout_, nullptr);
  VK_CALL(DestroyDescriptorPool)(device, descriptor_pool_, nullptr);
  VK_CALL(DestroyDescriptorSetLayout)(device, set_layout_, nullptr);
  Maintenance5Device::TearDown();
}

LocalReadDevice::Target LocalReadDevice::make_target(const Scene& scene, VkFormat format, VkImageAspectFlags aspects) {
  Target out{{}, format, {}};
  VkImageCreateInfo info =
      image_info(VK_IMAGE_TYPE_2D, format, {kSceneSize.width, kSceneSize.height, 1}, scene.layers, scene.samples);
  info.usage = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT |
               (aspects == VK_IMAGE_ASPECT_COLOR_BIT ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT
                                                     : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  EXPECT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &out.picture.image), VK_SUCCESS);
  VkMemoryRequirements needed;
  VK_CALL(GetImageMemoryRequirements)(device, out.picture.image, &needed);
  out.picture.memory = map(needed.size, out.picture.data);
  out.picture.size = needed.size;
  std::fill_n(out.picture.data, out.picture.size, std::byte{0x5a});
  EXPECT_EQ(VK_CALL(BindImageMemory)(device, out.picture.image, out.picture.memory, 0), VK_SUCCESS);
  auto view = make_struct<VkImageViewCreateInfo>();
  view.image = out.picture.image;
  view.viewType = scene.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspects, 0, 1, 0, scene.layers};
  EXPECT_EQ(VK_CALL(CreateImageView)(device, &view, nullptr, &out.picture.view), VK_SUCCESS);
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    if (!(aspects & aspect)) continue;
    view.subresourceRange.aspectMask = aspect;
    VkImageView& one = out.inputs.emplace_back();
    EXPECT_EQ(VK_CALL(CreateImageView)(device, &view, nullptr, &one), VK_SUCCESS);
    cleanup_.push_back([this, one] { VK_CALL(DestroyImageView)(device, one, nullptr); });
  }
  pictures.push_back(out.picture);
  return out;
}

std::vector<LocalReadDevice::Target> LocalReadDevice::make_targets(const Scene& scene) {
  std::vector<Target> targets;
  for (const VkFormat format : scene.colors) targets.push_back(make_target(scene, format, VK_IMAGE_ASPECT_COLOR_BIT));
  if (scene.depth) targets.push_back(make_target(scene, scene.depth, aspects_of(scene.depth)));
  return targets;
}

VkDescriptorSet LocalReadDevice::make_set(const Scene& scene, const Step& step, const std::vector<Target>& targets) {
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = descriptor_pool_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout_;
  VkDescriptorSet set = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  for (std::uint32_t i = 0; i < step.inputs.size(); ++i) {
    const std::uint32_t input = step.inputs[i];
    const bool stencil = input > scene.depth_number();
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, targets[stencil ? input - 1 : input].inputs[stencil ? 1 : 0],
                                      VK_IMAGE_LAYOUT_GENERAL};
    auto write = make_struct<VkWriteDescriptorSet>();
    write.dstSet = set;
    write.dstBinding = i;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
    write.pImageInfo = &image;
    VK_CALL(UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
  }
  return set;
}

VkRenderPass LocalReadDevice::make_render_pass(const Scene& scene) {
  std::vector<VkAttachmentDescription> attachments;
  std::vector<VkFormat> formats = scene.colors;
  if (scene.depth) formats.push_back(scene.depth);
  for (const VkFormat format : formats)
    attachments.push_back({0, format, scene.samples, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE,
                           VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE, VK_IMAGE_LAYOUT_UNDEFINED,
                           VK_IMAGE_LAYOUT_GENERAL});
  const auto reference = [&](std::uint32_t attachment) {
    return VkAttachmentReference{attachment == kUnused ? kUnused : std::min(attachment, scene.depth_number()),
                                 VK_IMAGE_LAYOUT_GENERAL};
  };
  std::vector<std::vector<VkAttachmentReference>> lists;
  lists.reserve(2 * scene.steps.size());
  const VkAttachmentReference depth = reference(scene.depth_number());
  std::vector<VkSubpassDescription> subpasses;
  std::vector<VkSubpassDependency> dependencies;
  for (std::uint32_t i = 0; i < scene.steps.size(); ++i) {
    const Step& step = scene.steps[i];
    auto &colors = lists.emplace_back(), &inputs = lists.emplace_back();
    std::ranges::transform(step.colors, std::back_inserter(colors), reference);
    std::ranges::transform(step.inputs, std::back_inserter(inputs), reference);
    subpasses.push_back(
        {step.ordered
             ? VkSubpassDescriptionFlags{VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_BIT_EXT}
             : 0u,
         VK_PIPELINE_BIND_POINT_GRAPHICS, static_cast<std::uint32_t>(inputs.size()), inputs.data(),
         static_cast<std::uint32_t>(colors.size()), colors.data(), nullptr, scene.depth ? &depth : nullptr, 0,
         nullptr});
    for (const std::uint32_t first : {i, i - 1})
      if (first <= i)
        dependencies.push_back(
            {first, i, kWriting, kReading, kWrites, kReads,
             VkDependencyFlags{VK_DEPENDENCY_BY_REGION_BIT} |
                 (scene.view_mask && first == i ? VkDependencyFlags{VK_DEPENDENCY_VIEW_LOCAL_BIT} : 0u)});
  }
  const std::vector<std::uint32_t> masks(subpasses.size(), scene.view_mask);
  auto views = make_struct<VkRenderPassMultiviewCreateInfo>();
  views.subpassCount = static_cast<std::uint32_t>(masks.size());
  views.pViewMasks = masks.data();
  auto info = make_struct<VkRenderPassCreateInfo>(scene.view_mask ? &views : nullptr);
  info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = static_cast<std::uint32_t>(subpasses.size());
  info.pSubpasses = subpasses.data();
  info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
  info.pDependencies = dependencies.data();
  VkRenderPass pass = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateRenderPass)(device, &info, nullptr, &pass), VK_SUCCESS);
  cleanup_.push_back([this, pass] { VK_CALL(DestroyRenderPass)(device, pass, nullptr); });
  return pass;
}

VkFramebuffer LocalReadDevice::make_framebuffer(const Scene& scene, VkRenderPass pass,
                                                const std::vector<Target>& targets) {
  std::vector<VkImageView> views;
  for (const Target& target : targets) views.push_back(target.picture.view);
  auto info = make_struct<VkFramebufferCreateInfo>();
  info.renderPass = pass;
  info.attachmentCount = static_cast<std::uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = kSceneSize.width;
  info.height = kSceneSize.height;
  info.layers = scene.view_mask ? 1 : scene.layers;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateFramebuffer)(device, &info, nullptr, &framebuffer), VK_SUCCESS);
  cleanup_.push_back([this, framebuffer] { VK_CALL(DestroyFramebuffer)(device, framebuffer, nullptr); });
  return framebuffer;
}

/// With libraries: one that knows the input attachments, and one that knows the locations.
VkPipeline LocalReadDevice::create_pipeline(VkGraphicsPipelineCreateInfo& info, const Scene& scene,
                                            const void* rendering) {
  const auto create = [&](const VkGraphicsPipelineCreateInfo& one) {
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &one, nullptr, &pipeline), VK_SUCCESS);
    cleanup_.push_back([this, pipeline] { VK_CALL(DestroyPipeline)(device, pipeline, nullptr); });
    return pipeline;
  };
  if (!scene.as_libraries || !rendering) return create(info);
  auto parts = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>(const_cast<void*>(rendering));
  info.flags |= VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
  std::array<VkPipeline, 2> made{};
  for (const bool output : {false, true}) {
    parts.flags = output ? VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT
                         : VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT |
                               VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT |
                               VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT;
    info.pNext = &parts;
    made[output] = create(info);
  }
  auto libraries = make_struct<VkPipelineLibraryCreateInfoKHR>();
  libraries.libraryCount = 2;
  libraries.pLibraries = made.data();
  auto linked = make_struct<VkGraphicsPipelineCreateInfo>(&libraries);
  linked.layout = layout_;
  return create(linked);
}

VkPipeline LocalReadDevice::make_pipeline(const Scene& scene, std::size_t number, VkRenderPass pass) {
  const Step& step = scene.steps[number];
  const bool layered = scene.layers > 1 && !scene.view_mask;
  std::string vertex_text = layered ? "#extension GL_ARB_shader_viewport_layer_array : require\n" : "";
  vertex_text += kVertex;
  vertex_text.replace(vertex_text.find("LAYER"), 5, layered ? "gl_Layer = gl_InstanceIndex;" : "");
  const auto vertex_words = compile(VK_SHADER_STAGE_VERTEX_BIT, vertex_text);
  auto fragment_words = compile(VK_SHADER_STAGE_FRAGMENT_BIT, step.fragment);
  if (!pass && scene.unnamed_depth) strip_index(fragment_words, index_of(step.inputs, scene.depth_number()));
  std::array<VkPipelineShaderStageCreateInfo, 2> stages;
  for (const bool fragment : {false, true}) {
    const auto info = module_info(fragment ? fragment_words : vertex_words);
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    cleanup_.push_back([this, module] { VK_CALL(DestroyShaderModule)(device, module, nullptr); });
    stages[fragment] = make_struct<VkPipelineShaderStageCreateInfo>();
    stages[fragment].stage = fragment ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT;
    stages[fragment].module = module;
    stages[fragment].pName = "main";
  }
  const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport area{0, 0, float(kSceneSize.width), float(kSceneSize.height), 0, 1};
  const VkRect2D scissor{{0, 0}, kSceneSize};
  auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
  viewport.viewportCount = viewport.scissorCount = 1;
  viewport.pViewports = &area;
  viewport.pScissors = &scissor;
  auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
  rasterization.lineWidth = 1;
  auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
  multisample.rasterizationSamples = scene.samples;
  multisample.alphaToCoverageEnable = step.covers_by_alpha;
  auto depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
  // What reads depth or stencil leaves them alone.
  const bool reads = std::ranges::any_of(step.inputs, [&](std::uint32_t i) { return i >= scene.depth_number(); });
  depth.depthTestEnable = depth.depthWriteEnable = depth.stencilTestEnable = !reads;
  depth.depthCompareOp = VK_COMPARE_OP_LESS;
  depth.front = depth.back = {
      VK_STENCIL_OP_KEEP, VK_STENCIL_OP_INCREMENT_AND_CLAMP, VK_STENCIL_OP_INVERT, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 0};
  // Blending is kept by attachment in dynamic rendering, by location in a render pass.
  std::vector<VkPipelineColorBlendAttachmentState> blends;
  if (pass)
    for (const std::uint32_t attachment : step.colors) blends.push_back(blend_of(step, attachment));
  else
    for (std::uint32_t i = 0; i < scene.colors.size(); ++i) blends.push_back(blend_of(step, i));
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  if (step.ordered) blend.flags = VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
  blend.attachmentCount = static_cast<std::uint32_t>(blends.size());
  blend.pAttachments = blends.data();
  blend.blendConstants[3] = 0.625f;
  const VkDynamicState masks = VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT;
  auto dynamic = make_struct<VkPipelineDynamicStateCreateInfo>();
  dynamic.dynamicStateCount = scene.writes_masks;
  dynamic.pDynamicStates = &masks;
  StepMapping mapping(scene, step);
  mapping.attachments.pNext = &mapping.inputs;
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>(&mapping.attachments);
  rendering.viewMask = scene.view_mask;
  rendering.colorAttachmentCount = scene.depth_number();
  rendering.pColorAttachmentFormats = scene.colors.data();
  rendering.depthAttachmentFormat = scene.depth;
  if (scene.depth && (aspects_of(scene.depth) & VK_IMAGE_ASPECT_STENCIL_BIT))
    rendering.stencilAttachmentFormat = scene.depth;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(pass ? nullptr : &rendering);
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  info.renderPass = pass;
  info.subpass = pass ? static_cast<std::uint32_t>(number) : 0;
  return create_pipeline(info, scene, pass ? nullptr : &rendering);
}

void LocalReadDevice::barrier(VkCommandBuffer commands) {
  auto memory = make_struct<VkMemoryBarrier>();
  memory.srcAccessMask = kWrites;
  memory.dstAccessMask = kReads;
  VK_CALL(CmdPipelineBarrier)
  (commands, kWriting, kReading, VK_DEPENDENCY_BY_REGION_BIT, 1, &memory, 0, nullptr, 0, nullptr);
}

void LocalReadDevice::draw_step(VkCommandBuffer commands, const Scene& scene, const Step& step, VkPipeline pipeline,
                                VkDescriptorSet set, bool by_location) {
  if (step.cleared != kUnused) {
    const std::uint32_t at = by_location ? index_of(step.colors, step.cleared) : step.cleared;
    const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, at, clear_of(5)};
    const VkClearRect rect{{{10, 10}, {40, 30}}, 0, scene.view_mask ? 1 : scene.layers};
    VK_CALL(CmdClearAttachments)(commands, 1, &clear, 1, &rect);
  }
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  VK_CALL(CmdBindDescriptorSets)
  (commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set, 0, nullptr);
  std::vector<VkColorComponentFlags> masks;
  const auto mask_of = [](std::uint32_t attachment) { return 0xfu ^ (2u << (attachment % 3)); };
  if (by_location)
    std::ranges::transform(step.colors, std::back_inserter(masks), mask_of);
  else
    for (std::uint32_t i = 0; i < scene.colors.size(); ++i) masks.push_back(mask_of(i));
  if (scene.writes_masks)
    VK_CALL(CmdSetColorWriteMaskEXT)(commands, 0, static_cast<std::uint32_t>(masks.size()), masks.data());
  const bool layered = scene.layers > 1 && !scene.view_mask;
  for (std::uint32_t i = 0; i < step.draws; ++i) {
    if (i) barrier(commands);
    VK_CALL(CmdDraw)(commands, 3, layered ? scene.layers : step.ordered ? 3 : 1, 0, 0);
  }
}

std::vector<LocalReadDevice::Contents> LocalReadDevice::bytes_of(const std::vector<Target>& targets) {
  std::vector<Contents> out;
  for (const Target& target : targets) out.emplace_back(target.picture.data, target.picture.data + target.picture.size);
  return out;
}

std::vector<LocalReadDevice::Contents> LocalReadDevice::as_subpasses(const Scene& scene) {
  const std::vector<Target> targets = make_targets(scene);
  const VkRenderPass pass = make_render_pass(scene);
  const VkFramebuffer framebuffer = make_framebuffer(scene, pass, targets);
  std::vector<VkPipeline> pipelines;
  for (std::size_t i = 0; i < scene.steps.size(); ++i) pipelines.push_back(make_pipeline(scene, i, pass));
  std::vector<VkClearValue> clears;
  for (std::size_t i = 0; i < scene.colors.size(); ++i) clears.push_back(clear_of(i));
  clears.emplace_back().depthStencil = kDepthClear;
  run([&](VkCommandBuffer commands) {
    auto begin = make_struct<VkRenderPassBeginInfo>();
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, kSceneSize};
    begin.clearValueCount = static_cast<std::uint32_t>(clears.size());
    begin.pClearValues = clears.data();
    VK_CALL(CmdBeginRenderPass)(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    for (std::size_t i = 0; i < scene.steps.size(); ++i) {
      if (i) VK_CALL(CmdNextSubpass)(commands, VK_SUBPASS_CONTENTS_INLINE);
      draw_step(commands, scene, scene.steps[i], pipelines[i], make_set(scene, scene.steps[i], targets), true);
    }
    VK_CALL(CmdEndRenderPass)(commands);
  });
  return bytes_of(targets);
}

VkCommandBuffer LocalReadDevice::make_secondary(const Scene& scene, const Step& step) {
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = secondaries_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
  StepMapping mapping(scene, step);
  mapping.attachments.pNext = &mapping.inputs;
  auto rendering = make_struct<VkCommandBufferInheritanceRenderingInfo>(&mapping.attachments);
  rendering.viewMask = scene.view_mask;
  rendering.colorAttachmentCount = scene.depth_number();
  rendering.pColorAttachmentFormats = scene.colors.data();
  rendering.depthAttachmentFormat = scene.depth;
  rendering.rasterizationSamples = scene.samples;
  const auto inherited = make_struct<VkCommandBufferInheritanceInfo>(&rendering);
  auto begin = make_struct<VkCommandBufferBeginInfo>();
  begin.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
  begin.pInheritanceInfo = &inherited;
  EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &begin), VK_SUCCESS);
  return commands;
}

std::vector<LocalReadDevice::Contents> LocalReadDevice::as_rendering(const Scene& scene) {
  const std::vector<Target> targets = make_targets(scene);
  std::vector<VkRenderingAttachmentInfo> attachments;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    auto& attachment = attachments.emplace_back(make_struct<VkRenderingAttachmentInfo>());
    attachment.imageView = targets[i].picture.view;
    attachment.imageLayout = scene.layout;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.clearValue = clear_of(i);
    if (i == scene.depth_number()) attachment.clearValue.depthStencil = kDepthClear;
  }
  run([&](VkCommandBuffer commands) {
    for (const Target& target : targets) to_layout(commands, scene, target);
    auto begin = make_struct<VkRenderingInfo>();
    if (scene.in_secondaries) begin.flags = VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT;
    if (scene.draws_inline_too) begin.flags |= VK_RENDERING_CONTENTS_INLINE_BIT_KHR;
    begin.renderArea = {{0, 0}, kSceneSize};
    begin.layerCount = scene.view_mask ? 1 : scene.layers;
    begin.viewMask = scene.view_mask;
    begin.colorAttachmentCount = scene.depth_number();
    begin.pColorAttachments = attachments.data();
    if (scene.depth) begin.pDepthAttachment = &attachments.back();
    if (scene.depth && (aspects_of(scene.depth) & VK_IMAGE_ASPECT_STENCIL_BIT))
      begin.pStencilAttachment = &attachments.back();
    VK_CALL(CmdBeginRenderingKHR)(commands, &begin);
    for (std::size_t i = 0; i < scene.steps.size(); ++i) {
      const Step& step = scene.steps[i];
      const bool secondary = scene.in_secondaries && (i % 2 == 0 || !scene.draws_inline_too);
      const VkCommandBuffer to = secondary ? make_secondary(scene, step) : commands;
      if (i && !scene.lacks_barriers) barrier(to);
      const StepMapping mapping(scene, step);
      if (!secondary) {
        VK_CALL(CmdSetRenderingAttachmentLocationsKHR)(commands, &mapping.attachments);
        VK_CALL(CmdSetRenderingInputAttachmentIndicesKHR)(commands, &mapping.inputs);
      }
      draw_step(to, scene, step, make_pipeline(scene, i, VK_NULL_HANDLE), make_set(scene, step, targets), false);
      if (!secondary) continue;
      EXPECT_EQ(VK_CALL(EndCommandBuffer)(to), VK_SUCCESS);
      VK_CALL(CmdExecuteCommands)(commands, 1, &to);
    }
    VK_CALL(CmdEndRenderingKHR)(commands);
  });
  return bytes_of(targets);
}

void LocalReadDevice::to_layout(VkCommandBuffer commands, const Scene& scene, const Target& target) {
  auto transition = make_struct<VkImageMemoryBarrier>();
  transition.dstAccessMask = kReads;
  transition.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  transition.newLayout = scene.layout;
  transition.image = target.picture.image;
  const VkImageAspectFlags aspects =
      target.format == scene.depth ? aspects_of(target.format) : VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT};
  transition.subresourceRange = {aspects, 0, 1, 0, scene.layers};
  VK_CALL(CmdPipelineBarrier)
  (commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, kReading, 0, 0, nullptr, 0, nullptr, 1, &transition);
}

void LocalReadDevice::expect_same(const Scene& scene) {
  const std::vector<Contents> expected = as_subpasses(scene), drawn = as_rendering(scene);
  ASSERT_EQ(drawn.size(), expected.size());
  const auto draws_something = [](const Contents& c) { return std::set<std::byte>(c.begin(), c.end()).size() > 20; };
  EXPECT_TRUE(std::any_of(drawn.begin(), drawn.end(), draws_something));
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const auto& other = expected[i];
    const auto differs = std::mismatch(drawn[i].begin(), drawn[i].end(), other.begin(), other.end()).first;
    EXPECT_TRUE(differs == drawn[i].end()) << "attachment " << i << ", byte " << differs - drawn[i].begin();
  }
}

}  // namespace vitrine::icd::test
#endif
