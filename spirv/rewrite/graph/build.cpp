// See build.h.
#include "spirv/rewrite/graph/build.h"

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// What an intrinsic has besides its operands.
void add_node(Graph& graph, InstId inst) {
  graph.insts[inst].node = static_cast<std::uint32_t>(graph.nodes.size());
  graph.nodes.push_back(std::make_unique<ir::Node>());
}

}  // namespace

Src result_of(const Graph& graph, InstId inst) {
  return {graph.insts[inst].result, graph.insts[inst].components == 1 ? std::array<std::uint8_t, 4>{} : kWhole};
}

Builder::Builder(Graph& graph, InstId position) : Builder(graph, position, false, graph.insts[position].origin) {}

Builder::Builder(Graph& graph, InstId position, bool behind, const ir::Origin& origin)
    : graph_(graph), position_(position), behind_(behind), origin_(origin) {}

Builder Builder::behind(Graph& graph, InstId position) { return behind(graph, position, graph.insts[position].origin); }

Builder Builder::behind(Graph& graph, InstId position, const ir::Origin& origin) {
  return {graph, position, true, origin};
}

Src Builder::place(InstId made) {
  graph_.insts[made].origin = origin_;
  if (behind_) {
    graph_.insert_after(position_, made);
    position_ = made;
  } else {
    graph_.insert_before(position_, made);
  }
  return result_of(graph_, made);
}

Src Builder::make(Kind kind, Op op, unsigned components, bool boolean, std::span<const Src> operands) {
  const InstId made = graph_.create(kind, op, static_cast<std::uint8_t>(components), boolean,
                                    static_cast<std::uint32_t>(operands.size()));
  std::uint32_t index = 0;
  for (const Src& src : operands) graph_.set_source(made, index++, src);
  return place(made);
}

Src Builder::alu(Op op, std::initializer_list<Src> operands, unsigned components) {
  return make(Kind::kAlu, op, components, ir::alu_info(op).result == 'B', std::span(operands.begin(), operands.size()));
}

Src Builder::like(const Inst& model, Op op, std::span<const Src> operands, unsigned components) {
  const Kind kind = model.kind;
  const std::uint8_t width = model.width;
  const bool exact = model.exact, packs = model.packs;
  const Src made = make(kind, op, components, ir::alu_info(op).result == 'B', operands);
  Inst& inst = graph_.insts[graph_.values[made.value].def];
  inst.width = width;
  inst.exact = exact;
  inst.packs = packs;
  return made;
}

Src Builder::wide(Op op, std::span<const Src> operands) {
  const char result = ir::wide_info(op).result;
  return make(Kind::kIntrinsic, op, ir::wide_words(result), result == 'B', operands);
}

Src Builder::vec(std::span<const Src> components, bool boolean) {
  return make(Kind::kVec, Op::kVec, static_cast<unsigned>(components.size()), boolean, components);
}

Src Builder::literal(std::uint32_t bits) { return literal(1, false, &bits); }

Src Builder::truth(bool value) {
  const std::uint32_t bits = value ? 1 : 0;
  return literal(1, true, &bits);
}

Src Builder::literal(unsigned components, bool boolean, const std::uint32_t* bits) {
  return place(graph_.create_const(static_cast<std::uint8_t>(components), boolean, bits));
}

Src Builder::access(Op op, unsigned components, std::initializer_list<Src> operands,
                    std::array<std::uint32_t, 3> data) {
  const InstId made = graph_.create(Kind::kIntrinsic, op, static_cast<std::uint8_t>(components), false,
                                    static_cast<std::uint32_t>(operands.size()));
  add_node(graph_, made);
  std::uint32_t index = 0;
  for (const Src& src : operands) graph_.set_source(made, index++, src);
  for (std::size_t i = 0; i < data.size(); ++i) node_of(graph_, made).instr.data[i] = data[i];
  return place(made);
}

Src Builder::undefined(unsigned components) {
  const InstId made = graph_.create(Kind::kIntrinsic, Op::kUndef, static_cast<std::uint8_t>(components), false, 0);
  add_node(graph_, made);
  return place(made);
}

Src Builder::move(Src src, ValueId like) { return place(make_move(graph_, src, like)); }

InstId make_jump(Graph& graph, Op op, const std::vector<Src>& operands) {
  const InstId jump = graph.create(Kind::kIntrinsic, op, 0, false, 0);
  add_node(graph, jump);
  graph.set_operands(jump, operands);
  return jump;
}

void replace_inst(Graph& graph, InstId id, ValueId by) {
  graph.replace_uses(graph.insts[id].result, by);
  graph.remove(id);
}

}  // namespace vitrine::spirv::rewriting
