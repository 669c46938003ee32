// Everything that feeds an output decorated Invariant is exact (lavapipe-shader-math.md 3.3): backwards over values,
// through the arguments of If and Loop, the conditions that choose between them, and local arrays.
#include "spirv/front/context.h"
#include "spirv/ir_walk.h"

namespace vitrine::spirv::front {
namespace {

using ir::Node;

struct Marker {
  ir::Function& function;
  std::vector<Node*> definition;  ///< node that defines a value
  std::vector<bool> marked;
  std::vector<bool> array_marked;
  std::vector<ir::ValueId> work;

  void mark(const ir::Src& src) {
    if (marked[src.value]) return;
    marked[src.value] = true;
    work.push_back(src.value);
  }

  void mark_all(const std::vector<ir::Src>& sources) {
    for (const ir::Src& src : sources) mark(src);
  }

  /// Every value that any argument or jump of the construct passes on.
  void mark_construct(Node& node) {
    if (node.kind == Node::Kind::kIf) mark(node.condition);
    mark_all(node.init);
    for (ir::NodeList* part : {&node.then_list, &node.else_list, &node.body, &node.continuing}) {
      if (const ir::Instr* yield = ir::yield_of(*part)) mark_all(yield->src);
      ir::each_jump(*part, [&](ir::Instr& jump) { mark_all(jump.src); });
      ir::each_node(*part, [&](Node& inner) {
        if (inner.kind == Node::Kind::kIf && node.kind == Node::Kind::kLoop) mark(inner.condition);
      });
    }
  }

  void mark_array(std::uint32_t array) {
    if (array_marked[array]) return;
    array_marked[array] = true;
    ir::each_node(function.body, [&](Node& node) {
      if (node.kind == Node::Kind::kInstr && node.instr.op == ir::Op::kStoreArray && node.instr.data[0] == array)
        mark_all(node.instr.src);
    });
  }

  void run() {
    while (!work.empty()) {
      Node* const node = definition[work.back()];
      work.pop_back();
      if (node == nullptr) continue;
      if (node->kind != Node::Kind::kInstr) {
        mark_construct(*node);
        continue;
      }
      if (node->instr.op < ir::Op::kAluCount) node->instr.exact = true;
      if (node->instr.op == ir::Op::kLoadArray) mark_array(node->instr.data[0]);
      mark_all(node->instr.src);
    }
  }
};

}  // namespace

void propagate_invariant(ir::Function& function) {
  Marker marker{function,
                std::vector<Node*>(function.values.size(), nullptr),
                std::vector<bool>(function.values.size(), false),
                std::vector<bool>(function.arrays.size(), false),
                {}};
  ir::each_node(function.body, [&](Node& node) {
    if (node.kind == Node::Kind::kInstr) {
      if (node.instr.result != ir::kNoValue) marker.definition[node.instr.result] = &node;
      const bool output = node.instr.op == ir::Op::kStoreOutput || node.instr.op == ir::Op::kStoreShared;
      if (output && node.instr.exact) marker.mark_all(node.instr.src);
    }
    for (const auto* values : {&node.results, &node.params, &node.continue_params})
      for (ir::ValueId value : *values) marker.definition[value] = &node;
  });
  marker.run();
}

}  // namespace vitrine::spirv::front
