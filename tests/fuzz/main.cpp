// A loop over mutated modules for compilers without libFuzzer. usage: vitrine_fuzz [SECONDS [SEED [MODULE.spv...]]] or
// FILE... Modules that run are mutated beside the seeds.
// The input at hand is kept in "fuzz-input" in the working folder when the process dies.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iterator>
#include <vector>

#include "tests/fuzz/last_input.h"
#include "tests/fuzz/module_fuzz.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/seeds.h"

namespace vitrine::fuzz {
namespace {

Words current;
VkShaderStageFlagBits current_stage = VK_SHADER_STAGE_COMPUTE_BIT;

/// As LLVMFuzzerTestOneInput() reads it: the stage, then the words.
Outcome run_current() {
  static std::vector<std::uint8_t> bytes;
  bytes.assign(1, number_of(current_stage));
  const auto* const words = reinterpret_cast<const std::uint8_t*>(current.data());
  bytes.insert(bytes.end(), words, words + current.size() * 4);
  set_input(bytes);
  return run_module(current_stage, current);
}

/// Runs the seeds; empty if one is refused.
std::vector<Module> run_seeds() {
  std::vector<Module> pool = compile_seeds();
  for (const Module& seed : pool) {
    current_stage = seed.stage;
    current = seed.words;
    if (run_current() != Outcome::kRan) {
      std::fprintf(stderr, "a seed does not run\n");
      return {};
    }
  }
  return pool;
}

/// Modules of files, each for its first entry point; those that do not run are left out.
void add_modules(std::vector<Module>& pool, char** paths, int count) {
  for (int i = 0; i < count; i++) {
    std::vector<std::uint8_t> bytes = read_bytes(paths[i]);
    bytes.insert(bytes.begin(), 0);
    current = words_of(bytes);
    for (const VkShaderStageFlagBits stage : kStages) {
      current_stage = stage;
      if (run_current() != Outcome::kRan) continue;
      pool.push_back({stage, current});
      break;
    }
  }
}

/// Mutants of seeds, of modules and of mutants that ran.
int loop(const Rounds& rounds, char** modules, int count) {
  std::vector<Module> pool = run_seeds();
  if (pool.empty()) return 1;
  add_modules(pool, modules, count);
  const std::size_t seeds = pool.size();
  Random random(rounds.seed);
  std::size_t runs = 0, ran = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  double slowest = 0;
  while (elapsed() < rounds.seconds) {
    const Module& from = pool[static_cast<std::size_t>(random() % pool.size())];
    current_stage = from.stage;
    current = from.words;
    mutate(current, random);
    const std::clock_t before = std::clock();  // of the processor: others may be using it, too
    const Outcome outcome = run_current();
    if (const double took = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC; took > slowest) {
      slowest = took;
      if (took > 10) keep_input();
    }
    runs++;
    if (outcome != Outcome::kRan) continue;
    ran++;
    if (pool.size() < seeds + 400)
      pool.push_back({current_stage, current});
    else
      pool[seeds + static_cast<std::size_t>(random() % (pool.size() - seeds))] = {current_stage, current};
  }
  std::printf("%zu mutants, %zu of them ran; the slowest took %.1f s\n", runs, ran, slowest);
  return 0;
}

int main(int count, char** arguments) {
  keep_input_on_death();
  if (names_files(count, arguments)) {
    // What other shaders leave in registers must not matter.
    if (run_seeds().empty()) return 1;
    return run_files(count, arguments);
  }
  return loop(rounds_of(count, arguments), arguments + 3, std::max(count - 3, 0));
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
