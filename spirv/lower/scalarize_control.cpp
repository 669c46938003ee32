// Control flow as markers in the body; values that cross joins; small branches as selects.
#include <algorithm>

#include "spirv/lower/scalarizer.h"

namespace vitrine::spirv::lowering {
namespace {

/// Turns of a loop that are written out one after the other, and their operations.
constexpr std::size_t kMaxTurns = 16, kMaxTurnOps = 1024, kSmallTurn = 64;

/// How many turns of a loop hand each variable a value that was computed in one of them, where `next` are the values
/// for the next turn: that many written out need no copies from one variable to another.
std::size_t turns_until_computed(const std::vector<ScalarId>& params, const std::vector<ScalarId>& next) {
  std::size_t most = 1;
  for (std::size_t i = 0; i < params.size(); ++i) {
    std::size_t turns = 1;
    ScalarId value = next[i];
    for (auto from = std::ranges::find(params, value); from != params.end() && value != params[i] && turns < kMaxTurns;
         from = std::ranges::find(params, value), ++turns)
      value = next[static_cast<std::size_t>(from - params.begin())];
    most = std::max(most, turns);
  }
  return most;
}

/// Branches up to this weight run unconditionally: skipping them would cost more than they do.
constexpr std::uint32_t kFlattenWeight = 12;

std::uint32_t weight_of(Op op) {
  switch (op) {
    case Op::kFPow:
    case Op::kFSin:
    case Op::kFCos:
    case Op::kFExp2:
    case Op::kFLog2:
    case Op::kIDiv:
    case Op::kUDiv:
    case Op::kIRem:
    case Op::kIMod:
    case Op::kUMod:
      return 8;
    case Op::kFDiv:
    case Op::kFRcp:
    case Op::kFSqrt:
    case Op::kFRsq:
      return 3;
    default:
      return 1;
  }
}

/// Weight of a list that may run unconditionally; above kFlattenWeight if it may not. `loads`: so may its loads.
std::uint32_t flatten_weight(const ir::NodeList& list, bool loads) {
  std::uint32_t weight = 0;
  for (const auto& node : list) {
    if (node->kind == ir::Node::Kind::kLoop) return kFlattenWeight + 1;
    if (node->kind == ir::Node::Kind::kIf) {
      weight += flatten_weight(node->then_list, loads) + flatten_weight(node->else_list, loads) +
                static_cast<std::uint32_t>(node->results.size());
    } else {
      const ir::Instr& instr = node->instr;
      if (instr.op < Op::kAluCount) {
        weight += weight_of(instr.op) * instr.components;
      } else if (loads && (instr.op == Op::kLoadUniform || instr.op == Op::kLoadPush)) {
        weight += 2;
      } else if (instr.op != Op::kConst && instr.op != Op::kUndef && instr.op != Op::kVec && instr.op != Op::kYield &&
                 instr.op != Op::kLoadInput) {
        return kFlattenWeight + 1;
      }
    }
    if (weight > kFlattenWeight) return weight;
  }
  return weight;
}

}  // namespace

void Scalarizer::emit_jump(Kind kind, ScalarId cond, const ir::Instr* instr) {
  ScalarOp op;
  op.kind = kind;
  op.cond = cond;
  op.instr = instr != nullptr ? instr : here_;
  if (kind == Kind::kBreak || kind == Kind::kContinue) {
    if (loops_.empty()) return fail("break or continue outside a loop");
    LoopContext& loop = loops_.back();
    const std::vector<ScalarId> values =
        arguments(instr->src, kind == Kind::kBreak ? loop.node->results : loop.node->continue_params);
    const std::vector<ScalarId>& joins = kind == Kind::kBreak ? loop.results : loop.continue_params;
    if (values.size() != joins.size()) return fail("jump with the wrong number of values");
    loop.has_continue |= kind == Kind::kContinue;
    op.partner = loop.op;
    set_join(op, values, joins);
  }
  out_.body.push_back(op);
}

void Scalarizer::set_join(ScalarOp& op, const std::vector<ScalarId>& values, const std::vector<ScalarId>& joins) {
  if (values.size() != joins.size()) return fail("join with the wrong number of values");
  for (std::size_t i = 0; i < joins.size(); ++i) out_.join_sources[joins[i]].push_back(values[i]);
  op.src = out_.add_operands(values);
  op.dst = out_.add_operands(joins);
}

Kind Scalarizer::jump_kind(Op op) {
  switch (op) {
    case Op::kBreak:
      return Kind::kBreak;
    case Op::kContinue:
      return Kind::kContinue;
    case Op::kReturn:
      return Kind::kReturn;
    default:
      return Kind::kKill;
  }
}

ListEnd Scalarizer::build_list(const ir::NodeList& list, const std::vector<ir::ValueId>& targets) {
  for (const auto& node : list) {
    if (!error_.empty()) return {};
    here_ = &node->instr;
    switch (node->kind) {
      case ir::Node::Kind::kInstr:
        if (node->instr.op == Op::kYield) return {true, arguments(node->instr.src, targets)};
        if (is_jump(node->instr.op)) {
          emit_jump(jump_kind(node->instr.op), kNoScalar, &node->instr);
          return {false, {}};
        }
        build_instr(node->instr);
        break;
      case ir::Node::Kind::kIf:
        if (!build_if(*node)) return {false, {}};
        break;
      case ir::Node::Kind::kLoop:
        build_loop(*node);
        break;
    }
  }
  return {};
}

ListEnd Scalarizer::build_scope(const ir::NodeList& list, const std::vector<ir::ValueId>& targets) {
  const std::size_t mark = undo_.size();
  ListEnd end = build_list(list, targets);
  forget(mark);
  return end;
}

void Scalarizer::forget(std::size_t mark) {
  for (; undo_.size() > mark; undo_.pop_back()) scoped_.erase(undo_.back());
}

const ir::Instr* Scalarizer::only_jump(const ir::NodeList& list) {
  if (list.size() != 1 || list[0]->kind != ir::Node::Kind::kInstr || !is_jump(list[0]->instr.op)) return nullptr;
  return &list[0]->instr;
}

bool Scalarizer::only_yield(const ir::NodeList& list) {
  return list.empty() ||
         (list.size() == 1 && list[0]->kind == ir::Node::Kind::kInstr && list[0]->instr.op == Op::kYield);
}

ScalarId Scalarizer::negate(ScalarId cond) {
  const std::array<ScalarId, 1> source{cond};
  return alu(Op::kNotB, source, nullptr);
}

bool Scalarizer::build_if(const ir::Node& node) {
  const ScalarId cond = component(node.condition, 0);
  if (level(cond) == Level::kConstant) {
    const ListEnd end = build_list(out_.scalars[cond].bits ? node.then_list : node.else_list, node.results);
    if (end.falls) define_all(node.results, end.values);
    return end.falls;
  }
  const ir::Instr* then_jump = only_jump(node.then_list);
  const ir::Instr* else_jump = only_jump(node.else_list);
  if ((then_jump && only_yield(node.else_list)) || (else_jump && only_yield(node.then_list))) {
    const ir::Instr* jump = then_jump ? then_jump : else_jump;
    emit_jump(jump_kind(jump->op), then_jump ? cond : negate(cond), jump);
    define_all(node.results, build_list(then_jump ? node.else_list : node.then_list, node.results).values);
    return true;
  }
  const bool loads = !out_.accesses_stay;
  if (level(cond) > Level::kUniform &&
      flatten_weight(node.then_list, loads) + flatten_weight(node.else_list, loads) <= kFlattenWeight) {
    const ListEnd then_end = build_list(node.then_list, node.results);
    const ListEnd else_end = build_list(node.else_list, node.results);
    here_ = &node.instr;
    define_all(node.results, select_all(cond, then_end.values, else_end.values));
    return true;
  }
  return build_branches(node, cond);
}

std::vector<ScalarId> Scalarizer::select_all(ScalarId cond, const std::vector<ScalarId>& a,
                                             const std::vector<ScalarId>& b) {
  std::vector<ScalarId> result;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) result.push_back(select(cond, a[i], b[i]));
  return result;
}

