// What an operation reads: questions, and patterns of operations in the manner of LLVM's PatternMatch:
//   Src word, offset;
//   match(graph, src, m_op(Op::kUShr, m_value(word), m_value(offset)))
// All look at one component: what they match are operations on scalars of 32 bits.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

// ---- questions

/// The bits that are read, if those are literal.
inline std::optional<std::uint32_t> literal_of(const Graph& graph, Src src) {
  const Inst* constant = graph.constant(src.value);
  return constant ? std::optional(constant->imm[src.swizzle[0]]) : std::nullopt;
}

inline bool is_literal(const Graph& graph, Src src, std::uint32_t bits) { return literal_of(graph, src) == bits; }

/// Both read the same component.
inline bool same(Src a, Src b) { return a.value == b.value && a.swizzle[0] == b.swizzle[0]; }

/// `inst` computes `op` with numbers of 32 bits.
inline bool is_op(const Inst* inst, Op op) { return inst && inst->kind == Inst::Kind::kAlu && inst->op == op; }

/// The operation on scalars of 32 bits that makes what is read; null if something else does.
inline const Inst* scalar_operation(const Graph& graph, Src src) {
  const Inst* inst = graph.def(src.value);
  return inst && inst->kind == Inst::Kind::kAlu && inst->components == 1 && inst->width == 32 ? inst : nullptr;
}

/// The same if it is this operation.
inline const Inst* scalar_operation(const Graph& graph, Src src, Op op) {
  const Inst* inst = scalar_operation(graph, src);
  return inst && inst->op == op ? inst : nullptr;
}

inline bool is_used_once(const Graph& graph, Src src) { return graph.values[src.value].uses == 1; }

// ---- patterns

template <class Pattern>
bool match(const Graph& graph, Src src, const Pattern& pattern) {
  return pattern.matches(graph, src);
}

struct MatchValue {
  Src& bound;
  bool matches(const Graph&, Src src) const { return bound = src, true; }
};
/// Anything, which is bound.
inline MatchValue m_value(Src& bound) { return {bound}; }

struct MatchSame {
  const Src& other;
  bool matches(const Graph&, Src src) const { return same(src, other); }
};
/// What has been bound before.
inline MatchSame m_same(const Src& bound) { return {bound}; }

struct MatchLiteral {
  std::uint32_t bits;
  bool matches(const Graph& graph, Src src) const { return is_literal(graph, src, bits); }
};
inline MatchLiteral m_literal(std::uint32_t bits) { return {bits}; }

struct MatchAnyLiteral {
  std::uint32_t& bits;
  bool matches(const Graph& graph, Src src) const {
    const std::optional<std::uint32_t> found = literal_of(graph, src);
    if (found) bits = *found;
    return found.has_value();
  }
};
/// Any literal, whose bits are bound.
inline MatchAnyLiteral m_any_literal(std::uint32_t& bits) { return {bits}; }

template <class... Operands>
struct MatchOp {
  Op op;
  std::tuple<Operands...> operands;
  bool matches(const Graph& graph, Src src) const {
    const Inst* inst = scalar_operation(graph, src, op);
    return inst && matches_operands(graph, *inst, std::index_sequence_for<Operands...>());
  }

 private:
  template <std::size_t... kIndex>
  bool matches_operands(const Graph& graph, const Inst& inst, std::index_sequence<kIndex...>) const {
    return (std::get<kIndex>(operands).matches(graph, graph.source(inst, kIndex)) && ...);
  }
};
/// An operation whose operands match in their order; fewer patterns than operands: the first ones.
template <class... Operands>
MatchOp<Operands...> m_op(Op op, Operands... operands) {
  return {op, {operands...}};
}

template <class Pattern>
struct MatchOnce {
  Pattern pattern;
  bool matches(const Graph& graph, Src src) const { return is_used_once(graph, src) && pattern.matches(graph, src); }
};
/// The same, of a value with one use.
template <class Pattern>
MatchOnce<Pattern> m_once(Pattern pattern) {
  return {pattern};
}

}  // namespace vitrine::spirv::rewriting
