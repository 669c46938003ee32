// Makes instructions at one place of the graph.
#pragma once

#include <array>
#include <initializer_list>
#include <span>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// What an operation reads of the whole result of `inst`.
Src result_of(const Graph& graph, InstId inst);

/// One component of what is read, for every component of who reads it.
inline Src scalar(Src src, unsigned component = 0) {
  const std::uint8_t c = src.swizzle[component];
  return {src.value, {c, c, c, c}};
}

class Builder {
 public:
  /// What it makes goes in front of `position`, in its order, and has its origin.
  Builder(Graph& graph, InstId position);
  /// The same, behind `position`.
  static Builder behind(Graph& graph, InstId position);
  static Builder behind(Graph& graph, InstId position, const ir::Origin& origin);

  /// An operation of ops.def on numbers of 32 bits.
  Src alu(Op op, std::initializer_list<Src> operands, unsigned components = 1);

  /// An operation on numbers as wide as those of `model`, exact if that is.
  Src like(const Inst& model, Op op, std::span<const Src> operands, unsigned components = 1);
  Src like(const Inst& model, Op op, std::initializer_list<Src> operands, unsigned components = 1) {
    return like(model, op, std::span(operands.begin(), operands.size()), components);
  }

  /// An operation of wide_ops.def.
  Src wide(Op op, std::span<const Src> operands);
  Src wide(Op op, std::initializer_list<Src> operands) {
    return wide(op, std::span(operands.begin(), operands.size()));
  }

  Src vec(std::span<const Src> components, bool boolean = false);
  Src vec(std::initializer_list<Src> components) { return vec(std::span(components.begin(), components.size())); }

  Src literal(std::uint32_t bits);
  Src truth(bool value);
  /// Of `components` numbers or booleans.
  Src literal(unsigned components, bool boolean, const std::uint32_t* bits);

  /// A load or store of an element of a local array: Op::kLoadArray, Op::kStoreArray (intrinsics.def).
  Src access(Op op, unsigned components, std::initializer_list<Src> operands, std::array<std::uint32_t, 3> data);

  /// Of no value in particular.
  Src undefined(unsigned components);

  /// A move of `src`, of the type of `like`.
  Src move(Src src, ValueId like);

  /// Gives an instruction made otherwise its place and origin.
  Src place(InstId made);

 private:
  Builder(Graph& graph, InstId position, bool behind, const ir::Origin& origin);
  Src make(Inst::Kind kind, Op op, unsigned components, bool boolean, std::span<const Src> operands);

  Graph& graph_;
  InstId position_;
  bool behind_;
  ir::Origin origin_;
};

/// A jump or Yield with these operands, in no block yet.
InstId make_jump(Graph& graph, Op op, const std::vector<Src>& operands);

/// Uses of the instruction's result become uses of `by`, and it goes.
void replace_inst(Graph& graph, InstId id, ValueId by);

}  // namespace vitrine::spirv::rewriting
