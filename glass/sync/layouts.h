// The layouts that images have, subresource by subresource, as commands run.
#pragma once

#include <vulkan/vulkan_core.h>

#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

namespace vitrine::glass::sync {

/// An image, and a part of it with counts resolved.
struct ImagePart {
  const void* image = nullptr;
  std::uint32_t image_levels = 1, image_layers = 1;
  VkImageSubresourceRange range{};
};

/// Any thread.
class Layouts {
 public:
  /// A layout of the part that is not this one; none: all of it has it. Contents that are given up have any.
  std::optional<VkImageLayout> other_than(const ImagePart& part, VkImageLayout layout);
  void set(const ImagePart& part, VkImageLayout layout);
  /// Others may give the image a layout: it has any from now on.
  void share(const void* image);
  void forget(const void* image);

 private:
  template <class F>
  void for_each(const ImagePart& part, F&& f);
  std::mutex mutex_;  ///< images are destroyed on other threads than commands run
  std::set<const void*> shared_;
  std::map<const void*, std::vector<VkImageLayout>> layouts_;  ///< stencil behind the rest, by level and layer
};

}  // namespace vitrine::glass::sync
