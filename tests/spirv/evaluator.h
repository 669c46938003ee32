// An independent oracle for the lowering and the executor: walks the tree of an ir::Function for one lane at a time.
// Covers scalar ALU (by the arithmetic model), control flow, inputs, outputs, buffers in set 0 and local arrays.
#pragma once

#include <array>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "spirv/ir.h"
#include "tests/spirv/alu/model.h"

namespace vitrine::spirv::test {

class Evaluator {
 public:
  explicit Evaluator(const ir::Function& function) : f_(function), values_(function.values.size()) {
    for (const ir::Array& array : f_.arrays) arrays_.emplace_back(array.elements, 0u);
    outputs.assign(f_.interface.outputs.size(), 0);
  }

  std::vector<std::uint32_t> inputs;
  std::vector<std::uint32_t> outputs;
  std::vector<std::vector<std::uint32_t>*> buffers;  ///< by slot of set 0
  std::vector<std::uint32_t> push;                   ///< words
  std::uint32_t invocation = 0;                      ///< gl_GlobalInvocationID.x
  bool killed = false;

  void run() { list(f_.body); }

 private:
  using Value = std::array<std::uint32_t, 4>;
  enum class Flow { kFall, kBreak, kContinue, kReturn };

  std::uint32_t get(const ir::Src& src, std::size_t component = 0) const {
    return values_[src.value][src.swizzle[component]];
  }
  std::vector<Value> all(const std::vector<ir::Src>& sources) const {
    std::vector<Value> result;
    for (const ir::Src& src : sources) {
      Value value{};
      for (std::size_t c = 0; c < f_.values[src.value].components; ++c) value[c] = get(src, c);
      result.push_back(value);
    }
    return result;
  }
  void assign(const std::vector<ir::ValueId>& to) {
    for (std::size_t i = 0; i < to.size(); ++i) values_[to[i]] = passed_.at(i);
  }

  Flow list(const ir::NodeList& nodes) {
    for (const auto& node : nodes) {
      Flow flow = Flow::kFall;
      if (node->kind == ir::Node::Kind::kIf) {
        flow = list(get(node->condition) ? node->then_list : node->else_list);
        if (flow == Flow::kFall) assign(node->results);
      } else if (node->kind == ir::Node::Kind::kLoop) {
        flow = loop(*node);
      } else {
        switch (node->instr.op) {
          case ir::Op::kYield:
            passed_ = all(node->instr.src);
            return Flow::kFall;
          case ir::Op::kBreak:
            passed_ = all(node->instr.src);
            return Flow::kBreak;
          case ir::Op::kContinue:
            passed_ = all(node->instr.src);
            return Flow::kContinue;
          case ir::Op::kReturn:
            return Flow::kReturn;
          case ir::Op::kKill:
            killed = true;
            return Flow::kReturn;
          default:
            instruction(node->instr);
        }
      }
      if (flow != Flow::kFall) return flow;
    }
    passed_.clear();
    return Flow::kFall;
  }

  Flow loop(const ir::Node& node) {
    passed_ = all(node.init);
    for (int guard = 0; guard < 100000; ++guard) {
      assign(node.params);
      Flow flow = list(node.body);
      if (flow == Flow::kFall || flow == Flow::kContinue) {
        assign(node.continue_params);
        flow = list(node.continuing);
      }
      if (flow == Flow::kReturn) return flow;
      if (flow == Flow::kBreak) {
        assign(node.results);
        return Flow::kFall;
      }
    }
    throw std::runtime_error("loop without end");
  }

  std::uint32_t& word(std::uint32_t slot, std::uint32_t offset) {
    static std::uint32_t outside;
    outside = 0;
    return offset / 4 < buffers.at(slot)->size() ? (*buffers[slot])[offset / 4] : outside;
  }

  void instruction(const ir::Instr& instr) {
    Value result{};
    if (instr.op < ir::Op::kExecutedCount) {
      for (std::size_t c = 0; c < instr.components; ++c) {
        std::uint32_t operand[3] = {};
        for (std::size_t i = 0; i < instr.src.size(); ++i) operand[i] = get(instr.src[i], c);
        result[c] = alu_model::evaluate(instr.op, operand[0], operand[1], operand[2]);
      }
    } else {
      result = intrinsic(instr);
    }
    if (instr.result != ir::kNoValue) values_[instr.result] = result;
  }

  Value intrinsic(const ir::Instr& instr) {
    Value result{};
    switch (instr.op) {
      case ir::Op::kConst:
        return instr.imm;
      case ir::Op::kUndef:
        break;
      case ir::Op::kVec:
        for (std::size_t c = 0; c < instr.src.size(); ++c) result[c] = get(instr.src[c]);
        break;
      case ir::Op::kLoadPush:
        for (std::uint32_t c = 0; c < instr.components; ++c)
          result[c] = push.at((get(instr.src[0]) + instr.data[0]) / 4 + c);
        break;
      case ir::Op::kGlobalInvocationId:
        result[0] = invocation;
        break;
      case ir::Op::kLoadInput:
        result[0] = inputs.at(instr.data[0]);
        break;
      case ir::Op::kStoreOutput:
        outputs.at(instr.data[0]) = get(instr.src[0]);
        break;
      case ir::Op::kLoadUniform:
      case ir::Op::kLoadStorage:
        for (std::uint32_t c = 0; c < instr.components; ++c)
          result[c] = word(instr.data[1], get(instr.src[1]) + instr.data[3] + 4 * c);
        break;
      case ir::Op::kStoreStorage:
        for (std::uint32_t c = 0; c < 4; ++c)
          if (instr.imm[0] >> c & 1)
            word(instr.data[1], get(instr.src[1]) + instr.data[3] + 4 * c) = get(instr.src[2], c);
        break;
      case ir::Op::kLoadArray:
        result[0] = element(instr);
        break;
      case ir::Op::kStoreArray:
        element(instr) = get(instr.src[1]);
        break;
      default:
        throw std::runtime_error("instruction that the oracle does not know");
    }
    return result;
  }

  std::uint32_t& element(const ir::Instr& instr) {
    std::vector<std::uint32_t>& array = arrays_[instr.data[0]];
    return array[std::min<std::size_t>(get(instr.src[0]) + instr.data[1], array.size() - 1)];
  }

  const ir::Function& f_;
  std::vector<Value> values_;
  std::vector<Value> passed_;
  std::vector<std::vector<std::uint32_t>> arrays_;
};

}  // namespace vitrine::spirv::test
