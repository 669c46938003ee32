// The places of a program that access memory which several invocations can reach, and which of them can race at all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "glass/place.h"
#include "glass/sanitize/accesses.h"
#include "spirv/memory_order.h"
#include "spirv/program.h"

namespace vitrine::glass::race {

/// Kinds of memory that barriers tell apart (SPIR-V 3.25, Memory Semantics).
enum class Memory : std::uint8_t { kShared, kBuffer, kImage };
inline constexpr std::size_t kMemories = 3;

/// One instruction.
struct Site {
  Memory memory = Memory::kBuffer;
  spirv::Access action = spirv::Access::kLoad;  ///< kLoad, kStore or kAtomic
  bool atomic_reads = false, atomic_writes = false;
  bool is_private = false;   ///< what it does is not made available or visible to other invocations
  spirv::MemoryOrder order;  ///< of atomic operations
  spirv::ir::Origin origin;
  std::uint64_t place = 0;  ///< tells it apart: what the compiler makes of one access, by parts, is one place
  std::uint32_t bytes = 4;  ///< that one lane touches
  /// Of memory: parts of the access behind its address, a component each, their size, and which component each is.
  sanitize::Touched touched;
  std::uint32_t element_bytes = 4, component[4] = {};
  std::uint32_t first = 0, end = 0;  ///< all parts: bytes behind its address
  std::uint32_t set = 0, slot = 0;
  bool is_texel = false;  ///< of an image or texel buffer

  bool writes() const { return action == spirv::Access::kStore || (action == spirv::Access::kAtomic && atomic_writes); }
  bool is_atomic() const { return action == spirv::Access::kAtomic; }
  /// What Group::log_shared() may take.
  bool is_logged() const { return memory == Memory::kShared && action != spirv::Access::kStore; }
  bool loads() const { return action == spirv::Access::kLoad; }
};

/// The sites of a program. It keeps nothing of the program itself, which may be gone before the findings are told.
struct Sites {
  Sites(const ShaderIdentity& shader, const spirv::Program& program);

  std::vector<Site> all;
  std::vector<std::uint32_t> by_instruction;  ///< kNone: it is none
  bool vulkan_model = false;                  ///< the Vulkan memory model
  bool hlsl = false;                          ///< what a workgroup shares is coherent without saying so
  bool orders_device = false;                 ///< atomic operations and fences may order workgroups
  bool orders_waves = false;                  ///< the same of waves of a draw
  bool has_private = false;                   ///< some access is
  bool has_atomics = false;                   ///< some access is atomic
  bool orders_shared = false;                 ///< atomic operations with semantics order accesses
  bool has_narrow_scope = false;              ///< an atomic operation's does not hold the device
  bool alike = false;                         ///< all workgroups do the same to shared memory, if
  bool alike_if_given = false;                ///< nothing writes what MemoryOrder::given loads read
  bool writes_device = false, writes_images = false, writes_global = false;

  static constexpr std::uint32_t kNone = ~0u;
};

/// "store of 4 bytes", "load of a texel".
std::string what_text(const Site& site);

}  // namespace vitrine::glass::race
