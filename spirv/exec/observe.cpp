// The loop of observed programs, and probes.
#include "spirv/exec/observe.h"

#include <utility>

#include "base/lane_count.h"
#include "spirv/exec/handlers.h"
#include "spirv/exec/operands.h"

namespace vitrine::spirv::exec {
namespace {

void execute_watched(Wave& wave, const Instruction* start, Watch& watch) {
  wave.status = Wave::Status::kRunning;
  for (const Instruction* next = start; next != nullptr;) {
    const Instruction* const instruction = next;
    watch.before(wave, instruction);
    next = instruction->handler(wave, instruction);
    watch.after(wave, instruction, next);
  }
}

const Instruction* hook(Wave& wave, const Instruction* i) {
  const Program& program = *wave.program;
  const auto index = static_cast<std::size_t>(i - program.code.data());
  if (wave.watch != nullptr) wave.watch->access(wave, i, program.notes[index]);
  return program.observation->hooked[index](wave, i);
}

const Instruction* hook_discard(Wave& wave, const Instruction* i) {
  const Program& program = *wave.program;
  const auto index = static_cast<std::size_t>(i - program.code.data());
  if (wave.watch != nullptr) wave.watch->discard(wave, i, program.notes[index]);
  return program.observation->hooked[index](wave, i);
}

/// Tells of a block: counts the lanes that `lanes_of` says come by.
template <base::LaneMask (*lanes_of)(Wave& wave, const Instruction* i)>
const Instruction* probe_block(Wave& wave, const Instruction* i) {
  if (wave.watch == nullptr) return i + 1;
  BlockCell* const cells = wave.watch->cells();
  if (cells == nullptr) return probe(wave, i);
  count_block(wave, cells[i->extra[0]], lanes_of(wave, i), 1);
  return i + 1;
}

base::LaneMask active_lanes(Wave& wave, const Instruction*) { return wave.active; }
base::LaneMask lanes_if(Wave& wave, const Instruction* i) { return wave.active & mask(wave, i->src[0]); }
base::LaneMask lanes_unless(Wave& wave, const Instruction* i) { return wave.active & ~mask(wave, i->src[0]); }
base::LaneMask all_lanes_if(Wave& wave, const Instruction* i) {
  return uniform_word(wave, i->src[0]) != 0 ? wave.active : 0;
}
base::LaneMask all_lanes_unless(Wave& wave, const Instruction* i) {
  return uniform_word(wave, i->src[0]) == 0 ? wave.active : 0;
}
base::LaneMask guarded_lanes(Wave& wave, const Instruction* i) {
  return lanes_at(wave, wave.program->probe_ops[i->extra[0]]);
}

/// Who tells of an instruction; null: nobody wants to know.
Handler hook_of(const Interest& wanted, Access access, Handler handler) {
  switch (access) {
    case Access::kNone:
      return wanted.discards && (handler == demote_all || handler == demote_if) ? hook_discard : nullptr;
    case Access::kImage:
      return wanted.accesses || wanted.images ? hook : nullptr;
    default:
      return wanted.accesses ? hook : nullptr;
  }
}

}  // namespace

base::LaneMask discarded_lanes(const Wave& wave, const Instruction* i) {
  const Handler handler = wave.program->observation->hooked[static_cast<std::size_t>(i - wave.program->code.data())];
  const base::LaneMask active = wave.active & wave.live;
  return handler == demote_if ? active & wave.masks[i->src[0] / sizeof(base::LaneMask)] : active;
}

bool hold_the_same(const InterfaceSlot& a, const InterfaceSlot& b) {
  return a.built_in == b.built_in && a.component == b.component && a.location == b.location && a.index == b.index &&
         a.stream == b.stream && a.interpolation == b.interpolation && a.sample_location == b.sample_location &&
         a.part == b.part;
}

void hook_instructions(Program& program) {
  Observation observation = *program.observation;
  const Interest& wanted = observation.interest;
  observation.hooked.assign(program.code.size(), nullptr);
  bool any = false;
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    const Handler by = hook_of(wanted, program.notes[i].access, program.code[i].handler);
    if (by == nullptr) continue;
    observation.hooked[i] = std::exchange(program.code[i].handler, by);
    any = true;
  }
  const bool nothing_else = wanted == Interest{.images = wanted.images, .discards = wanted.discards};
  program.observation = any || !nothing_else ? std::make_shared<const Observation>(std::move(observation)) : nullptr;
}

void execute_observed(Wave& wave, const Instruction* start) {
  const Observation& observation = *wave.program->observation;
  if (Watch* lasting = observation.observer->lasting_watch()) {
    wave.watch = lasting;
    execute(wave, start);
    wave.watch = nullptr;
    return;
  }
  const std::unique_ptr<Watch> watch = observation.observer->watch(wave, start);
  wave.watch = watch.get();
  if (watch && observation.interest.instructions) {
    execute_watched(wave, start, *watch);
  } else {
    execute(wave, start);
  }
  wave.watch = nullptr;
}

std::uint32_t word_of(const Wave& wave, OperandPlace place, std::size_t lane) {
  switch (place.file) {
    case 'r':
      return reinterpret_cast<const base::WaveRegister*>(wave.registers + place.offset)->lane[lane];
    case 'm':
      return static_cast<std::uint32_t>(wave.masks[place.offset / sizeof(base::LaneMask)] >> lane & 1);
    default:
      return wave.uniforms[place.offset / 4];
  }
}

base::LaneMask lanes_at(const Wave& wave, const ProbeOp& op) {
  base::LaneMask lanes = wave.active;
  for (const auto& [place, holds] : op.guards) {
    const base::LaneMask where = place.file == 'm' ? wave.masks[place.offset / sizeof(base::LaneMask)]
                                 : wave.uniforms[place.offset / 4] != 0 ? base::kAllLanes
                                                                        : 0;
    lanes &= holds ? where : ~where;
  }
  return lanes;
}

void count_block(const Wave& wave, BlockCell& cell, base::LaneMask lanes, std::uint64_t times) {
  const auto add = [](std::atomic<std::uint64_t>& to, std::uint64_t more) {
    to.store(to.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
  };
  if (lanes == 0) return;
  add(cell.waves, times);
  const base::LaneMask helpers = lanes & ~wave.live;
  add(cell.invocations, times * base::count_lanes(lanes & wave.live));
  if (helpers != 0) add(cell.helpers, times * base::count_lanes(helpers));
}

Handler block_probe(const ProbeOp& op) {
  if (op.guards.empty()) return probe_block<active_lanes>;
  if (op.guards.size() > 1) return probe_block<guarded_lanes>;
  const auto& [place, holds] = op.guards[0];
  if (place.file == 'm') return holds ? probe_block<lanes_if> : probe_block<lanes_unless>;
  return holds ? probe_block<all_lanes_if> : probe_block<all_lanes_unless>;
}

const Instruction* probe(Wave& wave, const Instruction* i) {
  if (wave.watch != nullptr) wave.watch->probe(wave, wave.program->probe_ops[i->extra[0]]);
  return i + 1;
}

}  // namespace vitrine::spirv::exec
