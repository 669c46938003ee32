// Text to IR and back for the tests of the rewrites.
#include "tests/spirv/rewrite/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "base/numeric.h"

namespace vitrine::spirv::test {
namespace {

using ir::Op;
using ir::ValueId;

class Builder {
 public:
  explicit Builder(std::string_view text) : text_(text) {}

  ir::Function build() {
    const ValueId value = expression();
    EXPECT_TRUE(text_.empty()) << text_;
    ir::Node& store = add(Op::kStoreOutput, 0, false);
    store.instr.src.push_back({value, {0, 0, 0, 0}});
    return std::move(function_);
  }

 private:
  ir::Node& add(Op op, std::uint8_t components, bool boolean) {
    auto node = std::make_unique<ir::Node>();
    node->instr.op = op;
    node->instr.components = components;
    node->instr.boolean = boolean;
    if (components != 0) node->instr.result = function_.new_value(components, boolean);
    function_.body.push_back(std::move(node));
    return *function_.body.back();
  }

  bool take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }

  std::string word() {
    std::size_t length = 0;
    while (length < text_.size() && text_[length] != '(' && text_[length] != ')' && text_[length] != ',') ++length;
    const std::string result(text_.substr(0, length));
    text_.remove_prefix(length);
    return result;
  }

  ValueId constant(std::uint32_t bits, bool boolean) {
    ir::Node& node = add(Op::kConst, 1, boolean);
    node.instr.imm[0] = bits;
    return node.instr.result;
  }

  ValueId input(char letter) {
    auto& value = inputs_.try_emplace(letter, ir::kNoValue).first->second;
    if (value != ir::kNoValue) return value;
    ir::Node& node = add(Op::kLoadInput, 1, false);
    node.instr.data[0] = static_cast<std::uint32_t>(letter - 'a');
    return value = node.instr.result;
  }

  ValueId expression() {
    const bool exact = take('!');
    const std::string name = word();
    if (name == "true" || name == "false") return constant(name == "true" ? 1 : 0, true);
    if (name.size() == 1 && name[0] >= 'a' && name[0] <= 'h') return input(name[0]);
    if (name.find('.') != std::string::npos) return constant(base::bits_of(std::strtof(name.c_str(), nullptr)), false);
    if (name[0] == '-' || (name[0] >= '0' && name[0] <= '9'))
      return constant(static_cast<std::uint32_t>(std::strtoll(name.c_str(), nullptr, 0)), false);
    return operation(name, exact);
  }

  ValueId operation(const std::string& name, bool exact) {
    if (name == "Vec") return vector();
    Op op = Op::kAluCount;
    for (std::uint16_t i = 0; i < static_cast<std::uint16_t>(Op::kAluCount); ++i)
      if (name == ir::alu_info(static_cast<Op>(i)).name) op = static_cast<Op>(i);
    EXPECT_NE(op, Op::kAluCount) << name;
    std::vector<ir::Src> operands;
    take('(');
    do operands.push_back({expression(), {0, 0, 0, 0}});
    while (take(','));
    take(')');
    if (ir::alu_info(op).reads > 1)
      for (ir::Src& operand : operands) operand.swizzle = {0, 1, 2, 3};
    ir::Node& node = add(op, 1, ir::alu_info(op).result == 'B');
    node.instr.exact = exact;
    node.instr.src = operands;
    return node.instr.result;
  }

  ValueId vector() {
    std::vector<ir::Src> parts;
    take('(');
    do parts.push_back({expression(), {0, 0, 0, 0}});
    while (take(','));
    take(')');
    ir::Node& node = add(Op::kVec, static_cast<std::uint8_t>(parts.size()), false);
    node.instr.src = parts;
    return node.instr.result;
  }

  std::string_view text_;
  ir::Function function_;
  std::map<char, ValueId> inputs_;
};

std::string print(const std::map<ValueId, const ir::Instr*>& defs, const ir::Src& src, char letter) {
  const ir::Instr& instr = *defs.at(src.value);
  char text[40];
  if (instr.op == Op::kLoadInput) return std::string(1, static_cast<char>('a' + instr.data[0]));
  if (instr.op == Op::kConst) {
    const std::uint32_t bits = instr.imm[src.swizzle[0]];
    if (instr.boolean) return bits ? "true" : "false";
    if (letter == 'F') {
      std::snprintf(text, sizeof(text), "%.9g", static_cast<double>(base::float_of(bits)));
      std::string number = text;
      return number.find_first_of(".en") == std::string::npos ? number.append(".0") : number;
    }
    return std::to_string(static_cast<std::int32_t>(bits));
  }
  if (instr.op == Op::kVec) return print(defs, instr.src[src.swizzle[0]], letter);
  const ir::AluInfo& info = ir::alu_info(instr.op);
  std::string result = info.name;
  result += '(';
  for (std::size_t i = 0; i < instr.src.size(); ++i) {
    ir::Src operand = instr.src[i];
    operand.swizzle[0] = operand.swizzle[src.swizzle[0]];
    if (i != 0) result += ',';
    result += print(defs, operand, info.operands[i]);
  }
  result += ')';
  return result;
}

void collect(const ir::NodeList& list, std::map<ValueId, const ir::Instr*>& defs, const ir::Instr*& store) {
  for (const auto& node : list) {
    if (node->instr.result != ir::kNoValue) defs[node->instr.result] = &node->instr;
    if (node->instr.op == Op::kStoreOutput && !store) store = &node->instr;
    collect(node->then_list, defs, store);
    collect(node->else_list, defs, store);
  }
}

}  // namespace

ir::Function shader_of(std::string_view expression) { return Builder(expression).build(); }

std::string expression_of(const ir::Function& function) {
  std::map<ValueId, const ir::Instr*> defs;
  const ir::Instr* store = nullptr;
  collect(function.body, defs, store);
  return store ? print(defs, store->src[0], 'F') : "no output";
}

}  // namespace vitrine::spirv::test
