// Control flow as lane masks, and moves of masks. A lane is active or waits in exactly one mask of an enclosing
// construct; a lane in none has ended.
#include <functional>

#include "spirv/exec/handlers.h"
#include "spirv/exec/observe.h"
#include "spirv/exec/operands.h"
#include "spirv/exec/profile.h"

namespace vitrine::spirv {

Loop loop_of(const Program& program) {
  if (program.observation) return exec::execute_observed;
  return exec::profile_enabled() ? exec::execute_profiled : execute;
}

void execute(Wave& wave, const Instruction* start) {
  wave.status = Wave::Status::kRunning;
  for (const Instruction* next = start; next != nullptr;) next = next->handler(wave, next);
}

namespace exec {
namespace {

const Instruction* target(const Instruction* instruction) {
  return instruction + static_cast<std::int32_t>(instruction->extra[0]);
}

const Instruction* next_or_target(const Wave& wave, const Instruction* instruction) {
  return wave.active != 0 ? instruction + 1 : target(instruction);
}

const Instruction* count_turn(Wave& wave, const Instruction* instruction) {
  wave.budget -= instruction->extra[1];
  if (wave.budget >= 0) return target(instruction);
  wave.status = Wave::Status::kFault;
  wave.resume = instruction;
  return nullptr;
}

const Instruction* demote(Wave& wave, const Instruction* instruction, base::LaneMask lanes) {
  wave.live &= ~lanes;
  if (wave.live != 0) return instruction + 1;
  wave.status = Wave::Status::kDone;
  return nullptr;
}

template <class Compare, class T>
const Instruction* jump_if_test(Wave& wave, const Instruction* i) {
  const bool holds =
      Compare()(static_cast<T>(uniform_word(wave, i->src[0])), static_cast<T>(uniform_word(wave, i->src[1])));
  return holds ? target(i) : i + 1;
}

base::LaneMask all_if(std::uint32_t word) { return word != 0 ? base::kAllLanes : 0; }

void assign_active(Wave& wave, base::LaneMask& to, base::LaneMask from) {
  to = (to & ~wave.active) | (from & wave.active);
}

}  // namespace

const Instruction* end_program(Wave& wave, const Instruction*) {
  wave.status = Wave::Status::kDone;
  return nullptr;
}

const Instruction* jump(Wave&, const Instruction* i) { return target(i); }

const Instruction* jump_unless(Wave& wave, const Instruction* i) {
  return uniform_word(wave, i->src[0]) == 0 ? target(i) : i + 1;
}

const Instruction* jump_if(Wave& wave, const Instruction* i) {
  return uniform_word(wave, i->src[0]) != 0 ? target(i) : i + 1;
}

Handler jump_compare(ir::Op test, bool holds) {
  switch (test) {
    case ir::Op::kIEq:
    case ir::Op::kINe:
      return (test == ir::Op::kIEq) == holds ? jump_if_test<std::equal_to<>, std::uint32_t>
                                             : jump_if_test<std::not_equal_to<>, std::uint32_t>;
    case ir::Op::kILt:
    case ir::Op::kIGe:
      return (test == ir::Op::kILt) == holds ? jump_if_test<std::less<>, std::int32_t>
                                             : jump_if_test<std::greater_equal<>, std::int32_t>;
    case ir::Op::kULt:
    case ir::Op::kUGe:
      return (test == ir::Op::kULt) == holds ? jump_if_test<std::less<>, std::uint32_t>
                                             : jump_if_test<std::greater_equal<>, std::uint32_t>;
    default:
      return nullptr;
  }
}

const Instruction* skip_if_empty(Wave& wave, const Instruction* i) { return next_or_target(wave, i); }

const Instruction* if_mask(Wave& wave, const Instruction* i) {
  const base::LaneMask condition = mask(wave, i->src[0]);
  mask(wave, i->dst) = wave.active & ~condition;
  wave.active &= condition;
  return next_or_target(wave, i);
}

const Instruction* else_mask(Wave& wave, const Instruction* i) {
  std::swap(wave.active, mask(wave, i->dst));
  return next_or_target(wave, i);
}

const Instruction* endif_mask(Wave& wave, const Instruction* i) {
  wave.active |= mask(wave, i->src[0]);
  return i + 1;
}

const Instruction* clear_mask(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) = 0;
  return i + 1;
}

const Instruction* leave_if(Wave& wave, const Instruction* i) {
  const base::LaneMask leaving = wave.active & mask(wave, i->src[0]);
  mask(wave, i->dst) |= leaving;
  wave.active &= ~leaving;
  return next_or_target(wave, i);
}

const Instruction* leave_all(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) |= wave.active;
  wave.active = 0;
  return target(i);
}

const Instruction* leave_begin(Wave& wave, const Instruction* i) {
  const base::LaneMask leaving = wave.active & mask(wave, i->src[0]);
  if (leaving == 0) return target(i);
  mask(wave, i->dst) = wave.active & ~leaving;
  wave.active = leaving;
  return i + 1;
}

const Instruction* leave_end(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) |= wave.active;
  wave.active = mask(wave, i->src[0]);
  return next_or_target(wave, i);
}

const Instruction* rejoin(Wave& wave, const Instruction* i) {
  wave.active |= mask(wave, i->dst);
  mask(wave, i->dst) = 0;
  return next_or_target(wave, i);
}

const Instruction* loop_back_mask(Wave& wave, const Instruction* i) {
  if (wave.active != 0) return count_turn(wave, i);
  wave.active = mask(wave, i->src[0]);
  return i + 1;
}

const Instruction* loop_back(Wave& wave, const Instruction* i) { return count_turn(wave, i); }

const Instruction* return_if(Wave& wave, const Instruction* i) {
  wave.active &= ~mask(wave, i->src[0]);
  return next_or_target(wave, i);
}

const Instruction* return_all(Wave& wave, const Instruction* i) {
  wave.active = 0;
  return target(i);
}

const Instruction* demote_all(Wave& wave, const Instruction* i) { return demote(wave, i, wave.active); }

const Instruction* demote_if(Wave& wave, const Instruction* i) {
  return demote(wave, i, wave.active & mask(wave, i->src[0]));
}

const Instruction* barrier(Wave& wave, const Instruction* i) {
  wave.status = Wave::Status::kAtBarrier;
  wave.resume = i + 1;
  return nullptr;
}

const Instruction* move_mask(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) = mask(wave, i->src[0]);
  return i + 1;
}

const Instruction* move_mask_active(Wave& wave, const Instruction* i) {
  assign_active(wave, mask(wave, i->dst), mask(wave, i->src[0]));
  return i + 1;
}

const Instruction* broadcast_mask(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) = all_if(uniform_word(wave, i->src[0]));
  return i + 1;
}

const Instruction* broadcast_mask_active(Wave& wave, const Instruction* i) {
  assign_active(wave, mask(wave, i->dst), all_if(uniform_word(wave, i->src[0])));
  return i + 1;
}

}  // namespace exec
}  // namespace vitrine::spirv
