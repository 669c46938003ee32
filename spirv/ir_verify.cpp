// Checks the invariants that ir.h states. Run after every pass in debug builds and in tests.
#include <algorithm>
#include <utility>

#include "spirv/ir_passes.h"

namespace vitrine::spirv::ir {
namespace {

struct Verifier {
  const Function& function;
  Scope scope;
  std::vector<bool> visible;
  std::vector<ValueId> defined{};  ///< what is visible, in the order of definition
  std::string error{};

  /// The innermost loop, and what is visible at each of its ways out.
  struct Loop {
    const Node* node = nullptr;
    std::size_t outside = 0;  ///< of `defined`
    bool left = false;
    std::vector<ValueId> at_exits;
    std::vector<ValueId> inside{};  ///< all that is defined in it
  };
  Loop loop{};

  void complain(const std::string& what, ValueId value = kNoValue) {
    if (!error.empty()) return;
    error = what;
    if (value != kNoValue) error += " %" + std::to_string(value);
  }

  void define(ValueId value) {
    if (value >= function.values.size()) return complain("result without ValueInfo", value);
    if (visible[value]) complain("defined twice", value);
    visible[value] = true;
    defined.push_back(value);
    if (loop.node != nullptr && scope == Scope::kBehindExits) loop.inside.push_back(value);
  }

  void hide_since(std::size_t count) {
    for (; defined.size() > count; defined.pop_back()) visible[defined.back()] = false;
  }

  void use(const Src& src, std::uint32_t width) {
    if (src.value >= function.values.size() || !visible[src.value])
      return complain("used where it is not visible:", src.value);
    for (std::uint32_t i = 0; i < width; i++)
      if (src.swizzle[i] >= function.values[src.value].components) complain("swizzle out of range of", src.value);
  }

  /// Values handed to results or params: same count, same types.
  void pass(const std::vector<Src>& sources, const std::vector<ValueId>& targets, const char* what) {
    if (sources.size() != targets.size())
      return complain(std::string(what) + " passes " + std::to_string(sources.size()) + " values, wanted " +
                      std::to_string(targets.size()));
    for (std::size_t i = 0; i < sources.size(); i++) {
      if (sources[i].value >= function.values.size()) return complain("no such value", sources[i].value);
      const ValueInfo from = function.values[sources[i].value], to = function.values[targets[i]];
      if (from.boolean != to.boolean) complain(std::string(what) + " passes another type to", targets[i]);
      use(sources[i], to.components);
    }
  }

  static bool is_jump(Op op) {
    return op == Op::kYield || op == Op::kBreak || op == Op::kContinue || op == Op::kReturn || op == Op::kKill;
  }

  void alu(const Instr& instr) {
    const AluInfo& info = alu_info(instr.op);
    if (instr.src.size() != info.sources) return complain(std::string(info.name) + ": number of sources");
    if (instr.boolean != (info.result == 'B')) complain(std::string(info.name) + ": type of the result", instr.result);
    for (std::size_t i = 0; i < instr.src.size() && error.empty(); i++) {
      use(instr.src[i], components_read(instr, i));
      if (error.empty() && function.values[instr.src[i].value].boolean != (info.operands[i] == 'B'))
        complain(std::string(info.name) + ": type of operand", instr.src[i].value);
    }
  }

  void intrinsic(const Instr& instr, const std::vector<ValueId>* yields, bool last) {
    if (is_jump(instr.op) && !last) complain(std::string(op_name(instr.op)) + " is not at the end of its list");
    switch (instr.op) {
      case Op::kYield:
        if (yields == nullptr) return complain("Yield outside If and Loop");
        return pass(instr.src, *yields, "Yield");
      case Op::kBreak:
        if (loop.node == nullptr) return complain("Break outside Loop");
        leave_loop();
        return pass(instr.src, loop.node->results, "Break");
      case Op::kContinue:
        if (loop.node == nullptr) return complain("Continue outside Loop");
        return pass(instr.src, loop.node->continue_params, "Continue");
      case Op::kVec:
        if (instr.src.size() != instr.components) complain("Vec: number of sources", instr.result);
        for (const Src& src : instr.src) use(src, 1);
        return;
      case Op::kLoadVar:
      case Op::kStoreVar:
      case Op::kExit:
        return complain("front-end instruction left over");
      default:
        for (const Src& src : instr.src) use(src, 1);
        if (is_wide(instr.op)) wide(instr);
    }
  }

