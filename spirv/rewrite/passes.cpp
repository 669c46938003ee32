// Runs the steps of passes.def in their order, and shows what each does to those who ask.
#include "spirv/rewrite/passes.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/check.h"
#include "base/log.h"
#include "spirv/ir_passes.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/llvm/passes.h"
#include "spirv/rewrite/lower/passes.h"
#include "spirv/rewrite/nir/algebraic/composed.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv::rewriting {
namespace {

/// What a step that returns nothing has changed is not asked for.
template <class Step>
bool changes(const Step& step) {
  if constexpr (std::is_void_v<decltype(step())>) {
    step();
    return false;
  } else {
    return step();
  }
}

constexpr Pass kPasses[] = {
#define VITRINE_PHASE(phase, rounds, what)
#define VITRINE_PASS(phase, when, needed, function, file, mirrors, why)                                        \
  {#function, [](Graph& graph) { return changes([&] { return function(graph); }); }, Phase::phase, When::when, \
   Needed::needed},
#include "spirv/rewrite/passes.def"
#undef VITRINE_PHASE
#undef VITRINE_PASS
};

struct PhaseInfo {
  Phase phase;
  int rounds;
};
/// A shader that still changes after the last round would never stop (rules that undo each other): what it is then is
/// correct, only its spelling differs from the reference's.
constexpr PhaseInfo kPhases[] = {
#define VITRINE_PHASE(phase, rounds, what) {Phase::phase, rounds},
#define VITRINE_PASS(phase, when, needed, function, file, mirrors, why)
#include "spirv/rewrite/passes.def"
#undef VITRINE_PHASE
#undef VITRINE_PASS
};

constexpr bool has_first_round(Phase phase) {
  for (const Pass& pass : kPasses)
    if (pass.phase == phase && pass.when == When::kFirst) return true;
  return false;
}

/// Steps that may run, of those that are not needed.
std::uint32_t pass_limit() {
  static const std::uint32_t limit = [] {
    const char* value = std::getenv("VITRINE_PASS_LIMIT");
    return value ? static_cast<std::uint32_t>(std::strtoul(value, nullptr, 10)) : ~std::uint32_t{0};
  }();
  return limit;
}

/// Shows what the steps make of one shader.
class Printer {
 public:
  explicit Printer(const Graph& graph) : graph_(graph), on_(base::log_enabled("ir")) {
    if (!on_) return;
    static std::atomic<std::uint32_t> shaders{0};
    shader_ = ++shaders;
    print("front end");
  }

  void after(const Pass& pass, std::uint32_t step, int round) {
    if (!on_) return;
    char title[96];
    const char* const needed = pass.needed == Needed::kNeeded ? " (needed)" : "";
    std::snprintf(title, sizeof(title), "step %u%s, round %d: %s", step, needed, round + 1, pass.name);
    print(title);
  }

 private:
  void print(const char* title) {
    std::string text = ir::dump(snapshot(graph_));
    if (text == before_) return;
    base::log("ir", "shader " + std::to_string(shader_) + ", " + title + "\n" + text);
    before_ = std::move(text);
  }

  const Graph& graph_;
  const bool on_;
  std::uint32_t shader_ = 0;
  std::string before_;
};

/// Runs the phases over one shader.
class Runner {
 public:
  explicit Runner(Graph& graph) : graph_(graph), printer_(graph) {}

  void run(const PhaseInfo& phase) {
    for (int round = 0; round < phase.rounds; ++round)
      if (!run_round(phase.phase, round)) return;
  }

 private:
  /// True when another round is wanted.
  bool run_round(Phase phase, int round) {
    graph_.first_round = round == 0;
    bool changed = round == 0 && has_first_round(phase), before = false;
    for (const Pass& pass : kPasses) {
      if (pass.phase != phase) continue;
      if (pass.when == When::kFirst && round == 0) run_pass(pass, round);
      if (pass.when == When::kIfBefore && before) run_pass(pass, round);
      if (pass.when == When::kAlways || (pass.when == When::kAtRest && !changed))
        changed |= before = run_pass(pass, round);
    }
    return changed;
  }

  bool run_pass(const Pass& pass, int round) {
    if (pass.needed == Needed::kOptional && step_ == pass_limit()) return false;
    step_ += pass.needed == Needed::kOptional ? 1 : 0;
    const bool changed = pass.run(graph_);
    printer_.after(pass, step_, round);
    verify(pass);
    return changed;
  }

  void verify([[maybe_unused]] const Pass& pass) const {
#ifndef NDEBUG
    const std::string error = ir::verify(snapshot(graph_), ir::Scope::kBehindExits);
    if (error.empty()) return;
    base::log_defect("UNREACHABLE", (std::string(pass.name) + " leaves " + error).c_str(), __FILE__, __LINE__);
    VITRINE_ASSERT(error.empty());
#endif
  }

  Graph& graph_;
  Printer printer_;
  std::uint32_t step_ = 0;  ///< optional steps that have run
};

}  // namespace

std::span<const Pass> passes() { return kPasses; }

const Pass* find_pass(std::string_view name) {
  for (const Pass& pass : kPasses)
    if (name == pass.name) return &pass;
  return nullptr;
}

void run_passes(Graph& graph) {
  Runner runner(graph);
  for (const PhaseInfo& phase : kPhases) runner.run(phase);
}

}  // namespace vitrine::spirv::rewriting
