// Operations on constants become their results (nir_opt_constant_folding.c; lavapipe-optimizer.md 4.7).
#include "base/float_mode.h"
#include "base/numeric.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/literals.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/nir/constant_expressions.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

void become_constant(Graph& graph, InstId id, const std::uint32_t* bits) {
  const Inst& inst = graph.insts[id];
  replace_inst(graph, id, Builder(graph, id).literal(inst.components, inst.boolean, bits).value);
}

bool fold_vector(Graph& graph, InstId id) {
  const Inst& inst = graph.insts[id];
  std::uint32_t bits[4] = {};
  for (std::uint32_t c = 0; c < inst.count; ++c) {
    const std::optional<std::uint32_t> part = literal_of(graph, graph.source(inst, c));
    if (!part) return false;
    bits[c] = *part;
  }
  become_constant(graph, id, bits);
  return true;
}

/// A sum of literals, of halves rounded once.
bool fold_sum(Graph& graph, InstId id) {
  const Inst& inst = graph.insts[id];
  const Src src = graph.source(inst, 0);
  const Inst* constant = graph.constant(src.value);
  if (!constant) return false;
  float sum = 0.0f;
  for (unsigned c = 0; c < operand_components(inst, 0); ++c) {
    const std::uint8_t s = src.swizzle[c];
    const auto number = static_cast<float>(literal_number(*constant, {s, s, s, s}, inst.width));
    sum = c == 0 ? number : sum + number;
  }
  std::uint32_t words[2] = {base::bits_of(sum), 0};
  if (inst.width == 16) words[0] = base::float_to_half_nearest(sum);
  become_constant(graph, id, words);
  return true;
}

bool fold_sized(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  std::uint32_t bits[5] = {};
  const unsigned steps = inst.width == 64 ? 1 : inst.components;
  for (unsigned c = 0; c < steps; ++c)
    if (!evaluate_sized(graph, inst, c, bits + c)) return false;
  become_constant(graph, id, bits);
  return true;
}

bool fold_conversion(Graph& graph, InstId id) {
  std::uint32_t words[2] = {};
  const Inst& inst = graph.insts[id];
  if (!evaluate_conversion(graph, inst, words) && !evaluate_integers(graph, inst, words)) return false;
  become_constant(graph, id, words);
  return true;
}

/// Replaces `id` by a constant if all its operands are constant.
bool fold(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  if (inst.kind == Inst::Kind::kVec) return fold_vector(graph, id);
  if (inst.op == Op::kFSum2 || inst.op == Op::kFSum3 || inst.op == Op::kFSum4) return fold_sum(graph, id);
  if (computes(inst) && inst.op >= Op::kExecutedCount && inst.op != Op::kFLrp && inst.op != Op::kFAddInSum)
    return false;  // its turn comes when it has been taken apart
  if (inst.kind == Inst::Kind::kSized) return fold_sized(graph, id);
  if (inst.kind == Inst::Kind::kIntrinsic) return fold_conversion(graph, id);
  if (inst.kind != Inst::Kind::kAlu || inst.count == 0) return false;
  std::uint32_t bits[4] = {};
  if (is_minimum_with_zero(graph, inst)) {
    become_constant(graph, id, bits);
    return true;
  }
  if (const Src number = extended_before(graph, inst); number.value != ir::kNoValue) {
    graph.replace_uses(inst.result, number.value);
    graph.remove(id);
    return true;
  }
  const Inst* constants[3] = {};
  for (std::uint32_t i = 0; i < inst.count; ++i) {
    constants[i] = graph.constant(graph.source(inst, i).value);
    if (!constants[i]) return false;
  }
  for (unsigned c = 0; c < inst.components; ++c) {
    std::uint32_t operand[3] = {};
    for (std::uint32_t i = 0; i < inst.count; ++i) operand[i] = constants[i]->imm[graph.source(inst, i).swizzle[c]];
    if (!evaluate(inst.op, operand, bits[c])) return false;
  }
  become_constant(graph, id, bits);
  return true;
}

}  // namespace

bool opt_constant_folding(Graph& graph) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  bool changed = false;
  auto visit = [&](InstId id) { changed |= fold(graph, id); };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting
