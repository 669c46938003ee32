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
inline base::WaveRegister& reg(Wave& wave, std::uint32_t offset) {
  return *reinterpret_cast<base::WaveRegister*>(wave.registers + offset);
}

}  // namespace vitrine::spirv::exec
