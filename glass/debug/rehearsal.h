// A wave of the rehearsed program (spirv/exec/observe.h): it begins as the wave that comes next does, runs in registers
// of its own, and what it has written is taken back before that one runs.
#pragma once

#include <memory>
#include <optional>

#include "glass/debug/stores.h"
#include "spirv/exec/observe.h"
#include "spirv/exec/wave_memory.h"

namespace vitrine::glass::debug {

class Rehearsal {
 public:
  explicit Rehearsal(std::shared_ptr<const spirv::Shader> shader) : shader_(std::move(shader)) {}
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  /// `wave` is about to start.
  void begin(const spirv::Wave& wave);
  /// To its end or, where `wave`'s program has barriers, to the next one. `stores` gets what `watch` keeps there.
  void run(const spirv::Wave& wave, spirv::exec::Watch& watch);
  /// Whether it stands at a barrier.
  bool waits() const { return wave_.status == spirv::Wave::Status::kAtBarrier; }
  /// Or has not started.
  bool goes_on() const { return waits() || wave_.status == spirv::Wave::Status::kRunning; }

  /// What runs.
  const spirv::Wave& wave() const { return wave_; }
  const spirv::Program& program() const { return shader_->program(); }
  /// `wave`, which has ended, gets the results of the rehearsal instead of its own.
  void hand_over(spirv::Wave& wave) const;
  /// Of registers of `wave`, which has ended, and memory: what it did otherwise.
  std::optional<StoreLog::Difference> compare(const spirv::Wave& wave) const;

  StoreLog stores;

 private:
  void bind(const spirv::Wave& wave);

  std::shared_ptr<const spirv::Shader> shader_;
  spirv::Fault fault_;
  spirv::exec::WaveMemory memory_;
  std::optional<spirv::BoundShader> bound_;
  std::uint64_t serial_ = 0;  ///< of the resources that it is bound to
  spirv::Wave wave_;
};

}  // namespace vitrine::glass::debug
