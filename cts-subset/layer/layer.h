// What the libraries in front of the loader share (layer/as_*.cpp): the loader's functions behind them, structures in
// chains, and how many pipelines they replaced.
#pragma once

#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace vitrine::layer {

/// The function that the application would have called.
template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}
#define NEXT(name) ::vitrine::layer::next<PFN_##name>(#name)

/// The structure of that type in a chain, or null.
template <class T>
const T* in_chain(const void* chain, VkStructureType type) {
  for (const auto* s = static_cast<const VkBaseInStructure*>(chain); s; s = s->pNext)
    if (s->sType == type) return reinterpret_cast<const T*>(s);
  return nullptr;
}

/// Of an array that may be null.
template <class T>
std::vector<T> copy(const T* first, uint32_t count) {
  return first ? std::vector<T>(first, first + count) : std::vector<T>();
}

inline bool offers(VkPhysicalDevice physical, const char* name) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> offered(count);
  vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, offered.data());
  return std::any_of(offered.begin(), offered.end(),
                     [&](const VkExtensionProperties& e) { return !std::strcmp(e.extensionName, name); });
}

/// The extensions that a device is made with, and more.
inline std::vector<const char*> names_with(const VkDeviceCreateInfo& info, std::initializer_list<const char*> more) {
  std::vector<const char*> names = copy(info.ppEnabledExtensionNames, info.enabledExtensionCount);
  for (const char* wanted : more)
    if (std::none_of(names.begin(), names.end(), [&](const char* name) { return !std::strcmp(name, wanted); }))
      names.push_back(wanted);
  return names;
}

/// LAYER_COUNTS=FILE: appends the two numbers when the process ends.
struct Counts {
  unsigned replaced = 0, left = 0;
  ~Counts() {
    const char* path = std::getenv("LAYER_COUNTS");
    std::FILE* file = path && replaced + left ? std::fopen(path, "a") : nullptr;
    if (!file) return;
    std::fprintf(file, "%u %u\n", replaced, left);
    std::fclose(file);
  }
};

}  // namespace vitrine::layer
