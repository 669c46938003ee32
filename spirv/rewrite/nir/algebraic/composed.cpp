// Dot products, remainders, ldexp, reductions of booleans, inserted and unpacked bits, which are single operations in
// the reference's first round: what the front end made of them stays closed to the rules until then, and vectors that
// end in zeros shorten dot products (lavapipe-shader-math.md 5.1).
#include "spirv/rewrite/nir/algebraic/composed.h"

#include <algorithm>
#include <initializer_list>

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

/// Whether operand `index` of the operation, which ends a composed one or is a part of it, can be made by a part of
/// this kind: of a reduction of booleans, of inserted, packed or unpacked bits, of a number limited to 0 and 1, or of a
/// power of two (of ldexp). What a composed operation takes is no part of it, though it may end another one.
bool is_part_of(const Graph& graph, const Inst& inst, std::uint32_t index, const Inst& part) {
  const auto one_of = [&](std::initializer_list<Op> ops) {
    return std::find(ops.begin(), ops.end(), part.op) != ops.end();
  };
  switch (inst.op) {
    case Op::kAndB:
    case Op::kOrB:
      return one_of({inst.op, Op::kEqB, Op::kXorB});
    case Op::kSelect:
      return part.op == (index == 0 ? Op::kULt : Op::kOr) && index != 1;
    case Op::kOr:
      return one_of({Op::kOr, Op::kAnd, Op::kShl});
    case Op::kAnd:
      return one_of({Op::kNot, Op::kShl, Op::kF2U, Op::kF2I, Op::kF2Half});
    case Op::kNot:
      return part.op == Op::kShl;
    case Op::kShl:
      return one_of({Op::kISub, Op::kAnd, Op::kIAdd});
    case Op::kIAdd:
    case Op::kISub:
      return one_of({Op::kShl, Op::kISub, Op::kIShr, Op::kIMin});
    case Op::kIShr:
      return part.op == Op::kIMin;
    case Op::kIMin:
      return part.op == Op::kIMax;
    case Op::kF2U:
    case Op::kF2I:
      return part.op == Op::kFRoundEven;
    case Op::kFRoundEven:
      return part.op == Op::kFMul;
    case Op::kFMul:
      return part.op == Op::kFMin;
    case Op::kFMin:
      return part.op == Op::kFMax;
    case Op::kFMax:
      return part.op == Op::kFDiv && is_alu(graph.def(graph.source(part, 0).value), Op::kI2F);
    case Op::kFDiv:
      return one_of({Op::kI2F, Op::kU2F});
    case Op::kI2F:
      return part.op == Op::kBfeI;
    case Op::kU2F:
    case Op::kHalf2F:
      return part.op == Op::kBfeU;
    default:
      return false;
  }
}

/// The parts of a composed operation that operand `index` of what ends it, or of a part, is made of, operands first.
void add_parts(const Graph& graph, const Inst& inst, std::uint32_t index, std::vector<InstId>& parts) {
  const auto add = [&](Src src) {
    InstId id = graph.values[src.value].def;
    if (id != kNone && graph.insts[id].op == Op::kMov) id = graph.values[graph.source(graph.insts[id], 0).value].def;
    if (id == kNone) return;
    const Inst& part = graph.insts[id];
    if (!part.opaque || part.kind != Kind::kAlu || !is_part_of(graph, inst, index, part)) return;
    for (std::uint32_t i = 0; i < part.count; ++i) add_parts(graph, part, i, parts);
    parts.push_back(id);
  };
  const Src src = graph.source(inst, index);
  const Inst* fields = graph.def(src.value);
  const bool unpacks = inst.op == Op::kI2F || inst.op == Op::kU2F || inst.op == Op::kHalf2F;
  if (!unpacks || !fields || fields->kind != Kind::kVec) return add(src);
  for (std::uint32_t i = 0; i < fields->count; ++i) add(graph.source(*fields, i));
}

std::vector<InstId> parts_of_tree(const Graph& graph, const Inst& end) {
  std::vector<InstId> parts;
  for (std::uint32_t i = 0; i < end.count; ++i) add_parts(graph, end, i, parts);
  return parts;
}

/// ldexp: the first product, and what makes the powers of two that both products multiply by.
std::vector<InstId> parts_of_product(const Graph& graph, const Inst& end) {
  const Inst* scaled = graph.def(graph.source(end, 0).value);
  const bool part = is_alu(scaled, Op::kFMul) && scaled->opaque &&
                    (scaled->opens == Opens::kAfterRules || scaled->opens == Opens::kWithResult);
  if (!part) return {};
  std::vector<InstId> parts;
  for (const Inst* product : {scaled, &end}) {
    const InstId power = graph.values[graph.source(*product, 1).value].def;
    if (power == kNone || !is_alu(&graph.insts[power], Op::kShl) || !graph.insts[power].opaque) continue;
    add_parts(graph, graph.insts[power], 0, parts);
    parts.push_back(power);
  }
  parts.push_back(graph.values[scaled->result].def);
  return parts;
}

/// Limits a number to 0 and 1, which is free where the reference counts operations.
bool saturates(const Graph& graph, const Inst& end) {
  if (end.op != Op::kFMin) return false;
  const Inst* largest = graph.def(graph.source(end, 0).value);
  if (!is_alu(largest, Op::kFMax) || !largest->opaque) return false;
  const Inst* scaled = graph.def(graph.source(*largest, 0).value);
  return !is_alu(scaled, Op::kFDiv) || !scaled->opaque;
}

}  // namespace

std::vector<InstId> parts_of_composed(const Graph& graph, InstId id) {
  const Inst& end = graph.insts[id];
  if (!end.opaque || end.kind != Kind::kAlu) return {};
  if (end.op == Op::kFMul) return parts_of_product(graph, end);
  if (end.op != Op::kFSub) return parts_of_tree(graph, end);
  const Inst* product = graph.def(graph.source(end, 1).value);
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
  if (inst.opaque && saturates(graph, inst)) return 0;
  if (!inst.opaque || inst.op != Op::kFAdd) return 1;
  // One dot product, later one sum of products, where we have a chain of additions.
  const Inst* before = graph.def(graph.source(inst, 0).value);
  return graph.first_rules || (before && before->opaque && is_alu(before, Op::kFAdd)) ? 0 : 1;
}

}  // namespace vitrine::spirv::rewriting
