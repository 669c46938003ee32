// What descriptors name that is gone when the command runs.
#pragma once

#include "glass/replayer/device.h"

namespace vitrine::glass::replayer {

/// Something of the type, for as long as a descriptor is written: what is known of those that are gone.
class Departing {
 public:
  Departing(const Device& device, VkDescriptorType type);
  ~Departing();
  Departing(const Departing&) = delete;
  Departing& operator=(const Departing&) = delete;
  /// `write` points to `buffer` and `image`, and is for a descriptor of the type.
  void fill(VkDescriptorBufferInfo& buffer, VkDescriptorImageInfo& image, VkWriteDescriptorSet& write) const;

 private:
  void make_buffer();
  void make_image();

  static constexpr VkDeviceSize kSize = 256;
  const Device& d_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkBufferView texels_ = VK_NULL_HANDLE;
  VkImage image_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

}  // namespace vitrine::glass::replayer
