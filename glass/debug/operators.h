// Operators and functions of expressions, component by component.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "glass/debug/value.h"

namespace vitrine::glass::debug {

/// A scalar meets a vector with each of its components. False: `error` says why not.
bool apply(std::string_view op, const std::vector<Scalar>& left, const std::vector<Scalar>& right,
           std::vector<Scalar>& result, std::string& error);
/// '-', '+', '!' or '~'.
Scalar negate(char sign, const Scalar& scalar);
/// Constructors of scalars; abs, min, max, floor, length, dot, any, all, isnan, isinf.
bool call_function(std::string_view name, const std::vector<std::vector<Scalar>>& arguments,
                   std::vector<Scalar>& result, std::string& error);

}  // namespace vitrine::glass::debug
