// Structured control flow (SPIR-V 2.11): blocks become the tree of ir.h. Selections become If, loops Loop, switches a
// sequence of Ifs; calls are inlined. Phis are variables written on the edges. Jumps that the tree has no form for
// (leaving a switch or a function early) are Exit instructions, which exits.cpp turns into structure.
#include <algorithm>

#include "spirv/front/convergence.h"
#include "spirv/front/debugging.h"
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"
#include "spirv/front/initialization.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

constexpr std::uint32_t kAnyCase = 0;  ///< no label: the key of the flag that all cases of a switch share

void build(Translator& t, std::uint32_t label, std::uint32_t end, bool enter_first);

/// Redirects emission to `list` for a while.
struct Into {
  Into(Translator& t, ir::NodeList& list) : translator(t), saved(std::exchange(t.list, &list)) {}
  ~Into() { translator.list = saved; }
  Translator& translator;
  ir::NodeList* saved;
};

Scope& push_scope(Translator& t, Scope::Kind kind, std::uint32_t merge) {
  t.scopes.push_back({kind, merge, 0, t.exits++, false, nullptr, 0, nullptr});
  return t.scopes.back();
}

void exit_scope(Translator& t, Scope& scope) {
  scope.exit_used = true;
  jump_to_end(t, &scope);
  emit_effect(t, ir::Op::kExit).data[0] = scope.exit;
}

/// Ends a construct: pops its scope and lowers the exits out of it, if there were any.
void close_scope(Translator& t, ir::NodeList& list) {
  const Scope scope = t.scopes.back();
  t.scopes.pop_back();
  arrive(t, scope);
  if (scope.exit_used) lower_exits(t, list, scope.exit);
}

void append(ir::NodeList& list, ir::NodeList&& more) {
  for (auto& node : more) list.push_back(std::move(node));
}

/// Local that an OpPhi reads; made when first asked for in this function instance.
std::uint32_t phi_local(Translator& t, const Inst& phi) {
  const auto [at, added] = t.phi_locals.try_emplace(phi.result, 0);
  if (added) at->second = new_local(t, phi.result_type, spv::StorageClass::Function, 0);
  return at->second;
}

void store_phi(Translator& t, std::uint32_t local, std::uint32_t value) {
  store(t, local_pointer(t, local), value_of(t, value));
  copy_to_local(t, local, value);
}

/// Writes the phis of `to` for the edge from the block `from`.
void store_phis(Translator& t, std::uint32_t from, std::uint32_t to) {
  const Block& block = t.module.block(to);
  for (std::uint32_t i = block.first; i <= block.last; i++) {
    const Inst& phi = t.module.code[i];
    if (phi.op != Op::OpPhi) {
      // OpExtInst: debug information, which optimizers leave between phis.
      if (phi.op == Op::OpLine || phi.op == Op::OpNoLine || phi.op == Op::OpExtInst) continue;
      break;
    }
    for (std::uint32_t p = 0; p + 1 < phi.count(); p += 2)
      if (phi.operand(p + 1) == from) store_phi(t, phi_local(t, phi), phi.operand(p));
  }
}

/// If `label` leaves an enclosing construct, emits the jump and returns true.
bool jump_out(Translator& t, std::uint32_t label) {
  for (std::size_t i = t.scopes.size(); i-- > 0;) {
    Scope& scope = t.scopes[i];
    if (scope.kind == Scope::Kind::kFunction) return false;
    if (scope.kind == Scope::Kind::kLoop) {
      if (label != scope.merge && label != scope.continue_target) return false;
      emit_effect(t, label == scope.merge ? ir::Op::kBreak : ir::Op::kContinue);
      jump_to_end(t, label == scope.merge ? &scope : nullptr);
      return true;
    }
    if (label == scope.merge) {
      exit_scope(t, scope);
      return true;
    }
    if (scope.falls == nullptr || label == scope.own_case) continue;
    if (const auto fall = scope.falls->find(label); fall != scope.falls->end()) {
      store_flag(t, fall->second, true);
      store_flag(t, scope.falls->at(kAnyCase), true);
      exit_scope(t, scope);
      return true;
    }
  }
  return false;
}

