// What a person writes as a value, number by number, where it is stored.
#pragma once

#include <vector>

#include "base/result.h"
#include "glass/debug/value.h"

namespace vitrine::glass::debug {

/// A number, and where it is stored, in the type that is stored there.
struct PlacedScalar {
  Place place;
  Scalar number;
};
/// What is stored so that `place` holds a value: to a scalar or vector as many numbers, or one for all; to arrays,
/// matrices and structures one of the same shape, a list of what their elements or members get, some members by name,
/// or all numbers one behind the other. Of a texel: four numbers. Otherwise why it cannot be.
base::Result<std::vector<PlacedScalar>> placed_numbers(const Viewer& viewer, const Place& place, const Value& value);
}  // namespace vitrine::glass::debug
