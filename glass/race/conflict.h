// Two accesses that race.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <mutex>
#include <optional>
#include <tuple>

#include "glass/race/sites.h"

namespace vitrine::glass::race {

/// For which commands a workgroup, which does the same to shared memory as all of the command do, has been found to be
/// without races there.
class SharedQuiet {
 public:
  void set(const spirv::ObservedCommand* command, bool always) {
    const std::lock_guard lock(mutex_);
    always_ |= always;
    if (command != nullptr) last_.emplace(command->owner, command->submission, command->command);
  }
  bool holds(const spirv::ObservedCommand* command) const {
    const std::lock_guard lock(mutex_);
    return always_ || (command != nullptr && last_ == Last{command->owner, command->submission, command->command});
  }

 private:
  using Last = std::tuple<const void*, std::uint64_t, std::uint32_t>;
  mutable std::mutex mutex_;
  bool always_ = false;
  std::optional<Last> last_;
};

/// A program as findings tell of it: it lives as long as the tool.
struct Told {
  Told(const ShaderIdentity& shader, const spirv::Program& program) : context(shader, program), sites(shader, program) {
    for (int i = 0; i < 3; ++i) size[i] = program.local_size[i];
  }
  const ShaderContext context;
  const Sites sites;
  std::uint32_t size[3];  ///< of a workgroup
  bool compute() const { return context.stage == VK_SHADER_STAGE_COMPUTE_BIT; }
  mutable SharedQuiet quiet;
};

/// An invocation: of a compute shader its workgroup and its number in it, of others what they are called by.
struct Who {
  std::array<std::uint32_t, 3> group{};
  std::uint32_t local = 0;
  auto operator<=>(const Who&) const = default;
};

struct Access {
  const Told* program = nullptr;
  std::uint32_t site = 0;
  Who who;
  const Site& what() const { return program->sites.all[site]; }
};

/// Two accesses to the same bytes that nothing orders, `later` in the order of workgroups, or as they came.
struct Conflict {
  Access earlier, later;
  std::uint64_t address = 0;  ///< of shared memory: an offset
  enum class Kind : std::uint8_t {
    kRace,
    kScope,       ///< atomic operations whose scope is too small
    kVisibility,  ///< ordered, but what was written is not made available and visible
  } kind = Kind::kRace;
  bool equal = false;  ///< both wrote the same value
};

}  // namespace vitrine::glass::race
