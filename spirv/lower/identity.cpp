// Inputs of observed programs that say which invocation a lane runs (spirv/exec/observe.h).
#include <algorithm>

#include "spirv/exec/observe.h"
#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {
namespace {

template <class Wanted>
void keep(ScalarFunction& f, ShaderInterface& interface, const InterfaceSlot& added, const Wanted& wanted) {
  const auto slot = std::find_if(interface.inputs.begin(), interface.inputs.end(), wanted);
  const auto index = static_cast<std::uint32_t>(slot - interface.inputs.begin());
  if (slot == interface.inputs.end()) interface.inputs.push_back(added);
  for (ScalarId id = 0; id < f.scalars.size(); ++id)
    if (f.scalars[id].input == index) return f.observed.push_back(id);
  const ScalarId id = f.add(false, Level::kVarying);
  f.scalars[id].input = index;
  f.observed.push_back(id);
}

void keep(ScalarFunction& f, ShaderInterface& interface, BuiltIn built_in, std::uint8_t component) {
  InterfaceSlot added;
  added.built_in = built_in;
  added.component = component;
  added.implied = true;
  keep(f, interface, added,
       [&](const InterfaceSlot& slot) { return slot.built_in == built_in && slot.component == component; });
}

}  // namespace

void keep_identity(ScalarFunction& function, ShaderInterface& interface) {
  if (interface.stage == VK_SHADER_STAGE_VERTEX_BIT) {
    keep(function, interface, BuiltIn::kVertexIndex, 0);
    keep(function, interface, BuiltIn::kInstanceIndex, 0);
  } else if (interface.stage == VK_SHADER_STAGE_FRAGMENT_BIT) {
    keep(function, interface, BuiltIn::kFragCoord, 0);
    keep(function, interface, BuiltIn::kFragCoord, 1);
  } else if (interface.stage != VK_SHADER_STAGE_COMPUTE_BIT) {
    for (std::uint8_t i = 0; i < 3; ++i) keep(function, interface, BuiltIn::kIdentity, i);
  }
}

void keep_inputs(ScalarFunction& function, ShaderInterface& interface, const ShaderInterface& other) {
  for (const InterfaceSlot& slot : other.inputs)
    keep(function, interface, slot, [&](const InterfaceSlot& known) { return exec::hold_the_same(known, slot); });
  interface.needs_helpers |= other.needs_helpers;
}

}  // namespace vitrine::spirv::lowering
