// Leaves of interface variables and the loads of their components, for interface.cpp and interpolation.cpp. Internal to
// front/.
#pragma once

#include <vector>

#include "spirv/front/context.h"

namespace vitrine::spirv::front {

struct BuiltInRow {
  spv::BuiltIn spirv;
  BuiltIn slot;  ///< kNone: `op`
  ir::Op op;     ///< instruction that gives the value
  std::uint8_t components;
};

/// One leaf of an interface variable.
struct Leaf {
  std::vector<Step> path;
  std::uint32_t type = 0;
  InterfaceSlot slot;  ///< of component 0
  bool invariant = false;
  const BuiltInRow* built_in = nullptr;
};

/// The scalars and vectors an Input or Output variable consists of, in order, each with its place in the interface.
std::vector<Leaf> interface_leaves(Translator& t, const Local& local);

/// Loads one component of an input where t.list is, which dominates every later use: each slot is loaded once.
ir::ValueId load_input(Translator& t, const InterfaceSlot& slot);

}  // namespace vitrine::spirv::front
