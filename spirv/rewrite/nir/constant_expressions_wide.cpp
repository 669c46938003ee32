// Folding of 64-bit integers: operations on literals, and those that are literal whatever their operands are
// (lavapipe-optimizer.md 4.7).
#include "spirv/rewrite/nir/constant_expressions.h"

#include "spirv/rewrite/graph/match.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// An operand of two words: its value if it is literal.
struct Integer {
  Src low, high;
  bool known = false;
  std::uint64_t value = 0;

  bool is(std::uint64_t number) const { return known && value == number; }
};

bool same_integer(const Integer& a, const Integer& b) { return same(a.low, b.low) && same(a.high, b.high); }

bool read_word(const Graph& graph, Src src, std::uint64_t& word) {
  const Inst* constant = graph.constant(src.value);
  if (constant) word = constant->imm[src.swizzle[0]];
  return constant != nullptr;
}

/// The operand whose low word is source `first`.
Integer operand_of(const Graph& graph, const Inst& inst, std::uint32_t first) {
  Integer operand{graph.source(inst, first), graph.source(inst, first + 1), false, 0};
  std::uint64_t low = 0, high = 0;
  operand.known = read_word(graph, operand.low, low) && read_word(graph, operand.high, high);
  operand.value = high << 32 | low;
  return operand;
}

/// `negated` is 0 - `number`.
bool is_negation(const Graph& graph, const Integer& negated, const Integer& number) {
  const Inst* inst = graph.def(negated.low.value);
  return inst && inst->kind == Kind::kIntrinsic && inst->op == Op::kQSub && negated.low.value == negated.high.value &&
         negated.low.swizzle[0] == 0 && negated.high.swizzle[0] == 1 && operand_of(graph, *inst, 0).is(0) &&
         same_integer(operand_of(graph, *inst, 2), number);
}

/// The smaller or larger one of two operands, which the front end writes as a comparison and a selection of each word.
struct Extremum {
  bool found = false, maximum = false;
  Integer a, b;
};

/// `less`: the comparison that it is for signed or unsigned numbers.
Extremum extremum_of(const Graph& graph, const Integer& number, Op less) {
  const Inst *low = graph.def(number.low.value), *high = graph.def(number.high.value);
  for (const Inst* word : {low, high})
    if (!word || word->kind != Kind::kAlu || word->op != Op::kSelect || word->components != 1) return {};
  const Inst* compared = graph.def(graph.source(*low, 0).value);
  if (!compared || compared->kind != Kind::kIntrinsic || compared->op != less ||
      !same(graph.source(*low, 0), graph.source(*high, 0)))
    return {};
  const Integer a = operand_of(graph, *compared, 0), b = operand_of(graph, *compared, 2);
  const Integer first{graph.source(*low, 1), graph.source(*high, 1)},
      second{graph.source(*low, 2), graph.source(*high, 2)};
  const bool maximum = same_integer(first, b) && same_integer(second, a);
  return {maximum || (same_integer(first, a) && same_integer(second, b)), maximum, a, b};
}

/// What is known of left < right where one of them is the smaller or larger one of two numbers: the other one is one of
/// these, or literal as one of these is.
bool compare_extremum(const Graph& graph, const Integer& left, const Integer& right, Op less, bool& result) {
  const auto literal_less = [&](const Integer& x, const Integer& y) {
    return less == Op::kLLt ? static_cast<std::int64_t>(x.value) < static_cast<std::int64_t>(y.value)
                            : x.value < y.value;
  };
  for (const bool is_left : {true, false}) {
    const Integer& other = is_left ? right : left;
    const Extremum extremum = extremum_of(graph, is_left ? left : right, less);
    if (!extremum.found) continue;
    result = is_left != extremum.maximum;
    for (const Integer& part : {extremum.a, extremum.b}) {
      if (same_integer(part, other) && !result) return true;
      if (part.known && other.known && (is_left ? literal_less(part, other) : literal_less(other, part)) == result)
        return true;
    }
  }
  return false;
}

