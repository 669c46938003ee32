// Text form of the intermediate representation: "%3:2 = FAdd %1.xy, %2.xx" (result : components).
#include <cstdio>

#include "spirv/ir_passes.h"

namespace vitrine::spirv::ir {
namespace {

struct Dump {
  const Function& function;
  Origins origins;
  std::string text;

  void add(const char* format, std::uint32_t value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    text += buffer;
  }

  void indent(int depth) { text.append(static_cast<std::size_t>(depth) * 2, ' '); }

  /// `width`: components the consumer reads.
  void source(const Src& src, std::uint32_t width) {
    add("%%%u", src.value);
    if (src.value >= function.values.size()) return;
    bool identity = function.values[src.value].components == width;
    for (std::uint8_t i = 0; i < width; i++) identity &= src.swizzle[i] == i;
    if (identity) return;
    text += '.';
    for (std::uint32_t i = 0; i < width; i++) text += "xyzw"[src.swizzle[i] & 3];
  }

  void sources(const std::vector<Src>& list, std::uint32_t width) {
    const char* separator = " ";
    for (const Src& src : list) {
      text += separator;
      source(src, width != 0 ? width : src.value < function.values.size() ? function.values[src.value].components : 1);
      separator = ", ";
    }
  }

  void values(const char* name, const std::vector<ValueId>& list) {
    if (list.empty()) return;
    text += name;
    for (ValueId value : list) result(value, " ");
  }

  void result(ValueId value, const char* before) {
    text += before;
    add("%%%u:", value);
    add("%u", function.values[value].components);
    if (function.values[value].boolean) text += 'b';
  }

  void instr(const Instr& instr) {
    if (instr.result != kNoValue) {
      result(instr.result, "");
      text += " = ";
    }
    text += op_name(instr.op);
    if (instr.width != 32) add("@%u", instr.width);
    if (instr.exact) text += '!';
    const bool alu = instr.op < Op::kAluCount;
    sources(instr.src, alu ? instr.components : instr.op == Op::kVec ? 1 : 0);
    if (instr.op == Op::kConst)
      for (std::uint8_t i = 0; i < instr.components; i++) add(" %#x", instr.imm[i]);
    if (!alu && instr.op != Op::kConst && instr.op != Op::kVec && instr.op != Op::kUndef) parameters(instr);
    if (origins == Origins::kShow) origin(instr.origin);
    text += '\n';
  }

  void origin(const Origin& origin) {
    if (origin.spirv_id == 0 && origin.place == 0) return;
    text += "  ;";
    if (origin.spirv_id != 0) add(" %%%u", origin.spirv_id);
    if (origin.place != 0 && function.sources) text += ' ' + function.sources->text(origin.place);
  }

  void parameters(const Instr& instr) {
    int last = 3;
    while (last >= 0 && instr.data[last] == 0) last--;
    for (int i = 0; i <= last; i++) add(i == 0 ? " [%u" : " %u", instr.data[i]);
    if (last >= 0) text += ']';
    if (instr.imm[0] != 0 || instr.imm[1] != 0) {
      add(" {%u", instr.imm[0]);
      add(" %u}", instr.imm[1]);
    }
    if (instr.image == nullptr) return;
    add(" access=%u", static_cast<std::uint32_t>(instr.image->access));
    add(" dim=%u", static_cast<std::uint32_t>(instr.image->dim));
    add(" slot=%u", instr.image->slot);
    add(" operands=%#x", instr.image->operands);
  }

  void list(const NodeList& nodes, int depth) {
    for (const auto& node : nodes) {
      indent(depth);
      switch (node->kind) {
        case Node::Kind::kInstr:
          instr(node->instr);
          break;
        case Node::Kind::kIf:
          branch(*node, depth);
          break;
        case Node::Kind::kLoop:
          loop(*node, depth);
          break;
      }
    }
  }

  void branch(const Node& node, int depth) {
    text += "If ";
    source(node.condition, 1);
    values(" ->", node.results);
    text += '\n';
    list(node.then_list, depth + 1);
    indent(depth);
    text += "Else\n";
    list(node.else_list, depth + 1);
  }

  void loop(const Node& node, int depth) {
    text += "Loop";
    values(" params", node.params);
    if (!node.init.empty()) text += " init";
    sources(node.init, 0);
    values(" ->", node.results);
    text += '\n';
    list(node.body, depth + 1);
    indent(depth);
    text += "Continuing";
    values("", node.continue_params);
    text += '\n';
    list(node.continuing, depth + 1);
  }
};

}  // namespace

std::string dump(const Function& function, Origins origins) {
  Dump dump{function, origins, {}};
  dump.list(function.body, 0);
  return std::move(dump.text);
}

}  // namespace vitrine::spirv::ir
