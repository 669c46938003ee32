// Arithmetic on vectors becomes arithmetic on their components (nir_lower_alu_width.c; lavapipe-optimizer.md 3.7).
#include <array>
#include <initializer_list>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// One scalar instruction per component, and a Vec of them.
void split(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  Builder build(graph, id);
  std::array<Src, 4> parts, operands;
  for (unsigned c = 0; c < inst.components; ++c) {
    for (std::uint32_t i = 0; i < inst.count; ++i) operands[i] = scalar(graph.source(inst, i), c);
    parts[c] = build.like(inst, inst.op, std::span(operands).first(inst.count));
  }
  replace_inst(graph, id, build.vec(std::span(parts).first(inst.components), inst.boolean).value);
}

/// What takes a vector to one number, or one number to a vector.
class Reducer {
 public:
  Reducer(Graph& graph, InstId id) : graph_(graph), inst_(graph.insts[id]), id_(id) {}

  void run() { replace_inst(graph_, id_, reduced().value); }

  static bool knows(Op op) {
    switch (op) {
      case Op::kFDot2:
      case Op::kFDot3:
      case Op::kFDot4:
      case Op::kPackUvec2ToUint:
      case Op::kPackUvec4ToUint:
      case Op::kPackHalf2x16:
      case Op::kUnpackHalf2x16:
        return true;
      default:
        return false;
    }
  }

 private:
  Src reduced() {
    switch (inst_.op) {
      case Op::kPackUvec2ToUint:
        return add(Op::kOr, {field(1, 16, 0xffff), field(0, 0, 0xffff)});
      case Op::kPackUvec4ToUint: {
        const Src upper = add(Op::kOr, {field(3, 24, 0xff), field(2, 16, 0xff)});
        return add(Op::kOr, {upper, add(Op::kOr, {field(1, 8, 0xff), field(0, 0, 0xff)})});
      }
      case Op::kPackHalf2x16:
        return add(Op::kPackHalf2x16Split, {part(0, 0), part(0, 1)});
      case Op::kUnpackHalf2x16: {
        const Src low = add(Op::kUnpackHalf2x16SplitX, {part(0, 0)});
        return build().vec({low, add(Op::kUnpackHalf2x16SplitY, {part(0, 0)})});
      }
      default:
        return dot();
    }
  }

  /// Products, added from the last to the first.
  Src dot() {
    Src sum;
    for (unsigned c = operand_components(inst_, 0); c-- > 0;) {
      const Src product = add(Op::kFMul, {part(0, c), part(1, c)});
      sum = sum.value == ir::kNoValue ? product : add(Op::kFAdd, {sum, product});
    }
    return sum;
  }

  Src field(unsigned c, std::uint32_t shift, std::uint32_t mask) {
    const Src bits = add(Op::kAnd, {part(0, c), literal(mask)});
    return shift == 0 ? bits : add(Op::kShl, {bits, literal(shift)});
  }

  Src part(std::uint32_t index, unsigned c) const { return scalar(graph_.source(inst_, index), c); }
  Builder build() { return {graph_, id_}; }
  Src literal(std::uint32_t bits) { return build().literal(bits); }
  Src add(Op op, std::initializer_list<Src> operands) { return build().like(inst_, op, operands); }

  Graph& graph_;
  const Inst inst_;
  const InstId id_;
};

}  // namespace

bool lower_alu_to_scalar(Graph& graph) {
  bool changed = false;
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (!computes(inst) || inst.width == 64 || (inst.components < 2 && !Reducer::knows(inst.op))) return;
    Reducer::knows(inst.op) ? Reducer(graph, id).run() : split(graph, id);
    changed = true;
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting
