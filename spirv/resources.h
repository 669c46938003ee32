// What a shader can reach: descriptors resolved to addresses and views, push constants. Filled by icd/ when a draw or
// dispatch is replayed; constant while it runs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "texel/sampler.h"
#include "texel/view.h"

namespace vitrine::spirv {

class ObservedCommand;  // spirv/observed_command.h

/// One array element of one binding. Each kind has fields of its own, so that a shader which expects another kind than
/// was bound (an invalid use) finds a null descriptor: buffers of size 0, images that read 0.
struct Descriptor {
  std::byte* data = nullptr;                       ///< uniform or storage buffer, offset applied
  std::uint64_t size = 0;                          ///< bytes of the bound range (buffers)
  const texel::ImageView* image = nullptr;         ///< sampled, storage, input attachment, combined
  const texel::BufferTexelView* texels = nullptr;  ///< uniform or storage texel buffer
  const texel::Sampler* sampler = nullptr;         ///< sampler, combined image sampler
};

inline constexpr std::uint32_t kMaxSets = 32;
/// Pseudo set of dynamic uniform/storage buffers: slot = running number of the dynamic descriptor in the pipeline
/// layout, in set order, then binding order, then array element; dynamic offsets are already applied.
inline constexpr std::uint32_t kDynamicSet = kMaxSets;
inline constexpr std::uint32_t kMaxPushConstantBytes = 256;

struct ResourceTable {
  const Descriptor* set[kMaxSets + 1] = {};   ///< null where nothing is bound: reads 0, drops writes
  std::uint32_t set_size[kMaxSets + 1] = {};  ///< descriptors in each
  const std::byte* push_constants = nullptr;  ///< kMaxPushConstantBytes bytes
  /// Of the draw or dispatch, given by BoundShader: what is derived from descriptors may be kept for as long as it
  /// stays. 0: for one use.
  std::uint64_t serial = 0;
  /// What observers are told of the draw or dispatch; null where nobody observes.
  const ObservedCommand* command = nullptr;
};

}  // namespace vitrine::spirv
