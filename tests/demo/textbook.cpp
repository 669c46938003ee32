// Draws one scene of textbook_scenes.h off screen through the Vulkan loader, on whatever device it offers first, and
// writes it as a PNG with pixels of 8x8. Usage: vitrine_textbook [NAME FILE.png]; without arguments: lists the names.
#include "tests/demo/textbook_scenes.h"

#include <png.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "tests/demo/textbook_frag.h"
#include "tests/demo/textbook_vert.h"

namespace vitrine::demo {
namespace {

constexpr std::uint32_t kZoom = 8;
constexpr VkFormat kColorFormat = VK_FORMAT_R8G8B8A8_UNORM, kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkExtent2D kExtent{kTextbookWidth, kTextbookHeight};

void require(VkResult result, const char* what) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(what) + " failed: " + std::to_string(result));
}
#define REQUIRE(call) require((call), #call)

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  void* data = nullptr;
};

struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};

/// Everything lives until the process ends.
class Textbook {
 public:
  Textbook() {
    const VkApplicationInfo application{
        VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "textbook", 1, nullptr, 0, VK_API_VERSION_1_1};
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    VkInstance instance;
    REQUIRE(vkCreateInstance(&info, nullptr, &instance));
    std::uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(instance, &count, &physical_);
    if (found < 0 || count == 0) throw std::runtime_error("there is no Vulkan device");
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceLineRasterizationFeaturesEXT lines{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT};
    lines.bresenhamLines = VK_TRUE;
    const char* extension = VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME;
    VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &lines};
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    device.enabledExtensionCount = 1;
    device.ppEnabledExtensionNames = &extension;
    REQUIRE(vkCreateDevice(physical_, &device, nullptr, &device_));
    vkGetDeviceQueue(device_, 0, 0, &queue_);
    const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandPool commands;
    REQUIRE(vkCreateCommandPool(device_, &pool, nullptr, &commands));
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, commands,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    REQUIRE(vkAllocateCommandBuffers(device_, &allocate, &commands_));
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    REQUIRE(vkBeginCommandBuffer(commands_, &begin));
    create_pass();
    create_texture();
  }

  /// RGBA8 pixels of the scene; once.
  std::vector<unsigned char> draw(const TextbookScene& scene) {
    const VkClearValue clears[2] = {{{{0.05f, 0.07f, 0.12f, 1}}}, {{{1, 0}}}};
    const VkRenderPassBeginInfo begin{
        VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO, nullptr, pass_, framebuffer_, {{0, 0}, kExtent}, 2, clears};
    vkCmdBeginRenderPass(commands_, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
    for (const TextbookDraw& draw : scene.draws) {
      const Buffer vertices = buffer(draw.vertices.size() * sizeof(TextbookVertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
      std::memcpy(vertices.data, draw.vertices.data(), draw.vertices.size() * sizeof(TextbookVertex));
      const VkDeviceSize zero = 0;
      vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(draw));
      vkCmdBindVertexBuffers(commands_, 0, 1, &vertices.handle, &zero);
      vkCmdDraw(commands_, static_cast<std::uint32_t>(draw.vertices.size()), 1, 0, 0);
    }
    vkCmdEndRenderPass(commands_);
    const std::size_t bytes = std::size_t{4} * kExtent.width * kExtent.height;
    const Buffer pixels = buffer(bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkBufferImageCopy copy{
        0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 0, 0}, {kExtent.width, kExtent.height, 1}};
    vkCmdCopyImageToBuffer(commands_, color_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle, 1, &copy);
    REQUIRE(vkEndCommandBuffer(commands_));
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    REQUIRE(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE));
    REQUIRE(vkQueueWaitIdle(queue_));
    const auto* first = static_cast<const unsigned char*>(pixels.data);
    return {first, first + bytes};
  }

 private:
  VkDeviceMemory allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
    std::uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           (!(requirements.memoryTypeBits >> type & 1) || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
      ++type;
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, requirements.size, type};
    VkDeviceMemory result;
    REQUIRE(vkAllocateMemory(device_, &info, nullptr, &result));
    return result;
  }

  Buffer buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = usage;
    Buffer result;
    REQUIRE(vkCreateBuffer(device_, &info, nullptr, &result.handle));
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device_, result.handle, &requirements);
    const VkDeviceMemory memory =
        allocate(requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    REQUIRE(vkBindBufferMemory(device_, result.handle, memory, 0));
    REQUIRE(vkMapMemory(device_, memory, 0, size, 0, &result.data));
    return result;
  }

  Image image(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    Image result;
    REQUIRE(vkCreateImage(device_, &info, nullptr, &result.handle));
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device_, result.handle, &requirements);
    REQUIRE(vkBindImageMemory(device_, result.handle, allocate(requirements, 0), 0));
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = result.handle;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    REQUIRE(vkCreateImageView(device_, &view, nullptr, &result.view));
    return result;
  }

  void create_pass() {
    color_ = image(kColorFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                   VK_IMAGE_ASPECT_COLOR_BIT);
    const Image depth =
        image(kDepthFormat, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
    VkAttachmentDescription attachments[2]{};
    attachments[0].format = kColorFormat;
    attachments[0].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    attachments[1].format = kDepthFormat;
    attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    for (VkAttachmentDescription& attachment : attachments) {
      attachment.samples = VK_SAMPLE_COUNT_1_BIT;
      attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    }
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth_reference{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth_reference;
    const VkSubpassDependency dependency{0,
                                         VK_SUBPASS_EXTERNAL,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT,
                                         0};
    const VkRenderPassCreateInfo pass{
        VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO, nullptr, 0, 2, attachments, 1, &subpass, 1, &dependency};
    REQUIRE(vkCreateRenderPass(device_, &pass, nullptr, &pass_));
    const VkImageView views[2] = {color_.view, depth.view};
    const VkFramebufferCreateInfo framebuffer{
        VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO, nullptr, 0, pass_, 2, views, kExtent.width, kExtent.height, 1};
    REQUIRE(vkCreateFramebuffer(device_, &framebuffer, nullptr, &framebuffer_));
  }

  void barrier(VkImage handle, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                      nullptr,
                                      VK_ACCESS_TRANSFER_WRITE_BIT,
                                      VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
                                      from,
                                      to,
                                      VK_QUEUE_FAMILY_IGNORED,
                                      VK_QUEUE_FAMILY_IGNORED,
                                      handle,
                                      {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &change);
  }

  void create_texture() {
    const std::vector<unsigned char> texels = textbook_texels();
    const Buffer staging = buffer(texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    std::memcpy(staging.data, texels.data(), texels.size());
    const Image texture =
        image(kColorFormat, {kTextureSize, kTextureSize}, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
              VK_IMAGE_ASPECT_COLOR_BIT);
    barrier(texture.handle, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy copy{
        0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 0, 0}, {kTextureSize, kTextureSize, 1}};
    vkCmdCopyBufferToImage(commands_, staging.handle, texture.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    barrier(texture.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    VkSamplerCreateInfo sampling{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampling.magFilter = sampling.minFilter = VK_FILTER_LINEAR;
    sampling.addressModeU = sampling.addressModeV = sampling.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkSampler sampler;
    REQUIRE(vkCreateSampler(device_, &sampling, nullptr, &sampler));
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    const VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, 1,
                                                   &binding};
    VkDescriptorSetLayout set_layout;
    REQUIRE(vkCreateDescriptorSetLayout(device_, &set_info, nullptr, &set_layout));
    const VkPipelineLayoutCreateInfo layout{
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout, 0, nullptr};
    REQUIRE(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_));
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size};
    VkDescriptorPool pool;
    REQUIRE(vkCreateDescriptorPool(device_, &pool_info, nullptr, &pool));
    const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1,
                                               &set_layout};
    REQUIRE(vkAllocateDescriptorSets(device_, &allocate, &set_));
    const VkDescriptorImageInfo sampled{sampler, texture.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &sampled;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  }

  template <std::size_t N>
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, const std::uint32_t (&words)[N],
                                        const VkSpecializationInfo* special) {
    const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, sizeof words, words};
    VkShaderModule module;
    REQUIRE(vkCreateShaderModule(device_, &info, nullptr, &module));
    return {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, bit, module, "main", special};
  }

  VkPipeline pipeline(const TextbookDraw& draw) {
    const TextbookState state(draw);
    const VkPipelineShaderStageCreateInfo stages[2] = {
        stage(VK_SHADER_STAGE_VERTEX_BIT, textbook_vert, nullptr),
        stage(VK_SHADER_STAGE_FRAGMENT_BIT, textbook_frag, &state.special)};
    const VkVertexInputBindingDescription binding{0, sizeof(TextbookVertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[3] = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                                                             {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
                                                             {2, 0, VK_FORMAT_R32G32_SFLOAT, 32}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &binding;
    input.vertexAttributeDescriptionCount = 3;
    input.pVertexAttributeDescriptions = attributes;
    const VkRect2D everything{{0, 0}, kExtent};
    const VkPipelineViewportStateCreateInfo viewport{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, nullptr, 0, 1, &draw.viewport, 1, &everything};
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &state.blend;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &state.assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &state.raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &state.depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    info.renderPass = pass_;
    VkPipeline result;
    REQUIRE(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &result));
    return result;
  }

  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Image color_;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

void write_magnified(const char* path, const std::vector<unsigned char>& pixels) {
  std::vector<unsigned char> large(pixels.size() * kZoom * kZoom);
  const std::uint32_t width = kExtent.width * kZoom;
  for (std::uint32_t y = 0; y < kExtent.height * kZoom; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      std::memcpy(&large[(std::size_t{y} * width + x) * 4],
                  &pixels[(std::size_t{y / kZoom} * kExtent.width + x / kZoom) * 4], 4);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = kExtent.height * kZoom;
  image.format = PNG_FORMAT_RGBA;
  if (!png_image_write_to_file(&image, path, 0, large.data(), 0, nullptr))
    throw std::runtime_error(std::string("cannot write ") + path + ": " + image.message);
}

int run(int argc, char** argv) {
  const std::vector<TextbookScene> scenes = textbook_scenes();
  for (const TextbookScene& scene : scenes) {
    if (argc == 1) std::printf("%-16s %s\n", scene.name.c_str(), scene.title.c_str());
    if (argc != 3 || scene.name != argv[1]) continue;
    Textbook textbook;
    write_magnified(argv[2], textbook.draw(scene));
    std::printf("%s: %s\n", argv[2], scene.title.c_str());
    return 0;
  }
  if (argc == 1) return 0;
  std::fprintf(stderr, "usage: %s [NAME FILE.png]; without arguments the names are listed\n", argv[0]);
  return 2;
}

}  // namespace
}  // namespace vitrine::demo

int main(int argc, char** argv) {
  try {
    return vitrine::demo::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
