// A device beside the suite's own, with one more extension: for extensions that change what a device does as soon as
// they are enabled.
#pragma once

#include <algorithm>

#include "harness/run.h"

namespace vitrine::cts {

inline bool offers_extension(const Gpu& gpu, const char* name) {
  return std::find(gpu.offered.begin(), gpu.offered.end(), name) != gpu.offered.end();
}

/// A device like the run's, with the extension.
struct OwnDevice {
  Gpu gpu;
  OwnDevice(const Gpu& like, const char* extension) : gpu(like) {
    gpu.device = VK_NULL_HANDLE;
    gpu.extensions.push_back(extension);
    recreate(gpu);
    take_validation_errors();  // of the extension lists, as for the suite's own devices
  }
  OwnDevice(const OwnDevice&) = delete;
  ~OwnDevice() { vkDestroyDevice(gpu.device, nullptr); }
};

}  // namespace vitrine::cts
