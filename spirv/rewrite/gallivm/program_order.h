// The tree of a graph as blocks with edges, as the reference's liveness sees it: where values are made and read.
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// A value that meets at a join: a result of an If or Loop, a parameter of a Loop.
struct Join {
  ValueId value = ir::kNoValue;
  InstId owner = kNone;
  bool parameter = false;
  std::uint32_t web = kNone;  ///< the register that the ways in write; the value's own may be another one
  struct Way {
    InstId end = kNone;  ///< Yield, Break, Continue; the Loop itself
    std::uint32_t operand = 0;
  };
  std::vector<Way> ways;
};

struct OrderedJoin {
  Join join;
  std::uint32_t block = 0, position = 0;
  std::uint32_t copy_position = 0;  ///< where all joins of the block become values
};

/// Positions grow in program order; those of one block lie together.
struct ProgramOrder {
  explicit ProgramOrder(const Graph& graph);

  struct Block {
    std::vector<std::uint32_t> predecessors;
  };
  std::vector<Block> blocks;
  std::vector<OrderedJoin> joins;
  std::vector<std::uint32_t> block, definition;          ///< per value
  std::vector<std::uint32_t> user_block, user_position;  ///< per instruction; kNone: in no block
};

}  // namespace vitrine::spirv::rewriting
