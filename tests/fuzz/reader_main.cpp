// A loop over mutated inputs of readers. usage: vitrine_reader_fuzz [SECONDS [SEED]] or FILE... Inputs that were taken
// are mutated beside the seeds. The input at hand is kept in "fuzz-input" in the working folder when the process dies.
#include <chrono>
#include <cstdio>
#include <iterator>
#include <map>

#include "tests/fuzz/last_input.h"
#include "tests/fuzz/mutate_text.h"
#include "tests/fuzz/readers.h"

namespace vitrine::fuzz {
namespace {

/// Inputs of one reader, without the byte that names it. The first are seeds and stay.
struct Pool {
  std::vector<std::string> inputs;
  std::size_t seeds = 0;
};

void keep(Pool& pool, std::string text, Random& random) {
  constexpr std::size_t kKept = 300;
  if (pool.inputs.size() < pool.seeds + kKept)
    pool.inputs.push_back(std::move(text));
  else
    pool.inputs[pool.seeds + below(random, kKept)] = std::move(text);
}

void loop(const Rounds& rounds) {
  constexpr std::size_t kLongest = 20000;
  std::map<char, Pool> pools;
  for (const std::string& input : reader_seeds()) {
    pools[input[0]].inputs.push_back(input.substr(1));
    ++pools[input[0]].seeds;
  }
  Random random(rounds.seed);
  std::size_t runs = 0, taken = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  while (elapsed() < rounds.seconds) {
    auto& [reader, pool] = *std::next(pools.begin(), static_cast<std::ptrdiff_t>(below(random, pools.size())));
    std::string text = pool.inputs[below(random, pool.inputs.size())];
    mutate_text(text, pool.inputs, random);
    if (text.size() > kLongest) continue;
    const std::string input = reader + text;
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    set_input(bytes);
    ++runs;
    if (!read_input(bytes)) continue;
    ++taken;
    keep(pool, std::move(text), random);
  }
  std::printf("%zu inputs, %zu of them taken\n", runs, taken);
}

int main(int count, char** arguments) {
  keep_input_on_death();
  for (const std::string& seed : reader_seeds()) {
    if (read_input({reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size()})) continue;
    std::fprintf(stderr, "a seed of reader %d is not taken\n", seed[0]);
    return 1;
  }
  if (names_files(count, arguments)) return run_files(count, arguments);
  loop(rounds_of(count, arguments));
  return 0;
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
