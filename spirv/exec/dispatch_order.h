// In which order the workgroups of a dispatch run, and what of a workgroup runs between two barriers: in the order of
// their numbers, a wave at a time; or, where VITRINE_SHAKE asks for it (base/shake.h), in any other, waves in parts.
// No invocation can tell, unless it relies on what others do that nothing makes it wait for (Vulkan 1.3.239, Shader
// Execution: "the order in which invocations run is undefined").
#pragma once

#include <array>
#include <memory>

#include "base/lanes.h"
#include "base/shake.h"
#include "spirv/program.h"

namespace vitrine::spirv::exec {

class DispatchOrder {
 public:
  /// `groups` workgroups of `waves` waves.
  DispatchOrder(const Program& program, std::uint64_t groups, std::uint32_t waves) : pieces_(waves) {
    if (!base::shakes(base::ShakeKind::kOrder)) return;
    choices_ = std::make_unique<const Choices>(program, groups);
    pieces_ *= choices_->parts;
  }

  bool shaken() const { return choices_ != nullptr; }
  /// Of a workgroup: what runs by itself.
  std::uint32_t pieces() const { return pieces_; }
  std::uint32_t wave_of(std::uint32_t piece) const { return choices_ ? piece / choices_->parts : piece; }
  /// Lanes of its wave that belong to a piece.
  base::LaneMask lanes_of(std::uint32_t piece) const {
    return choices_ ? choices_->lanes[piece % choices_->parts] : base::kAllLanes;
  }

  std::uint64_t group(std::uint64_t position) const { return choices_ ? choices_->groups(position) : position; }
  /// Shaken: the order of the pieces of a workgroup, from its n-th barrier on.
  base::Shuffle pieces_in(std::uint64_t group, std::uint32_t barriers) const {
    return base::Shuffle(pieces_, base::mix(choices_->key, base::mix(group, barriers)));
  }

 private:
  struct Choices {
    Choices(const Program& program, std::uint64_t count)
        : groups(count, base::next_choice()), key(base::next_choice()) {
      // Into 1 to 64 parts, any lanes together.
      if (!program.uses_subgroups && program.groups_per_wave == 1) parts = 1u << base::next_choice() % 7;
      const base::Shuffle order(base::kWaveWidth, key);
      for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
        lanes[order(lane) % parts] |= base::LaneMask{1} << lane;
    }

    base::Shuffle groups;
    std::uint64_t key;
    std::uint32_t parts = 1;
    std::array<base::LaneMask, base::kWaveWidth> lanes{};
  };

  std::uint32_t pieces_;
  std::unique_ptr<const Choices> choices_;  ///< null: the usual order
};

}  // namespace vitrine::spirv::exec
