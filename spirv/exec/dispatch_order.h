// In which order the workgroups of a dispatch run, and what of a workgroup runs between two barriers: in the order of
// their numbers, a wave at a time; or, where VITRINE_SHAKE asks for it (base/shake.h), in any other, waves in parts.
// No invocation can tell, unless it relies on what others do that nothing makes it wait for (Vulkan 1.3.239, Shader
// Execution: "the order in which invocations run is undefined").
#pragma once

#include <array>

#include "base/lanes.h"
#include "base/shake.h"
#include "spirv/program.h"

namespace vitrine::spirv::exec {

class DispatchOrder {
 public:
  /// `groups` workgroups of `waves` waves.
  DispatchOrder(const Program& program, std::uint64_t groups, std::uint32_t waves)
      : shaken_(base::shakes(base::ShakeKind::kOrder)), groups_(groups, shaken_ ? base::next_choice() : 0) {
    pieces_ = waves;
    lanes_[0] = base::kAllLanes;
    if (!shaken_) return;
    key_ = base::next_choice();
    if (!program.uses_subgroups && program.groups_per_wave == 1) divide();
    pieces_ *= parts_;
  }

  bool shaken() const { return shaken_; }
  /// Of a workgroup: what runs by itself.
  std::uint32_t pieces() const { return pieces_; }
  std::uint32_t wave_of(std::uint32_t piece) const { return piece / parts_; }
  /// Lanes of its wave that belong to a piece.
  base::LaneMask lanes_of(std::uint32_t piece) const { return lanes_[piece % parts_]; }

  std::uint64_t group(std::uint64_t position) const { return shaken_ ? groups_(position) : position; }
  /// The order of the pieces of a workgroup, from its n-th barrier on.
  base::Shuffle pieces_in(std::uint64_t group, std::uint32_t barriers) const {
    return base::Shuffle(pieces_, base::mix(key_, base::mix(group, barriers)));
  }

 private:
  /// Into 1 to 64 parts, any lanes together.
  void divide() {
    parts_ = 1u << base::next_choice() % 7;
    const base::Shuffle lanes(base::kWaveWidth, key_);
    lanes_ = {};
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
      lanes_[lanes(lane) % parts_] |= base::LaneMask{1} << lane;
  }

  bool shaken_;
  std::uint32_t pieces_, parts_ = 1;
  std::uint64_t key_ = 0;
  base::Shuffle groups_;
  std::array<base::LaneMask, base::kWaveWidth> lanes_{};
};

}  // namespace vitrine::spirv::exec
