// Inputs and outputs of a module as GLSL: types, and expressions of random numbers.
#pragma once

#include <string>
#include <vector>

#include "cases/modules/reflect.h"

namespace vitrine::cts {

/// The kind of an input or output: float, int or uint with 1 to 4 components, and how many locations it takes.
struct Slot {
  std::string scalar;
  uint32_t components = 1, columns = 1;
  std::vector<uint32_t> lengths;  ///< of arrays, outermost first

  uint32_t locations() const {
    uint32_t count = columns;
    for (const uint32_t n : lengths) count *= n;
    return count;
  }
};

/// Throws Unsupported for blocks and for numbers that do not have 32 bits.
Slot slot_of(const Reflection& r, uint32_t type);
/// The type without its arrays.
std::string glsl_type(const Slot& slot);
/// An expression of random numbers for one element, out of the function of numbers_of().
std::string random_value(const Slot& slot, uint32_t seed);

/// The function number(uint k) of random numbers between -0.25 and 2.25, those of invocation `index` (an expression).
std::string numbers_of(const std::string& index);

}  // namespace vitrine::cts