bool is_exit(const Translator& t, std::uint32_t label) {
  for (std::size_t i = t.scopes.size(); i-- > 0;) {
    const Scope& scope = t.scopes[i];
    if (scope.kind == Scope::Kind::kFunction) return false;
    if (label == scope.merge) return true;
    if (scope.kind == Scope::Kind::kLoop) return label == scope.continue_target;
    if (scope.falls != nullptr && label != scope.own_case && scope.falls->count(label) != 0) return true;
  }
  return false;
}

/// One branch of a conditional: phis of the edge, then the blocks up to `end`.
void build_branch(Translator& t, ir::NodeList& list, std::uint32_t from, std::uint32_t label, std::uint32_t end) {
  const Into into(t, list);
  store_phis(t, from, label);
  build(t, label, end, false);
}

/// Both branches of a conditional.
void build_branches(Translator& t, ir::Node& node, std::uint32_t from, const Inst& branch, std::uint32_t end) {
  const Assigned before = assigned_here(t);
  build_branch(t, node.then_list, from, branch.operand(1), end);
  const Assigned behind = go_on_from(t, before);
  build_branch(t, node.else_list, from, branch.operand(2), end);
  go_on_from(t, meet(behind, assigned_here(t)));
}

void build_if(Translator& t, const Block& block, const Inst& branch) {
  const ir::ValueId chooser = condition(t, branch.operand(0));
  push_scope(t, Scope::Kind::kSelection, block.merge);
  ir::NodeList list;
  if (branch.operand(1) == branch.operand(2)) {
    build_branch(t, list, block.label, branch.operand(1), block.merge);
  } else {
    // Also where the condition is a literal: the reference finds that out after its first round of rules.
    const Into into(t, list);
    ir::Node& node = emit_node(t, ir::Node::Kind::kIf);
    node.condition = whole(chooser);
    build_branches(t, node, block.label, branch, block.merge);
  }
  close_scope(t, list);
  append(*t.list, std::move(list));
}

struct Case {
  std::uint32_t label = 0;
  bool is_default = false;
  std::vector<std::uint64_t> literals;
  ir::NodeList body;
};

/// Literals have as many words as the selector.
std::vector<Case> read_cases(const Inst& inst, std::uint8_t width) {
  std::vector<Case> cases;
  std::unordered_map<std::uint32_t, std::size_t> index;  ///< by label
  auto find = [&](std::uint32_t label) -> Case& {
    const auto [at, added] = index.try_emplace(label, cases.size());
    if (added) cases.emplace_back().label = label;
    return cases[at->second];
  };
  find(inst.operand(1)).is_default = true;
  const std::uint32_t words = width == 64 ? 2 : 1;
  for (std::uint32_t i = 2; i + words < inst.count(); i += words + 1) {
    std::uint64_t literal = inst.operand(i);
    if (words == 2) literal |= std::uint64_t{inst.operand(i + 1)} << 32;
    find(inst.operand(i + words)).literals.push_back(width < 32 ? literal & ((1u << width) - 1) : literal);
  }
  return cases;
}

ir::ValueId either(Translator& t, ir::ValueId a, ir::ValueId b) {
  return emit(t, ir::Op::kOrB, 1, true, {whole(a), whole(b)});
}

ir::ValueId literal_false(Translator& t) {
  const std::uint32_t word = 0;
  return literal(t, {&word, 1}, true);
}

/// One of the case's literals. The reference compares for every case, and again for the default, and joins with false.
ir::ValueId equals_literal(Translator& t, const Expr& selector, const Case& c) {
  ir::ValueId condition = literal_false(t);
  for (const std::uint64_t value : c.literals)
    condition = either(t, condition, apply(ir::Op::kIEq, {selector, constant_bits(t, value, selector.width)}).id);
  return condition;
}

/// That a case is entered from the switch; the default where none of the literals leads elsewhere.
ir::ValueId case_condition(Translator& t, const Expr& selector, const Case& c, const std::vector<Case>& cases,
                           const std::vector<std::size_t>& order) {
  if (!c.is_default) return equals_literal(t, selector, c);
  ir::ValueId others = literal_false(t);
  for (const std::size_t i : order)
    if (!cases[i].is_default) others = either(t, others, equals_literal(t, selector, cases[i]));
  return emit(t, ir::Op::kNotB, 1, true, {whole(others)});
}

/// Flags by which a case is entered from the case before it; they tell the order of cases. The reference has one for
/// all of them, which is what cases read.
using Falls = std::unordered_map<std::uint32_t, std::uint32_t>;

