// Tables of what a step of rewrite() makes of a few lines (tests/spirv/ir_text.h). A shader that differs from the
// reference becomes a row of the step that is to blame.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <type_traits>

#include "spirv/ir_passes.h"
#include "spirv/rewrite/graph/graph.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/passes.h"
#include "tests/spirv/ir_text.h"

namespace vitrine::spirv::test {

using rewriting::Graph;

/// `out`: null where the step must change nothing.
struct PassCase {
  const char* why;
  const char* in;
  const char* out = nullptr;
};

/// What is compared: all instructions, or those whose results somebody needs.
enum class Dead : std::uint8_t { kIgnored, kCompared };

/// The text that a function has in the form of the rewrites, after `step`.
template <class Step>
std::string text_after(const char* text, Dead dead, Step step) {
  ir::Function function = parse_ir(text);
  rewriting::Graph graph(function);
  step(graph);
  if (dead == Dead::kIgnored) rewriting::opt_dce(graph);
  return text_of(rewriting::snapshot(graph));
}

/// Runs `step`, a function of a Graph, on every row. A step that returns whether it changed something must tell the
/// truth where it must change nothing.
template <class Step>
requires(!std::is_convertible_v<Step, const char*>) void check_step(Step step, std::span<const PassCase> cases,
                                                                    Dead dead = Dead::kIgnored) {
  for (const PassCase& row : cases) {
    SCOPED_TRACE(row.why);
    const auto leave = [](rewriting::Graph&) {};
    bool changed = false;
    const std::string got = text_after(row.in, dead, [&](Graph& graph) {
      if constexpr (std::is_same_v<decltype(step(graph)), bool>) {
        changed = step(graph);
      } else {
        step(graph);
      }
    });
    EXPECT_EQ(got, text_after(row.out ? row.out : row.in, dead, leave)) << "of" << row.in;
    if (row.out == nullptr) {
      EXPECT_FALSE(changed) << "but nothing changed in" << row.in;
    }
  }
}

/// The same for a row of passes.def, by its name.
inline void check_step(const char* name, std::span<const PassCase> cases, Dead dead = Dead::kIgnored) {
  const rewriting::Pass* const pass = rewriting::find_pass(name);
  ASSERT_NE(pass, nullptr) << name;
  check_step([&](Graph& graph) { return pass->run(graph); }, cases, dead);
}

/// A part of a step that works on one branch or loop, as a step on all of them.
template <class Part>
auto each_of(rewriting::Inst::Kind kind, Part part) {
  return [=](Graph& graph) {
    bool changed = false;
    auto visit = [&](rewriting::InstId id) {
      if (graph.insts[id].kind == kind) changed |= part(graph, id);
    };
    rewriting::for_each_inst(graph, graph.root, visit);
    return changed;
  };
}
template <class Part>
auto each_branch(Part part) {
  return each_of(rewriting::Inst::Kind::kIf, part);
}
template <class Part>
auto each_loop(Part part) {
  return each_of(rewriting::Inst::Kind::kLoop, part);
}

}  // namespace vitrine::spirv::test
