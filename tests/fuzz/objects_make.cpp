// Objects by kind, of those that are there.
#include <array>
#include <span>
#include <string>

#include "tests/fuzz/objects.h"
#include "tests/glsl/compile.h"

#define VK_CALL(name) VK_GET(d_.instance, name)

namespace vitrine::fuzz {

using icd::make_struct;

namespace {

constexpr VkDeviceSize kMemoryBytes = 1 << 16, kBufferBytes = 4096;
constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr std::uint32_t kSide = 16;

constexpr const char* kSources[] = {
    R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Data { uint data[]; };
layout(set = 0, binding = 1) uniform sampler2D picture;
layout(set = 0, binding = 2, rgba8) uniform image2D canvas;
layout(set = 0, binding = 3) uniform textureBuffer texels;
void main() {
  const uint i = gl_GlobalInvocationID.x;
  const vec4 v = textureLod(picture, vec2(i) / 64.0, 0.0) + texelFetch(texels, int(i));
  imageStore(canvas, ivec2(i & 15, i >> 4), v);
  data[i] = data[i + 1] + packUnorm4x8(v);
})",
    R"(#version 450
void main() { gl_Position = vec4(gl_VertexIndex & 1, gl_VertexIndex >> 1, 0.5, 1.0) * vec4(4, 4, 1, 1) - vec4(1, 1, 0, 0); })",
    R"(#version 450
layout(set = 0, binding = 1) uniform sampler2D picture;
layout(location = 0) out vec4 colour;
void main() { colour = texture(picture, gl_FragCoord.xy / 16.0); })"};

VkDescriptorType type_of(std::uint32_t binding) {
  constexpr VkDescriptorType kTypes[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                         VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER};
  return kTypes[binding];
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, const Ref& module) {
  auto info = make_struct<VkPipelineShaderStageCreateInfo>();
  info.stage = bit;
  info.module = as<VkShaderModule>(module);
  info.pName = "main";
  return info;
}

std::span<const std::uint32_t> words_of(Shader shader) {
  constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_COMPUTE_BIT, VK_SHADER_STAGE_VERTEX_BIT,
                                               VK_SHADER_STAGE_FRAGMENT_BIT};
  static std::array<std::vector<std::uint32_t>, std::size(kSources)> compiled;
  const auto i = static_cast<std::size_t>(shader);
  if (compiled[i].empty()) {
    std::string log;
    compiled[i] = test::compile_glsl(kStages[i], kSources[i], test::VulkanVersion::k12, log);
    demand(!compiled[i].empty(), log);
  }
  return compiled[i];
}

}  // namespace

Ref Objects::keep(Kind kind, std::uint64_t handle, std::vector<Ref> of) {
  auto thing = std::make_shared<Thing>();
  thing->kind = kind;
  thing->handle = handle;
  thing->of = std::move(of);
  things_.push_back(thing);
  return thing;
}

void Objects::make() { make_of(static_cast<Kind>(c_.below(static_cast<std::uint32_t>(Kind::kCount)))); }