ScalarId Scalarizer::select(ScalarId cond, ScalarId a, ScalarId b) {
  const std::array<ScalarId, 3> sources{cond, a, b};
  return alu(out_.scalars[a].boolean ? Op::kSelectB : Op::kSelect, sources, nullptr);
}

bool Scalarizer::build_branches(const ir::Node& node, ScalarId cond) {
  const std::uint32_t if_index = add_marker(Kind::kIf);
  out_.body[if_index].cond = cond;
  const ListEnd then_end = build_scope(node.then_list, node.results);
  here_ = &node.instr;
  const std::uint32_t else_index = add_marker(Kind::kElse);
  const ListEnd else_end = build_scope(node.else_list, node.results);
  here_ = &node.instr;
  const std::uint32_t end_index = add_marker(Kind::kEndIf);
  out_.body[if_index].partner = else_index;
  out_.body[else_index].partner = end_index;
  out_.body[end_index].partner = if_index;
  out_.body[else_index].falls = then_end.falls;
  out_.body[end_index].falls = else_end.falls;
  if (then_end.falls && else_end.falls) {
    join_branches(node, cond, else_index, end_index, then_end.values, else_end.values);
  } else if (then_end.falls || else_end.falls) {
    define_all(node.results, then_end.falls ? then_end.values : else_end.values);
  }
  return then_end.falls || else_end.falls;
}

