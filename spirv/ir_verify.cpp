// Checks the invariants that ir.h states. Run after every pass in debug builds and in tests.
#include "spirv/ir_passes.h"

namespace vitrine::spirv::ir {
namespace {

struct Verifier {
  const Function& function;
  std::vector<bool> visible;
  std::string error;
  const Node* loop = nullptr;

  void complain(const std::string& what, ValueId value = kNoValue) {
    if (!error.empty()) return;
    error = what;
    if (value != kNoValue) error += " %" + std::to_string(value);
  }

  void define(ValueId value, std::vector<ValueId>& defined) {
    if (value >= function.values.size()) return complain("result without ValueInfo", value);
    if (visible[value]) complain("defined twice", value);
    visible[value] = true;
    defined.push_back(value);
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
        if (loop == nullptr) return complain("Break outside Loop");
        return pass(instr.src, loop->results, "Break");
      case Op::kContinue:
        if (loop == nullptr) return complain("Continue outside Loop");
        return pass(instr.src, loop->continue_params, "Continue");
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

  void list(const NodeList& nodes, const std::vector<ValueId>* yields) {
    std::vector<ValueId> defined;
    for (std::size_t i = 0; i < nodes.size() && error.empty(); i++) {
      const Node& node = *nodes[i];
      switch (node.kind) {
        case Node::Kind::kInstr:
          node.instr.op < Op::kAluCount ? alu(node.instr) : intrinsic(node.instr, yields, i + 1 == nodes.size());
          if (node.instr.result != kNoValue) {
            define(node.instr.result, defined);
            const ValueInfo info = function.values[node.instr.result];
            if (info.components != node.instr.components || info.boolean != node.instr.boolean)
              complain("ValueInfo differs from the instruction", node.instr.result);
          }
          break;
        case Node::Kind::kIf:
          use(node.condition, 1);
          list(node.then_list, &node.results);
          list(node.else_list, &node.results);
          for (ValueId value : node.results) define(value, defined);
          break;
        case Node::Kind::kLoop:
          check_loop(node, defined);
          break;
      }
    }
    if (yields != nullptr && error.empty() &&
        (nodes.empty() || nodes.back()->kind != Node::Kind::kInstr || !is_jump(nodes.back()->instr.op)))
      complain("list without Yield or jump at its end");
    for (ValueId value : defined) visible[value] = false;
  }

  void check_loop(const Node& node, std::vector<ValueId>& defined) {
    pass(node.init, node.params, "Loop");
    const Node* const outer = loop;
    std::vector<ValueId> inside;
    for (ValueId value : node.params) define(value, inside);
    loop = &node;
    list(node.body, &node.continue_params);
    for (ValueId value : node.continue_params) define(value, inside);
    list(node.continuing, &node.params);
    loop = outer;
    for (ValueId value : inside) visible[value] = false;
    for (ValueId value : node.results) define(value, defined);
  }
};

}  // namespace

std::string verify(const Function& function) {
  Verifier verifier{function, std::vector<bool>(function.values.size(), false), {}};
  verifier.list(function.body, nullptr);
  return std::move(verifier.error);
}

}  // namespace vitrine::spirv::ir
