// Access to the three register files by the byte offsets of an instruction.
#pragma once

#include <cstring>
#include <utility>

#include "spirv/program.h"

namespace vitrine::spirv::exec {

inline base::LaneMask& mask(Wave& wave, std::uint32_t offset) {
  return *reinterpret_cast<base::LaneMask*>(reinterpret_cast<std::byte*>(wave.masks) + offset);
}
inline std::uint32_t& uniform_word(Wave& wave, std::uint32_t offset) { return wave.uniforms[offset / 4]; }
/// Lanes of `all` that take part in a group operation: the active ones that are no helpers; helpers alone among
/// themselves, so that loops over elected invocations end for them too (Vulkan, Helper Invocations: "may be considered
/// inactive for group operations"). Where MaximallyReconvergesKHR applies, they "must remain active for all
/// instructions".
inline base::LaneMask participants(const Wave& wave, base::LaneMask all = base::kAllLanes) {
  const base::LaneMask active = wave.active & all, lanes = active & wave.live;
  return lanes != 0 && !wave.program->helpers_take_part ? lanes : active;
}
inline base::WaveRegister& reg(Wave& wave, std::uint32_t offset) {
  return *reinterpret_cast<base::WaveRegister*>(wave.registers + offset);
}

}  // namespace vitrine::spirv::exec