void Objects::make_of(Kind kind, std::uint32_t agreed) {
  switch (kind) {
    case Kind::kMemory: {
      auto info = make_struct<VkMemoryAllocateInfo>();
      info.allocationSize = kMemoryBytes;
      made(kind, VK_CALL(AllocateMemory), info);
      break;
    }
    case Kind::kBuffer:
      make_buffer();
      break;
    case Kind::kBufferView:
      if (const Ref buffer = need(Kind::kBuffer)) {
        auto info = make_struct<VkBufferViewCreateInfo>();
        info.buffer = as<VkBuffer>(buffer);
        info.format = kFormat;
        info.offset = c_.below(8) * 256;
        info.range = VK_WHOLE_SIZE;
        made(kind, VK_CALL(CreateBufferView), info, {buffer});
      }
      break;
    case Kind::kImage:
      make_image();
      break;
    case Kind::kImageView:
      if (const Ref image = need(Kind::kImage)) {
        auto info = make_struct<VkImageViewCreateInfo>();
        info.image = as<VkImage>(image);
        info.viewType = VK_IMAGE_VIEW_TYPE_2D;
        info.format = kFormat;
        info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        made(kind, VK_CALL(CreateImageView), info, {image});
      }
      break;
    case Kind::kSampler:
      made(kind, VK_CALL(CreateSampler), make_struct<VkSamplerCreateInfo>());
      break;
    case Kind::kSetLayout:
      make_set_layout();
      break;
    case Kind::kTemplate:
      make_template();
      break;
    case Kind::kPipelineLayout:
      if (const Ref set_layout = need(Kind::kSetLayout)) {
        const auto handle = as<VkDescriptorSetLayout>(set_layout);
        auto info = make_struct<VkPipelineLayoutCreateInfo>();
        info.setLayoutCount = 1;
        info.pSetLayouts = &handle;
        const Ref layout = made(kind, VK_CALL(CreatePipelineLayout), info);
        layout->agreed = set_layout->agreed;
        // Immutable samplers are used as long as the layout is.
        layout->of = set_layout->of;
      }
      break;
    case Kind::kDescriptorPool: {
      VkDescriptorPoolSize sizes[kBindings];
      for (std::uint32_t i = 0; i < kBindings; ++i) sizes[i] = {type_of(i), 6};
      auto info = make_struct<VkDescriptorPoolCreateInfo>();
      info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
      info.maxSets = 6;
      info.poolSizeCount = kBindings;
      info.pPoolSizes = sizes;
      made(kind, VK_CALL(CreateDescriptorPool), info);
      break;
    }
    case Kind::kSet:
      make_set(agreed);
      break;
    case Kind::kModule:
      make_module(static_cast<Shader>(agreed < static_cast<std::uint32_t>(Shader::kCount)
                                          ? agreed
                                          : c_.below(static_cast<std::uint32_t>(Shader::kCount))));
      break;
    case Kind::kCache:
      made(kind, VK_CALL(CreatePipelineCache), make_struct<VkPipelineCacheCreateInfo>());
      break;
    case Kind::kComputePipeline:
      make_compute_pipeline();
      break;
    case Kind::kRenderPass:
      make_render_pass();
      break;
    case Kind::kFramebuffer:
      make_framebuffer();
      break;
    case Kind::kGraphicsPipeline:
      make_graphics_pipeline();
      break;
    case Kind::kQueryPool: {
      auto info = make_struct<VkQueryPoolCreateInfo>();
      info.queryType = c_.one_in(2) ? VK_QUERY_TYPE_OCCLUSION : VK_QUERY_TYPE_TIMESTAMP;
      info.queryCount = c_.between(1, 4);
      made(kind, VK_CALL(CreateQueryPool), info)->agreed = info.queryType;
      break;
    }
    case Kind::kEvent:
      made(kind, VK_CALL(CreateEvent), make_struct<VkEventCreateInfo>());
      break;
    case Kind::kFence:
      made(kind, VK_CALL(CreateFence), make_struct<VkFenceCreateInfo>());
      break;
    case Kind::kSemaphore:
      made(kind, VK_CALL(CreateSemaphore), make_struct<VkSemaphoreCreateInfo>());
      break;
    case Kind::kCommandPool: {
      auto info = make_struct<VkCommandPoolCreateInfo>();
      info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
      made(kind, VK_CALL(CreateCommandPool), info);
      break;
    }
    case Kind::kCommands:
    case Kind::kSecondary:
      make_commands(kind == Kind::kSecondary);
      break;
    case Kind::kCount:
      break;
  }
}

void Objects::make_buffer() {
  const Ref memory = need(Kind::kMemory);
  if (!memory) return;
  auto info = make_struct<VkBufferCreateInfo>();
  info.size = kBufferBytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const Ref buffer = made(Kind::kBuffer, VK_CALL(CreateBuffer), info, {memory});
  const VkDeviceSize offset = c_.below(kMemoryBytes / kBufferBytes) * kBufferBytes;
  demand(VK_CALL(BindBufferMemory)(d_.device, as<VkBuffer>(buffer), as<VkDeviceMemory>(memory), offset) == VK_SUCCESS,
         "memory of a buffer");
}

