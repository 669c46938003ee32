// Copy propagation: uses of Mov, MovB and Vec read the sources instead; loop parameters and results that always carry
// one value give way to it.
#include "spirv/ir_passes.h"
#include "spirv/ir_walk.h"

namespace vitrine::spirv::ir {
namespace {

using Component = std::pair<ValueId, std::uint8_t>;

struct Copies {
  Function& function;
  std::vector<const Instr*> definition;  ///< Mov, MovB or Vec that defines the value, or null
  std::vector<ValueId> same_as;          ///< value that carries the same, or kNoValue
  std::vector<std::uint32_t> order;      ///< position of the definition in the tree
  std::uint32_t position = 0;
  bool changed = false;

  ValueId resolve(ValueId value) const {
    while (value < same_as.size() && same_as[value] != kNoValue) value = same_as[value];
    return value;
  }

  /// Where a component really comes from.
  Component origin_of(Component at) const {
    while (true) {
      at.first = resolve(at.first);
      const Instr* copy = at.first < definition.size() ? definition[at.first] : nullptr;
      if (copy == nullptr) return at;
      const Src& src = copy->op == Op::kVec ? copy->src[at.second] : copy->src[0];
      at = {src.value, src.swizzle[copy->op == Op::kVec ? 0 : at.second]};
    }
  }

  /// `any_swizzle`: the consumer reads components one by one. `joins`: the consumer hands over whole values.
  void rewrite(Src& src, std::uint32_t width, bool any_swizzle, bool joins) {
    src.value = resolve(src.value);
    Src next = src;
    const Component first = origin_of({src.value, src.swizzle[0]});
    next.value = first.first;
    bool identity = function.values[next.value].components == width;
    for (std::uint32_t i = 0; i < width; i++) {
      const Component from = origin_of({src.value, src.swizzle[i]});
      if (from.first != next.value) return;
      next.swizzle[i] = from.second;
      identity &= from.second == i;
    }
    if (width == 1) next.swizzle = {first.second, first.second, first.second, first.second};
    if (joins ? identity : width == 1 || any_swizzle || identity) src = next;
  }

  void define(ValueId value) {
    if (value >= order.size()) order.resize(value + 1, 0);
    order[value] = position++;
  }

  void run_list(NodeList& list) {
    for (auto& node : list) {
      const Op op = node->instr.op;
      const bool alu = node->kind == Node::Kind::kInstr && op < Op::kAluCount;
      const bool joins =
          node->kind == Node::Kind::kLoop ||
          (node->kind == Node::Kind::kInstr && (op == Op::kYield || op == Op::kBreak || op == Op::kContinue));
      each_operand(function, *node, [&](Src& src, std::uint32_t width) { rewrite(src, width, alu, joins); });
      switch (node->kind) {
        case Node::Kind::kInstr:
          note(node->instr);
          break;
        case Node::Kind::kIf:
          run_if(*node);
          break;
        case Node::Kind::kLoop:
          run_loop(*node);
          break;
      }
    }
  }

  void note(const Instr& instr) {
    if (instr.result == kNoValue) return;
    define(instr.result);
    if (instr.result >= definition.size()) definition.resize(function.values.size(), nullptr);
    const bool copy = instr.op == Op::kMov || instr.op == Op::kMovB || instr.op == Op::kVec;
    definition[instr.result] = copy ? &instr : nullptr;
  }

  bool whole_value(const Src& src) const {
    for (std::uint8_t i = 0; i < function.values[src.value].components; i++)
      if (src.swizzle[i] != i) return false;
    return true;
  }

  void equate(ValueId value, ValueId with) {
    if (value >= same_as.size()) same_as.resize(function.values.size(), kNoValue);
    if (same_as[value] == with || value == with) return;
    same_as[value] = with;
    changed = true;
  }

  /// The one value that all sources carry (apart from `self`), when it is defined before `limit`; otherwise kNoValue.
  ValueId common(const std::vector<const Src*>& sources, ValueId self, std::uint32_t limit) const {
    ValueId found = kNoValue;
    for (const Src* src : sources) {
      if (!whole_value(*src)) return kNoValue;
      const ValueId value = resolve(src->value);
      if (value == self) continue;
      if (found != kNoValue && found != value) return kNoValue;
      found = value;
    }
    if (found == kNoValue || order[found] >= limit ||
        function.values[found].components != function.values[self].components)
      return kNoValue;
    return found;
  }

  void run_if(Node& node) {
    const std::uint32_t start = position;
    run_list(node.then_list);
    run_list(node.else_list);
    const Instr *a = yield_of(node.then_list), *b = yield_of(node.else_list);
    for (std::size_t i = 0; i < node.results.size(); i++) {
      std::vector<const Src*> sources;
      if (a != nullptr) sources.push_back(&a->src[i]);
      if (b != nullptr) sources.push_back(&b->src[i]);
      const ValueId same = common(sources, node.results[i], start);
      if (same != kNoValue) equate(node.results[i], same);
      define(node.results[i]);
    }
  }

  void run_loop(Node& node) {
    const std::uint32_t start = position;
    for (ValueId value : node.params) define(value);
    const std::uint32_t inside = position;
    run_list(node.body);
    for (ValueId value : node.continue_params) define(value);
    run_list(node.continuing);
    std::vector<const Instr*> breaks, continues;
    for (NodeList* part : {&node.body, &node.continuing})
      each_jump(*part, [&](Instr& jump) { (jump.op == Op::kBreak ? breaks : continues).push_back(&jump); });
    if (const Instr* yield = yield_of(node.body)) continues.push_back(yield);
    auto join = [&](const std::vector<ValueId>& targets, const std::vector<const Instr*>& jumps, std::uint32_t limit) {
      for (std::size_t i = 0; i < targets.size(); i++) {
        std::vector<const Src*> sources;
        for (const Instr* jump : jumps) sources.push_back(&jump->src[i]);
        const ValueId same = common(sources, targets[i], limit);
        if (same != kNoValue) equate(targets[i], same);
      }
    };
    join(node.continue_params, continues, inside);
    join(node.results, breaks, start);
    const Instr* next = yield_of(node.continuing);
    for (std::size_t i = 0; i < node.params.size(); i++) {
      std::vector<const Src*> sources{&node.init[i]};
      if (next != nullptr) sources.push_back(&next->src[i]);
      const ValueId same = common(sources, node.params[i], start);
      if (same != kNoValue) equate(node.params[i], same);
    }
    for (ValueId value : node.results) define(value);
  }
};

}  // namespace

void propagate_copies(Function& function) {
  Copies copies{function, {}, {}, {}};
  // A value found to be the same as another may reveal the next one; nesting bounds the rounds.
  for (int round = 0; round < 16; round++) {
    copies.order.assign(function.values.size(), 0);
    copies.position = 0;
    copies.changed = false;
    copies.run_list(function.body);
    if (!copies.changed) return;
  }
}

}  // namespace vitrine::spirv::ir
