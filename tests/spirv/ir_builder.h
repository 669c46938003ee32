// Builds ir::Functions by hand for the tests of the lowering and the executor.
#pragma once

#include <initializer_list>
#include <utility>

#include "base/numeric.h"
#include "spirv/ir.h"

namespace vitrine::spirv::test {

using ir::NodeList;
using ir::Op;
using ir::Src;
using ir::ValueId;

inline Src src(ValueId value, std::uint8_t component = 0) {
  return {value, {component, component, component, component}};
}
/// All components of a vector value.
inline Src vec(ValueId value) { return {value, {0, 1, 2, 3}}; }

class Builder {
 public:
  Builder() { lists_.push_back(&function.body); }

  ir::Function function;

  ir::Instr& append(Op op, std::uint8_t components, bool boolean, std::vector<Src> sources) {
    auto node = std::make_unique<ir::Node>();
    node->instr.op = op;
    node->instr.components = components;
    node->instr.boolean = boolean;
    node->instr.src = std::move(sources);
    if (components != 0) node->instr.result = function.new_value(components, boolean);
    lists_.back()->push_back(std::move(node));
    return lists_.back()->back()->instr;
  }

  ValueId constant(std::uint32_t bits) {
    ir::Instr& instr = append(Op::kConst, 1, false, {});
    instr.imm[0] = bits;
    return instr.result;
  }
  ValueId constant_bool(bool value) {
    ir::Instr& instr = append(Op::kConst, 1, true, {});
    instr.imm[0] = value;
    return instr.result;
  }
  ValueId constant_float(float value) { return constant(base::bits_of(value)); }

  ValueId alu(Op op, std::initializer_list<ValueId> sources) {
    std::vector<Src> list;
    for (const ValueId id : sources) list.push_back(src(id));
    return append(op, 1, ir::alu_info(op).result == 'B', std::move(list)).result;
  }

  ValueId input(std::uint32_t index) {
    while (function.interface.inputs.size() <= index) {
      InterfaceSlot slot;
      slot.location = static_cast<std::uint16_t>(function.interface.inputs.size());
      function.interface.inputs.push_back(slot);
    }
    ir::Instr& instr = append(Op::kLoadInput, 1, false, {});
    instr.data[0] = index;
    return instr.result;
  }
  void output(std::uint32_t index, ValueId value) {
    while (function.interface.outputs.size() <= index) {
      InterfaceSlot slot;
      slot.location = static_cast<std::uint16_t>(function.interface.outputs.size());
      function.interface.outputs.push_back(slot);
    }
    append(Op::kStoreOutput, 0, false, {src(value)}).data[0] = index;
  }
  ValueId load(Op op, std::uint32_t set, std::uint32_t slot, ValueId offset, std::uint8_t components,
               std::uint32_t added = 0) {
    const ValueId element = constant(0);
    ir::Instr& instr = append(op, components, false, {src(element), src(offset)});
    instr.data[0] = set;
    instr.data[1] = slot;
    instr.data[2] = 1;
    instr.data[3] = added;
    return instr.result;
  }
  void store(std::uint32_t set, std::uint32_t slot, ValueId offset, Src value, std::uint32_t mask = 1) {
    const ValueId element = constant(0);
    ir::Instr& instr = append(Op::kStoreStorage, 0, false, {src(element), src(offset), value});
    instr.data[0] = set;
    instr.data[1] = slot;
    instr.data[2] = 1;
    instr.imm[0] = mask;
  }

  void jump(Op op, std::initializer_list<ValueId> values = {}) {
    std::vector<Src> list;
    for (const ValueId id : values) list.push_back(vec(id));
    append(op, 0, false, std::move(list));
  }
  void yield(std::initializer_list<ValueId> values = {}) { jump(Op::kYield, values); }

  /// Runs `then` and `otherwise` to fill the branches (each ends in yield() or a jump).
  template <class Then, class Else>
  std::vector<ValueId> branch(ValueId condition, std::size_t results, Then&& then, Else&& otherwise) {
    auto owned = std::make_unique<ir::Node>();
    ir::Node* node = owned.get();
    node->kind = ir::Node::Kind::kIf;
    node->condition = src(condition);
    lists_.back()->push_back(std::move(owned));
    fill(node->then_list, then);
    fill(node->else_list, otherwise);
    for (std::size_t i = 0; i < results; ++i) node->results.push_back(function.new_value(1, false));
    return node->results;
  }

  /// body(params) and continuing(params, continue_params) fill the lists.
  template <class Body, class Continuing>
  std::vector<ValueId> loop(const std::vector<ValueId>& init, std::size_t continue_params, std::size_t results,
                            Body&& body, Continuing&& continuing) {
    auto owned = std::make_unique<ir::Node>();
    ir::Node* node = owned.get();
    node->kind = ir::Node::Kind::kLoop;
    for (const ValueId id : init) {
      node->init.push_back(vec(id));
      node->params.push_back(function.new_value(1, function.values[id].boolean));
    }
    for (std::size_t i = 0; i < continue_params; ++i) node->continue_params.push_back(function.new_value(1, false));
    for (std::size_t i = 0; i < results; ++i) node->results.push_back(function.new_value(1, false));
    lists_.back()->push_back(std::move(owned));
    fill(node->body, [&] { body(node->params); });
    fill(node->continuing, [&] { continuing(node->params, node->continue_params); });
    return node->results;
  }

 private:
  template <class F>
  void fill(NodeList& list, F&& f) {
    lists_.push_back(&list);
    f();
    lists_.pop_back();
  }

  std::vector<NodeList*> lists_;
};

}  // namespace vitrine::spirv::test