void Objects::make_image() {
  const Ref memory = need(Kind::kMemory);
  if (!memory) return;
  auto info = make_struct<VkImageCreateInfo>();
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = kFormat;
  info.extent = {kSide, kSide, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
               VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Ref image = made(Kind::kImage, VK_CALL(CreateImage), info, {memory});
  VkMemoryRequirements needs{};
  VK_CALL(GetImageMemoryRequirements)(d_.device, as<VkImage>(image), &needs);
  demand(needs.size <= kMemoryBytes, "a small image");
  const auto places = static_cast<std::uint32_t>((kMemoryBytes - needs.size) / needs.alignment + 1);
  const VkDeviceSize offset = c_.below(places) * needs.alignment;
  demand(VK_CALL(BindImageMemory)(d_.device, as<VkImage>(image), as<VkDeviceMemory>(memory), offset) == VK_SUCCESS,
         "memory of an image");
}

void Objects::make_set_layout() {
  // Seldom: shaders are translated for each.
  const Ref immutable = c_.one_in(40) ? some(Kind::kSampler) : nullptr;
  const auto sampler = as<VkSampler>(immutable);
  VkDescriptorSetLayoutBinding bindings[kBindings];
  for (std::uint32_t i = 0; i < kBindings; ++i)
    bindings[i] = {i, type_of(i), 1, VK_SHADER_STAGE_ALL, immutable && i == 1 ? &sampler : nullptr};
  auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  info.bindingCount = kBindings;
  info.pBindings = bindings;
  const Ref layout = made(Kind::kSetLayout, VK_CALL(CreateDescriptorSetLayout), info);
  if (!immutable) return;
  layout->of = {immutable};
  // One of its own: a sampler's handle may come again.
  static std::uint32_t last = 0;
  if (!immutable->agreed) immutable->agreed = ++last;
  layout->agreed = immutable->agreed;
}

void Objects::make_template() {
  const Ref layout = need(Kind::kSetLayout);
  if (!layout) return;
  VkDescriptorUpdateTemplateEntry entry{};
  entry.descriptorCount = 1;
  entry.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  auto info = make_struct<VkDescriptorUpdateTemplateCreateInfo>();
  info.descriptorUpdateEntryCount = 1;
  info.pDescriptorUpdateEntries = &entry;
  info.descriptorSetLayout = as<VkDescriptorSetLayout>(layout);
  made(Kind::kTemplate, VK_CALL(CreateDescriptorUpdateTemplate), info)->agreed = layout->agreed;
}

void Objects::make_module(Shader shader) {
  auto info = make_struct<VkShaderModuleCreateInfo>();
  info.codeSize = words_of(shader).size_bytes();
  info.pCode = words_of(shader).data();
  made(Kind::kModule, VK_CALL(CreateShaderModule), info)->agreed = static_cast<std::uint32_t>(shader);
}

void Objects::make_set(std::uint32_t agreed) {
  const Ref pool = need(Kind::kDescriptorPool), layout = need(Kind::kSetLayout, agreed);
  if (!pool || !layout) return;
  const auto handle = as<VkDescriptorSetLayout>(layout);
  auto info = make_struct<VkDescriptorSetAllocateInfo>();
  info.descriptorPool = as<VkDescriptorPool>(pool);
  info.descriptorSetCount = 1;
  info.pSetLayouts = &handle;
  VkDescriptorSet set = VK_NULL_HANDLE;
  const VkResult result = VK_CALL(AllocateDescriptorSets)(d_.device, &info, &set);
  demand(result == VK_SUCCESS || result == VK_ERROR_OUT_OF_POOL_MEMORY, "a set");
  if (result != VK_SUCCESS) return;
  const Ref thing = keep(Kind::kSet, reinterpret_cast<std::uint64_t>(set));
  thing->pool = pool;
  thing->layout = layout;
  thing->agreed = layout->agreed;
  // By binding what is written there, and behind them the sampler.
  thing->of.resize(kBindings + 1);
  if (!layout->of.empty()) thing->of[kBindings] = layout->of[0];
  if (c_.one_in(5)) return;
  for (std::uint32_t i = 0; i < kBindings; ++i) write(thing, i);
}

VkPipelineCache Objects::some_cache() { return c_.one_in(50) ? as<VkPipelineCache>(some(Kind::kCache)) : cache_; }

void Objects::make_compute_pipeline() {
  const Ref module = need(Kind::kModule, static_cast<std::uint32_t>(Shader::kCompute));
  const Ref layout = need(Kind::kPipelineLayout);
  if (!module || !layout) return;
  auto info = make_struct<VkComputePipelineCreateInfo>();
  info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module);
  info.layout = as<VkPipelineLayout>(layout);
  VkPipeline pipeline = VK_NULL_HANDLE;
  demand(VK_CALL(CreateComputePipelines)(d_.device, some_cache(), 1, &info, nullptr, &pipeline) == VK_SUCCESS,
         "a compute pipeline");
  keep(Kind::kComputePipeline, reinterpret_cast<std::uint64_t>(pipeline), layout->of)->agreed = layout->agreed;
}

