// The engine that applies the rule table the way the reference's compiler does (lavapipe-shader-math.md 4.1;
// lavapipe-optimizer.md 4.1): users before producers, the first matching rule in table order; replaced values wake
// those of their users for whom the change of structure matters; replaced instructions' operands stay, and count as
// uses, until dead code is removed.
#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <utility>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/literals.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/algebraic/pattern.h"
#include "spirv/rewrite/nir/algebraic/shape_sets.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/range_analysis.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;
using Swizzle = std::array<std::uint8_t, 4>;

constexpr unsigned kMaxOrders = 8;  ///< commutative operations of one search that are tried in both orders

struct Match {
  std::array<Src, 8> variable;
  std::array<std::uint8_t, 8> width{};  ///< bits of the variables that are numbers, 0: booleans
  std::uint32_t seen = 0;
  std::uint32_t orders = 0;  ///< bit i: commutative operation i has its operands swapped
  bool inexact = false;      ///< both stick over the attempts with other orders, as in the reference
  bool has_exact = false;
};

class Rewriter {
 public:
  /// `lowers`: only what programs do not have is replaced.
  Rewriter(Graph& graph, const Rules& rules, const ShapeSets& sets, bool lowers = false)
      : graph_(graph), rules_(rules), sets_(sets), lowers_(lowers), ranges_(graph) {
    states_.resize(graph.values.size());
    inexact_off_ = graph.function.forbids_inexact(32);
  }

  bool run() {
    std::vector<InstId> order;
    auto visit = [&](InstId id) {
      if (!computes(graph_.insts[id])) return;
      update_state(id);
      any_sized_ |= graph_.insts[id].width != 32;
      order.push_back(id);
    };
    for_each_inst(graph_, graph_.root, visit);
    queue_.assign(order.rbegin(), order.rend());
    bool changed = false;
    for (; !queue_.empty(); queue_.pop_front()) {
      const Inst& inst = graph_.insts[queue_.front()];
      if (!inst.removed && (!lowers_ || inst.op >= Op::kExecutedCount)) changed |= rewrite(queue_.front());
    }
    return changed;
  }

 private:
  // ---- states

  /// True when the state changed.
  bool update_state(InstId id) {
    const Inst& inst = graph_.insts[id];
    const ShapeSet& shapes = sets_.shapes[static_cast<std::size_t>(shape_op(inst.op))];
    std::array<ShapeState, kMaxChildren> operands{};
    unsigned constant = 0;
    if (!shapes.empty()) {
      for (unsigned i = 0; i < std::min<unsigned>(inst.count, kMaxChildren); ++i) {
        const ValueId value = graph_.source(inst, i).value;
        operands[i] = states_[value];
        constant |= graph_.constant(value) != nullptr ? 1u << i : 0;
      }
    }
    const ShapeState state{shapes.fitting(operands, constant), shape_op(inst.op)};
    const ShapeState before = std::exchange(states_[inst.result], state);
    return before.shapes != state.shapes || (state.shapes != 0 && before.op != state.op);
  }

  void wake_users(ValueId value) {
    std::vector<ValueId> pending{value};
    for (std::size_t next = 0; next < pending.size(); ++next) {
      for (Slot slot = graph_.values[pending[next]].first_use; slot != kNone; slot = graph_.sources[slot].next) {
        const InstId user = graph_.sources[slot].user;
        if (!computes(graph_.insts[user]) || !update_state(user)) continue;
        queue_.push_back(user);
        pending.push_back(graph_.insts[user].result);
      }
    }
  }

  // ---- conditions

