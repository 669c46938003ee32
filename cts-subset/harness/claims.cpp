// Writes and reads the claims of the reference.
#include "harness/claims.h"

#include <algorithm>
#include <cinttypes>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace vitrine::cts {
namespace {

/// Feature structures are VkBool32 behind sType and pNext, and nothing else.
constexpr size_t kFirstFeature = sizeof(VkBaseOutStructure);

template <typename T>
VkBool32* features_begin(T& structure) {
  return reinterpret_cast<VkBool32*>(reinterpret_cast<unsigned char*>(&structure) + kFirstFeature);
}

std::string bits_of(const VkBool32* features, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += features[i] ? '1' : '0';
  return text;
}

void set_bits(VkBool32* features, size_t count, const std::string& text) {
  for (size_t i = 0; i < std::min(count, text.size()); ++i) features[i] = text[i] == '1';
}

constexpr size_t kCoreFeatures = sizeof(VkPhysicalDeviceFeatures) / sizeof(VkBool32);

void read_features(Gpu& gpu, const std::string& type, const std::string& bits) {
  const auto everything = [](const char*) { return true; };
  for_each_structure(gpu.extension_features, everything, [&](auto& structure, VkStructureType s_type, bool) {
    if (std::to_string(s_type) == type)
      set_bits(features_begin(structure), (sizeof structure - kFirstFeature) / sizeof(VkBool32), bits);
  });
}

/// Those of the core, and those of the extensions that cases know: ASTC of floats, planes, 4444.
std::vector<VkFormat> known_formats() {
  constexpr std::pair<VkFormat, int> kRuns[] = {{VK_FORMAT_R4G4_UNORM_PACK8, VK_FORMAT_ASTC_12x12_SRGB_BLOCK},
                                                {VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK, 14},
                                                {VK_FORMAT_G8B8G8R8_422_UNORM, 34},
                                                {VK_FORMAT_G8_B8R8_2PLANE_444_UNORM, 4},
                                                {VK_FORMAT_A4R4G4B4_UNORM_PACK16, 2}};
  std::vector<VkFormat> formats;
  for (const auto& [first, count] : kRuns)
    for (int i = 0; i < count; ++i) formats.push_back(static_cast<VkFormat>(first + i));
  return formats;
}

}  // namespace

std::vector<std::string> claims_of(const Gpu& gpu) {
  std::vector<std::string> claims = {"extensions"};
  for (const std::string& name : gpu.offered) claims[0] += " " + name;
  claims.push_back("features " + bits_of(&gpu.features.robustBufferAccess, kCoreFeatures));
  ExtensionFeatures features = gpu.extension_features;
  for_each_structure(
      features, [&](const char* name) { return gpu.has(name); },
      [&](auto& structure, VkStructureType type, bool is_there) {
        if (!is_there) return;
        const size_t count = (sizeof structure - kFirstFeature) / sizeof(VkBool32);
        claims.push_back("structure " + std::to_string(type) + " " + bits_of(features_begin(structure), count));
      });
  for (const VkFormat format : known_formats()) {
    const VkFormatProperties found = gpu.format_properties(format);
    if (!(found.linearTilingFeatures | found.optimalTilingFeatures | found.bufferFeatures)) continue;
    char line[80];
    std::snprintf(line, sizeof line, "format %d %x %x %x", format, found.linearTilingFeatures,
                  found.optimalTilingFeatures, found.bufferFeatures);
    claims.push_back(line);
  }
  return claims;
}

Gpu gpu_of_claims(const std::string& name, const std::vector<std::string>& claims) {
  Gpu gpu;
  gpu.name = name;
  for (const std::string& claim : claims) {
    std::istringstream words(claim);
    std::string kind, type, bits;
    words >> kind;
    if (kind == "extensions")
      for (std::string extension; words >> extension;) gpu.offered.push_back(extension);
    else if (kind == "features" && words >> bits)
      set_bits(&gpu.features.robustBufferAccess, kCoreFeatures, bits);
    else if (kind == "structure" && words >> type >> bits)
      read_features(gpu, type, bits);
    int number = 0;
    VkFormatProperties found{};
    if (kind == "format" && words >> number >> std::hex >> found.linearTilingFeatures >> found.optimalTilingFeatures >>
                                found.bufferFeatures)
      gpu.recorded_formats[static_cast<VkFormat>(number)] = found;
  }
  keep_wanted_extensions(gpu);
  return gpu;
}

}  // namespace vitrine::cts
