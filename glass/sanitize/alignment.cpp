// Accesses to PhysicalStorageBuffer memory at addresses that are not multiples of what the instruction promises, or of
// the size of the largest scalar.
#include <spirv/unified1/spirv.hpp11>

#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

const char* verb_of(std::uint16_t opcode) {
  switch (static_cast<spv::Op>(opcode)) {
    case spv::Op::OpLoad:
      return "load";
    case spv::Op::OpStore:
      return "store";
    case spv::Op::OpCopyMemory:
      return "copy";
    default:
      return "atomic operation";
  }
}

}  // namespace

void check_alignment(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op, const spirv::Probe& probe) {
  const base::LaneMask lanes = real_lanes_at(wave, op);
  if (lanes == 0) return;
  const Words low(wave, op.operands[0]), high(wave, op.operands[1]);
  const Words distance(wave, op.operands[2]), added(wave, op.operands[3]);
  const auto address_of = [&](std::size_t lane) {
    const auto behind = static_cast<std::int32_t>(distance[lane] + added[lane]);
    return (std::uint64_t{high[lane]} << 32 | low[lane]) + static_cast<std::uint64_t>(std::int64_t{behind});
  };
  const base::LaneMask wrong =
      lanes_where(lanes, [&](std::size_t lane) { return address_of(lane) % probe.number != 0; });
  if (wrong == 0) return;
  reporter.report(wave, place_of(op), origin_of(probe), "misaligned-access", wrong, [&](std::size_t lane) {
    // The address itself is another one in every run.
    std::string text = verb_of(probe.opcode);
    text += " at an address that is " + std::to_string(address_of(lane) % probe.number);
    return text += " more than a multiple of " + std::to_string(probe.number);
  });
}

}  // namespace vitrine::glass::sanitize