  bool used_as_float_only(ValueId value) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next) {
      const Inst& user = graph_.insts[graph_.sources[slot].user];
      if (!computes(user) || ir::alu_info(user.op).operands[slot - user.first] != 'F') return false;
    }
    return true;
  }

  /// Who reads one word of a double reads the other one, too, and is one use.
  unsigned double_uses(ValueId value) const {
    unsigned uses = 0;
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next)
      uses += graph_.sources[slot].src.swizzle[0] == 0 ? 1 : 0;
    return uses;
  }

  bool used_but_for_saturation(ValueId value) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next)
      if (!is_alu(graph_.insts[graph_.sources[slot].user], Op::kFSat)) return true;
    return false;
  }

  static bool is_alu(const Inst& inst, Op op) { return computes(inst) && inst.op == op; }

  /// True when an If reads the value as its condition.
  bool decides(ValueId value) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next)
      if (graph_.insts[graph_.sources[slot].user].kind == Kind::kIf) return true;
    return false;
  }

  bool holds_for_inst(Condition condition, const Inst& inst) const {
    switch (condition) {
      case Condition::kOnce:
        return inst.width == 64 && !inst.boolean ? double_uses(inst.result) == 1 : graph_.values[inst.result].uses == 1;
      case Condition::kUsed:
        return used_but_for_saturation(inst.result);
      case Condition::kFloatOnly:
        return used_as_float_only(inst.result);
      case Condition::kNotForIf:
        return !decides(inst.result);
      case Condition::kBits16:
        return inst.width == 16;
      case Condition::kBits32:
        return inst.width == 32;
      case Condition::kBits64:
        return inst.width == 64;
      default:
        return true;
    }
  }

  bool is_product(ValueId value) const {
    const Inst* inst = graph_.def(value);
    if (!inst || !computes(*inst)) return false;
    if (inst->op == Op::kFNeg) return is_product(graph_.source(*inst, 0).value);
    return inst->op == Op::kFMul;
  }

  /// Every component that is read is a power of two (or minus one) in the operand's type.
  bool is_power_of_two(const Inst& inst, std::uint32_t index, const Swizzle& swizzle, unsigned components,
                       bool negative) const {
    const Inst* constant = graph_.constant(graph_.source(inst, index).value);
    if (!constant) return false;
    const bool is_unsigned = ir::alu_info(inst.op).operands[index] == 'U';
    for (unsigned c = 0; c < components; ++c) {
      const std::uint32_t bits = constant->imm[swizzle[c]];
      const bool sign = (bits & 0x80000000u) != 0;
      const std::uint32_t magnitude = negative ? 0u - bits : bits;
      if (negative && (!sign || bits == 0x80000000u)) return false;
      if (!negative && sign && !is_unsigned) return false;
      if (magnitude == 0 || (magnitude & (magnitude - 1)) != 0) return false;
    }
    return true;
  }

  /// `test` holds for every component that is read of a constant.
  template <class Test>
  bool all_components(const Inst& inst, std::uint32_t index, const Swizzle& swizzle, unsigned components,
                      Test test) const {
    const Inst* constant = graph_.constant(graph_.source(inst, index).value);
    if (!constant) return false;
    for (unsigned c = 0; c < components; ++c)
      if (!test(constant->imm[swizzle[c]])) return false;
    return true;
  }

  bool is_multiple(const Inst& inst, std::uint32_t index, const Swizzle& swizzle, unsigned components,
                   std::uint32_t factor) const {
    return all_components(inst, index, swizzle, components, [=](std::uint32_t v) { return v % factor == 0; });
  }

  bool holds_for_range(Condition condition, const Range& range) const {
    const bool not_negative = (range.signs & Range::kNegative) == 0,
               not_positive = (range.signs & Range::kPositive) == 0;
    switch (condition) {
      case Condition::kNumber:
        return range.number;
      case Condition::kFinite:
        return range.finite;
      case Condition::kIntegral:
        return range.integral;
      case Condition::kNotNegative:
        return not_negative;
      case Condition::kNotPositive:
        return not_positive;
      case Condition::kNotZero:
        return (range.signs & Range::kZero) == 0;
      case Condition::kGt0:
        return range.signs == Range::kPositive;
      case Condition::kLt0:
        return range.signs == Range::kNegative;
      case Condition::kNumberNotNegative:
        return range.number && not_negative;
      case Condition::kNumberNotPositive:
        return range.number && not_positive;
      case Condition::kNumberGt0:
        return range.number && range.signs == Range::kPositive;
      case Condition::kNumberLt0:
        return range.number && range.signs == Range::kNegative;
      default:
        return true;
    }
  }

  bool holds_for_operand(Condition condition, const Inst& inst, std::uint32_t index, const Swizzle& swizzle,
                         unsigned components) {
    const ValueId value = graph_.source(inst, index).value;
    switch (condition) {
      case Condition::kNone:
        return true;
      case Condition::kNotConst:
        return graph_.constant(value) == nullptr;
      case Condition::kFmul:
        return is_product(value);
      case Condition::kNotFmul:
        return !is_product(value);
      case Condition::kPosPow2:
        return is_power_of_two(inst, index, swizzle, components, false);
      case Condition::kNegPow2:
        return is_power_of_two(inst, index, swizzle, components, true);
      case Condition::kShifts2:
        return all_components(inst, index, swizzle, components, [](std::uint32_t v) { return (v & 31) >= 2; });
      case Condition::kBelow32:
        return all_components(inst, index, swizzle, components, [](std::uint32_t v) { return v < 32; });
      case Condition::kMultiple2:
        return is_multiple(inst, index, swizzle, components, 2);
      case Condition::kMultiple4:
        return is_multiple(inst, index, swizzle, components, 4);
      case Condition::kMultiple8:
        return is_multiple(inst, index, swizzle, components, 8);
      case Condition::kMultiple16:
        return is_multiple(inst, index, swizzle, components, 16);
      case Condition::kMultiple32:
        return is_multiple(inst, index, swizzle, components, 32);
      case Condition::kMultiple64:
        return is_multiple(inst, index, swizzle, components, 64);
      default:
        return holds_for_range(condition, ranges_.of_source(inst, index));
    }
  }

  // ---- matching: by the table's patterns, of vectors and of every width; those of graph/match.h are of scalars

  /// Bits of the numbers of operand `index`, 0: booleans.
  static std::uint8_t operand_width(const Inst& inst, std::uint32_t index, std::uint8_t width) {
    if (inst.kind == Kind::kVec) return inst.boolean ? std::uint8_t{0} : width;
    const char letter = ir::alu_info(inst.op).operands[index];
    if (letter == 'B') return 0;
    return letter == 'F' || ir::is_selection(inst.op) ? width : std::uint8_t{32};
  }

  /// Components that the instruction reads of an operand whatever its result has; 0: those of the result.
  static unsigned fixed_components(const Inst& inst, std::uint32_t index) {
    if (inst.kind == Kind::kVec) return 1;
    if (inst.width == 64) return operand_components(inst, index);
    return ir::alu_info(inst.op).reads;
  }

  bool match_constant(const Pattern& pattern, ValueId value, const Swizzle& swizzle, unsigned components,
                      unsigned width) const {
    const Inst* constant = graph_.constant(value);
    if (!constant) return false;
    if (pattern.kind == Pattern::Kind::kFloat && width == 64)
      return !constant->boolean && literal_number(*constant, swizzle, width) == pattern.number;
    const bool wants_boolean = pattern.kind == Pattern::Kind::kBoolean;
    if (constant->boolean != wants_boolean) return false;
    for (unsigned c = 0; c < components; ++c) {
      const std::uint32_t bits = constant->imm[swizzle[c]];
      if (pattern.kind == Pattern::Kind::kFloat) {
        const Swizzle here{swizzle[c]};
        if ((width == 32 ? static_cast<double>(std::bit_cast<float>(bits)) : literal_number(*constant, here, width)) !=
            pattern.number)
          return false;
      } else if (bits != pattern.bits) {
        return false;
      }
    }
    return true;
  }

  bool match_variable(const Pattern& pattern, const Inst& inst, std::uint32_t index, const Swizzle& swizzle,
                      unsigned components, std::uint8_t width, Match& match) {
    const ValueId value = graph_.source(inst, index).value;
    Src& bound = match.variable[pattern.variable];
    if (match.seen >> pattern.variable & 1) {
      if (bound.value != value || match.width[pattern.variable] != width) return false;
      for (unsigned c = 0; c < components; ++c)
        if (bound.swizzle[c] != swizzle[c]) return false;
      return true;
    }
    if (pattern.constant && !graph_.constant(value)) return false;
    if (!holds_for_operand(pattern.condition, inst, index, swizzle, components)) return false;
    match.seen |= 1u << pattern.variable;
    match.width[pattern.variable] = width;
    bound = {value, {}};
    for (unsigned c = 0; c < components; ++c) bound.swizzle[c] = swizzle[c];
    return true;
  }

  bool match_operand(std::uint16_t index, const Inst& inst, std::uint32_t operand, unsigned components,
                     const Swizzle& outer, std::uint8_t width, Match& match) {
    const Src src = graph_.source(inst, operand);
    Swizzle swizzle{};
    const unsigned fixed = fixed_components(inst, operand);
    if (fixed != 0) components = fixed;
    for (unsigned c = 0; c < components; ++c) swizzle[c] = src.swizzle[fixed != 0 ? c : outer[c]];
    width = operand_width(inst, operand, width);
    const Pattern& pattern = rules_.patterns[index];
    if (pattern.kind == Pattern::Kind::kVariable)
      return match_variable(pattern, inst, operand, swizzle, components, width, match);
    if (pattern.kind != Pattern::Kind::kOp) return match_constant(pattern, src.value, swizzle, components, width);
    const Inst* def = graph_.def(src.value);
    if (pattern.op == Op::kVec) return def && match_vec(pattern, *def, components, swizzle, width, match);
    if (!def || !computes(*def)) return false;
    if (def->boolean ? width != 0 : !makes(*def, width)) return false;
    if (def->width == 64 && !def->boolean && (swizzle[0] != 0 || swizzle[1] != 1)) return false;
    return match_op(pattern, *def, components, swizzle, def->boolean ? def->width : width, match);
  }

  bool match_vec(const Pattern& pattern, const Inst& vec, unsigned components, const Swizzle& swizzle,
                 std::uint8_t width, Match& match) {
    if (vec.kind != Kind::kVec || vec.count != pattern.children || components != vec.count) return false;
    for (std::uint8_t c = 0; c < vec.count; ++c)
      if (swizzle[c] != c || !match_operand(pattern.child[c], vec, c, 1, {0}, width, match)) return false;
    return true;
  }

  /// The instruction's numbers have `width` bits. Selections of words may be of halves.
  static bool makes(const Inst& inst, unsigned width) {
    if (inst.width == width) return true;
    return width == 16 && inst.kind == Kind::kAlu && ir::is_selection(inst.op);
  }

  /// `width`: bits of the numbers of the operation, of a comparison those of its operands.
  bool match_op(const Pattern& pattern, const Inst& inst, unsigned components, const Swizzle& swizzle,
                std::uint8_t width, Match& match) {
    if (pattern.op != inst.op || !holds_for_inst(pattern.condition, inst)) return false;
    match.inexact |= pattern.inexact;
    match.has_exact |= inst.exact;
    if (match.inexact && match.has_exact) return false;
    const bool swap = pattern.commutative >= 0 && pattern.commutative < static_cast<int>(kMaxOrders) &&
                      (match.orders >> pattern.commutative & 1) != 0;
    for (unsigned i = 0; i < pattern.children; ++i) {
      const unsigned operand = swap && i < 2 ? i ^ 1 : i;
      if (!match_operand(pattern.child[i], inst, operand, components, swizzle, width, match)) return false;
    }
    return true;
  }

  bool try_rule(const Rule& rule, const Inst& inst, Match& match) {
    const Pattern& search = rules_.patterns[rule.search];
    if (inst.width != 32 ? !applies(rule, search, inst.width) : search.inexact && inexact_off_) return false;
    if (rule.needs_free_zeros && graph_.function.signed_zero_inf_nan_preserve) return false;
    const std::uint32_t attempts = 1u << std::min<unsigned>(rule.commutative, kMaxOrders);
    for (match.orders = 0; match.orders < attempts; ++match.orders) {
      match.seen = 0;
      if (match_op(search, inst, inst.components, {0, 1, 2, 3}, inst.width, match)) return true;
    }
    return false;
  }

  /// For numbers of 16 and 64 bits.
  bool applies(const Rule& rule, const Pattern& search, unsigned width) const {
    if (rule.needs_free_zeros && width == 64) return false;
    return !(search.inexact || rule.needs_free_zeros) || !graph_.function.forbids_inexact(width);
  }

  // ---- replacing

  /// Makes room for the state of what has been made.
  Src with_state(Src made) {
    states_.resize(graph_.values.size());
    return made;
  }

  Src build_constant(Builder& at, const Pattern& pattern, unsigned width) {
    std::uint32_t bits[2] = {pattern.bits, 0};
    if (pattern.kind == Pattern::Kind::kFloat) literal_words(pattern.number, width, bits);
    const unsigned components = width == 64 && pattern.kind == Pattern::Kind::kFloat ? 2 : 1;
    return with_state(at.literal(components, pattern.kind == Pattern::Kind::kBoolean, bits));
  }

  /// Bits of the numbers that a pattern of a replacement makes, by the variables in it; 0: booleans, or literals alone.
  std::uint8_t width_of(std::uint16_t index, const Match& match) const {
    const Pattern& pattern = rules_.patterns[index];
    if (pattern.kind == Pattern::Kind::kVariable) return match.width[pattern.variable];
    if (pattern.kind != Pattern::Kind::kOp || pattern.op == Op::kVec) return 0;
    if (ir::alu_info(pattern.op).result == 'B') return 0;
    return computed_width(pattern, match);
  }

  /// Bits of the numbers that the operation computes with.
  std::uint8_t computed_width(const Pattern& pattern, const Match& match) const {
    for (unsigned i = 0; i < pattern.children; ++i)
      if (const std::uint8_t width = width_of(pattern.child[i], match); width != 0) return width;
    return 0;
  }

  static Src read(const Pattern& pattern, const Match& match) {
    const Src& src = match.variable[pattern.variable];
    if (pattern.component < 0) return src;
    return scalar(src, static_cast<unsigned>(pattern.component));
  }

  Src build_vec(Builder& at, const Pattern& pattern, std::uint8_t width, const Match& match) {
    std::array<Src, kMaxChildren> part;
    for (unsigned c = 0; c < pattern.children; ++c) part[c] = build(at, pattern.child[c], 1, width, match);
    return with_state(at.vec(std::span(part).first(pattern.children)));
  }

  Src build(Builder& at, std::uint16_t index, unsigned components, std::uint8_t width, const Match& match) {
    const Pattern& pattern = rules_.patterns[index];
    if (pattern.kind == Pattern::Kind::kVariable) return read(pattern, match);
    if (pattern.kind != Pattern::Kind::kOp) return build_constant(at, pattern, width);
    if (pattern.op == Op::kVec) return build_vec(at, pattern, width, match);
    const ir::AluInfo& info = ir::alu_info(pattern.op);
    const bool boolean = info.result == 'B';
    if (any_sized_)
      if (const std::uint8_t known = computed_width(pattern, match); known != 0) width = known;
    if (boolean && width == 0) width = 32;
    const unsigned lanes = width != 64 ? components : boolean ? 1 : 2;
    std::array<Src, kMaxChildren> operand;
    const unsigned parts = info.reads != 0 ? info.reads : lanes;
    for (unsigned i = 0; i < pattern.children; ++i) operand[i] = build(at, pattern.child[i], parts, width, match);
    const bool sized = width != 32 && !ir::is_selection(pattern.op) && has_sizes(info);
    Inst model;
    model.kind = sized ? Kind::kSized : Kind::kAlu;
    if (sized || pattern.op == Op::kSelect) model.width = width;
    model.exact = match.has_exact || pattern.exact;
    model.packs = pattern.op == Op::kF2Half || pattern.op == Op::kHalf2F;
    const Src made = with_state(at.like(model, pattern.op, std::span(operand).first(pattern.children), lanes));
    update_state(graph_.values[made.value].def);
    return made;
  }

  /// The operation has an operand or a result that is a float.
  static bool has_sizes(const ir::AluInfo& info) { return info.result == 'F' || info.operands[0] == 'F'; }

  /// Replacements of unary operations go where their operand is, so that they do not prolong other values' lives.
  Builder place_of(InstId id) {
    const Inst& inst = graph_.insts[id];
    switch (inst.op) {
      case Op::kFNeg:
      case Op::kFAbs:
      case Op::kINeg:
      case Op::kIAbs:
      case Op::kNot:
      case Op::kNotB:
        break;
      default:
        return {graph_, id};
    }
    const InstId def = graph_.values[graph_.source(inst, 0).value].def;
    if (def == kNone || !computes(graph_.insts[def])) return {graph_, id};
    return Builder::behind(graph_, def, inst.origin);
  }

  /// What takes the place of the result: a value of its own where it is a part or a rearrangement of another one.
  ValueId replacement(InstId id, const Rule& rule, const Match& match) {
    Builder at = place_of(id);
    const ValueId result = graph_.insts[id].result;
    const Src built = build(at, rule.replacement, graph_.insts[id].components, graph_.insts[id].width, match);
    return is_whole(graph_, built, result) ? built.value : with_state(at.move(built, result)).value;
  }

  bool rewrite(InstId id) {
    const CandidateSet& candidates = sets_.candidates[static_cast<std::size_t>(graph_.insts[id].op)];
    return candidates.until(states_[graph_.insts[id].result].shapes, [&](std::uint16_t number) {
      const Rule& rule = rules_.rules[number];
      Match match;
      if (!try_rule(rule, graph_.insts[id], match)) return false;
      const ValueId value = replacement(id, rule, match);
      replace_inst(graph_, id, value);
      wake_users(value);
      ranges_.clear();
      return true;
    });
  }

  Graph& graph_;
  const Rules& rules_;
  const ShapeSets& sets_;
  const bool lowers_;
  RangeAnalysis ranges_;
  std::vector<ShapeState> states_;
  std::deque<InstId> queue_;
  bool inexact_off_ = false;
  bool any_sized_ = false;  ///< there are numbers that do not have 32 bits
};

}  // namespace

bool lower_operations(Graph& graph) {
  bool any = false;
  auto visit = [&](InstId id) {
    const Op op = graph.insts[id].op;
    const bool is_sum = op == Op::kFSum3 || op == Op::kFSum4 || op == Op::kFAddInSum;  // build_sums()
    any |= computes(graph.insts[id]) && op >= Op::kExecutedCount && !is_sum;
  };
  for_each_inst(graph, graph.root, visit);
  bool changed = false;
  while (any) {
    any = Rewriter(graph, main_rules(), main_shape_sets(), true).run();
    any |= lower_alu_to_scalar(graph);
    changed |= any;
  }
  return changed;
}

bool opt_algebraic(Graph& graph) { return Rewriter(graph, main_rules(), main_shape_sets()).run(); }
bool opt_algebraic_late(Graph& graph) { return Rewriter(graph, late_rules(), late_shape_sets()).run(); }

}  // namespace vitrine::spirv::rewriting
