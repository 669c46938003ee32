// Float operations on the host that do not depend on the width (lavapipe-shader-math.md sections 1, 7.1).
#pragma once

#include <cmath>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// `r`: of an operation of one operand of type T. False: not one of these.
template <class T>
bool fold_unary(Op op, T a, T& r) {
  switch (op) {
    case Op::kFNeg:
      r = -a;
      return true;
    case Op::kFAbs:
      r = std::abs(a);
      return true;
    case Op::kFRcp:
      r = T{1} / a;
      return true;
    case Op::kFSqrt:
      r = std::sqrt(a);
      return true;
    case Op::kFRsq:
      r = T{1} / std::sqrt(a);
      return true;
    case Op::kFFloor:
      r = std::floor(a);
      return true;
    case Op::kFCeil:
      r = std::ceil(a);
      return true;
    case Op::kFTrunc:
      r = std::trunc(a);
      return true;
    case Op::kFRoundEven:
      r = std::nearbyint(a);
      return true;
    case Op::kFFract:
      r = a - std::floor(a);
      return true;
    default:
      return false;
  }
}

/// The same for two operands.
template <class T>
bool fold_binary(Op op, T a, T b, T& r) {
  switch (op) {
    case Op::kFAdd:
      r = a + b;
      return true;
    case Op::kFSub:
      r = a - b;
      return true;
    case Op::kFMul:
      r = a * b;
      return true;
    case Op::kFDiv:
      r = a / b;
      return true;
    case Op::kFMin:
      r = a < b || std::isnan(b) ? a : b;
      return true;
    case Op::kFMax:
      r = a > b || std::isnan(b) ? a : b;
      return true;
    default:
      return false;
  }
}

/// Whether a comparison holds.
template <class T>
bool fold_comparison(Op op, T a, T b, bool& r) {
  switch (op) {
    case Op::kFLt:
      r = a < b;
      return true;
    case Op::kFGe:
      r = a >= b;
      return true;
    case Op::kFEq:
      r = a == b;
      return true;
    case Op::kFNeu:
      r = a != b;
      return true;
    default:
      return false;
  }
}

}  // namespace vitrine::spirv::rewriting
