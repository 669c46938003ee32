// The demo picture: a lit, textured torus knot over a floor, drawn off screen through the Vulkan loader on whatever
// device it offers first, and written as a PNG. Usage: vitrine_demo FILE.png [WIDTH HEIGHT]
#include <png.h>
#include <vulkan/vulkan.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/demo/scene_frag.h"
#include "tests/demo/scene_vert.h"

namespace {

using Clock = std::chrono::steady_clock;

void require(VkResult result, const char* what) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(what) + " failed: " + std::to_string(result));
}

struct Vec3 {
  float x, y, z;
};
Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec3 normalized(Vec3 v) {
  const float length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

struct Vertex {
  Vec3 position;
  Vec3 normal;
  float u, v;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

Vec3 knot_point(float t) {
  const float r = 1.6f + 0.6f * std::cos(3 * t);
  return {r * std::cos(2 * t), 0.75f * std::sin(3 * t) + 1.5f, r * std::sin(2 * t)};
}

/// A tube along the (2,3) torus knot.
Mesh make_knot(std::uint32_t rings, std::uint32_t sides) {
  constexpr float kTau = 6.2831853f;
  Mesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    const float t = kTau * static_cast<float>(i) / static_cast<float>(rings);
    const Vec3 center = knot_point(t);
    const Vec3 tangent = normalized(knot_point(t + 0.01f) - knot_point(t - 0.01f));
    const Vec3 side = normalized(cross(tangent, {0, 1, 0}));
    const Vec3 up = cross(side, tangent);
    for (std::uint32_t j = 0; j <= sides; ++j) {
      const float a = kTau * static_cast<float>(j) / static_cast<float>(sides);
      const float c = std::cos(a), s = std::sin(a);
      const Vec3 n{side.x * c + up.x * s, side.y * c + up.y * s, side.z * c + up.z * s};
      const Vec3 p{center.x + 0.34f * n.x, center.y + 0.34f * n.y, center.z + 0.34f * n.z};
      mesh.vertices.push_back({p, n, 24 * static_cast<float>(i) / static_cast<float>(rings),
                               3 * static_cast<float>(j) / static_cast<float>(sides)});
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t a = i * (sides + 1) + j, b = a + sides + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
  return mesh;
}

void append_floor(Mesh& mesh, float half, float y) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, z] : {std::pair{-half, -half}, {half, -half}, {-half, half}, {half, half}}) {
    mesh.vertices.push_back({{x, y, z}, {0, 1, 0}, x, z});
  }
  for (const std::uint32_t i : {0u, 2u, 1u, 1u, 2u, 3u}) mesh.indices.push_back(first + i);
}

using Matrix = std::array<float, 16>;  // column major

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix r{};
  for (int c = 0; c < 4; ++c)
    for (int row = 0; row < 4; ++row)
      for (int k = 0; k < 4; ++k) r[c * 4 + row] += a[k * 4 + row] * b[c * 4 + k];
  return r;
}

Matrix look_at(Vec3 eye, Vec3 target) {
  const Vec3 f = normalized(target - eye), s = normalized(cross(f, {0, 1, 0})), u = cross(s, f);
  return {s.x, u.x, -f.x, 0, s.y, u.y, -f.y, 0, s.z, u.z, -f.z, 0, -dot(s, eye), -dot(u, eye), dot(f, eye), 1};
}

Matrix perspective(float fov, float aspect, float near, float far) {
  const float f = 1 / std::tan(fov / 2);
  return {f / aspect, 0, 0, 0, 0, -f, 0, 0, 0, 0, far / (near - far), -1, 0, 0, near * far / (near - far), 0};
}

struct CameraBlock {
  Matrix view_projection;
  float eye[4];
  float lights[3][4];
  float light_colors[3][4];
};

struct Material {
  float tint[4];
  float gloss;
};

class Demo {
 public:
  Demo(std::uint32_t width, std::uint32_t height) : extent_{width, height} {}

