// What is known of a loop before it is unrolled (nir_loop_analyze.c; lavapipe-optimizer.md 5.20). Exits are Ifs at the
// top level of the body with a Break on one side.
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

inline constexpr unsigned kMaxIterations = 32;

/// An If that leaves the loop.
struct Exit {
  InstId branch = kNone;
  unsigned break_side = 0;
  bool counted = false;
  unsigned trips = 0;  ///< counted: times it is not taken before it is
};

struct LoopInfo {
  std::vector<Exit> exits;
  std::size_t limiting = SIZE_MAX;  ///< the counted exit that is taken first
  bool exact = true;                ///< all exits are counted
  bool once = false;                ///< the body ends in Break
  unsigned trips() const { return limiting == SIZE_MAX ? 0 : exits[limiting].trips; }
};

/// False: the loop cannot be unrolled.
bool analyze_loop(const Graph& graph, InstId loop, LoopInfo& info);

struct LoopCost {
  unsigned instructions = 0;
  bool has_loop = false;
  bool wanted = false;  ///< an array is walked from end to end
};

/// What one of `trips` iterations costs, counted as the reference does.
LoopCost cost_of_loop(const Graph& graph, InstId loop, unsigned trips);

}  // namespace vitrine::spirv::rewriting
