// Runs the steps of passes.def in their order, and shows what each does to those who ask.
#include "spirv/rewrite/passes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/check.h"
#include "base/log.h"
#include "base/words.h"
#include "spirv/ir_passes.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/llvm/passes.h"
#include "spirv/rewrite/lower/passes.h"
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
#define VITRINE_PASS(phase, when, needed, function, file, mirrors, why) \
  {#function,      [](Graph& graph) { return changes([&] { return function(graph); }); }, Phase::phase, When::when,      \
   Needed::needed, std::is_same_v<decltype(function(std::declval<Graph&>())), bool>},
#include "spirv/rewrite/passes.def"
#undef VITRINE_PHASE
#undef VITRINE_PASS
};

/// By row: the first of the same function.
constexpr auto kFirstRow = [] {
  std::array<std::uint8_t, std::size(kPasses)> first{};
  for (std::size_t row = 0; row < first.size(); ++row)
    while (std::string_view(kPasses[first[row]].name) != kPasses[row].name) ++first[row];
  return first;
}();

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

/// Which steps, of those that are not needed, run over one shader.
class Choice {
 public:
  Choice(std::uint32_t shader, Steps steps) {
    if (steps == Steps::kNeeded) {
      limit_ = 0;
      return;
    }
    static const char* const off = std::getenv("VITRINE_PASS_OFF");
    static const char* const limit = std::getenv("VITRINE_PASS_LIMIT");
    if (off) off_ = off;
    if (!limit) return;
    char* end = nullptr;
    const auto number = static_cast<std::uint32_t>(std::strtoul(limit, &end, 10));
    if (*end != ':') {
      limit_ = number;
    } else if (number == shader) {
      limit_ = static_cast<std::uint32_t>(std::strtoul(end + 1, nullptr, 10));
    }
  }

  /// `step`: how many have run.
  bool leaves_out(const Pass& pass, std::uint32_t step) const {
    return pass.needed == Needed::kOptional && (step >= limit_ || base::has_word(off_, pass.name));
  }

 private:
  std::string_view off_;
  std::uint32_t limit_ = ~std::uint32_t{0};
};

/// Shaders of the process, counted from 1.
std::uint32_t next_shader() {
  static std::atomic<std::uint32_t> count{0};
  return ++count;
}

/// Shows what the steps make of one shader.
class Printer {
 public:
  Printer(const Graph& graph, std::uint32_t shader, const StepListener& listener)
      : graph_(graph), shader_(shader), listener_(listener), logs_(base::log_enabled("ir")) {
    if (on()) print("front end", "before all steps", "front end");
  }

  /// What is left in the end, changed or not.
  void final() {
    before_.clear();
    if (logs_) print("final", {}, nullptr);
  }

  void after(const Pass& pass, std::uint32_t step, int round) {
    if (!on()) return;
    char place[96];
    const char* const needed = pass.needed == Needed::kNeeded ? " (needed)" : "";
    std::snprintf(place, sizeof(place), "step %u%s, round %d", step, needed, round + 1);
    print(std::string(place) + ": " + pass.name, place, pass.name);
  }

 private:
  bool on() const { return logs_ || listener_; }

  /// Without a `step` the listener is not told.
  void print(const std::string& title, const std::string& place, const char* step) {
    std::string text = ir::dump(snapshot(graph_), ir::Origins::kShow);
    if (text == before_) return;
    if (logs_) base::log("ir", "shader " + std::to_string(shader_) + ", " + title + "\n" + text);
    if (listener_ && step) listener_(step, place, text);
    before_ = std::move(text);
  }

  const Graph& graph_;
  const std::uint32_t shader_;
  const StepListener& listener_;
  const bool logs_;
  std::string before_;
};

/// Runs the phases over one shader.
class Runner {
 public:
  Runner(Graph& graph, const StepListener& listener, Steps steps) : Runner(graph, next_shader(), listener, steps) {}

  void run() {
    for (const PhaseInfo& phase : kPhases)
      for (int round = 0; round < phase.rounds; ++round)
        if (!run_round(phase.phase, round)) break;
    printer_.final();
  }

 private:
  Runner(Graph& graph, std::uint32_t shader, const StepListener& listener, Steps steps)
      : graph_(graph), choice_(shader, steps), printer_(graph, shader, listener) {}

  /// True when another round is wanted.
  bool run_round(Phase phase, int round) {
    graph_.first_round = round == 0;
    bool changed = false, before = false;
    for (const Pass& pass : kPasses) {
      if (pass.phase != phase) continue;
      if (pass.when == When::kIfBefore && before) run_pass(pass, round);
      if (pass.when == When::kAlways || (pass.when == When::kAtRest && !changed))
        changed |= before = run_pass(pass, round);
    }
    return changed;
  }

  bool run_pass(const Pass& pass, int round) {
    if (choice_.leaves_out(pass, step_)) return false;
    step_ += pass.needed == Needed::kOptional ? 1 : 0;
    std::uint32_t& idle_at = idle_at_[kFirstRow[static_cast<std::size_t>(&pass - kPasses)]];
    if (idle_at == version_) {
      VITRINE_ASSERT(!pass.run(graph_));
      return false;
    }
    const bool changed = pass.run(graph_);
    if (changed || !pass.tells) ++version_;
    if (!changed && pass.tells) idle_at = version_;
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
  const Choice choice_;
  Printer printer_;
  std::uint32_t step_ = 0;     ///< optional steps that have run
  std::uint32_t version_ = 1;  ///< of the graph: another one where a step has, or may have, changed it
  /// By first row of a function: the last version that it left as it was. It need not see that again. (What a first
  /// round allows on top, opt_trivial_continues did then.)
  std::array<std::uint32_t, std::size(kPasses)> idle_at_{};
};

}  // namespace

std::span<const Pass> passes() { return kPasses; }

const Pass* find_pass(std::string_view name) {
  for (const Pass& pass : kPasses)
    if (name == pass.name) return &pass;
  return nullptr;
}

void run_passes(Graph& graph, const StepListener& listener, Steps steps) { Runner(graph, listener, steps).run(); }

}  // namespace vitrine::spirv::rewriting
