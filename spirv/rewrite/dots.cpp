// Dot products, remainders, ldexp and reductions of booleans, which are single operations in the reference's first
// round: what the front end made of them stays closed to the rules until then, and vectors that end in zeros shorten
// dot products (lavapipe-shader-math.md 5.1).
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

bool is_alu(const Inst* inst, Op op) { return inst && computes(*inst) && inst->op == op; }

/// The instruction that uses `value`, if there is one only and it is a part of a dot product.
InstId next_sum(const Graph& graph, ValueId value) {
  const Slot use = graph.values[value].first_use;
  if (use == kNone) return kNone;
  const Inst& user = graph.insts[graph.sources[use].user];
  return user.opaque && is_alu(&user, Op::kFAdd) ? graph.sources[use].user : kNone;
}

/// Zeros that end the vector, which must be composed, not loaded or constant as a whole.
unsigned ending_zeros(const Graph& graph, const Inst& product, std::uint32_t index) {
  const Src src = graph.source(product, index);
  const Inst* vec = graph.def(src.value);
  if (!vec || vec->kind != Kind::kVec || vec->count != product.components) return 0;
  unsigned zeros = 0;
  for (unsigned c = product.components; c-- > 0; ++zeros) {
    if (src.swizzle[c] != c) return 0;
    const Src part = graph.source(*vec, c);
    const Inst* constant = graph.constant(part.value);
    if (!constant || (constant->imm[part.swizzle[0]] & 0x7fffffffu) != 0) break;
  }
  for (unsigned c = 0; c < product.components; ++c)
    if (src.swizzle[c] != c) return 0;
  return zeros;
}

class Shortener {
 public:
  explicit Shortener(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    const Inst product = graph_.insts[id];
    if (product.kind != Kind::kAlu || product.op != Op::kFMul || product.opens != Opens::kAfterRules) return;
    const InstId last = last_sum(product);
    if (last == kNone) return;
    for (const std::uint32_t index : {0u, 1u}) {
      const unsigned zeros = ending_zeros(graph_, product, index);
      if (zeros == 0) continue;
      replace(product, last, std::max(1u, product.components - zeros), index);
      return;
    }
  }

 private:
  InstId last_sum(const Inst& product) const {
    InstId sum = next_sum(graph_, product.result);
    for (unsigned c = 2; c < product.components && sum != kNone; ++c) sum = next_sum(graph_, graph_.insts[sum].result);
    return sum;
  }

  InstId add(const Inst& like, InstId position, Op op, Src a, Src b, Opens opens) {
    const InstId made = graph_.create(Kind::kAlu, op, 1, false, 2);
    graph_.insts[made].exact = like.exact;
    graph_.insts[made].origin = like.origin;
    graph_.insts[made].opaque = true;
    graph_.insts[made].opens = opens;
    graph_.set_source(made, 0, a);
    graph_.set_source(made, 1, b);
    graph_.insert_before(position, made);
    return made;
  }

  /// Products of the first `left` components; several are added from the last to the first.
  void replace(const Inst& product, InstId last, unsigned left, std::uint32_t composed) {
    const Opens opens = left == 1 ? Opens::kVisited : Opens::kAfterRound;
    InstId sum = kNone;
    for (unsigned c = left; c-- > 0;) {
      Src factor[2];
      for (const std::uint32_t i : {0u, 1u}) {
        const Src src = graph_.source(product, i);
        const std::uint8_t s = src.swizzle[c];
        factor[i] = {src.value, {s, s, s, s}};
      }
      const Inst& vec = *graph_.def(graph_.source(product, composed).value);
      factor[composed] = graph_.source(vec, c);
      const std::uint8_t s = factor[composed].swizzle[0];
      factor[composed].swizzle = {s, s, s, s};
      const InstId part = add(product, last, Op::kFMul, factor[composed], factor[1 - composed], opens);
      const Src value{graph_.insts[part].result, {0, 0, 0, 0}};
      sum = sum == kNone ? part : add(product, last, Op::kFAdd, {graph_.insts[sum].result, {0, 0, 0, 0}}, value, opens);
    }
    graph_.replace_uses(graph_.insts[last].result, graph_.insts[sum].result);
  }

  Graph& graph_;
};