void build_case(Translator& t, Case& c, const Falls& falls, std::uint32_t merge) {
  Scope& scope = push_scope(t, Scope::Kind::kCase, merge);
  scope.falls = &falls;
  scope.own_case = c.label;
  {
    const Into into(t, c.body);
    store_flag(t, falls.at(kAnyCase), false);
    build(t, c.label, merge, false);
  }
  close_scope(t, c.body);
}

/// Order in which no case comes before one that falls into it; otherwise backwards, so that the default comes last: the
/// reference's order, which decides what its rewrites see.
/// `target`: the case that a case falls into; none: how many there are.
std::vector<std::size_t> case_order(const std::vector<Case>& cases, const std::vector<std::size_t>& target) {
  std::vector<std::size_t> order;
  std::vector<bool> placed(cases.size(), false);
  for (std::size_t root = 0; root < cases.size(); root++) {
    std::vector<std::size_t> chain;
    for (std::size_t at = root; at < cases.size() && !placed[at]; at = target[at]) {
      if (chain.size() == cases.size()) throw Failure("switch cases fall through in a circle");
      chain.push_back(at);
    }
    for (; !chain.empty(); chain.pop_back()) {
      const std::size_t at = chain.back();
      const auto next = target[at] < cases.size() ? std::find(order.begin(), order.end(), target[at]) : order.begin();
      order.insert(next, at);
      placed[at] = true;
    }
  }
  return order;
}

/// The last of the cases whose flags (local -> number of the case) a list sets; `none`: none.
std::size_t last_set(const Translator& t, const ir::NodeList& list,
                     const std::unordered_map<std::uint32_t, std::size_t>& flags, std::size_t none) {
  std::size_t last = none;
  const auto take = [&](std::size_t number) {
    if (number != none && (last == none || number > last)) last = number;
  };
  for (const auto& node : list) {
    if (node->kind == ir::Node::Kind::kInstr) {
      if (node->instr.op != ir::Op::kStoreVar) continue;
      const auto flag = flags.find(t.accesses[node->instr.data[0]].local);
      if (flag != flags.end()) take(flag->second);
    } else {
      for (const ir::NodeList* part : {&node->then_list, &node->else_list, &node->body, &node->continuing})
        take(last_set(t, *part, flags, none));
    }
  }
  return last;
}

/// Into which case each falls.
std::vector<std::size_t> fall_targets(const Translator& t, const std::vector<Case>& cases, const Falls& falls) {
  std::unordered_map<std::uint32_t, std::size_t> flags;
  for (std::size_t i = 0; i < cases.size(); i++)
    if (const auto flag = falls.find(cases[i].label); flag != falls.end()) flags[flag->second] = i;
  std::vector<std::size_t> targets;
  for (const Case& c : cases) targets.push_back(last_set(t, c.body, flags, cases.size()));
  return targets;
}

void build_switch(Translator& t, const Block& block, const Inst& inst) {
  const Expr selector = number_of(t, inst.operand(0));
  if (selector.size() != 1 || is_boolean(t, selector.id)) fail(inst, "selector is not an integer");
  std::vector<Case> cases = read_cases(inst, selector.width);
  Falls falls;
  falls[kAnyCase] = new_flag(t);
  for (const Case& c : cases) {
    // A fall-through writes the phis of its target later than this, so writing them for every target is safe.
    store_phis(t, block.label, c.label);
    if (c.label != block.merge && !is_exit(t, c.label)) falls[c.label] = new_flag(t);
  }
  for (const auto& [label, flag] : falls) store_flag(t, flag, false);
  const Assigned before = assigned_here(t);
  Assigned behind;
  behind.reachable = false;
  for (Case& c : cases) {
    go_on_from(t, before);
    build_case(t, c, falls, block.merge);
    behind = meet(behind, assigned_here(t));
  }
  go_on_from(t, behind);

  const std::vector<std::size_t> order = case_order(cases, fall_targets(t, cases, falls));
  for (const std::size_t i : order) {
    const ir::ValueId entered = case_condition(t, selector, cases[i], cases, order);
    const ir::ValueId condition = either(t, entered, load_flag(t, falls[kAnyCase]));
    ir::Node& node = emit_node(t, ir::Node::Kind::kIf);
    node.condition = whole(condition);
    node.then_list = std::move(cases[i].body);
  }
}

