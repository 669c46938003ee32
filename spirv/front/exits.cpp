// Lowers Exit instructions: leaving a selection, switch case or inlined function from inside it. Where one branch of an
// If always exits, what follows the If moves into the other branch; otherwise a flag guards it; inside loops the flag
// is followed by Break (the shape that the reference's return lowering gives).
#include <algorithm>

#include "spirv/front/context.h"

namespace vitrine::spirv::front {
namespace {

using Kind = ir::Node::Kind;
enum class Leaves : std::uint8_t { kNever, kMaybe, kAlways };

bool is_exit(const ir::Node& node, std::uint32_t exit) {
  return node.kind == Kind::kInstr && node.instr.op == ir::Op::kExit && node.instr.data[0] == exit;
}

bool ends_in_jump(const ir::NodeList& list) {
  if (list.empty() || list.back()->kind != Kind::kInstr) return false;
  const ir::Op op = list.back()->instr.op;
  return op == ir::Op::kBreak || op == ir::Op::kContinue || op == ir::Op::kKill || op == ir::Op::kExit;
}

bool contains_exit(const ir::NodeList& list, std::uint32_t exit) {
  for (const auto& node : list)
    if (is_exit(*node, exit) || contains_exit(node->then_list, exit) || contains_exit(node->else_list, exit) ||
        contains_exit(node->body, exit) || contains_exit(node->continuing, exit))
      return true;
  return false;
}

struct Lowering {
  Translator& t;
  std::uint32_t exit = 0;
  std::uint32_t flag = UINT32_MAX;  ///< local, made when first needed
  std::uint32_t depth = 0;

  void set_flag(ir::NodeList& list) {
    if (flag == UINT32_MAX) flag = new_flag(t);
    ir::NodeList* const saved = std::exchange(t.list, &list);
    store_flag(t, flag, true);
    t.list = saved;
  }

  /// Appends If(flag) to `list` and returns it.
  ir::Node& if_flag(ir::NodeList& list) {
    if (flag == UINT32_MAX) flag = new_flag(t);
    ir::NodeList* const saved = std::exchange(t.list, &list);
    const ir::ValueId value = load_flag(t, flag);
    ir::Node& node = emit_node(t, Kind::kIf);
    node.condition = whole(value);
    t.list = saved;
    return node;
  }

  static ir::NodeList split_after(ir::NodeList& list, std::size_t i) {
    ir::NodeList rest(std::make_move_iterator(list.begin() + static_cast<std::ptrdiff_t>(i) + 1),
                      std::make_move_iterator(list.end()));
    list.resize(i + 1);
    return rest;
  }

  static void append(ir::NodeList& list, ir::NodeList&& more) {
    if (ends_in_jump(list)) return;
    for (auto& node : more) list.push_back(std::move(node));
  }

  /// Inside a loop an exit sets the flag and breaks; loops around it break again.
  void lower_in_loop(ir::NodeList& list) {
    for (std::size_t i = 0; i < list.size(); i++) {
      ir::Node& node = *list[i];
      if (is_exit(node, exit)) {
        list.resize(i);
        set_flag(list);
        ir::NodeList* const saved = std::exchange(t.list, &list);
        emit_effect(t, ir::Op::kBreak);
        t.list = saved;
        return;
      }
      if (node.kind == Kind::kIf) {
        lower_in_loop(node.then_list);
        lower_in_loop(node.else_list);
      } else if (node.kind == Kind::kLoop && (contains_exit(node.body, exit) || contains_exit(node.continuing, exit))) {
        lower_in_loop(node.body);
        lower_in_loop(node.continuing);
        ir::NodeList rest = split_after(list, i);
        ir::NodeList* const saved = std::exchange(t.list, &if_flag(list).then_list);
        emit_effect(t, ir::Op::kBreak);
        t.list = saved;
        i = list.size() - 1;
        append(list, std::move(rest));
      }
    }
  }

  Leaves lower(ir::NodeList& list) {
    if (++depth > kMaxDepth) throw Failure("control flow is too deeply nested");
    const Leaves result = lower_list(list);
    depth--;
    return result;
  }

  Leaves lower_list(ir::NodeList& list) {
    for (std::size_t i = 0; i < list.size(); i++) {
      ir::Node& node = *list[i];
      if (is_exit(node, exit)) {
        list.resize(i);
        set_flag(list);
        return Leaves::kAlways;
      }
      if (node.kind == Kind::kIf && (contains_exit(node.then_list, exit) || contains_exit(node.else_list, exit)))
        return lower_if(list, i);
      if (node.kind == Kind::kLoop && (contains_exit(node.body, exit) || contains_exit(node.continuing, exit))) {
        lower_in_loop(node.body);
        lower_in_loop(node.continuing);
        return guard_rest(list, i);
      }
    }
    return Leaves::kNever;
  }

  /// What follows node i runs only where the flag is not set.
  Leaves guard_rest(ir::NodeList& list, std::size_t i) {
    ir::NodeList rest = split_after(list, i);
    if (rest.empty()) return Leaves::kMaybe;
    lower(rest);
    if_flag(list).else_list = std::move(rest);
    return Leaves::kMaybe;
  }

  Leaves lower_if(ir::NodeList& list, std::size_t i) {
    ir::Node& node = *list[i];
    const Leaves then_leaves = lower(node.then_list), else_leaves = lower(node.else_list);
    if (then_leaves == Leaves::kAlways && else_leaves == Leaves::kAlways) {
      list.resize(i + 1);
      return Leaves::kAlways;
    }
    if (then_leaves == Leaves::kMaybe || else_leaves == Leaves::kMaybe) return guard_rest(list, i);
    ir::NodeList rest = split_after(list, i);
    const Leaves rest_leaves = lower(rest);
    append(then_leaves == Leaves::kAlways ? node.else_list : node.then_list, std::move(rest));
    return rest_leaves == Leaves::kAlways ? Leaves::kAlways : Leaves::kMaybe;
  }
};

}  // namespace

void lower_exits(Translator& t, ir::NodeList& list, std::uint32_t exit) {
  Lowering lowering{t, exit};
  lowering.lower(list);
  if (lowering.flag == UINT32_MAX) return;
  // The flag starts as false in front of the construct.
  ir::NodeList start;
  ir::NodeList* const saved = std::exchange(t.list, &start);
  store_flag(t, lowering.flag, false);
  t.list = saved;
  list.insert(list.begin(), std::make_move_iterator(start.begin()), std::make_move_iterator(start.end()));
}

}  // namespace vitrine::spirv::front
