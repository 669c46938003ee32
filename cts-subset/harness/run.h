// One run of a case on one device: creates Vulkan objects that live until its end, and collects outputs.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/gpu.h"
#include "harness/inputs.h"
#include "harness/output.h"
#include "harness/random.h"

namespace vitrine::cts {

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  unsigned char* data = nullptr;  ///< mapped for the buffer's life; coherent

  template <typename T>
  T* as() const {
    return reinterpret_cast<T*>(data);
  }
};

struct ImageSpec {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  VkExtent3D extent{64, 64, 1};
  VkImageUsageFlags usage = 0;  ///< transfer source and destination are always added
  uint32_t levels = 1, layers = 1;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkImageViewType view = VK_IMAGE_VIEW_TYPE_2D;  ///< also decides the image type
  VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL;
  VkImageCreateFlags flags = 0;
  VkComponentMapping components{};
  const void* next = nullptr;  ///< pNext of the image's creation
};

/// An image in VK_IMAGE_LAYOUT_GENERAL with a view of everything.
struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  ImageSpec spec;

  VkExtent3D level_extent(uint32_t level) const;
  VkImageAspectFlags aspects() const { return aspects_of(spec.format); }
  VkImageSubresourceLayers layers(uint32_t level = 0) const { return {aspects(), level, 0, spec.layers}; }
  VkImageSubresourceRange range() const { return {aspects(), 0, spec.levels, 0, spec.layers}; }
};

/// One descriptor binding with what is bound there.
struct Binding {
  uint32_t binding;
  VkDescriptorType type;
  std::vector<VkDescriptorBufferInfo> buffers;
  std::vector<VkDescriptorImageInfo> images;
  std::vector<VkBufferView> views;
  bool immutable_samplers = false;  ///< the samplers of `images` are part of the layout
};
Binding storage_buffer(uint32_t binding, const Buffer& buffer);
Binding uniform_buffer(uint32_t binding, const Buffer& buffer);
Binding sampled(uint32_t binding, const Image& image, VkSampler sampler);
Binding storage_image(uint32_t binding, const Image& image);
Binding input_attachment(uint32_t binding, const Image& image);

/// A pipeline layout with one descriptor set, and push constants for all stages from offset 0.
struct Resources {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  void bind(VkCommandBuffer cmd, VkPipelineBindPoint point = VK_PIPELINE_BIND_POINT_GRAPHICS) const;
};

class Run {
 public:
  Run(Gpu& gpu, uint64_t seed, uint32_t index);
  ~Run();
  Run(const Run&) = delete;

  Gpu& gpu;
  VkDevice device;
  Random random;   ///< same seed on both devices
  uint32_t index;  ///< number within the random generator
  /// False: --mutate leaves the shaders as they are. What they do is undefined in SPIR-V, and equal to the reference's
  /// only as far as the case's own literals go.
  bool mutates = true;
  std::vector<Output> outputs;
  std::vector<std::pair<std::string, std::string>> notes;
  Inputs inputs;  ///< what the device is given

  /// Ends the run as unsupported unless the device claims what the case needs.
  void require(bool claimed, const char* what) const;

  Buffer buffer(VkDeviceSize size, VkBufferUsageFlags extra_usage = 0);
  template <typename T>
  Buffer buffer_of(const std::vector<T>& values) {
    const Buffer result = buffer(values.size() * sizeof(T));
    std::memcpy(result.data, values.data(), values.size() * sizeof(T));
    return result;
  }
  Image image(const ImageSpec& spec);
  VkImageView image_view(const Image& image, VkImageViewType type, VkFormat format, VkImageSubresourceRange range,
                         VkComponentMapping components = {});
  VkSampler sampler(const VkSamplerCreateInfo& info);
  VkSampler sampler(VkFilter filter, VkSamplerAddressMode mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  VkShaderModule shader(VkShaderStageFlagBits stage, const std::string& glsl);
  VkShaderModule module(const std::vector<uint32_t>& words);
  Resources resources(const std::vector<Binding>& bindings, uint32_t push_bytes = 0);
  VkPipeline compute(VkPipelineLayout layout, VkShaderModule module, const VkSpecializationInfo* special = nullptr);

  /// A primary command buffer, begun.
  VkCommandBuffer begin();
  VkCommandBuffer begin_secondary(const VkCommandBufferInheritanceInfo& inheritance, VkCommandBufferUsageFlags usage);
  /// Ends, submits and waits. Makes everything visible to the host.
  void submit(VkCommandBuffer cmd);
  /// Everything before is finished and visible to everything after.
  void barrier(VkCommandBuffer cmd);
  /// One command buffer from start to end.
  void once(const std::function<void(VkCommandBuffer)>& record);

  /// Binds a compute pipeline with its resources, dispatches workgroups, and waits.
  void dispatch(const Resources& resources, VkPipeline pipeline, uint32_t x, uint32_t y = 1, uint32_t z = 1);
  /// The same with push constants from offset 0.
  void dispatch(const Resources& resources, VkPipeline pipeline, uint32_t x, std::span<const std::byte> push);

  /// Fills a level (all layers, tightly packed) of one aspect of an image.
  void upload(const Image& image, uint32_t level, std::span<const unsigned char> bytes, VkImageAspectFlags aspect = 0);
  std::vector<unsigned char> download(const Image& image, uint32_t level, VkImageAspectFlags aspect = 0);
  /// Random bytes, such that floats are finite, over the whole image.
  void fill_random(const Image& image);

  /// Adds an output. Images: every level and layer, every aspect (multisampled: every sample).
  Output& out(const std::string& name, const Buffer& buffer, VkFormat format = VK_FORMAT_R32_UINT);
  void out(const std::string& name, const Image& image);
  Output& out(Output output);
  void out_samples(const std::string& name, const Image& image);
  void may_be_blank();
  /// Text written beside the pictures when the case fails (a generated shader, a state).
  void note(const std::string& name, const std::string& text) { notes.emplace_back(name, text); }

  /// Destroys at the end of the run, in reverse order.
  void defer(std::function<void()> destroy) { deferred_.push_back(std::move(destroy)); }
  template <typename T>
  T own(T handle, void(VKAPI_PTR* destroy)(VkDevice, T, const VkAllocationCallbacks*)) {
    defer([device = device, handle, destroy] { destroy(device, handle, nullptr); });
    return handle;
  }

 private:
  VkShaderModule create_module(const std::vector<uint32_t>& words);
  VkDeviceMemory allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted);
  std::vector<std::function<void()>> deferred_;
  std::vector<VkImageMemoryBarrier> pending_;  // first transitions of new images
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

/// Bytes of a level of one aspect, all layers, tightly packed.
VkDeviceSize level_bytes(const Image& image, uint32_t level, VkImageAspectFlags aspect);
/// The format that a copy of one aspect has in a buffer.
VkFormat aspect_format(VkFormat format, VkImageAspectFlags aspect);
/// Random texels of a format with finite, ordinary values.
std::vector<unsigned char> random_texels(Random& random, VkFormat format, size_t bytes);

}  // namespace vitrine::cts