  void run(const char* path) {
    const auto start = Clock::now();
    create_device();
    create_targets();
    create_mesh();
    create_texture();
    create_pipeline();
    const auto ready = Clock::now();
    draw();
    const auto first = Clock::now();
    draw();
    const auto second = Clock::now();
    write_png(path);
    const auto ms = [](auto from, auto to) { return std::chrono::duration<double, std::milli>(to - from).count(); };
    std::printf("%s: %u x %u, %zu triangles; setup %.1f ms, first frame %.1f ms, next frame %.1f ms -> %s\n",
                name_.c_str(), extent_.width, extent_.height, index_count_ / 3, ms(start, ready), ms(ready, first),
                ms(first, second), path);
  }

 private:
  struct Buffer {
    VkBuffer buffer;
    void* data;
  };
  struct Image {
    VkImage image;
    VkImageView view;
  };

  void create_device() {
    const VkApplicationInfo application{
        VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "vitrine demo", 1, nullptr, 0, VK_API_VERSION_1_0};
    VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    instance_info.pApplicationInfo = &application;
    VkInstance instance;
    require(vkCreateInstance(&instance_info, nullptr, &instance), "vkCreateInstance");
    std::uint32_t count = 1;
    const VkResult listed = vkEnumeratePhysicalDevices(instance, &count, &physical_);
    if (listed < 0 || count == 0) throw std::runtime_error("no Vulkan device");
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical_, &properties);
    name_ = properties.deviceName;
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    device_info.queueCreateInfoCount = 1;
    device_info.pQueueCreateInfos = &queue_info;
    require(vkCreateDevice(physical_, &device_info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, 0, 0, &queue_);
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandPool pool;
    require(vkCreateCommandPool(device_, &pool_info, nullptr, &pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                         VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    pool_ = pool;
    require(vkAllocateCommandBuffers(device_, &allocate, &setup_), "vkAllocateCommandBuffers");
    require(vkAllocateCommandBuffers(device_, &allocate, &frame_), "vkAllocateCommandBuffers");
  }

  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties properties;
    vkGetPhysicalDeviceMemoryProperties(physical_, &properties);
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
      if ((allowed >> i & 1) && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    throw std::runtime_error("no memory type");
  }

  VkDeviceMemory allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted) {
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, requirements.size,
                                    memory_type(requirements.memoryTypeBits, wanted)};
    VkDeviceMemory memory;
    require(vkAllocateMemory(device_, &info, nullptr, &memory), "vkAllocateMemory");
    return memory;
  }