/// The comparisons of components that a reduction of booleans joins, and their joints, operands first.
std::vector<InstId> parts_of_reduction(const Graph& graph, const Inst& end) {
  std::vector<InstId> parts;
  for (std::uint32_t i = 0; i < end.count; ++i) {
    const InstId part = graph.values[graph.source(end, i).value].def;
    if (part == kNone || !graph.insts[part].opaque || graph.insts[part].kind != Kind::kAlu) continue;
    if (graph.insts[part].op != Op::kXorB) {
      const std::vector<InstId> inner = parts_of_reduction(graph, graph.insts[part]);
      parts.insert(parts.end(), inner.begin(), inner.end());
    }
    parts.push_back(part);
  }
  return parts;
}

}  // namespace

std::vector<InstId> parts_of_composed(const Graph& graph, InstId id) {
  const Inst& end = graph.insts[id];
  if (!end.opaque || end.kind != Kind::kAlu) return {};
  if (end.op == Op::kAndB || end.op == Op::kOrB) return parts_of_reduction(graph, end);
  if (end.op == Op::kFMul) {
    const Inst* scaled = graph.def(graph.source(end, 0).value);
    const bool part = is_alu(scaled, Op::kFMul) && scaled->opaque &&
                      (scaled->opens == Opens::kAfterRules || scaled->opens == Opens::kWithResult);
    return part ? std::vector<InstId>{graph.values[scaled->result].def} : std::vector<InstId>{};
  }
  const Inst* product = end.op == Op::kFSub ? graph.def(graph.source(end, 1).value) : nullptr;
  if (!is_alu(product, Op::kFMul)) return {};
  const Inst* rounded = graph.def(graph.source(*product, 1).value);
  if (!is_alu(rounded, Op::kFFloor) && !is_alu(rounded, Op::kFTrunc)) return {};
  std::vector<InstId> parts;
  for (const Inst* part : {graph.def(graph.source(*rounded, 0).value), rounded, product})
    if (part && is_alu(part, part->op) && part->opaque) parts.push_back(graph.values[part->result].def);
  return parts;
}

void hide_composed(Graph& graph) {
  const auto is_sum_of = [&](const Inst& inst, ValueId products) {
    return inst.opaque && inst.count == 2 && graph.source(inst, 1).value == products;
  };
  auto visit = [&](InstId id) {
    Inst& inst = graph.insts[id];
    if (!inst.opaque) return;
    const std::vector<InstId> parts = parts_of_composed(graph, id);
    if (!parts.empty()) {
      inst.opens = Opens::kVisited;
      for (const InstId part : parts) graph.insts[part].opens = Opens::kWithResult;
      return;
    }
    if (inst.op != Op::kFAdd) {
      inst.opens = Opens::kAfterRules;
      return;
    }
    const ValueId products = graph.source(inst, 1).value;
    const InstId multiplication = graph.values[products].def;
    if (multiplication != kNone && is_alu(&graph.insts[multiplication], Op::kFMul)) {
      graph.insts[multiplication].opaque = true;
      graph.insts[multiplication].opens = Opens::kAfterRules;
    }
    const Slot use = graph.values[inst.result].first_use;
    const bool more = use != kNone && is_sum_of(graph.insts[graph.sources[use].user], products);
    if (graph.source(inst, 0).value == products && !more) inst.opens = Opens::kVisitedAfterRound;
  };
  for_each_inst(graph, graph.root, visit);
}

void shorten_dot_products(Graph& graph) {
  Shortener shortener(graph);
  auto visit = [&](InstId id) { shortener.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

void show_products(Graph& graph) {
  graph.first_rules = false;
  for (Inst& inst : graph.insts)
    if (inst.opens == Opens::kAfterRules || inst.opens == Opens::kWithResult) inst.opaque = false;
}

void show_short_products(Graph& graph) {
  for (Inst& inst : graph.insts)
    if (inst.opens == Opens::kAfterRound) inst.opaque = false;
}

unsigned cost_of(const Graph& graph, const Inst& inst) {
  if (inst.opaque && inst.opens == Opens::kWithResult) return 0;
  if (!inst.opaque || inst.op != Op::kFAdd) return 1;
  // One dot product, later one sum of products, where we have a chain of additions.
  const Inst* before = graph.def(graph.source(inst, 0).value);
  return graph.first_rules || (before && before->opaque && is_alu(before, Op::kFAdd)) ? 0 : 1;
}

}  // namespace vitrine::spirv::rewriting