bool evaluate_shift(const Graph& graph, const Inst& inst, std::uint64_t& result) {
  const Integer a = operand_of(graph, inst, 0);
  std::uint64_t count = 0;
  const bool known = read_word(graph, graph.source(inst, 2), count);
  count &= 63;
  if (inst.op == Op::kQShl) result = a.value << count;
  if (inst.op == Op::kQShr) result = a.value >> count;
  if (inst.op == Op::kLShr) result = static_cast<std::uint64_t>(static_cast<std::int64_t>(a.value) >> count);
  return a.is(0) || (a.known && known);
}

bool evaluate_comparison(const Graph& graph, const Inst& inst, std::uint64_t& result) {
  const bool negated = inst.op == Op::kLGe || inst.op == Op::kQGe;
  if (!negated && inst.op != Op::kLLt && inst.op != Op::kQLt) return false;
  const Op less = inst.op == Op::kLLt || inst.op == Op::kLGe ? Op::kLLt : Op::kQLt;
  bool is_less = false;
  if (!compare_extremum(graph, operand_of(graph, inst, 0), operand_of(graph, inst, 2), less, is_less)) return false;
  result = is_less != negated ? 1 : 0;
  return true;
}

bool evaluate_binary(const Graph& graph, const Inst& inst, std::uint64_t& result) {
  const Integer a = operand_of(graph, inst, 0), b = operand_of(graph, inst, 2);
  const bool known = a.known && b.known, equal = same_integer(a, b);
  const auto left = static_cast<std::int64_t>(a.value), right = static_cast<std::int64_t>(b.value);
  switch (inst.op) {
    case Op::kQAdd:
      result = known ? a.value + b.value : 0;
      return known || is_negation(graph, a, b) || is_negation(graph, b, a);
    case Op::kQSub:
      result = known ? a.value - b.value : 0;
      return known || equal;
    case Op::kQMul:
      result = known ? a.value * b.value : 0;
      return known || a.is(0) || b.is(0);
    case Op::kQDiv:
      result = known && b.value != 0 ? a.value / b.value : 0;
      return known;
    case Op::kQMod:
      result = 0;
      return b.is(1);
    case Op::kLRem:
    case Op::kLMod:
      result = 0;
      return b.is(1) || b.is(~std::uint64_t{0});
    case Op::kLLt:
      result = known && left < right ? 1 : 0;
      return known || equal;
    case Op::kLGe:
      result = !known || left >= right ? 1 : 0;
      return known || equal;
    case Op::kQLt:  // nothing is less than 0
      result = known && a.value < b.value ? 1 : 0;
      return known || equal || b.is(0);
    case Op::kQGe:
      result = !known || a.value >= b.value ? 1 : 0;
      return known || equal || b.is(0);
    default:
      return false;
  }
}

}  // namespace

bool evaluate_integers(const Graph& graph, const Inst& inst, std::uint32_t words[2]) {
  std::uint64_t result = 0;
  const bool shifts = inst.op == Op::kQShl || inst.op == Op::kQShr || inst.op == Op::kLShr;
  if (inst.count != (shifts ? 3u : 4u)) return false;
  if (shifts ? !evaluate_shift(graph, inst, result)
             : !evaluate_binary(graph, inst, result) && !evaluate_comparison(graph, inst, result))
    return false;
  words[0] = static_cast<std::uint32_t>(result);
  words[1] = static_cast<std::uint32_t>(result >> 32);
  return true;
}

bool is_minimum_with_zero(const Graph& graph, const Inst& select) {
  if (select.op != Op::kSelect || select.components != 1) return false;
  const Inst* less = graph.def(graph.source(select, 0).value);
  const Src other = graph.source(select, 2);
  std::uint64_t word = 1;
  if (!less || less->kind != Kind::kIntrinsic || less->op != Op::kQLt || !operand_of(graph, *less, 0).is(0))
    return false;
  const Integer number = operand_of(graph, *less, 2);
  return read_word(graph, graph.source(select, 1), word) && word == 0 &&
         (same(number.low, other) || same(number.high, other));
}

}  // namespace vitrine::spirv::rewriting