void Objects::make_render_pass() {
  VkAttachmentDescription attachment{};
  attachment.format = kFormat;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = c_.one_in(2) ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_GENERAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  auto info = make_struct<VkRenderPassCreateInfo>();
  info.attachmentCount = info.subpassCount = 1;
  info.pAttachments = &attachment;
  info.pSubpasses = &subpass;
  made(Kind::kRenderPass, VK_CALL(CreateRenderPass), info);
}

void Objects::make_framebuffer() {
  const Ref pass = need(Kind::kRenderPass), view = need(Kind::kImageView);
  if (!pass || !view) return;
  const auto handle = as<VkImageView>(view);
  auto info = make_struct<VkFramebufferCreateInfo>();
  info.renderPass = as<VkRenderPass>(pass);
  info.attachmentCount = 1;
  info.pAttachments = &handle;
  info.width = info.height = kSide;
  info.layers = 1;
  made(Kind::kFramebuffer, VK_CALL(CreateFramebuffer), info, {view});
}

void Objects::make_graphics_pipeline() {
  const Ref vertex = need(Kind::kModule, static_cast<std::uint32_t>(Shader::kVertex));
  const Ref fragment = need(Kind::kModule, static_cast<std::uint32_t>(Shader::kFragment));
  const Ref layout = need(Kind::kPipelineLayout), pass = need(Kind::kRenderPass);
  if (!vertex || !fragment || !layout || !pass) return;
  const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                    stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  const auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport viewport{0, 0, kSide, kSide, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSide, kSide}};
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
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &multisample;
  info.pColorBlendState = &blend;
  info.layout = as<VkPipelineLayout>(layout);
  info.renderPass = as<VkRenderPass>(pass);
  VkPipeline pipeline = VK_NULL_HANDLE;
  demand(VK_CALL(CreateGraphicsPipelines)(d_.device, some_cache(), 1, &info, nullptr, &pipeline) == VK_SUCCESS,
         "a graphics pipeline");
  keep(Kind::kGraphicsPipeline, reinterpret_cast<std::uint64_t>(pipeline), layout->of)->agreed = layout->agreed;
}

void Objects::make_commands(bool secondary) {
  const Ref pool = need(Kind::kCommandPool);
  if (!pool) return;
  auto info = make_struct<VkCommandBufferAllocateInfo>();
  info.commandPool = as<VkCommandPool>(pool);
  info.level = secondary ? VK_COMMAND_BUFFER_LEVEL_SECONDARY : VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  demand(VK_CALL(AllocateCommandBuffers)(d_.device, &info, &commands) == VK_SUCCESS, "a command buffer");
  keep(secondary ? Kind::kSecondary : Kind::kCommands, reinterpret_cast<std::uint64_t>(commands))->pool = pool;
}

}  // namespace vitrine::fuzz