  void wide(const Instr& instr) {
    const WideInfo& info = wide_info(instr.op);
    std::uint32_t words = 0;
    for (const char* letter = info.operands; *letter != 0; letter++) words += wide_words(*letter);
    if (instr.src.size() != words) complain(std::string(info.name) + ": number of sources");
    if (instr.components != wide_words(info.result) || instr.boolean != (info.result == 'B'))
      complain(std::string(info.name) + ": type of the result", instr.result);
  }

  /// What all ways out so far have in common stays visible behind the loop.
  void leave_loop() {
    if (scope == Scope::kLists) return;
    const std::vector<ValueId> here(defined.begin() + static_cast<std::ptrdiff_t>(loop.outside), defined.end());
    if (!std::exchange(loop.left, true)) {
      loop.at_exits = here;
    } else {
      std::erase_if(loop.at_exits, [&](ValueId id) { return std::find(here.begin(), here.end(), id) == here.end(); });
    }
  }

  /// `stays`: what the list defines is visible behind it.
  void list(const NodeList& nodes, const std::vector<ValueId>* yields, bool stays = false) {
    const std::size_t before = defined.size();
    for (std::size_t i = 0; i < nodes.size() && error.empty(); i++) {
      const Node& node = *nodes[i];
      switch (node.kind) {
        case Node::Kind::kInstr:
          node.instr.op < Op::kAluCount ? alu(node.instr) : intrinsic(node.instr, yields, i + 1 == nodes.size());
          if (node.instr.result != kNoValue) {
            define(node.instr.result);
            const ValueInfo info = function.values[node.instr.result];
            if (info.components != node.instr.components || info.boolean != node.instr.boolean)
              complain("ValueInfo differs from the instruction", node.instr.result);
          }
          break;
        case Node::Kind::kIf:
          use(node.condition, 1);
          check_if(node);
          break;
        case Node::Kind::kLoop:
          check_loop(node);
          break;
      }
    }
    if (yields != nullptr && error.empty() &&
        (nodes.empty() || nodes.back()->kind != Node::Kind::kInstr || !is_jump(nodes.back()->instr.op)))
      complain("list without Yield or jump at its end");
    if (!stays) hide_since(before);
  }

  bool leaves(const NodeList& nodes) const {
    return scope == Scope::kBehindExits && !nodes.empty() && nodes.back()->kind == Node::Kind::kInstr &&
           nodes.back()->instr.op != Op::kYield;
  }

  void check_if(const Node& node) {
    list(node.then_list, &node.results, leaves(node.else_list));
    list(node.else_list, &node.results, leaves(node.then_list));
    for (ValueId value : node.results) define(value);
  }

  void check_loop(const Node& node) {
    pass(node.init, node.params, "Loop");
    Loop outer = std::exchange(loop, Loop{&node, defined.size(), false, {}, {}});
    for (ValueId value : node.params) define(value);
    list(node.body, &node.continue_params, scope == Scope::kBehindExits);
    for (ValueId value : node.continue_params) define(value);
    list(node.continuing, &node.params);
    hide_since(loop.outside);
    // Nothing behind a loop without a way out runs, whatever it reads.
    const Loop inner = std::exchange(loop, std::move(outer));
    const std::vector<ValueId>& stays = inner.left ? inner.at_exits : inner.inside;
    if (loop.node != nullptr) loop.inside.insert(loop.inside.end(), inner.inside.begin(), inner.inside.end());
    for (const ValueId value : stays)
      if (!visible[value]) define(value);
    for (ValueId value : node.results) define(value);
  }
};

}  // namespace

std::string verify(const Function& function, Scope scope) {
  Verifier verifier{function, scope, std::vector<bool>(function.values.size(), false)};
  verifier.list(function.body, nullptr);
  return std::move(verifier.error);
}

}  // namespace vitrine::spirv::ir
