// A loop over mutated modules for compilers without libFuzzer. usage: vitrine_fuzz [SECONDS [SEED [MODULE.spv...]]] or
// FILE... Modules that run are mutated beside the seeds.
// The input at hand is kept in "fuzz-input" in the working folder when the process dies.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <unistd.h>

#include "tests/fuzz/module_fuzz.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/seeds.h"

namespace vitrine::fuzz {
namespace {

Words current;
VkShaderStageFlagBits current_stage = VK_SHADER_STAGE_COMPUTE_BIT;

void keep_input() {
  const int file = open("fuzz-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const std::uint8_t stage = number_of(current_stage);
  if (file < 0 || write(file, &stage, 1) != 1) return;
  if (write(file, current.data(), current.size() * 4) < 0) return;
  close(file);
}

constexpr int kDeaths[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
struct sigaction otherwise[std::size(kDeaths)];  // the sanitizer's

extern "C" void on_death(int signal) {
  keep_input();
  for (std::size_t i = 0; i < std::size(kDeaths); i++)
    if (kDeaths[i] == signal) sigaction(signal, &otherwise[i], nullptr);
  if (signal == SIGABRT) std::raise(signal);  // the others come again where this returns to
}

/// On a stack of its own, as the usual one may be what has run out.
void keep_input_on_death() {
  static char stack[1 << 16];
  stack_t given{};
  if (sigaltstack(nullptr, &given) != 0 || given.ss_flags == SS_DISABLE) {
    given.ss_sp = stack;
    given.ss_size = sizeof stack;
    given.ss_flags = 0;
    sigaltstack(&given, nullptr);
  }
  struct sigaction action {};
  action.sa_handler = on_death;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < std::size(kDeaths); i++) sigaction(kDeaths[i], &action, &otherwise[i]);
}

/// Runs the seeds; empty if one is refused.
std::vector<Module> run_seeds() {
  std::vector<Module> pool = compile_seeds();
  for (const Module& seed : pool) {
    current_stage = seed.stage;
    current = seed.words;
    if (run_module(current_stage, current) != Outcome::kRan) {
      std::fprintf(stderr, "a seed does not run\n");
      return {};
    }
  }
  return pool;
}

std::vector<std::uint8_t> read_bytes(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Modules of files, each for its first entry point; those that do not run are left out.
void add_modules(std::vector<Module>& pool, char** paths, int count) {
  for (int i = 0; i < count; i++) {
    std::vector<std::uint8_t> bytes = read_bytes(paths[i]);
    bytes.insert(bytes.begin(), 0);
    current = words_of(bytes);
    for (const VkShaderStageFlagBits stage : kStages) {
      current_stage = stage;
      if (run_module(stage, current) != Outcome::kRan) continue;
      pool.push_back({stage, current});
      break;
    }
  }
}

/// Mutants of seeds, of modules and of mutants that ran.
int loop(double seconds, std::uint64_t seed, char** modules, int count) {
  std::vector<Module> pool = run_seeds();
  if (pool.empty()) return 1;
  add_modules(pool, modules, count);
  const std::size_t seeds = pool.size();
  Random random(seed);
  std::size_t runs = 0, ran = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  double slowest = 0;
  while (elapsed() < seconds) {
    const Module& from = pool[static_cast<std::size_t>(random() % pool.size())];
    current_stage = from.stage;
    current = from.words;
    mutate(current, random);
    const std::clock_t before = std::clock();  // of the processor: others may be using it, too
    const Outcome outcome = run_module(current_stage, current);
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
  if (count > 1 && std::isdigit(static_cast<unsigned char>(arguments[1][0])) == 0) {
    // What other shaders leave in registers must not matter.
    if (run_seeds().empty()) return 1;
    for (int i = 1; i < count; i++) {
      const std::vector<std::uint8_t> bytes = read_bytes(arguments[i]);
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    return 0;
  }
  const double seconds = count > 1 ? std::atof(arguments[1]) : 60;
  return loop(seconds, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1, arguments + 3, std::max(count - 3, 0));
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
