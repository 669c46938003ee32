// What operations on numbers of 16 and 64 bits consist of, once no rule looks at them any more (lavapipe-shader-math.md
// 6.6; lavapipe-optimizer.md 8.1).
//
// binary16 is computed in binary32 and rounded after every operation, which gives the bits of the operation in binary16
// (24 >= 2 * 11 + 2). A double is two words for wide_ops.def.
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/lower/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// The operation on doubles that wide_ops.def has; kCount: none.
Op wide_op(Op op) {
  switch (op) {
    case Op::kFAdd:
      return Op::kDAdd;
    case Op::kFMul:
      return Op::kDMul;
    case Op::kFDiv:
      return Op::kDDiv;
    case Op::kFSqrt:
      return Op::kDSqrt;
    case Op::kFFloor:
      return Op::kDFloor;
    case Op::kFCeil:
      return Op::kDCeil;
    case Op::kFTrunc:
      return Op::kDTrunc;
    case Op::kFRoundEven:
      return Op::kDRoundEven;
    case Op::kFMin:
      return Op::kDMin;
    case Op::kFMax:
      return Op::kDMax;
    case Op::kFLt:
      return Op::kDLt;
    case Op::kFGe:
      return Op::kDGe;
    case Op::kFEq:
      return Op::kDEq;
    case Op::kFNeu:
      return Op::kDNeu;
    default:
      return Op::kCount;
  }
}

/// The function of the C library that the reference calls; kCount: none.
Op library_op(Op op) {
  switch (op) {
    case Op::kFSin:
      return Op::kHSin;
    case Op::kFCos:
      return Op::kHCos;
    case Op::kFExp2:
      return Op::kHExp2;
    case Op::kFLog2:
      return Op::kHLog2;
    default:
      return Op::kCount;
  }
}

Src splat(ValueId value, std::uint8_t component) { return {value, {component, component, component, component}}; }

class Expander {
 public:
  explicit Expander(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    if (graph_.insts[id].kind != Kind::kSized) return;
    id_ = id;
    components_ = graph_.insts[id].components;
    const Op op = graph_.insts[id].op;
    const Src made = graph_.insts[id].width == 64 ? wide(op) : half(op);
    replace_inst(graph_, id, made.value);
    changed_ = true;
  }

  bool changed() const { return changed_; }

 private:
  Src operand(std::uint32_t index) const { return graph_.source(graph_.insts[id_], index); }

  Builder build() { return {graph_, id_}; }
  Src literal(std::uint32_t bits) { return build().literal(bits); }
  Src alu(Op op, std::initializer_list<Src> operands) { return build().alu(op, operands, components_); }

  // ---- binary16

  Src rounded(Src value) { return alu(Op::kF2Half, {value}); }
  Src single(Src value) { return alu(Op::kHalf2F, {value}); }
  Src half_product(Src a, Src b) { return rounded(alu(Op::kFMul, {single(a), single(b)})); }

  Src is_nan(Src a) { return alu(Op::kULt, {literal(0x7c00), alu(Op::kAnd, {a, literal(0x7fff)})}); }

  /// a < b (min) or a > b (max) or only b is NaN: a, else b. The reference has no instruction for binary16, and chooses
  /// otherwise than for binary32 when both are NaN.
  Src half_extremum(Op op, Src a, Src b) {
    const Src wins = op == Op::kFMin ? alu(Op::kFLt, {single(a), single(b)}) : alu(Op::kFLt, {single(b), single(a)});
    const Src only_b = alu(Op::kAndB, {is_nan(b), alu(Op::kNotB, {is_nan(a)})});
    return alu(Op::kSelect, {alu(Op::kOrB, {wins, only_b}), a, b});
  }

  Src half_sign(Src a) {
    const Src magnitude = alu(Op::kAnd, {a, literal(0x7fff)});
    const Src number = alu(Op::kULt, {alu(Op::kISub, {magnitude, literal(1)}), literal(0x7c00)});
    const Src one = alu(Op::kOr, {alu(Op::kAnd, {a, literal(0x8000)}), literal(0x3c00)});
    return alu(Op::kSelect, {number, one, literal(0)});
  }

  Src half_function(Op op, Src a) {
    const Src argument = single(a);
    std::vector<Src> parts;
    for (std::uint8_t c = 0; c < components_; ++c) parts.push_back(build().wide(op, {splat(argument.value, c)}));
    return rounded(build().vec(parts));
  }

