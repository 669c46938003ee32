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

/// Fails on built-ins that are not supported.
const BuiltInRow& built_in_row(const Inst& variable, std::uint32_t built_in);

/// One leaf of an interface variable.
struct Leaf {
  std::vector<Step> path;
  std::uint32_t type = 0;
  InterfaceSlot slot;  ///< of component 0
  bool invariant = false;
  const BuiltInRow* built_in = nullptr;
};

/// The slot of a word of a leaf: numbers of 64 bits have two words, and go on in the next location.
InterfaceSlot word_slot(const Leaf& leaf, std::uint32_t word);

/// The scalars and vectors an Input or Output variable consists of, in order, each with its place in the interface.
std::vector<Leaf> interface_leaves(Translator& t, const Local& local);

/// The scalar or vector of `type` as it crosses the interface: numbers of 16 bits as those of 32. And back.
ir::ValueId to_interface(Translator& t, std::uint32_t type, ir::ValueId value);
ir::ValueId from_interface(Translator& t, std::uint32_t type, ir::ValueId value);

/// Loads one component of an input where t.list is, which dominates every later use: each slot is loaded once.
ir::ValueId load_input(Translator& t, const InterfaceSlot& slot);

}  // namespace vitrine::spirv::front
