// Splits ALU instructions of several components into one instruction per component.
#include "spirv/ir_passes.h"

namespace vitrine::spirv::ir {
namespace {

void split(Function& function, NodeList& list, std::unique_ptr<Node> node) {
  const Instr& wide = node->instr;
  auto joined = std::make_unique<Node>();
  joined->instr.op = Op::kVec;
  joined->instr.components = wide.components;
  joined->instr.boolean = wide.boolean;
  joined->instr.result = wide.result;
  joined->instr.origin = wide.origin;
  for (std::uint8_t c = 0; c < wide.components; c++) {
    auto part = std::make_unique<Node>();
    Instr& instr = part->instr;
    instr = wide;
    instr.components = 1;
    instr.result = function.new_value(1, wide.boolean);
    for (Src& src : instr.src) src.swizzle = {src.swizzle[c], src.swizzle[c], src.swizzle[c], src.swizzle[c]};
    joined->instr.src.push_back({instr.result, {0, 0, 0, 0}});
    list.push_back(std::move(part));
  }
  list.push_back(std::move(joined));
}

void scalarize_list(Function& function, NodeList& list) {
  NodeList old = std::move(list);
  list.clear();
  list.reserve(old.size());
  for (auto& node : old) {
    if (node->kind == Node::Kind::kInstr) {
      if (node->instr.op < Op::kAluCount && node->instr.components > 1)
        split(function, list, std::move(node));
      else
        list.push_back(std::move(node));
      continue;
    }
    for (NodeList* part : {&node->then_list, &node->else_list, &node->body, &node->continuing})
      scalarize_list(function, *part);
    list.push_back(std::move(node));
  }
}

}  // namespace

void scalarize(Function& function) {
  scalarize_list(function, function.body);
  propagate_copies(function);
}

}  // namespace vitrine::spirv::ir
