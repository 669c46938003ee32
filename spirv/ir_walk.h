// Walks over the tree of ir.h that several passes need.
#pragma once

#include <array>

#include "spirv/ir.h"

namespace vitrine::spirv::ir {

/// Calls f(node) for every node of a list and below, parents before children.
template <class List, class F>
void each_node(List& list, const F& f) {
  for (auto& node : list) {
    f(*node);
    if (node->kind == Node::Kind::kInstr) continue;
    each_node(node->then_list, f);
    each_node(node->else_list, f);
    each_node(node->body, f);
    each_node(node->continuing, f);
  }
}

/// Calls f(src, width) for every operand of a node; width: components that are read.
template <class F>
void each_operand(const Function& function, Node& node, const F& f) {
  if (node.kind == Node::Kind::kIf) f(node.condition, 1u);
  for (Src& src : node.init) f(src, static_cast<std::uint32_t>(function.values[src.value].components));
  Instr& instr = node.instr;
  for (std::size_t i = 0; i < instr.src.size(); ++i) {
    Src& src = instr.src[i];
    std::uint32_t width = function.values[src.value].components;
    if (instr.op < Op::kAluCount)
      width = components_read(instr, i);
    else if (instr.op == Op::kVec || (src.swizzle[0] == src.swizzle[1] && src.swizzle[0] == src.swizzle[2]))
      width = 1;
    f(src, width);
  }
}

/// The Yield at the end of a list; null when it ends in a jump.
inline Instr* yield_of(NodeList& list) {
  if (list.empty() || list.back()->kind != Node::Kind::kInstr || list.back()->instr.op != Op::kYield) return nullptr;
  return &list.back()->instr;
}

/// Calls f(instr) for every Break and Continue that belongs to the loop around `list`.
template <class F>
void each_jump(NodeList& list, const F& f) {
  for (auto& node : list) {
    if (node->kind == Node::Kind::kIf) {
      each_jump(node->then_list, f);
      each_jump(node->else_list, f);
    } else if (node->kind == Node::Kind::kInstr && (node->instr.op == Op::kBreak || node->instr.op == Op::kContinue)) {
      f(node->instr);
    }
  }
}

/// Stores, atomics, barriers, ends of invocations: what must stay although nothing uses its result.
/// `image` is that of an image instruction.
bool has_effect(Op op, const ImageInfo* image);

}  // namespace vitrine::spirv::ir