void Scalarizer::join_branches(const ir::Node& node, ScalarId cond, std::uint32_t else_index, std::uint32_t end_index,
                               const std::vector<ScalarId>& a, const std::vector<ScalarId>& b) {
  std::vector<ScalarId> values, joins, from_then, from_else;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const bool uniform = std::max({level(cond), level(a[i]), level(b[i])}) <= Level::kUniform;
    if (a[i] == b[i] || uniform) {
      values.push_back(a[i] == b[i] ? a[i] : select(cond, a[i], b[i]));
      continue;
    }
    values.push_back(out_.add(out_.scalars[a[i]].boolean, Level::kVarying));
    out_.scalars[values.back()].join = true;
    joins.push_back(values.back());
    from_then.push_back(a[i]);
    from_else.push_back(b[i]);
  }
  set_join(out_.body[else_index], from_then, joins);
  set_join(out_.body[end_index], from_else, joins);
  define_all(node.results, values);
}

std::uint32_t Scalarizer::add_marker(Kind kind) {
  ScalarOp op;
  op.kind = kind;
  op.instr = here_;
  out_.body.push_back(op);
  return static_cast<std::uint32_t>(out_.body.size() - 1);
}

/// One turn of a loop: its body and what continues it, between which a marker goes, `continuing`.
ListEnd Scalarizer::build_turn(const ir::Node& node, std::size_t mark, std::uint32_t& continuing) {
  const ListEnd body_end = build_list(node.body, node.continue_params);
  const bool has_continue = loops_.back().has_continue;
  if (has_continue) forget(mark);  // lanes that continued early have not computed the rest of the body
  here_ = &node.instr;
  continuing = add_marker(Kind::kContinuing);
  out_.body[continuing].falls = body_end.falls;
  if (body_end.falls && !has_continue) {
    define_all(node.continue_params, body_end.values);
  } else if (body_end.falls) {
    set_join(out_.body[continuing], body_end.values, loops_.back().continue_params);
  }
  if (!body_end.falls && !has_continue) return {false, {}};
  return build_list(node.continuing, node.params);
}

/// How many turns of a loop, of which one is built, are written out one after the other. Variables that hand their
/// values on do so by name then; in two turns of a small loop those that depend on each other need no copies, either:
/// the second turn gives the registers back that the first one takes.
std::size_t Scalarizer::turns_to_write(const std::vector<ScalarId>& params, const ListEnd& next,
                                       std::uint32_t continuing) const {
  const LoopContext& loop = loops_.back();
  if (!next.falls || loop.has_continue || !out_.body[continuing].falls) return 1;
  // Folding would honour denormals where the loop may not. Booleans have none: behind the first turn they are known.
  std::size_t varied = 0;
  for (const ScalarId id : next.values) {
    if (level(id) != Level::kConstant) {
      ++varied;
    } else if (!out_.scalars[id].boolean) {
      return 1;
    }
  }
  // Without probes, so that an observed loop has as many turns.
  const auto size = static_cast<std::size_t>(std::count_if(out_.body.begin() + loop.op, out_.body.end(),
                                                           [](const ScalarOp& op) { return op.op != Op::kProbe; }));
  const std::size_t least = varied > 2 && size <= kSmallTurn ? 2 : 1;
  return std::max(least, std::min(turns_until_computed(params, next.values), kMaxTurnOps / size));
}

void Scalarizer::build_loop(const ir::Node& node) {
  const std::vector<ScalarId> init = arguments(node.init, node.params);
  const std::vector<ScalarId> params = new_joins(node.params);
  const std::uint32_t loop_index = add_marker(Kind::kLoop);
  set_join(out_.body[loop_index], init, params);
  LoopContext context;
  context.node = &node;
  context.op = loop_index;
  for (const ir::ValueId value : node.results)
    for (std::uint32_t i = 0; i < ir_.values[value].components; ++i) {
      context.results.push_back(out_.add(ir_.values[value].boolean, Level::kVarying));
      out_.scalars[context.results.back()].join = true;
    }
  context.continue_params = new_joins(node.continue_params);
  loops_.push_back(std::move(context));
  const std::size_t mark = undo_.size();
  std::uint32_t continuing_index = kNoIndex;
  ListEnd next = build_turn(node, mark, continuing_index);
  const std::size_t turns = turns_to_write(params, next, continuing_index);
  for (std::size_t turn = 1; turn < turns && next.falls; ++turn) {
    out_.body[continuing_index].kind = Kind::kTurn;
    add_marker(Kind::kTurn);
    forget(mark);  // a turn is what it would be in a loop of its own: the same sums, in the same order
    define_all(node.params, next.values);
    next = build_turn(node, mark, continuing_index);
  }
  here_ = &node.instr;
  const std::uint32_t end_index = add_marker(Kind::kEndLoop);
  out_.body[end_index].falls = next.falls;
  if (next.falls) set_join(out_.body[end_index], next.values, params);
  out_.body[loop_index].partner = continuing_index;
  out_.body[continuing_index].partner = end_index;
  out_.body[end_index].partner = loop_index;
  forget(mark);
  define_all(node.results, loops_.back().results);
  loops_.pop_back();
}

}  // namespace vitrine::spirv::lowering
