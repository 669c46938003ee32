// What SPIR-V says of the order of an access or a barrier, in one word, for those who observe it
// (exec::Interest::order): the executor needs none of it, as memory is coherent and waves run in lockstep.
#pragma once

#include <cstdint>

namespace vitrine::spirv {

/// Scope of SPIR-V, by its number.
enum class MemoryScope : std::uint8_t {
  kCrossDevice,
  kDevice,
  kWorkgroup,
  kSubgroup,
  kInvocation,
  kQueueFamily,
  kShaderCall,
  kUnknown,
};

/// Loads and stores have bits of Memory Operands (of Image Operands those that mean the same), atomic operations and
/// barriers bits of Memory Semantics.
struct MemoryOrder {
  static constexpr std::uint32_t kAcquires = 0x2 | 0x8 | 0x10, kReleases = 0x4 | 0x8 | 0x10;
  static constexpr std::uint32_t kUniformMemory = 0x40, kWorkgroupMemory = 0x100, kImageMemory = 0x800;
  static constexpr std::uint32_t kMakeAvailable = 0x2000, kMakeVisible = 0x4000;
  static constexpr std::uint32_t kPointerAvailable = 0x8, kPointerVisible = 0x10, kNonPrivate = 0x20;

  std::uint16_t bits = 0;
  MemoryScope memory = MemoryScope::kUnknown;
  MemoryScope execution = MemoryScope::kUnknown;  ///< of control barriers
  bool coherent = false;                          ///< the variable is declared so, or nothing is known of it
  bool alike = false;  ///< of shared memory: all workgroups do the same to it (spirv/lower/alike.h)
  bool given = false;  ///< that holds if nothing writes what loads with this bit read

  constexpr std::uint32_t word() const {
    return bits | static_cast<std::uint32_t>(memory) << 16 | static_cast<std::uint32_t>(execution) << 20 |
           std::uint32_t{coherent} << 24 | std::uint32_t{alike} << 25 | std::uint32_t{given} << 26 | 1u << 31;
  }
  static constexpr MemoryOrder of(std::uint32_t word) {
    return {static_cast<std::uint16_t>(word),
            static_cast<MemoryScope>(word >> 16 & 7),
            static_cast<MemoryScope>(word >> 20 & 7),
            (word >> 24 & 1) != 0,
            (word >> 25 & 1) != 0,
            (word >> 26 & 1) != 0};
  }
  constexpr bool acquires() const { return (bits & kAcquires) != 0; }
  constexpr bool releases() const { return (bits & kReleases) != 0; }
};

/// Whether a scope holds all invocations of a workgroup, and all of a device.
constexpr bool covers_workgroup(MemoryScope scope) {
  return scope <= MemoryScope::kWorkgroup || scope == MemoryScope::kQueueFamily;
}
constexpr bool covers_device(MemoryScope scope) {
  return scope <= MemoryScope::kDevice || scope == MemoryScope::kQueueFamily;
}

}  // namespace vitrine::spirv
