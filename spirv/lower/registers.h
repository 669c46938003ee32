// Register allocation: varying scalars to registers, varying booleans and the masks of control flow to mask slots.
#pragma once

#include <cstdint>
#include <vector>

#include "spirv/lower/scalar.h"

namespace vitrine::spirv::lowering {

/// Mask slots of one control flow operation of the body (kNoIndex where not needed).
/// kIf: [0] = lanes of the else-branch, then lanes that finished the then-branch.
/// kLoop: [0] = lanes that left by break, [1] = lanes waiting at the continue target.
/// kBreak, kContinue with a condition and values: [0] = lanes that stay.
struct ControlSlots {
  std::uint32_t slot[2] = {kNoIndex, kNoIndex};
};

struct Allocation {
  /// Per scalar: register (varying, non-boolean) or mask slot (varying booleans); kNoIndex where none. Scalars of one
  /// register whose moves vanish share it.
  std::vector<std::uint32_t> place;
  std::vector<ControlSlots> slots;  ///< per operation of the body
  std::uint32_t register_count = 0;
  std::uint32_t mask_count = 0;
};

Allocation allocate(const ScalarFunction& function);

}  // namespace vitrine::spirv::lowering