/// The continue construct goes in front of the body, guarded by a flag that only the first iteration has not set: the
/// reference's shape, which decides what its rewrites see.
void put_in_front(Translator& t, ir::Node& loop, ir::NodeList&& continuing, std::uint32_t continues) {
  ir::NodeList body = std::move(loop.body);
  loop.body.clear();
  const Into into(t, loop.body);
  const ir::ValueId flag = load_flag(t, continues);
  ir::Node& first = emit_node(t, ir::Node::Kind::kIf);
  first.condition = whole(flag);
  first.then_list = std::move(continuing);
  store_flag(t, continues, true);
  append(loop.body, std::move(body));
}

void build_loop(Translator& t, const Block& header) {
  const std::uint32_t continues = new_flag(t);
  store_flag(t, continues, false);
  t.inst = &t.module.code[header.last - 1];
  ir::Node& node = emit_node(t, ir::Node::Kind::kLoop);
  t.scopes.push_back({Scope::Kind::kLoop, header.merge, header.continue_target, 0, false, nullptr, 0, nullptr});
  const Assigned before = assigned_here(t);
  {
    const Into into(t, node.body);
    build(t, header.label, header.continue_target, true);
  }
  if (header.continue_target != header.label) {
    // In the continue construct a jump to the continue target is no longer possible; the header ends it.
    t.scopes.back().continue_target = 0;
    go_on_from(t, before);
    ir::NodeList continuing;
    {
      const Into into(t, continuing);
      build(t, header.continue_target, header.label, true);
    }
    if (!continuing.empty()) put_in_front(t, node, std::move(continuing), continues);
  }
  jump_to_end(t, nullptr);
  arrive(t, t.scopes.back());
  t.scopes.pop_back();
}

/// Conditional branch without merge: at least one side leaves a construct or ends the list. Returns the label to go on
/// with, 0: none.
std::uint32_t build_conditional_jump(Translator& t, const Block& block, const Inst& branch, std::uint32_t end) {
  const std::uint32_t yes = branch.operand(1), no = branch.operand(2);
  if (yes == no) {
    store_phis(t, block.label, yes);
    return yes;
  }
  const bool yes_leaves = yes == end || is_exit(t, yes), no_leaves = no == end || is_exit(t, no);
  if (!yes_leaves && !no_leaves) fail(branch, "branches without a merge block");
  ir::Node& node = emit_node(t, ir::Node::Kind::kIf);
  node.condition = whole(condition(t, branch.operand(0)));
  if (yes_leaves && no_leaves) {
    build_branches(t, node, block.label, branch, end);
    return 0;
  }
  const std::uint32_t leaving = yes_leaves ? yes : no, staying = yes_leaves ? no : yes;
  ir::NodeList& jump = yes_leaves ? node.then_list : node.else_list;
  ir::NodeList& rest = yes_leaves ? node.else_list : node.then_list;
  const Assigned before = assigned_here(t);
  build_branch(t, jump, block.label, leaving, end);
  if (leaving != end) {
    go_on_from(t, before);
    store_phis(t, block.label, staying);
    return staying;
  }
  const Assigned behind = go_on_from(t, before);
  build_branch(t, rest, block.label, staying, end);
  go_on_from(t, meet(behind, assigned_here(t)));
  return 0;
}

void leave_function(Translator& t, const Inst& inst) {
  const Frame& frame = t.frames.back();
  if (inst.op == Op::OpReturnValue && frame.result_local == kNoLocal) fail(inst, "the function returns no value");
  if (inst.op == Op::OpReturnValue) store_phi(t, frame.result_local, inst.operand(0));
  exit_scope(t, t.scopes[frame.scope]);
}

void end_invocation(Translator& t, const Inst& inst) {
  t.function.interface.uses_discard = true;
  jump_to_end(t, nullptr);
  // SPIR-V 1.6, OpTerminateInvocation: "Ceases all further processing in any invocation that executes it". Votes of
  // quads, and all group operations where invocations reconverge maximally, tell helpers from those that are gone.
  const bool leaves = (t.function.helpers_take_part || t.module.votes_in_quads) && inst.op == Op::OpTerminateInvocation;
  if (leaves || std::any_of(t.scopes.begin(), t.scopes.end(),
                            [](const Scope& scope) { return scope.kind == Scope::Kind::kLoop; })) {
    emit_effect(t, ir::Op::kKill).data[0] = leaves;
    return;
  }
  // Outside loops the lane goes on as a helper, as the reference lets it, so that later derivatives have its values.
  emit_effect(t, ir::Op::kDemote);
}

