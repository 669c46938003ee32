// One atomic operation on a word of 32 or 64 bits, and many of them on the same 32-bit word at once.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "base/lanes.h"
#include "base/numeric.h"
#include "spirv/ir.h"

namespace vitrine::spirv::exec {

/// Minimum or maximum of what memory holds and of the operand, whose values are `a` and `b` (LLVM's minnum and maxnum
/// on x86): of a NaN, quiet or signaling, and a number it is the number; of two NaN the operand; of equal ones the old.
template <class Word, class Float>
inline Word extremum(ir::AtomicOp op, Word old, Word operand, Float a, Float b) {
  return std::isnan(a) || (op == ir::AtomicOp::kFMin ? b < a : b > a) ? operand : old;
}

/// On binary32 or binary64.
template <class Word>
inline Word combine_float(ir::AtomicOp op, Word old, Word operand) {
  using Float = std::conditional_t<sizeof(Word) == 4, float, double>;
  const auto a = std::bit_cast<Float>(old), b = std::bit_cast<Float>(operand);
  return op == ir::AtomicOp::kFAdd ? std::bit_cast<Word>(a + b) : extremum(op, old, operand, a, b);
}

/// The new value of a word of 32 or 64 bits, for operations that always write.
template <class Word>
inline Word combine(ir::AtomicOp op, Word old, Word operand) {
  using Signed = std::make_signed_t<Word>;
  const auto a = static_cast<Signed>(old), b = static_cast<Signed>(operand);
  switch (op) {
    case ir::AtomicOp::kAdd:
      return old + operand;
    case ir::AtomicOp::kSub:
      return old - operand;
    case ir::AtomicOp::kIMin:
      return static_cast<Word>(std::min(a, b));
    case ir::AtomicOp::kIMax:
      return static_cast<Word>(std::max(a, b));
    case ir::AtomicOp::kUMin:
      return std::min(old, operand);
    case ir::AtomicOp::kUMax:
      return std::max(old, operand);
    case ir::AtomicOp::kAnd:
      return old & operand;
    case ir::AtomicOp::kOr:
      return old | operand;
    case ir::AtomicOp::kXor:
      return old ^ operand;
    case ir::AtomicOp::kFAdd:
    case ir::AtomicOp::kFMin:
    case ir::AtomicOp::kFMax:
      return combine_float(op, old, operand);
    case ir::AtomicOp::kExchange:
    case ir::AtomicOp::kStore:
      return operand;
    case ir::AtomicOp::kCompareExchange:
    case ir::AtomicOp::kLoad:
      break;
  }
  return old;
}

/// Returns the old value. kAtomic false: the word belongs to this thread.
template <bool kAtomic, class Word>
inline Word apply_atomic(ir::AtomicOp op, Word* word, Word operand, Word compare) {
  if constexpr (!kAtomic) {
    const Word old = *word;
    *word = op == ir::AtomicOp::kCompareExchange ? (old == compare ? operand : old) : combine(op, old, operand);
    return old;
  } else {
    std::atomic_ref<Word> shared(*word);
    switch (op) {
      case ir::AtomicOp::kAdd:
        return shared.fetch_add(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kSub:
        return shared.fetch_sub(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kAnd:
        return shared.fetch_and(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kOr:
        return shared.fetch_or(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kXor:
        return shared.fetch_xor(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kExchange:
        return shared.exchange(operand, std::memory_order_relaxed);
      case ir::AtomicOp::kLoad:
        return shared.load(std::memory_order_relaxed);
      case ir::AtomicOp::kStore:
        shared.store(operand, std::memory_order_relaxed);
        return 0;
      case ir::AtomicOp::kCompareExchange: {
        Word expected = compare;
        shared.compare_exchange_strong(expected, operand, std::memory_order_relaxed);
        return expected;
      }
      default: {
        Word old = shared.load(std::memory_order_relaxed);
        while (!shared.compare_exchange_weak(old, combine(op, old, operand), std::memory_order_relaxed)) {
        }
        return old;
      }
    }
  }
}

/// All lanes of `active` (not empty) on one word, as if one after the other in lane order with nobody in between: one
/// memory operation. False where the operation does not combine.
template <bool kAtomic>
inline bool combine_lanes(ir::AtomicOp op, std::uint32_t* word, const std::uint32_t* operand, base::LaneMask active,
                          std::uint32_t* result) {
  switch (op) {
    case ir::AtomicOp::kAdd:
      break;
    case ir::AtomicOp::kIMin:
    case ir::AtomicOp::kIMax:
    case ir::AtomicOp::kUMin:
    case ir::AtomicOp::kUMax:
    case ir::AtomicOp::kAnd:
    case ir::AtomicOp::kOr:
    case ir::AtomicOp::kXor:
      if (result != nullptr) return false;
      break;
    default:
      return false;
  }
  const int first = std::countr_zero(active);
  std::uint32_t total = operand[first];
  if (op == ir::AtomicOp::kAdd && result != nullptr) {
    std::uint32_t sum = 0;
    base::for_each_lane(active, [&](std::size_t lane) {
      const std::uint32_t before = sum;
      sum += operand[lane];
      result[lane] = before;
    });
    const std::uint32_t old = apply_atomic<kAtomic, std::uint32_t>(op, word, sum, 0);
    base::for_each_lane(active, [&](std::size_t lane) { result[lane] += old; });
    return true;
  }
  base::for_each_lane(active & (active - 1), [&](std::size_t lane) { total = combine(op, total, operand[lane]); });
  apply_atomic<kAtomic, std::uint32_t>(op, word, total, 0);
  return true;
}

}  // namespace vitrine::spirv::exec