  Buffer create_buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = usage;
    Buffer result{};
    require(vkCreateBuffer(device_, &info, nullptr, &result.buffer), "vkCreateBuffer");
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device_, result.buffer, &requirements);
    const VkDeviceMemory memory =
        allocate(requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    require(vkBindBufferMemory(device_, result.buffer, memory, 0), "vkBindBufferMemory");
    require(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &result.data), "vkMapMemory");
    return result;
  }

  Image create_image(VkFormat format, VkExtent2D extent, std::uint32_t levels, VkImageUsageFlags usage,
                     VkImageAspectFlags aspect, VkSampleCountFlagBits samples) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = levels;
    info.arrayLayers = 1;
    info.samples = samples;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    Image result{};
    require(vkCreateImage(device_, &info, nullptr, &result.image), "vkCreateImage");
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device_, result.image, &requirements);
    require(vkBindImageMemory(device_, result.image, allocate(requirements, 0), 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = result.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect, 0, levels, 0, 1};
    require(vkCreateImageView(device_, &view, nullptr, &result.view), "vkCreateImageView");
    return result;
  }

  void create_targets() {
    color_ = create_image(VK_FORMAT_R8G8B8A8_SRGB, extent_, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT, VK_SAMPLE_COUNT_4_BIT);
    depth_ = create_image(VK_FORMAT_D32_SFLOAT, extent_, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                          VK_IMAGE_ASPECT_DEPTH_BIT, VK_SAMPLE_COUNT_4_BIT);
    resolved_ = create_image(VK_FORMAT_R8G8B8A8_SRGB, extent_, 1,
                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                             VK_IMAGE_ASPECT_COLOR_BIT, VK_SAMPLE_COUNT_1_BIT);
    readback_ = create_buffer(VkDeviceSize{extent_.width} * extent_.height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);

    std::array<VkAttachmentDescription, 3> attachments{};
    attachments[0] = {0,
                      VK_FORMAT_R8G8B8A8_SRGB,
                      VK_SAMPLE_COUNT_4_BIT,
                      VK_ATTACHMENT_LOAD_OP_CLEAR,
                      VK_ATTACHMENT_STORE_OP_DONT_CARE,
                      VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                      VK_ATTACHMENT_STORE_OP_DONT_CARE,
                      VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    attachments[1] = attachments[0];
    attachments[1].format = VK_FORMAT_D32_SFLOAT;
    attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    attachments[2] = {0,
                      VK_FORMAT_R8G8B8A8_SRGB,
                      VK_SAMPLE_COUNT_1_BIT,
                      VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                      VK_ATTACHMENT_STORE_OP_STORE,
                      VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                      VK_ATTACHMENT_STORE_OP_DONT_CARE,
                      VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference resolve{2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pResolveAttachments = &resolve;
    subpass.pDepthStencilAttachment = &depth;
    const VkSubpassDependency to_transfer{0,
                                          VK_SUBPASS_EXTERNAL,
                                          VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                          VK_PIPELINE_STAGE_TRANSFER_BIT,
                                          VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                          VK_ACCESS_TRANSFER_READ_BIT,
                                          0};
    VkRenderPassCreateInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    pass.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    pass.pAttachments = attachments.data();
    pass.subpassCount = 1;
    pass.pSubpasses = &subpass;
    pass.dependencyCount = 1;
    pass.pDependencies = &to_transfer;
    require(vkCreateRenderPass(device_, &pass, nullptr, &render_pass_), "vkCreateRenderPass");
    const std::array<VkImageView, 3> views{color_.view, depth_.view, resolved_.view};
    VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebuffer.renderPass = render_pass_;
    framebuffer.attachmentCount = static_cast<std::uint32_t>(views.size());
    framebuffer.pAttachments = views.data();
    framebuffer.width = extent_.width;
    framebuffer.height = extent_.height;
    framebuffer.layers = 1;
    require(vkCreateFramebuffer(device_, &framebuffer, nullptr, &framebuffer_), "vkCreateFramebuffer");
  }

  void create_mesh() {
    Mesh mesh = make_knot(600, 40);
    knot_indices_ = static_cast<std::uint32_t>(mesh.indices.size());
    append_floor(mesh, 24, -0.1f);
    index_count_ = mesh.indices.size();
    vertices_ = create_buffer(mesh.vertices.size() * sizeof(Vertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    std::memcpy(vertices_.data, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vertex));
    indices_ = create_buffer(mesh.indices.size() * 4, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    std::memcpy(indices_.data, mesh.indices.data(), mesh.indices.size() * 4);

    const Vec3 eye{3.9f, 3.4f, 4.3f};
    CameraBlock block{};
    block.view_projection = multiply(
        perspective(0.85f, static_cast<float>(extent_.width) / static_cast<float>(extent_.height), 0.1f, 100.0f),
        look_at(eye, {0, 1.25f, 0}));
    const float lights[3][8] = {
        {3, 5, 2, 1, 9.0f, 8.2f, 7.0f, 1}, {-4, 3, 1, 1, 1.5f, 3.5f, 8.0f, 1}, {0.5f, 2, -4, 1, 8.0f, 2.0f, 3.0f, 1}};
    for (int i = 0; i < 3; ++i) {
      std::memcpy(block.lights[i], lights[i], 16);
      std::memcpy(block.light_colors[i], lights[i] + 4, 16);
    }
    block.eye[0] = eye.x, block.eye[1] = eye.y, block.eye[2] = eye.z;
    camera_ = create_buffer(sizeof(block), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    std::memcpy(camera_.data, &block, sizeof(block));
  }

  /// A brick-and-checker pattern whose mip chain the device makes with blits.
  void create_texture() {
    constexpr std::uint32_t kSize = 256, kLevels = 9;
    texture_ =
        create_image(VK_FORMAT_R8G8B8A8_SRGB, {kSize, kSize}, kLevels,
                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                     VK_IMAGE_ASPECT_COLOR_BIT, VK_SAMPLE_COUNT_1_BIT);
    const Buffer staging = create_buffer(kSize * kSize * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    auto* texel = static_cast<std::uint8_t*>(staging.data);
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x, texel += 4) {
        const bool light = ((x / 128) ^ (y / 128)) != 0;
        const bool groove = x % 64 < 3 || y % 64 < 3;
        const std::uint32_t grain = (x * 2654435761u ^ y * 40503u * 65537u) >> 27;
        const std::uint32_t value = groove ? 60 : (light ? 205 : 130) + grain;
        texel[0] = static_cast<std::uint8_t>(value);
        texel[1] = static_cast<std::uint8_t>(value - (light ? 10 : 25));
        texel[2] = static_cast<std::uint8_t>(value - (light ? 30 : 15));
        texel[3] = 255;
      }
    }
    begin(setup_);
    move_levels(0, kLevels, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy copy{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 0, 0}, {kSize, kSize, 1}};
    vkCmdCopyBufferToImage(setup_, staging.buffer, texture_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    for (std::uint32_t level = 1; level < kLevels; ++level) {
      move_levels(level - 1, 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      const auto size = [](std::uint32_t l) { return static_cast<std::int32_t>(kSize >> l); };
      VkImageBlit blit{};
      blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
      blit.srcOffsets[1] = {size(level - 1), size(level - 1), 1};
      blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
      blit.dstOffsets[1] = {size(level), size(level), 1};
      vkCmdBlitImage(setup_, texture_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, texture_.image,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    }
    move_levels(0, kLevels - 1, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    move_levels(kLevels - 1, 1, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    submit(setup_);

    VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    sampler.maxLod = VK_LOD_CLAMP_NONE;
    require(vkCreateSampler(device_, &sampler, nullptr, &sampler_), "vkCreateSampler");
  }

  void move_levels(std::uint32_t first, std::uint32_t count, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = texture_.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, first, count, 0, 1};
    vkCmdPipelineBarrier(setup_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
  }

  template <std::size_t N>
  VkShaderModule shader_module(const std::uint32_t (&words)[N]) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = sizeof(words);
    info.pCode = words;
    VkShaderModule module;
    require(vkCreateShaderModule(device_, &info, nullptr, &module), "vkCreateShaderModule");
    return module;
  }

  void create_descriptors() {
    const std::array<VkDescriptorSetLayoutBinding, 2> bindings{
        {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
         {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}}};
    VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layout.bindingCount = 2;
    layout.pBindings = bindings.data();
    VkDescriptorSetLayout set_layout;
    require(vkCreateDescriptorSetLayout(device_, &layout, nullptr, &set_layout), "vkCreateDescriptorSetLayout");
    const VkPushConstantRange range{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Material)};
    VkPipelineLayoutCreateInfo pipeline_layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    pipeline_layout.setLayoutCount = 1;
    pipeline_layout.pSetLayouts = &set_layout;
    pipeline_layout.pushConstantRangeCount = 1;
    pipeline_layout.pPushConstantRanges = &range;
    require(vkCreatePipelineLayout(device_, &pipeline_layout, nullptr, &layout_), "vkCreatePipelineLayout");
    const std::array<VkDescriptorPoolSize, 2> sizes{
        {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}}};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1;
    pool.poolSizeCount = 2;
    pool.pPoolSizes = sizes.data();
    VkDescriptorPool descriptor_pool;
    require(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptor_pool), "vkCreateDescriptorPool");
    const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, descriptor_pool,
                                               1, &set_layout};
    require(vkAllocateDescriptorSets(device_, &allocate, &set_), "vkAllocateDescriptorSets");
    const VkDescriptorBufferInfo buffer{camera_.buffer, 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo image{sampler_, texture_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    std::array<VkWriteDescriptorSet, 2> writes{};
    writes[0] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set_,    0,      0, 1,
                 VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,      nullptr, &buffer, nullptr};
    writes[1] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,    nullptr, set_,    1,      0, 1,
                 VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, &image,  nullptr, nullptr};
    vkUpdateDescriptorSets(device_, 2, writes.data(), 0, nullptr);
  }

  void create_pipeline() {
    create_descriptors();
    const std::array<VkPipelineShaderStageCreateInfo, 2> stages{
        {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_VERTEX_BIT,
          shader_module(scene_vert), "main", nullptr},
         {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_FRAGMENT_BIT,
          shader_module(scene_frag), "main", nullptr}}};
    const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const std::array<VkVertexInputAttributeDescription, 3> attributes{{{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                                                       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12},
                                                                       {2, 0, VK_FORMAT_R32G32_SFLOAT, 24}}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &binding;
    input.vertexAttributeDescriptionCount = 3;
    input.pVertexAttributeDescriptions = attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent_};
    const VkPipelineViewportStateCreateInfo viewports{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, nullptr, 0, 1, &viewport, 1, &scissor};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_4_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState write{};
    write.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &write;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewports;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    info.renderPass = render_pass_;
    require(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
            "vkCreateGraphicsPipelines");
    record();
  }

  void record() {
    begin(frame_);
    std::array<VkClearValue, 2> clear{};
    clear[0].color = {{0.05f, 0.07f, 0.12f, 1}};
    clear[1].depthStencil = {1, 0};
    const VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                     nullptr,
                                     render_pass_,
                                     framebuffer_,
                                     {{0, 0}, extent_},
                                     2,
                                     clear.data()};
    vkCmdBeginRenderPass(frame_, &pass, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(frame_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    vkCmdBindDescriptorSets(frame_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
    const VkDeviceSize zero = 0;
    vkCmdBindVertexBuffers(frame_, 0, 1, &vertices_.buffer, &zero);
    vkCmdBindIndexBuffer(frame_, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    const Material knot{{1.0f, 0.72f, 0.35f, 1}, 48}, floor{{0.55f, 0.6f, 0.7f, 1}, 12};
    vkCmdPushConstants(frame_, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(knot), &knot);
    vkCmdDrawIndexed(frame_, knot_indices_, 1, 0, 0, 0);
    vkCmdPushConstants(frame_, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(floor), &floor);
    vkCmdDrawIndexed(frame_, static_cast<std::uint32_t>(index_count_) - knot_indices_, 1, knot_indices_, 0, 0);
    vkCmdEndRenderPass(frame_);
    const VkBufferImageCopy copy{
        0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 0, 0}, {extent_.width, extent_.height, 1}};
    vkCmdCopyImageToBuffer(frame_, resolved_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback_.buffer, 1, &copy);
    require(vkEndCommandBuffer(frame_), "vkEndCommandBuffer");
  }

  static void begin(VkCommandBuffer commands) {
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    require(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
  }

  void submit(VkCommandBuffer commands) {
    if (commands == setup_) require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    require(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
    require(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
  }

  void draw() { submit(frame_); }

  void write_png(const char* path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = extent_.width;
    image.height = extent_.height;
    image.format = PNG_FORMAT_RGBA;
    if (!png_image_write_to_file(&image, path, 0, readback_.data, 0, nullptr)) {
      throw std::runtime_error(std::string("cannot write ") + path + ": " + image.message);
    }
  }

  VkExtent2D extent_;
  std::string name_;
  VkPhysicalDevice physical_{};
  VkDevice device_{};
  VkQueue queue_{};
  VkCommandPool pool_{};
  VkCommandBuffer setup_{}, frame_{};
  Image color_{}, depth_{}, resolved_{}, texture_{};
  Buffer readback_{}, vertices_{}, indices_{}, camera_{};
  VkRenderPass render_pass_{};
  VkFramebuffer framebuffer_{};
  VkSampler sampler_{};
  VkPipelineLayout layout_{};
  VkDescriptorSet set_{};
  VkPipeline pipeline_{};
  std::uint32_t knot_indices_ = 0;
  std::size_t index_count_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::fprintf(stderr, "usage: %s FILE.png [WIDTH HEIGHT]\n", argv[0]);
    return 2;
  }
  const auto size = [&](int index, unsigned long fallback) {
    return static_cast<std::uint32_t>(argc == 4 ? std::strtoul(argv[index], nullptr, 10) : fallback);
  };
  try {
    Demo(size(2, 1280), size(3, 720)).run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
  return 0;
}
