// One run of the API's fuzzer: resources, pipelines and commands that are valid usage, over data that is hostile.
// Memory is imported from the heap, block by block, so that AddressSanitizer sees every access beside a buffer or an
// image.
#pragma once

#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

#include "tests/fuzz/api_world.h"
#include "tests/fuzz/choices.h"

namespace vitrine::fuzz {

/// A function of the driver, in Run.
#define VK_CALL(name) VK_GET(w_.instance, name)

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  std::uint32_t* words = nullptr;
};

struct Picture {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkExtent3D extent{};
  std::uint32_t levels = 1, layers = 1;
};

/// Everything of one run; destroyed with it.
class Run {
 public:
  explicit Run(Choices& choices) : c_(choices), w_(world()) {}
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// False: the device is lost.
  bool go();

 private:
  /// Heap memory of whole pages; what is bound lies at its end, so that a byte beyond is beyond the block.
  VkDeviceMemory import(std::size_t bytes, void*& data);

  Buffer make_buffer();

  Picture make_image(VkFormat format, VkExtent3D extent, std::uint32_t levels, std::uint32_t layers,
                     VkImageUsageFlags usage, VkImageAspectFlags aspects, VkSampleCountFlagBits samples);

  std::uint32_t side() { return c_.one_in(4) ? c_.between(1, 5) : c_.between(1, 150); }

  void make_images();

  Buffer& some_buffer() { return buffers_[c_.below(static_cast<std::uint32_t>(buffers_.size()))]; }
  /// A multiple of `step` at which `bytes` more lie in the buffer.
  VkDeviceSize offset_in(const Buffer& buffer, VkDeviceSize bytes, VkDeviceSize step);

  void make_set();

  void make_sampler();

  void write_descriptor(std::uint32_t binding);

  static VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, VkShaderModule module);
  VkShaderModule one_of(const std::vector<VkShaderModule>& list);

  void make_graphics();

  bool has_stencil() const;

  void make_compute();

  void record();

  void render();

  void draw();

  /// Parameters from a buffer: all but the numbers of vertices and instances, which only cost time, are hostile.
  void draw_indirect(std::uint32_t count, std::uint32_t copies);

  /// Where the next parameters of an indirect command stand; the buffer's size: there is no more room. Nothing else
  /// writes to that buffer.
  VkDeviceSize take_parameters(VkDeviceSize bytes);

  void dispatch();

  void transfer();

  Choices& c_;
  World& w_;
  std::vector<std::unique_ptr<void, Free>> blocks_;
  std::vector<VkDeviceMemory> memories_;
  std::array<Buffer, 4> buffers_{};
  Buffer parameters_;  ///< of indirect commands
  VkDeviceSize used_parameters_ = 0;
  Picture target_, depth_, picture_, canvas_;
  std::array<VkBufferView, 2> texels_{};
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  VkPipeline graphics_ = VK_NULL_HANDLE, compute_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkSampleCountFlagBits samples_ = VK_SAMPLE_COUNT_1_BIT;
  std::uint32_t layers_ = 1;
};

}  // namespace vitrine::fuzz
