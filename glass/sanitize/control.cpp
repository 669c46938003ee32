// What needs invocations together, where some are missing: derivatives of a quad, barriers of a workgroup. What must
// not be reached.
#include <spirv/unified1/spirv.hpp11>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

using spirv::Probe;
using spirv::ProbeOp;
using spirv::Wave;

/// Lanes of quads (four in a row) of which an invocation that is no helper is missing.
base::LaneMask in_broken_quads(base::LaneMask lanes, base::LaneMask missing) {
  constexpr base::LaneMask kFirsts = 0x1111111111111111u;
  const base::LaneMask broken = (missing | missing >> 1 | missing >> 2 | missing >> 3) & kFirsts;
  return lanes & broken * 0xf;
}

bool is_derivative(std::uint16_t opcode) {
  return opcode >= static_cast<std::uint16_t>(spv::Op::OpDPdx) &&
         opcode <= static_cast<std::uint16_t>(spv::Op::OpFwidthCoarse);
}

void check_quad(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  const base::LaneMask lanes = spirv::exec::lanes_at(wave, op);
  const base::LaneMask wrong = in_broken_quads(lanes & wave.live, wave.live & ~lanes);
  if (wrong == 0) return;
  const bool derivative = is_derivative(probe.opcode);
  reporter.report(wave, place_of(op), origin_of(probe),
                  derivative ? "divergent-derivative" : "divergent-implicit-lookup", wrong, [&](std::size_t) {
                    return std::string(derivative ? "derivative" : "lookup with implicit level of detail") +
                           " where other invocations of the quad are elsewhere";
                  });
}

std::string barrier_text(std::size_t) { return "barrier of a workgroup that not all its invocations reach"; }

constexpr const char* kBarrierRule = "divergent-barrier";

/// One place for a barrier however its workgroup comes apart.
std::uint64_t barrier_place(const spirv::ir::Origin& origin) { return std::uint64_t{2} << 32 | origin.place; }

/// Lanes of `lanes` whose patch misses some: a wave of control shaders has several patches, one after the other.
base::LaneMask in_broken_patches(const Wave& wave, base::LaneMask lanes) {
  const std::uint32_t size = wave.program->observation->interface.modes.control_points;
  base::LaneMask broken = 0;
  for (std::uint32_t first = 0; size != 0 && first < base::kWaveWidth; first += size) {
    const base::LaneMask patch = base::first_lanes(size) << first & wave.launched;
    if ((lanes & patch) != patch) broken |= lanes & patch;
  }
  return broken;
}

void check_barrier(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  const base::LaneMask lanes = spirv::exec::lanes_at(wave, op);
  if (reporter.stage() == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT) {
    const base::LaneMask wrong = in_broken_patches(wave, lanes);
    if (wrong == 0) return;
    return reporter.report(
        wave, barrier_place(origin_of(probe)), origin_of(probe), kBarrierRule, wrong,
        [](std::size_t) { return std::string("barrier of a patch that not all its invocations reach"); });
  }
  if (lanes == 0 || lanes == wave.launched) return;
  reporter.report(wave, barrier_place(origin_of(probe)), origin_of(probe), kBarrierRule, lanes, barrier_text);
}

void check_unreachable(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  const base::LaneMask lanes = real_lanes_at(wave, op);
  if (lanes == 0) return;
  reporter.report(wave, place_of(op), origin_of(probe), "unreachable", lanes,
                  [](std::size_t) { return std::string("OpUnreachable was reached"); });
}

}  // namespace

void check_control(Reporter& reporter, const Wave& wave, const ProbeOp& op, const Probe& probe) {
  switch (probe.kind) {
    case Probe::Kind::kQuad:
      return check_quad(reporter, wave, op, probe);
    case Probe::Kind::kBarrier:
      return check_barrier(reporter, wave, op, probe);
    default:
      return check_unreachable(reporter, wave, op, probe);
  }
}

void check_apart(Reporter& reporter, const Wave& wave) {
  if (wave.active != wave.launched) return;  // said where it came by
  const spirv::ir::Origin& origin = spirv::exec::waits_at(wave).origin;
  reporter.report(wave, barrier_place(origin), origin, kBarrierRule, wave.active, barrier_text);
}

}  // namespace vitrine::glass::sanitize
