// Uses of values that depend on parts of variables which the invocation has not written.
#include "glass/sanitize/variables.h"

#include <algorithm>
#include <optional>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Probe;
using spirv::ProbeOp;
using spirv::Wave;

constexpr std::uint32_t kUnknownIndex = ~0u;  ///< what was an index is not known any more

/// Groups of lanes that name the same cells: f(lanes, first cell; nothing if some index is not known).
template <class F>
void for_each_first_cell(const Wave& wave, const ProbeOp& op, const Probe& probe, base::LaneMask lanes, F&& f) {
  if (probe.steps.empty()) return f(lanes, std::optional(probe.first_cell));
  base::for_each_lane(lanes, [&](std::size_t lane) {
    std::optional<std::uint32_t> first = probe.first_cell;
    for (std::size_t i = 0; i < probe.steps.size(); ++i) {
      const auto& [cells, length] = probe.steps[i];
      const std::uint32_t index = spirv::exec::word_of(wave, op.operands[i], lane);
      if (index == kUnknownIndex) first.reset();
      if (first) *first += std::min(index, length - 1) * cells;
    }
    f(base::LaneMask{1} << lane, first);
  });
}

base::LaneMask undefined_in(const VariableShadow& shadow, const std::vector<std::uint32_t>& slots) {
  base::LaneMask undefined = 0;
  for (const std::uint32_t slot : slots) undefined |= shadow.undefined[slot];
  return undefined;
}

void set(base::LaneMask& mask, base::LaneMask lanes, base::LaneMask value) { mask = (mask & ~lanes) | (value & lanes); }

void write(VariableShadow& shadow, const Wave& wave, const ProbeOp& op, const Probe& probe, base::LaneMask lanes) {
  for_each_first_cell(wave, op, probe, lanes, [&](base::LaneMask same, std::optional<std::uint32_t> first) {
    // Somewhere in the variable: all of it counts as written.
    if (!first) {
      for (base::LaneMask& cell : shadow.written) cell |= same;
      return;
    }
    for (std::uint32_t c = 0; c < probe.cells; ++c) {
      const base::LaneMask undefined = probe.slots.empty() ? 0 : undefined_in(shadow, probe.slots[c]);
      set(shadow.written[*first + c], same, ~undefined);
    }
  });
}

void read(VariableShadow& shadow, const Wave& wave, const ProbeOp& op, const Probe& probe, base::LaneMask lanes) {
  for_each_first_cell(wave, op, probe, lanes, [&](base::LaneMask same, std::optional<std::uint32_t> first) {
    for (std::uint32_t c = 0; c < probe.cells; ++c)
      set(shadow.undefined[probe.first_slot + c], same, first ? ~shadow.written[*first + c] : 0);
  });
}

void choose(VariableShadow& shadow, const Wave& wave, const ProbeOp& op, const Probe& probe, base::LaneMask lanes) {
  for (std::uint32_t c = 0; c < probe.cells; ++c) {
    const Words condition(wave, op.operands[c]);
    const base::LaneMask holds = lanes_where(lanes, [&](std::size_t lane) { return condition[lane] != 0; });
    const base::LaneMask undefined =
        (undefined_in(shadow, probe.slots[2 * c]) & holds) | (undefined_in(shadow, probe.slots[2 * c + 1]) & ~holds);
    set(shadow.undefined[probe.first_slot + c], lanes, undefined);
  }
}

/// Says it once: what else depends on the same values is the same fault.
void use(VariableShadow& shadow, Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe,
         base::LaneMask lanes) {
  const base::LaneMask wrong = undefined_in(shadow, probe.slots[0]) & lanes & wave.live;
  if (wrong == 0) return;
  reporter.report(wave, place_of(op), origin_of(probe), "uninitialized-variable", wrong,
                  [&](std::size_t) { return probe.format; });
  for (const std::uint32_t slot : probe.slots[0])
    if (slot != 0) shadow.undefined[slot] &= ~wrong;
}

}  // namespace

void VariableShadow::begin(std::uint32_t cells, std::uint32_t slots) {
  written.assign(cells, 0);
  undefined.assign(slots, 0);
  undefined[0] = base::kAllLanes;
}

VariableShadows::VariableShadows(const spirv::Program& program) {
  for (const spirv::ProbeOp& op : program.probe_ops) {
    const Probe& probe = program.probes[op.probe];
    if (probe.kind == Probe::Kind::kUse) slots_ = std::max(slots_, 1u);
    if (probe.kind == Probe::Kind::kChoose) slots_ = std::max(slots_, probe.first_slot + probe.cells);
    if (probe.kind != Probe::Kind::kRead && probe.kind != Probe::Kind::kWrite) continue;
    std::uint32_t end = probe.first_cell + probe.cells;
    for (const auto& [cells, length] : probe.steps) end += cells * (length - 1);
    cells_ = std::max(cells_, end);
    slots_ = std::max(slots_, probe.first_slot + probe.cells);
  }
  for (const Probe& probe : program.probes)
    for (const auto& slots : probe.slots)
      if (!slots.empty()) slots_ = std::max(slots_, slots.back() + 1);
}

VariableShadow* VariableShadows::of(const Wave& wave, const spirv::Instruction* start) {
  if (slots_ == 0) return nullptr;
  VariableShadow* shadow = nullptr;
  {
    const std::lock_guard lock(mutex_);
    shadow = &shadows_[&wave];
  }
  if (start == wave.program->code.data()) shadow->begin(cells_, slots_);
  return shadow;
}

void check_variable(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe,
                    VariableShadow& shadow) {
  const base::LaneMask lanes = spirv::exec::lanes_at(wave, op);
  if (lanes == 0) return;
  switch (probe.kind) {
    case Probe::Kind::kWrite:
      return write(shadow, wave, op, probe, lanes);
    case Probe::Kind::kRead:
      return read(shadow, wave, op, probe, lanes);
    case Probe::Kind::kChoose:
      return choose(shadow, wave, op, probe, lanes);
    default:
      return use(shadow, reporter, wave, op, probe, lanes);
  }
}

}  // namespace vitrine::glass::sanitize