/// A selection whose branches meet before its merge block is one up to there, then the rest up to the merge block.
void build_selection(Translator& t, const Block& block, const Inst& branch) {
  const MeetingPoints& points = t.meeting_points.at(t.frames.back().function->entry);
  const auto point = points.find(block.label);
  if (point == points.end()) return build_if(t, block, branch);
  Block inner = block;
  inner.merge = point->second;
  push_scope(t, Scope::Kind::kSelection, block.merge);
  ir::NodeList list;
  {
    const Into into(t, list);
    build_if(t, inner, branch);
    build(t, point->second, block.merge, false);
  }
  close_scope(t, list);
  append(*t.list, std::move(list));
}

/// Ends a block; returns the label to go on with in the same list, 0: the list is complete.
std::uint32_t build_terminator(Translator& t, const Block& block, std::uint32_t end) {
  const Inst& inst = t.module.code[block.last];
  t.inst = &inst;
  step_to(t, inst);
  if (inst.op == Op::OpBranchConditional || inst.op == Op::OpSwitch) use_in_branch(t, inst.operand(0));
  switch (inst.op) {
    case Op::OpBranch:
      store_phis(t, block.label, inst.operand(0));
      return inst.operand(0);
    case Op::OpBranchConditional:
      if (block.merge_op != Op::OpSelectionMerge) return build_conditional_jump(t, block, inst, end);
      build_selection(t, block, inst);
      return block.merge;
    case Op::OpSwitch:
      if (block.merge_op != Op::OpSelectionMerge) fail(inst, "switch without a merge block");
      build_switch(t, block, inst);
      return block.merge;
    case Op::OpReturn:
    case Op::OpReturnValue:
      leave_function(t, inst);
      return 0;
    case Op::OpKill:
    case Op::OpTerminateInvocation:
      end_invocation(t, inst);
      return 0;
    case Op::OpUnreachable:
      if (t.interest.control) probe_before(t, inst);
      jump_to_end(t, nullptr);
      return 0;
    default:
      return 0;
  }
}

void load_phi(Translator& t, const Inst& inst) {
  t.values[inst.result] = load(t, local_pointer(t, phi_local(t, inst)));
  copy_from_local(t, inst.result, phi_local(t, inst));
}

void call(Translator& t, const Inst& inst);

void translate_observed(Translator& t, const Inst& inst) {
  if (t.interest.control) probe_before(t, inst);
  if (t.interest.accesses) probe_access(t, inst);
  if (t.interest.order) probe_order(t, inst);
  before_instruction(t, inst);
  translate_instruction(t, inst);
  after_instruction(t, inst);
  show_result(t, inst);
  if (t.interest.arithmetic || t.interest.numbers) probe_after(t, inst);
}

void build_block(Translator& t, const Block& block) {
  if (t.interest.blocks) probe_block(t, block);
  begin_lines(t);
  for (std::uint32_t i = block.first; i < block.last; i++) {
    const Inst& inst = t.module.code[i];
    t.inst = &inst;
    if (++t.steps > kMaxSteps) fail(inst, "the shader expands to too many instructions");
    step_to(t, inst);
    if (inst.op == Op::OpPhi)
      load_phi(t, inst), show_result(t, inst);
    else if (inst.op == Op::OpFunctionCall)
      call(t, inst), step_back(t, inst);
    else
      translate_observed(t, inst);
  }
}

/// Blocks from `label` until `end` or a jump. `enter_first`: `label` is a loop header or continue target being entered.
void build(Translator& t, std::uint32_t label, std::uint32_t end, bool enter_first) {
  const Deeper deeper(t, "control flow is");
  bool header_entered = enter_first;
  while (label != 0) {
    if (!header_entered && (label == end || jump_out(t, label))) return;
    const Block& block = t.module.block(label);
    const bool as_loop = block.merge_op == Op::OpLoopMerge && !(header_entered && t.scopes.back().merge == block.merge);
    header_entered = false;
    if (as_loop) {
      build_loop(t, block);
      label = block.merge;
      continue;
    }
    if (!t.built_blocks.insert(label).second) fail(t.module.code[block.last], "control flow is not structured");
    build_block(t, block);
    label = build_terminator(t, block, end);
  }
}

