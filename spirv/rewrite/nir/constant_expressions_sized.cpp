// Operations on constants of 16 and 64 bits: halves are computed in binary32 and rounded at the end.
#include "spirv/rewrite/nir/constant_expressions.h"

#include <bit>
#include <limits>

#include "base/numeric.h"
#include "spirv/rewrite/graph/literals.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/nir/constant_expressions_float.h"

namespace vitrine::spirv::rewriting {
namespace {

/// What the shift of this op by `count` shifts; none: it is something else.
Src shifted(const Graph& graph, Src src, Op op, std::uint32_t count) {
  const Inst* shift = scalar_operation(graph, src, op);
  return shift && is_literal(graph, graph.source(*shift, 1), count) ? graph.source(*shift, 0) : Src{};
}

/// The number is one of 32 - `count` bits, extended from their sign; minima and maxima are followed `depth` levels.
bool is_extended(const Graph& graph, Src src, std::uint32_t count, unsigned depth = 4) {
  if (const Inst* constant = graph.constant(src.value)) {
    const auto number = static_cast<std::int32_t>(constant->imm[src.swizzle[0]]);
    const std::int32_t least = std::numeric_limits<std::int32_t>::min() >> count;
    return number >= least && number < -least;
  }
  for (const Op op : {Op::kIMin, Op::kIMax})
    if (const Inst* inst = scalar_operation(graph, src, op))
      return depth > 0 && is_extended(graph, graph.source(*inst, 0), count, depth - 1) &&
             is_extended(graph, graph.source(*inst, 1), count, depth - 1);
  const Src low = shifted(graph, src, Op::kIShr, count);
  return low.value != ir::kNoValue && shifted(graph, low, Op::kShl, count).value != ir::kNoValue;
}

}  // namespace

Src extended_before(const Graph& graph, const Inst& inst) {
  if (inst.kind != Inst::Kind::kAlu || inst.op != Op::kIShr || inst.components != 1) return {};
  for (const std::uint32_t count : {16u, 24u}) {
    const Src low = shifted(graph, {inst.result, {0, 0, 0, 0}}, Op::kIShr, count);
    Src number = low.value == ir::kNoValue ? low : shifted(graph, low, Op::kShl, count);
    if (number.value == ir::kNoValue) continue;
    if (const Inst* mask = scalar_operation(graph, number, Op::kAnd);
        mask && is_literal(graph, graph.source(*mask, 1), 0xffffffffu >> count))
      number = graph.source(*mask, 0);
    if (!graph.constant(number.value) && is_extended(graph, number, count)) return number;
  }
  return {};
}

bool evaluate_conversion(const Graph& graph, const Inst& inst, std::uint32_t words[2]) {
  std::uint32_t source[2] = {};
  if (!ir::is_wide(inst.op)) return false;
  if (inst.count > 2) return false;
  for (std::uint32_t i = 0; i < inst.count; ++i) {
    const Inst* constant = graph.constant(graph.source(inst, i).value);
    if (!constant) return false;
    source[i] = constant->imm[graph.source(inst, i).swizzle[0]];
  }
  const std::uint64_t all = std::uint64_t{source[1]} << 32 | source[0];
  switch (inst.op) {
    case Op::kDFromF:
      literal_words(static_cast<double>(base::float_of(source[0])), 64, words);
      return true;
    case Op::kDFromI:
      literal_words(static_cast<std::int32_t>(source[0]), 64, words);
      return true;
    case Op::kDFromU:
      literal_words(source[0], 64, words);
      return true;
    case Op::kDFromL:
      literal_words(static_cast<double>(static_cast<std::int64_t>(all)), 64, words);
      return true;
    case Op::kDFromQ:
      literal_words(static_cast<double>(all), 64, words);
      return true;
    case Op::kFFromD:
      literal_words(std::bit_cast<double>(all), 32, words);
      return true;
    case Op::kFFromL:
      words[0] = base::bits_of(static_cast<float>(static_cast<std::int64_t>(all)));
      return true;
    case Op::kFFromQ:
      words[0] = base::bits_of(static_cast<float>(all));
      return true;
    default:
      return false;
  }
}

bool evaluate_sized(const Graph& graph, const Inst& inst, unsigned c, std::uint32_t words[2]) {
  const char* const letters = ir::alu_info(inst.op).operands;
  double numbers[3] = {};
  std::uint32_t singles[3] = {};
  for (std::uint32_t i = 0; i < inst.count; ++i) {
    const Src src = graph.source(inst, i);
    const Inst* constant = graph.constant(src.value);
    if (!constant) return false;
    std::array<std::uint8_t, 4> swizzle = src.swizzle;
    if (inst.width != 64) swizzle[0] = src.swizzle[c];
    if (letters[i] == 'B') {
      singles[i] = constant->imm[swizzle[0]];
      numbers[i] = singles[i] != 0 ? 1.0 : 0.0;
      continue;
    }
    numbers[i] = literal_number(*constant, swizzle, inst.width);
    singles[i] = base::bits_of(static_cast<float>(numbers[i]));
  }
  if (bool holds = false; fold_comparison(inst.op, numbers[0], numbers[1], holds)) {
    words[0] = holds ? 1 : 0;
    return true;
  }
  if (inst.width == 16) {
    std::uint32_t result = 0;
    if (inst.op == Op::kFLrp) {
      const float x = base::float_of(singles[0]), y = base::float_of(singles[1]), weight = base::float_of(singles[2]);
      const float rest = 1.0f - weight;
      const float left = x * rest, right = y * weight;
      words[0] = base::float_to_half_nearest(left + right);
      return true;
    }
    if (!evaluate(inst.op, singles, result)) return false;
    words[0] = base::float_to_half_nearest(base::float_of(result));
    return true;
  }
  double result = 0.0;
  if (inst.op == Op::kB2F) {
    result = numbers[0];
  } else if (inst.op == Op::kFMulAdd) {
    const double product = numbers[0] * numbers[1];
    result = product + numbers[2];
  } else if (inst.op == Op::kFSign) {
    result = numbers[0] > 0.0 ? 1.0 : numbers[0] < 0.0 ? -1.0 : 0.0;
  } else if (inst.op == Op::kFAddInSum) {
    result = numbers[0] + numbers[1];
  } else if (!fold_unary(inst.op, numbers[0], result) && !fold_binary(inst.op, numbers[0], numbers[1], result)) {
    return false;
  }
  literal_words(result, 64, words);
  return true;
}

}  // namespace vitrine::spirv::rewriting
