// The device's table of compiled shaders that are alive, by what they were compiled from.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "icd/edge/allocation.h"

namespace vitrine::icd {

struct CompiledShader;

/// Two independent hashes of everything that decides the result of a compilation.
using ShaderKey = std::array<std::uint64_t, 2>;

struct ShaderKeyHash {
  std::size_t operator()(const ShaderKey& key) const { return key[0]; }
};

/// Guarded by its mutex. Does not keep shaders alive.
struct ShaderTable {
  explicit ShaderTable(const HostMemory& m) : shaders(0, ShaderKeyHash{}, std::equal_to<ShaderKey>{}, m) {}

  using Entry = std::pair<const ShaderKey, std::weak_ptr<const CompiledShader>>;
  std::mutex mutex;
  std::unordered_map<ShaderKey, std::weak_ptr<const CompiledShader>, ShaderKeyHash, std::equal_to<ShaderKey>,
                     HostAllocator<Entry>>
      shaders;
  std::size_t sweep_at = 64;  ///< entries at which dead ones are dropped
};

}  // namespace vitrine::icd
