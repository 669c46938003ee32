// See rehearsal.h.
#include "glass/debug/rehearsal.h"

#include <algorithm>
#include <cstring>

namespace vitrine::glass::debug {
namespace {

using spirv::InterfaceSlot;
using spirv::Wave;

base::WaveRegister& register_of(const Wave& wave, const InterfaceSlot& slot) {
  return *reinterpret_cast<base::WaveRegister*>(wave.registers + std::size_t{slot.reg} * spirv::kRegisterStride);
}

const InterfaceSlot* find(const std::vector<InterfaceSlot>& slots, const InterfaceSlot& wanted) {
  const auto found =
      std::ranges::find_if(slots, [&](const InterfaceSlot& slot) { return spirv::exec::hold_the_same(slot, wanted); });
  return found == slots.end() ? nullptr : &*found;
}

}  // namespace

void Rehearsal::bind(const Wave& wave) {
  if (bound_ && wave.resources->serial == serial_ && serial_ != 0) return;
  bound_.emplace(*shader_, *wave.resources, fault_);
  serial_ = wave.resources->serial;
  wave_ = Wave{};
  memory_.bind(*bound_, wave_);
}

void Rehearsal::begin(const Wave& wave) {
  bind(wave);
  // Memory is told apart by the table's address.
  wave_.resources = wave.resources;
  wave_.active = wave.active;
  wave_.live = wave.live;
  wave_.launched = wave.launched;
  wave_.shared = wave.shared;
  wave_.shared_size = wave.shared_size;
  std::copy_n(wave.workgroup_id, 3, wave_.workgroup_id);
  std::copy_n(wave.num_workgroups, 3, wave_.num_workgroups);
  wave_.first_invocation = wave.first_invocation;
  wave_.budget = wave.budget;
  wave_.status = Wave::Status::kRunning;
  const spirv::Program& program = shader_->program();
  wave_.resume = program.code.data();
  // What nobody has written to a variable is the same in every run.
  if (wave_.arrays != nullptr) std::memset(wave_.arrays, 0, program.array_bytes);
  if (!program.cleared.empty()) spirv::exec::clear_undefined(program, wave_);
  const auto& inputs = wave.program->observation->interface.inputs;
  for (const InterfaceSlot& slot : shader_->interface().inputs)
    if (const InterfaceSlot* given = find(inputs, slot)) register_of(wave_, slot) = register_of(wave, *given);
}

void Rehearsal::run(const Wave& wave, spirv::exec::Watch& watch) {
  stores.clear();
  wave_.watch = &watch;
  do {
    spirv::execute(wave_, wave_.resume);
  } while (waits() && !wave.program->has_barrier);
  wave_.watch = nullptr;
}

void Rehearsal::hand_over(Wave& wave) const {
  for (const InterfaceSlot& slot : wave.program->observation->interface.outputs)
    if (const InterfaceSlot* const shown = find(shader_->interface().outputs, slot))
      register_of(wave, slot) = register_of(wave_, *shown);
}

std::optional<StoreLog::Difference> Rehearsal::compare(const Wave& wave) const {
  std::optional<StoreLog::Difference> difference = stores.compare();
  if (wave.status != Wave::Status::kDone || wave_.status != Wave::Status::kDone) return difference;
  const base::LaneMask lanes = wave.live & wave_.live;
  for (const InterfaceSlot& slot : wave.program->observation->interface.outputs) {
    const InterfaceSlot* const shown = find(shader_->interface().outputs, slot);
    if (shown == nullptr) continue;
    const base::WaveRegister &there = register_of(wave, slot), &kept = register_of(wave_, *shown);
    base::for_each_lane(lanes, [&](std::size_t lane) {
      if (there.lane[lane] == kept.lane[lane]) return;
      if (!difference) difference = {0, there.lane[lane], kept.lane[lane]};
      ++difference->words;
    });
  }
  return difference;
}

}  // namespace vitrine::glass::debug