  Src half_power(Src a, Src b) {
    const Src power = half_function(Op::kHExp2, half_product(half_function(Op::kHLog2, a), b));
    const Src zero = alu(Op::kFEq, {single(a), literal(0)});
    return alu(Op::kSelect, {alu(Op::kOrB, {zero, is_nan(a)}), literal(0), power});
  }

  Src half(Op op) {
    const Src a = operand(0);
    if (const Op function = library_op(op); function != Op::kCount) return half_function(function, a);
    switch (op) {
      case Op::kFNeg:
        return alu(Op::kXor, {a, literal(0x8000)});
      case Op::kFAbs:
        return alu(Op::kAnd, {a, literal(0x7fff)});
      case Op::kFSign:
        return half_sign(a);
      case Op::kFMin:
      case Op::kFMax:
        return half_extremum(op, a, operand(1));
      case Op::kFFract:
        return rounded(alu(Op::kFSub, {single(a), alu(Op::kFFloor, {single(a)})}));
      case Op::kFRsq:
        return rounded(alu(Op::kFRcp, {single(rounded(alu(Op::kFSqrt, {single(a)})))}));
      case Op::kFMulAdd:
        return rounded(alu(Op::kFAdd, {single(half_product(a, operand(1))), single(operand(2))}));
      case Op::kFPow:
        return half_power(a, operand(1));
      case Op::kB2F:
        return alu(Op::kSelect, {a, literal(0x3c00), literal(0)});
      default:
        break;
    }
    const Src result = graph_.insts[id_].count == 1 ? alu(op, {single(a)}) : alu(op, {single(a), single(operand(1))});
    return ir::alu_info(op).result == 'B' ? result : rounded(result);
  }

  // ---- doubles

  Src word(Src value, std::size_t index) const { return splat(value.value, value.swizzle[index]); }
  Src pair(Src low, Src high) { return build().vec({low, high}); }
  Src scalar(Op op, std::initializer_list<Src> operands) { return build().alu(op, operands); }

  Src apply(Op op, Src a) { return build().wide(op, {word(a, 0), word(a, 1)}); }
  Src apply(Op op, Src a, Src b) { return build().wide(op, {word(a, 0), word(a, 1), word(b, 0), word(b, 1)}); }

  Src negated(Src a) { return pair(word(a, 0), scalar(Op::kXor, {word(a, 1), literal(0x80000000)})); }
  Src one() { return pair(literal(0), literal(0x3ff00000)); }

  /// NaN and zeros give +0.
  Src wide_sign(Src a) {
    const Src zero = literal(0), zeros = pair(zero, zero);
    const Src below = apply(Op::kDLt, a, zeros), above = apply(Op::kDLt, zeros, a);
    const Src magnitude = scalar(Op::kSelect, {above, literal(0x3ff00000), zero});
    return pair(zero, scalar(Op::kSelect, {below, literal(0xbff00000), magnitude}));
  }

  Src wide(Op op) {
    const Src a = operand(0);
    if (const Op known = wide_op(op); known != Op::kCount)
      return graph_.insts[id_].count == 1 ? apply(known, a) : apply(known, a, operand(1));
    switch (op) {
      case Op::kFNeg:
        return negated(a);
      case Op::kFAbs:
        return pair(word(a, 0), scalar(Op::kAnd, {word(a, 1), literal(0x7fffffff)}));
      case Op::kFSub:
        return apply(Op::kDAdd, a, negated(operand(1)));
      case Op::kFRcp:
        return apply(Op::kDDiv, one(), a);
      case Op::kFRsq:
        return apply(Op::kDDiv, one(), apply(Op::kDSqrt, a));
      case Op::kFFract:
        return apply(Op::kDAdd, a, negated(apply(Op::kDFloor, a)));
      case Op::kFSign:
        return wide_sign(a);
      case Op::kFMulAdd:
        return apply(Op::kDAdd, apply(Op::kDMul, a, operand(1)), operand(2));
      case Op::kB2F:
        return pair(literal(0), scalar(Op::kSelect, {a, literal(0x3ff00000), literal(0)}));
      default:
        return a;  // the front end lets no other operation pass (ir::has_double)
    }
  }

  Graph& graph_;
  InstId id_ = kNone;
  unsigned components_ = 1;
  bool changed_ = false;
};

}  // namespace

bool expand_sized(Graph& graph) {
  Expander expander(graph);
  auto visit = [&](InstId id) { expander.visit(id); };
  for_each_inst(graph, graph.root, visit);
  return expander.changed();
}

}  // namespace vitrine::spirv::rewriting
