// Merges equal instructions, the later into the one that dominates it: what the reference's two compilers both do
// (lavapipe-optimizer.md 3.6, 7.1).
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

struct Merging {
  bool by_value = false;      ///< literals are equal by their bits, whatever constant they are a component of
  bool only_doubles = false;  ///< nothing but pairs of words that doubles are made of
  bool push = true;           ///< loads of push constants, too
};

/// True when something has been merged.
bool merge_equal(Graph& graph, const Merging& what);

}  // namespace vitrine::spirv::rewriting
