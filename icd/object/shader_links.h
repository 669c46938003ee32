// The device's table of shader objects that draws have used together (Vulkan 1.4.309, Shader Objects): each such link
// is a pipeline of which every state is dynamic, made when they first meet and kept while all of them are alive.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "icd/edge/allocation.h"

namespace vitrine::icd {

struct ShaderLink;

inline constexpr std::size_t kGraphicsStages = 5;  ///< vertex, tessellation control and evaluation, geometry, fragment

/// Numbers of the shader objects by stage (0: none), the color outputs that matter (bit i = location i; those of a
/// fragment shader that has others, too, count alone), and the locations of the color attachments, a byte each.
using LinkKey = std::array<std::uint64_t, kGraphicsStages + 2>;

struct LinkKeyHash {
  std::size_t operator()(const LinkKey& key) const {
    std::uint64_t hash = 0x243f6a8885a308d3u;
    for (const std::uint64_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Guarded by its mutex, and so are the lists of links that shader objects have.
struct ShaderLinks {
  explicit ShaderLinks(const HostMemory& m) : links(0, LinkKeyHash{}, std::equal_to<LinkKey>{}, m) {}

  using Entry = std::pair<const LinkKey, std::shared_ptr<ShaderLink>>;
  std::mutex mutex;
  std::unordered_map<LinkKey, std::shared_ptr<ShaderLink>, LinkKeyHash, std::equal_to<LinkKey>, HostAllocator<Entry>>
      links;
};

}  // namespace vitrine::icd
