// The features and extensions that replay turns on: all that the device has of those that shaders and state can ask
// for.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "glass/bug/bug.h"

namespace vitrine::glass::replayer {

class Features {
 public:
  Features(VkPhysicalDevice device, const bug::Bug& bug);
  ~Features();
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;

  /// For VkDeviceCreateInfo; lives as long as this.
  const void* chain() const;
  /// What the bug's state needs and the device lacks; null: nothing.
  const char* missing(const bug::Bug& bug) const;
  /// bufferDeviceAddressCaptureReplay.
  bool addresses_again() const;
  const std::vector<const char*>& extensions() const { return extensions_; }

 private:
  struct Structures;
  void add_extensions(VkPhysicalDevice device, const bug::Bug& bug);

  std::unique_ptr<Structures> structures_;
  std::vector<const char*> extensions_;
};

}  // namespace vitrine::glass::replayer