void bind_arguments(Translator& t, const Inst& inst, const Function& callee) {
  for (std::uint32_t i = 0; i < callee.params.size(); i++) {
    const std::uint32_t argument = inst.operand(i + 1), param = callee.params[i];
    if (const auto image = t.images.find(argument); image != t.images.end())
      t.images[param] = image->second;
    else if (t.module.type(t.module.def(param).result_type).kind == Type::Kind::kPointer)
      t.pointers[param] = pointer_of(t, argument);
    else
      t.values[param] = value_of(t, argument), copy_value(t, param, argument);
  }
}

bool is_shared(const Translator& t, const ir::Instr& instr) {
  std::vector<std::uint32_t> key(instr.imm.begin(), instr.imm.begin() + instr.components);
  key.push_back(instr.boolean ? 1 : 0);
  key.push_back(instr.op == ir::Op::kUndef ? 1 : 0);
  const auto found = t.constant_ids.find(key);
  return found != t.constant_ids.end() && found->second == instr.result;
}

/// The literals that a function names, those behind the first `constants`, go in front of its instructions, as in the
/// reference: a literal of a function that is called in a branch does not make equal literals in front of the branch.
void place_literals(Translator& t, std::size_t constants, std::size_t prologue, ir::NodeList& list) {
  std::unordered_set<ir::ValueId> early;
  for (std::size_t i = prologue; i < t.prologue.size(); i++)
    for (const ir::Src& src : t.prologue[i]->instr.src) early.insert(src.value);
  ir::NodeList kept, moved;
  for (std::size_t i = constants; i < t.constants.size(); i++) {
    const ir::Instr& instr = t.constants[i]->instr;
    const bool moves = instr.op == ir::Op::kConst && early.count(instr.result) == 0 && !is_shared(t, instr);
    if (moves) t.constant_words.erase(instr.result);
    (moves ? moved : kept).push_back(std::move(t.constants[i]));
  }
  t.constants.resize(constants);
  append(t.constants, std::move(kept));
  append(moved, std::move(list));
  list = std::move(moved);
}

/// Inlines a function into the current list; afterwards `result_local` (kNoLocal: none) holds what it returned.
void build_function(Translator& t, const Function& callee, std::uint32_t result_local) {
  for (const Frame& frame : t.frames)
    if (frame.function == &callee) throw Failure("function %" + std::to_string(callee.id) + " is recursive");
  if (callee.entry == 0) throw Failure("function %" + std::to_string(callee.id) + " has no body");
  const auto blocks = std::exchange(t.built_blocks, {});
  const auto phis = std::exchange(t.phi_locals, {});
  ir::NodeList list;
  const std::size_t constants = t.constants.size(), prologue = t.prologue.size();
  push_scope(t, Scope::Kind::kFunction, 0);
  if (t.meeting_points.count(callee.entry) == 0)
    t.meeting_points[callee.entry] = find_meeting_points(t.module, callee.entry);
  t.frames.push_back({&callee, result_local, t.scopes.size() - 1});
  {
    const Into into(t, list);
    enter_function(t, callee);
    build(t, callee.entry, 0, false);
  }
  t.frames.pop_back();
  if (!t.frames.empty()) place_literals(t, constants, prologue, list);
  close_scope(t, list);
  append(*t.list, std::move(list));
  t.built_blocks = blocks;
  t.phi_locals = phis;
}

void call(Translator& t, const Inst& inst) {
  const Deeper deeper(t, "control flow is");
  const auto callee = t.module.functions.find(inst.operand(0));
  if (callee == t.module.functions.end()) fail(inst, "calls something that is no function");
  bind_arguments(t, inst, callee->second);
  const bool has_result = t.module.type(inst.result_type).kind != Type::Kind::kVoid;
  const std::uint32_t local = has_result ? new_local(t, inst.result_type, spv::StorageClass::Function, 0) : kNoLocal;
  const std::uint32_t here = inlined_place(t, inst.origin.place), caller = t.call;
  if (here != 0) t.call = here;
  build_function(t, callee->second, local);
  t.call = caller;
  t.inst = &inst;
  if (!has_result) return;
  t.values[inst.result] = load(t, local_pointer(t, local));
  copy_from_local(t, inst.result, local);
}

}  // namespace

void translate_entry(Translator& t) {
  const auto entry = t.module.functions.find(t.module.entry_function);
  if (entry == t.module.functions.end()) throw Failure("the entry point has no function");
  t.list = &t.function.body;
  build_function(t, entry->second, kNoLocal);
}

}  // namespace vitrine::spirv::front
