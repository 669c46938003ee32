// See invocation.h.
#include "spirv/exec/invocation.h"

#include "base/numeric.h"
#include "spirv/exec/observe.h"

namespace vitrine::spirv::exec {
namespace {

/// Where an input of this wave lies. Null: the stage has none such.
const base::WaveRegister* input_of(const Wave& wave, BuiltIn built_in, std::uint8_t component) {
  for (const InterfaceSlot& slot : wave.program->observation->interface.inputs)
    if (slot.built_in == built_in && slot.component == component)
      return reinterpret_cast<const base::WaveRegister*>(wave.registers + std::size_t{slot.reg} * kRegisterStride);
  return nullptr;
}

/// As Scalarizer::quad_environment().
std::array<std::uint32_t, 3> place_in_quads(const std::uint32_t* size, std::uint32_t local) {
  const std::uint32_t quad = local / 4, columns = size[0] / 2, rows = size[1] / 2;
  return {quad % columns * 2 + local % 2, quad / columns % rows * 2 + local % 4 / 2, quad / columns / rows};
}

std::array<std::uint32_t, 3> compute_id(const Wave& wave, std::size_t lane) {
  const std::uint32_t* size = wave.program->local_size;
  const std::uint32_t invocations = size[0] * size[1] * size[2];
  const std::uint32_t at = wave.first_invocation + static_cast<std::uint32_t>(lane);
  const std::uint32_t group = wave.program->groups_per_wave > 1 ? at / invocations : 0, local = at % invocations;
  const bool quads = wave.program->observation->interface.derivative_group == DerivativeGroup::kQuads;
  const auto [x, y, z] = quads ? place_in_quads(size, local)
                               : std::array{local % size[0], local / size[0] % size[1], local / size[0] / size[1]};
  return {(wave.workgroup_id[0] + group) * size[0] + x, wave.workgroup_id[1] * size[1] + y,
          wave.workgroup_id[2] * size[2] + z};
}

/// The inputs of a stage that tell; null: there is none.
std::array<const base::WaveRegister*, 3> inputs_of(const Wave& wave) {
  switch (wave.program->observation->interface.stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return {input_of(wave, BuiltIn::kVertexIndex, 0), input_of(wave, BuiltIn::kInstanceIndex, 0)};
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return {input_of(wave, BuiltIn::kFragCoord, 0), input_of(wave, BuiltIn::kFragCoord, 1)};
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return {};
    default:
      return {input_of(wave, BuiltIn::kIdentity, 0), input_of(wave, BuiltIn::kIdentity, 1),
              input_of(wave, BuiltIn::kIdentity, 2)};
  }
}

std::uint32_t number_of(const Wave& wave, const base::WaveRegister& input, std::size_t lane) {
  const bool fragment = wave.program->observation->interface.stage == VK_SHADER_STAGE_FRAGMENT_BIT;
  return fragment ? base::truncate_to_uint(base::float_of(input.lane[lane])) : input.lane[lane];
}

}  // namespace

std::array<std::uint32_t, 3> invocation_of(const Wave& wave, std::size_t lane) { return Invocations(wave)(wave, lane); }

Invocations::Invocations(const Wave& wave) {
  const auto inputs = inputs_of(wave);
  while (count_ < inputs.size() && inputs[count_] != nullptr) {
    inputs_[count_] = *inputs[count_];
    ++count_;
  }
}

std::array<std::uint32_t, 3> Invocations::operator()(const Wave& wave, std::size_t lane) const {
  if (wave.program->observation->interface.stage == VK_SHADER_STAGE_COMPUTE_BIT) return compute_id(wave, lane);
  std::array<std::uint32_t, 3> id{};
  for (std::uint8_t i = 0; i < count_; ++i) id[i] = number_of(wave, inputs_[i], lane);
  return id;
}

}  // namespace vitrine::spirv::exec
