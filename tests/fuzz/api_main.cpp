// A loop over random runs of the API for compilers without libFuzzer. usage: vitrine_api_fuzz [SECONDS [SEED]] or
// FILE...
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "tests/fuzz/api_world.h"
#include "tests/fuzz/last_input.h"

namespace vitrine::fuzz {
namespace {

constexpr std::size_t kBytes = 2048;  // more choices than a run makes

void loop(double seconds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> bytes(kBytes);
  std::size_t runs = 0;
  double slowest = 0;
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double start = now();
  for (double at = start; at - start < seconds;) {
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    set_input(bytes);
    keep_input();  // a process that is killed for its memory says nothing
    run_api(bytes.data(), bytes.size());
    ++runs;
    const double after = now();
    if (after - at > slowest) {
      slowest = after - at;
      if (slowest > 5) std::rename("fuzz-input", "fuzz-input-slow");
    }
    at = after;
  }
  std::remove("fuzz-input");
  std::printf("%zu runs; the slowest took %.1f s\n", runs, slowest);
}

int main(int count, char** arguments) {
  setenv("VITRINE_SHADER_BUDGET", "2000000", 0);
  if (names_files(count, arguments)) {
    for (int i = 1; i < count; ++i) {
      const std::vector<std::uint8_t> bytes = read_bytes(arguments[i]);
      run_api(bytes.data(), bytes.size());
    }
    return 0;
  }
  loop(count > 1 ? std::atof(arguments[1]) : 60, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
  return 0;
}

}  // namespace
}  // namespace vitrine::fuzz

int main(int count, char** arguments) { return vitrine::fuzz::main(count, arguments); }
