// A loop over mutated modules for compilers without libFuzzer. usage: vitrine_fuzz [SECONDS [SEED]] or FILE...
// The input at hand is kept in "fuzz-input" in the working folder when the process dies.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
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

extern "C" void on_death(int signal) {
  keep_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
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

/// Mutants of seeds and of mutants that ran.
int loop(double seconds, std::uint64_t seed) {
  std::vector<Module> pool = run_seeds();
  if (pool.empty()) return 1;
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
    const double before = elapsed();
    const Outcome outcome = run_module(current_stage, current);
    if (const double took = elapsed() - before; took > slowest) {
      slowest = took;
      if (took > 10) keep_input();
    }
    runs++;
    if (outcome != Outcome::kRan) continue;
    ran++;
    if (pool.size() < 400)
      pool.push_back({current_stage, current});
    else
      pool[seeds + static_cast<std::size_t>(random() % (pool.size() - seeds))] = {current_stage, current};
  }
  std::printf("%zu mutants, %zu of them ran; the slowest took %.1f s\n", runs, ran, slowest);
  return 0;
}

int main(int count, char** arguments) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, on_death);
  if (count > 1 && std::isdigit(static_cast<unsigned char>(arguments[1][0])) == 0) {
    // What other shaders leave in registers must not matter.
    if (run_seeds().empty()) return 1;
    for (int i = 1; i < count; i++) {
      std::ifstream file(arguments[i], std::ios::binary);
      const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    return 0;
  }
  const double seconds = count > 1 ? std::atof(arguments[1]) : 60;
  return loop(seconds, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
