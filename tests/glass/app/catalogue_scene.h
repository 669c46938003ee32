// The scene of the catalogues (tests/glass/scene.h) as Vulkan objects: what its shaders find in set 0 and in push
// constants.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace catalogue {

inline void must(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "%s: VkResult %d\n", what, result);
  std::exit(3);
}

struct Device {
  VkInstance instance{};
  VkPhysicalDevice physical{};
  VkDevice device{};
  VkQueue queue{};
};

/// With all features that there are.
Device make_device();

inline constexpr std::uint32_t kBindings = 13;
inline constexpr VkDeviceSize kBytes = 64 * 4;
inline constexpr std::uint32_t kPixels = 8;

struct Buffer {
  VkBuffer buffer{};
  VkDeviceMemory memory{};
};
struct Image {
  VkImage image{};
  VkDeviceMemory memory{};
  VkImageView view{};
};

/// Everything is new for each shader, as memory that nothing has written is no more once something has.
class Scene {
 public:
  explicit Scene(const Device& device);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  VkPipelineLayout layout{};
  VkImageView target() const { return target_.view; }
  /// Writes what the scene has written, and brings images into VK_IMAGE_LAYOUT_GENERAL.
  void fill(VkCommandBuffer commands) const;
  /// For shaders at this point.
  void bind(VkCommandBuffer commands, VkPipelineBindPoint point) const;

 private:
  Buffer make_buffer(VkBufferUsageFlags usage, VkDeviceSize room = kBytes);
  Image make_image(VkFormat format, VkImageViewType type, std::uint32_t levels, std::uint32_t layers,
                   VkImageUsageFlags usage, VkExtent2D extent = {4, 4});
  void make_layouts();
  void make_set();
  void write_buffers(VkBuffer gone);
  void write_images();
  void write(std::uint32_t binding, VkDescriptorType type, const std::vector<VkDescriptorImageInfo>& images,
             const std::vector<VkDescriptorBufferInfo>& buffers);
  void make_addresses();

  const Device& d_;
  Buffer words_, other_, fresh_, texels_, rows_, memory_;
  Image flat_, layered_, floats_, fresh_image_, target_;
  VkBufferView texel_view_{};
  VkSampler sampler_{};
  VkDescriptorSetLayout set_layout_{};
  VkDescriptorPool pool_{};
  VkDescriptorSet set_{};
  std::array<std::uint32_t, 5> push_{};
  std::vector<Buffer> buffers_;
  std::vector<Image> images_;
};

}  // namespace catalogue
