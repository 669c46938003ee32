// What the modules of others get bound: random contents for every descriptor and push constant.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cases/modules/reflect.h"
#include "harness/run.h"

namespace vitrine::cts {

/// Everything bound, and what the shader may have written.
struct Bound {
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::vector<std::pair<uint32_t, VkDescriptorSet>> sets;
  std::vector<std::pair<std::string, Buffer>> buffers;
  std::vector<std::pair<std::string, Image>> images;
  std::vector<unsigned char> push;
  uint32_t image_scale = 1;  ///< storage images are 64 times as wide and high

  void bind(VkCommandBuffer cmd, VkPipelineBindPoint point) const;
  void out(Run& run) const;
};

Bound bind_everything(Run& run, const Reflection& r, uint32_t image_scale = 1);

}  // namespace vitrine::cts
