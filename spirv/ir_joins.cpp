// Makes every value that crosses a join a whole value of the join's width, as the lowering wants it.
#include "spirv/ir_passes.h"
#include "spirv/ir_walk.h"

namespace vitrine::spirv::ir {
namespace {

struct Joins {
  Function& function;

  bool is_whole(const Src& src, ValueId target) const {
    const std::uint8_t width = function.values[target].components;
    if (function.values[src.value].components != width) return false;
    for (std::uint8_t i = 0; i < width; i++)
      if (src.swizzle[i] != i) return false;
    return true;
  }

  /// Gathers the components of `src` into a value of its own, defined before list[i]; returns the new i.
  std::size_t gather(NodeList& list, std::size_t i, Src& src, ValueId target) {
    if (is_whole(src, target)) return i;
    auto node = std::make_unique<Node>();
    Instr& vec = node->instr;
    vec.op = Op::kVec;
    vec.components = function.values[target].components;
    vec.boolean = function.values[target].boolean;
    for (std::uint8_t c = 0; c < vec.components; c++)
      vec.src.push_back({src.value, {src.swizzle[c], src.swizzle[c], src.swizzle[c], src.swizzle[c]}});
    vec.result = function.new_value(vec.components, vec.boolean);
    src = {vec.result, {0, 1, 2, 3}};
    list.insert(list.begin() + static_cast<std::ptrdiff_t>(i), std::move(node));
    return i + 1;
  }

  std::size_t gather_all(NodeList& list, std::size_t i, std::vector<Src>& sources,
                         const std::vector<ValueId>& targets) {
    for (std::size_t k = 0; k < sources.size() && k < targets.size(); k++) i = gather(list, i, sources[k], targets[k]);
    return i;
  }

  void run(NodeList& list, const std::vector<ValueId>* yields, const Node* loop) {
    for (std::size_t i = 0; i < list.size(); i++) {
      Node& node = *list[i];
      if (node.kind == Node::Kind::kIf) {
        run(node.then_list, &node.results, loop);
        run(node.else_list, &node.results, loop);
      } else if (node.kind == Node::Kind::kLoop) {
        i = gather_all(list, i, node.init, node.params);
        run(node.body, &node.continue_params, &node);
        run(node.continuing, &node.params, &node);
      } else if (node.instr.op == Op::kYield && yields != nullptr) {
        i = gather_all(list, i, node.instr.src, *yields);
      } else if (node.instr.op == Op::kBreak && loop != nullptr) {
        i = gather_all(list, i, node.instr.src, loop->results);
      } else if (node.instr.op == Op::kContinue && loop != nullptr) {
        i = gather_all(list, i, node.instr.src, loop->continue_params);
      }
    }
  }
};

}  // namespace

void make_joins_whole(Function& function) { Joins{function}.run(function.body, nullptr, nullptr); }

}  // namespace vitrine::spirv::ir
