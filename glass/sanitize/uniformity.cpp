// Descriptors that are chosen by an index without NonUniform, where invocations choose different ones. Those that must
// agree are the invocation group (Vulkan 1.3.239, Scope: Invocation Group): of compute shaders the workgroup, else what
// a device likes of a draw, here the wave.
#include "glass/sanitize/checks.h"
#include "glass/sanitize/operands.h"

namespace vitrine::glass::sanitize {
namespace {

/// How many lanes in a row belong to one invocation group.
std::uint32_t lanes_of_group(const spirv::Wave& wave) {
  const spirv::Program& program = *wave.program;
  if (program.groups_per_wave <= 1) return base::kWaveWidth;
  return program.local_size[0] * program.local_size[1] * program.local_size[2];
}

/// Lanes whose index is not that of the first lane in their group.
base::LaneMask apart(const spirv::Wave& wave, const Words& index, base::LaneMask lanes) {
  const std::uint32_t size = lanes_of_group(wave);
  base::LaneMask result = 0;
  for (std::uint32_t first = 0; first < base::kWaveWidth; first += size) {
    const base::LaneMask group = base::first_lanes(size) << first & lanes;
    if (group == 0) continue;
    const std::uint32_t chosen = index[static_cast<std::size_t>(std::countr_zero(group))];
    result |= lanes_where(group, [&](std::size_t lane) { return index[lane] != chosen; });
  }
  return result;
}

}  // namespace

void check_uniformity(Reporter& reporter, const spirv::Wave& wave, const spirv::ProbeOp& op,
                      const spirv::Probe& probe) {
  const base::LaneMask lanes = real_lanes_at(wave, op);
  for (const spirv::OperandPlace& place : op.operands) {
    const Words index(wave, place);
    const base::LaneMask wrong = apart(wave, index, lanes);
    if (wrong == 0) continue;
    return reporter.report(wave, place_of(op), origin_of(probe), "non-uniform-index", wrong, [&](std::size_t lane) {
      return "descriptor " + std::to_string(index[lane]) +
             " where other invocations choose another, with an index that is not NonUniform";
    });
  }
}

}  // namespace vitrine::glass::sanitize
