// What the reference's code computes otherwise on a CPU without AVX-512 (deviations.md: float-to-uint, double-rounding)
// (lavapipe-optimizer.md 7.11).
#include "base/reference_cpu.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/llvm/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Converter {
 public:
  explicit Converter(Graph& graph) : graph_(graph) {}

  void visit(InstId id) {
    id_ = id;
    const Inst inst = graph_.insts[id];
    Src made;
    if (inst.kind == Kind::kAlu && inst.op == Op::kF2U && inst.components == 1)
      made = is_only_stored(inst) ? apply(Op::kLFromF, operands()) : by_two_integers();
    else if (inst.kind == Kind::kIntrinsic)
      made = wide(inst.op);
    if (made.value == ir::kNoValue) return;
    replace_inst(graph_, id, made.value);
  }

 private:
  Src wide(Op op) {
    switch (op) {
      case Op::kUFromD:
        return apply(Op::kLFromD, operands());  // users read the low word
      case Op::kQFromF:
        return by_two_integers(operands(), {alu(Op::kFAdd, {operand(0), literal(0xdf000000)})}, Op::kLFromF);
      case Op::kQFromD:
        return by_two_integers(operands(), words(sum({literal(0), literal(0xc3e00000)})), Op::kLFromD);
      case Op::kDTrunc:
        return by_integer(operands());
      case Op::kDRoundEven: {
        // As much as the largest binary32 below 1/2, with the operand's sign.
        const Src sign = alu(Op::kAnd, {operand(1), literal(0x80000000)});
        return by_integer(words(sum({literal(0xe0000000), alu(Op::kOr, {sign, literal(0x3fdfffff)})})));
      }
      default:
        return {};
    }
  }

  /// Nothing but one store to memory uses the scalar, as a component of a vector or by itself: the reference then
  /// converts one lane at a time.
  bool is_only_stored(const Inst& inst) const {
    const Inst* from = &inst;
    for (int step = 0; step < 2; ++step) {
      const Value& value = graph_.values[from->result];
      if (value.uses != 1) return false;
      const Inst& user = graph_.insts[graph_.sources[value.first_use].user];
      if (user.kind == Kind::kIntrinsic)
        return user.op == Op::kStoreStorage || user.op == Op::kStoreGlobal || user.op == Op::kStoreShared;
      if (user.kind != Kind::kVec) return false;
      from = &user;
    }
    return false;
  }

  /// Of vectors: what is no signed integer is converted less 2^31.
  Src by_two_integers() {
    const Src small = alu(Op::kF2I, {operand(0)});
    const Src large = alu(Op::kF2I, {alu(Op::kFAdd, {operand(0), literal(0xcf000000)})});
    const Src is_large = alu(Op::kIShr, {small, literal(31)});
    return alu(Op::kOr, {small, alu(Op::kAnd, {large, is_large})});
  }

  /// The same for 64 bits: what is no signed integer is converted less 2^63.
  Src by_two_integers(const std::vector<Src>& number, const std::vector<Src>& reduced, Op conversion) {
    const Src small = apply(conversion, number), large = apply(conversion, reduced);
    const Src is_large = alu(Op::kIShr, {scalar(small, 1), literal(31)});
    std::vector<Src> result;
    for (const std::size_t word : {0u, 1u})
      result.push_back(alu(Op::kOr, {scalar(small, word), alu(Op::kAnd, {scalar(large, word), is_large})}));
    return vec(result);
  }

  /// The integer near `rounded`; the operand itself beyond 2^24.
  Src by_integer(const std::vector<Src>& rounded) {
    const Src whole = apply(Op::kDFromL, words(apply(Op::kLFromD, rounded)));
    const Src size = alu(Op::kAnd, {operand(1), literal(0x7fffffff)});
    const Src fits = apply(Op::kDGe, {literal(0), literal(0x41700000), operand(0), size});
    std::vector<Src> result;
    for (const std::size_t word : {0u, 1u})
      result.push_back(alu(Op::kSelect, {scalar(fits, 0), scalar(whole, word), operand(word)}));
    return vec(result);
  }

  Src sum(const std::vector<Src>& added) { return apply(Op::kDAdd, {operand(0), operand(1), added[0], added[1]}); }

  Src operand(std::size_t index) const {
    return scalar(graph_.source(graph_.insts[id_], static_cast<std::uint32_t>(index)), 0);
  }
  std::vector<Src> operands() const {
    std::vector<Src> all;
    for (std::uint32_t i = 0; i < graph_.insts[id_].count; ++i) all.push_back(operand(i));
    return all;
  }
  static std::vector<Src> words(Src pair) { return {scalar(pair, 0), scalar(pair, 1)}; }

  Builder build() { return {graph_, id_}; }
  Src literal(std::uint32_t bits) { return build().literal(bits); }
  Src alu(Op op, std::initializer_list<Src> operands) { return build().alu(op, operands); }
  Src apply(Op op, const std::vector<Src>& operands) { return build().wide(op, operands); }
  Src vec(const std::vector<Src>& components) { return build().vec(components); }

  Graph& graph_;
  InstId id_ = kNone;
};

}  // namespace

void lower_without_avx512(Graph& graph) {
  if (!base::reference_lacks_avx512()) return;
  Converter converter(graph);
  auto visit = [&](InstId id) { converter.visit(id); };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting
